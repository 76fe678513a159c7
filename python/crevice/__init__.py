# SPDX-License-Identifier: MIT
"""Ambient occlusion from depth and normals.

    import crevice
    accessibility = crevice.ao(depth, vfov=60, radius=0.5)

Arrays have rows from top to bottom. Results are accessibility: 1 is open, 0 is fully
occluded, background is 1. Errors are subclasses of crevice.Error with the library's line;
warnings go to `warnings`, what was chosen goes to the logger "crevice" of `logging`.

Everything may be called from several threads. Calls that share a Context take turns;
ao() makes a context of its own, so calls of it run at the same time. The interpreter's
lock is released while Crevice computes. Ctrl-C ends a run: KeyboardInterrupt.
"""
import dataclasses
import logging
import math
import typing
import warnings

import numpy as np

from . import _crevice
from ._crevice import (Context, DeviceError, Error, GBuffer, InvalidArgument, NotReady,
                       OutOfMemory, Plan, Unsupported)

__all__ = ["Camera", "Context", "DeviceError", "Error", "Filter", "GBuffer",
           "InvalidArgument", "Method", "NotReady", "Option", "OutOfMemory", "Plan",
           "Unsupported", "ao", "filters", "methods", "options"]
__version__ = _crevice.version()

_IDENTITY = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)


@dataclasses.dataclass(frozen=True)
class Camera:
    """How pixels map to view space: right-handed, looking down -Z, +X right, +Y up.

    fx, fy: focal length in pixels, or pixels per scene unit if orthographic; > 0.
    cx, cy: principal point in pixels from the left and the top edge.
    world_to_view: rotation, nine numbers row by row; only normals in world space read it.
    """

    fx: float
    fy: float
    cx: float
    cy: float
    orthographic: bool = False
    world_to_view: typing.Tuple[float, ...] = _IDENTITY

    @classmethod
    def perspective(cls, width: int, height: int, vfov: float) -> "Camera":
        """Square pixels, centred. vfov: full vertical field of view, degrees, in (0, 180)."""
        if not 0 < vfov < 180:
            raise InvalidArgument(f"vfov: {vfov} is out of range; it is in (0, 180) degrees")
        if vfov < 3.2:
            warnings.warn(f"vfov: {vfov:g} is taken as degrees; {vfov:g} radians are "
                          f"{math.degrees(vfov):.4g} degrees", stacklevel=2)
        return cls._of(_crevice.camera_perspective(width, height, math.radians(vfov)))

    @classmethod
    def parallel(cls, width: int, height: int, view_height: float) -> "Camera":
        """Orthographic, square pixels, centred. view_height: scene units, > 0."""
        if not view_height > 0:
            raise InvalidArgument(f"view_height: {view_height} is not positive")
        return cls._of(_crevice.camera_orthographic(width, height, view_height))

    def look_at(self, eye, target, up=(0.0, 1.0, 0.0)) -> "Camera":
        """The same camera at eye, looking at target: sets world_to_view."""
        return self._of(_crevice.camera_look_at(self, tuple(eye), tuple(target), tuple(up)))

    def crop(self, x: int, y: int) -> "Camera":
        """The camera of the part whose top left pixel is (x, y); negative ones widen."""
        return dataclasses.replace(self, cx=self.cx - x, cy=self.cy - y)

    @classmethod
    def _of(cls, row) -> "Camera":
        return cls(*row[1:5], bool(row[0]), row[5])

    def _astuple(self):
        return (int(self.orthographic), self.fx, self.fy, self.cx, self.cy,
                tuple(self.world_to_view))


class Method(typing.NamedTuple):
    """A method of the registry."""

    name: str
    title: str
    paper: str
    hemisphere: str  # "uniform" or "cosine"
    options: typing.List[str]  # keys that it reads beyond those that every method reads
    bent_normal: bool  # gives bent normals


class Filter(typing.NamedTuple):
    """A filter of the registry."""

    name: str
    title: str
    paper: str
    options: typing.List[str]


class Option(typing.NamedTuple):
    """A row of the option table; default is that of the method asked for."""

    key: str
    type: str  # "float", "int", "bool" or "choice"
    unit: str
    default: float  # a choice's is the index in choices
    min: float
    max: float
    choices: typing.List[str]
    help: str


def methods() -> typing.List[Method]:
    """All methods."""
    return [Method(*row) for row in _crevice.methods()]


def filters() -> typing.List[Filter]:
    """All filters."""
    return [Filter(*row) for row in _crevice.filters()]


def options(method: typing.Optional[str] = None) -> typing.List[Option]:
    """Options that a method reads with its default filter. None: the default method."""
    return [Option(*row) for row in _crevice.options(method)]


