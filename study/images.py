# SPDX-License-Identifier: MIT
"""Pictures: read and written through OpenImageIO, coloured, cut."""
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import OpenImageIO as oiio

# Colours of an error: too dark, right, too bright; and of what has no surface.
DARK, RIGHT, BRIGHT = (0.13, 0.35, 0.75), (1.0, 1.0, 1.0), (0.86, 0.40, 0.05)
NOTHING = (0.55, 0.55, 0.58)


class PictureError(Exception):
    """A picture that cannot be read or written; says which."""


@dataclass(frozen=True)
class Frame:
    """A file's pixels inside the display window, and what lies around it."""
    channels: dict[str, np.ndarray]  # height x width each, float32
    guard: tuple[int, int]  # columns on the left and rows on the top, px
    whole: dict[str, np.ndarray]  # the same with the guard band

    def vector(self, name: str) -> np.ndarray:
        return np.stack([self.channels[f"{name}.{axis}"] for axis in "XYZ"], axis=-1)


def read(path: Path) -> Frame:
    file = oiio.ImageInput.open(str(path))
    if not file:
        raise PictureError(f"{path}: cannot be read: {oiio.geterror()}")
    spec = file.spec()
    pixels = file.read_image(oiio.FLOAT)
    file.close()
    if pixels is None:
        raise PictureError(f"{path}: cannot be read to its end; remove it and run again")
    pixels = pixels.reshape(spec.height, spec.width, spec.nchannels)
    left, top = spec.full_x - spec.x, spec.full_y - spec.y
    whole = {n: pixels[..., i] for i, n in enumerate(spec.channelnames)}
    inside = np.s_[top:top + spec.full_height, left:left + spec.full_width]
    return Frame({n: p[inside] for n, p in whole.items()}, (left, top), whole)


def read_single(path: Path, channel: str = "AO") -> np.ndarray:
    channels = read(path).channels
    return channels[channel] if channel in channels else next(iter(channels.values()))


def write_exr(path: Path, channels: dict[str, np.ndarray], guard: int = 0) -> None:
    """guard: rows and columns on each side that lie outside the display window."""
    first = next(iter(channels.values()))
    height, width = first.shape
    spec = oiio.ImageSpec(width, height, len(channels), oiio.FLOAT)
    spec.channelnames = tuple(channels)
    spec.x = spec.y = -guard
    spec.full_width, spec.full_height = width - 2 * guard, height - 2 * guard
    spec.attribute("compression", "zip")
    write(path, spec, np.stack(list(channels.values()), axis=-1).astype(np.float32))


def write(path: Path, spec: oiio.ImageSpec, pixels: np.ndarray) -> None:
    file = oiio.ImageOutput.create(str(path))
    if not file or not file.open(str(path), spec) or not file.write_image(pixels):
        raise PictureError(f"{path}: cannot be written: {oiio.geterror()}")
    file.close()


def write_png(path: Path, pixels: np.ndarray) -> None:
    """Grey (height x width) or colour (height x width x 3), 0 to 1."""
    levels = (np.clip(np.nan_to_num(pixels), 0, 1) * 255 + 0.5).astype(np.uint8)
    levels = levels.reshape(levels.shape[0], levels.shape[1], -1)
    write(path, oiio.ImageSpec(levels.shape[1], levels.shape[0], levels.shape[2], oiio.UINT8),
          levels)


def error_map(a: np.ndarray, b: np.ndarray, mask: np.ndarray, scale: float) -> np.ndarray:
    """Colours of a - b: blue too dark, white right, orange too bright."""
    share = np.clip((a - b) / scale, -1, 1)[..., None]
    right, dark, bright = (np.array(c) for c in (RIGHT, DARK, BRIGHT))
    colour = np.where(share < 0, right + (dark - right) * -share,
                      right + (bright - right) * share)
    return np.where(mask[..., None], colour, np.array(NOTHING))


def busiest_window(picture: np.ndarray, width: int, height: int, tries: int = 6
                   ) -> tuple[slice, slice]:
    """Rows and columns of the window in which the picture varies most."""
    rows, columns = picture.shape
    width, height = min(width, columns), min(height, rows)
    windows = [np.s_[y:y + height, x:x + width]
               for y in np.linspace(0, rows - height, tries).astype(int)
               for x in np.linspace(0, columns - width, tries).astype(int)]
    return max(windows, key=lambda window: float(np.var(picture[window])))