def _plain(array):
    """What the C part takes: masked pixels become NaN."""
    if isinstance(array, np.ma.MaskedArray):
        kind = array.dtype if array.dtype.kind == "f" else np.float32
        return np.asarray(np.ma.filled(array.astype(kind), np.nan))
    if hasattr(array, "__array__") and not isinstance(array, np.ndarray):
        return np.asarray(array)
    return array


def _text(value) -> str:
    if isinstance(value, bool):
        return "on" if value else "off"
    return value if isinstance(value, str) else repr(value)


def _radius(gbuffer, width, height, camera) -> float:
    """5 % of the view's height at the median depth, as the tool chooses it."""
    depth = np.empty((height, width), np.float32)
    gbuffer.get_depth(depth)
    seen = depth[np.isfinite(depth)]
    if seen.size == 0:
        return 1.0
    scale = 1.0 if camera.orthographic else float(np.median(seen))
    radius = 0.05 * height * scale / camera.fy
    logging.getLogger("crevice").info("radius %g was chosen: 5 %% of the view's height", radius)
    return radius


def ao(depth, normals=None, *, vfov=None, camera=None, radius=None, method=None,
       preset="medium", filter=None, encoding="planar", near=0.0, far=0.0,
       background=math.inf, normal_space="view", layers=(), layer_kind="surfaces", guard=0,
       threads=0, exact=False, out=None, return_bent_normal=False, **values):
    """Accessibility of one frame: an array of float32, 1 open, 0 occluded.

    depth: (rows, columns), float16, float32, float64, uint8, uint16 or int16, any strides.
        Background is NaN, inf, zero, negative, or masked (numpy.ma).
    normals: (rows, columns, 3), any length but zero; None takes them from depth.
    vfov or camera: full vertical field of view in degrees, or a Camera of the whole array.
    radius: beyond it nothing occludes, scene units. None chooses 5 % of the view's height
        at the median depth, and logs it.
    method: a name of methods(); None for the default. preset: low, medium, high, ultra, paper.
    filter: a name of filters(), "none", or None for the method's default.
    encoding: planar, radial, hardware, reversed, disparity, normalised,
        normalised-reversed, gl or logarithmic; near and far belong to it. background: planar
        or radial depth from which on there is nothing.
    normal_space: "view" or "world" (by camera.world_to_view).
    layers: depth of further layers, up to three arrays. layer_kind: "surfaces" or "solid".
    guard: pixels on each side that occlude but get no result: one number, or (left, top,
        right, bottom). The result is smaller by them.
    threads: 0 for all processors. exact: sample exactly where the plain code does.
    out: an array of float32 to write to. Further keywords are options(method).
    return_bent_normal: returns (accessibility, bent normals). These are float32 (rows,
        columns, 3), unit vectors in view space along the mean open direction, background
        0. The method must be one whose Method.bent_normal is True.

    Raises Error (InvalidArgument is a ValueError, too) and TypeError. Safe to call from
    several threads at once.
    """
    if return_bent_normal and all(row.key != "bent_normal" for row in options(method)):
        raise InvalidArgument(
            f"return_bent_normal: {method or 'the default method'} gives no bent normals; "
            "choose one of " + ", ".join(row.name for row in methods() if row.bent_normal))
    depth = _plain(depth)
    rows, columns = np.shape(depth)[:2] if np.ndim(depth) in (2, 3) else (0, 0)
    if (vfov is None) == (camera is None):
        raise TypeError("ao() takes either vfov (degrees) or camera")
    if camera is None:
        camera = Camera.perspective(columns, rows, vfov)
    guard = (guard,) * 4 if isinstance(guard, int) else tuple(guard)
    context = Context(threads=threads, exact=exact)
    gbuffer = GBuffer(context, columns, rows, layers=1 + len(layers), layer_kind=layer_kind,
                      guard=guard)
    gbuffer.set_camera(camera)
    for index, layer in enumerate((depth, *map(_plain, layers))):
        gbuffer.set_depth(layer, layer=index, encoding=encoding, near=near, far=far,
                          background=background)
    if normals is not None:
        gbuffer.set_normals(_plain(normals), space=normal_space)
    texts = {key: _text(value) for key, value in values.items()}
    texts["radius"] = _text(float(_radius(gbuffer, columns, rows, camera)
                                  if radius is None else radius))
    if filter is not None:
        texts["filter"] = filter
    if return_bent_normal:
        texts["bent_normal"] = "on"
    plan = Plan(gbuffer, method=method, preset=preset, options=texts)
    size = (rows - guard[1] - guard[3], columns - guard[0] - guard[2])
    if out is None:
        out = np.empty(size, np.float32)
    return plan.run(gbuffer, out, np.empty((*size, 3), np.float32) if return_bent_normal else None)
