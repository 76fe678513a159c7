# SPDX-License-Identifier: MIT
"""Writes a PNG of 8-bit RGB or RGBA with a palette: fewer_colours.py PICTURE.

Channels are rounded to whole steps, the smallest with which 256 colours are enough.
"""
import struct
import sys
import zlib


def chunks(data):
    at = 8
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        yield kind, data[at + 8:at + 8 + size]
        at += 12 + size


def paeth(a, b, c):
    p = a + b - c
    near = (abs(p - a), abs(p - b), abs(p - c))
    return (a, b, c)[near.index(min(near))]


def unfilter(kind, row, above, bpp):
    for i in range(len(row)):
        a = row[i - bpp] if i >= bpp else 0
        c = above[i - bpp] if i >= bpp else 0
        guess = (0, a, above[i], (a + above[i]) // 2, paeth(a, above[i], c))[kind]
        row[i] = (row[i] + guess) & 255
    return row


def read(path):
    """Rows of (r, g, b)."""
    with open(path, "rb") as file:
        parts = list(chunks(file.read()))
    width, height, depth, colour, _, _, interlace = struct.unpack(">IIBBBBB", parts[0][1])
    if depth != 8 or colour not in (2, 6) or interlace:
        sys.exit(f"{path}: is not a plain PNG of 8-bit RGB or RGBA")
    bpp = 3 if colour == 2 else 4
    pixels = zlib.decompress(b"".join(body for kind, body in parts if kind == b"IDAT"))
    above, rows = bytearray(width * bpp), []
    for y in range(height):
        at = y * (width * bpp + 1)
        row = bytearray(pixels[at + 1:at + 1 + width * bpp])
        above = unfilter(pixels[at], row, above, bpp)
        rows.append([tuple(above[i:i + 3]) for i in range(0, len(above), bpp)])
    return rows


def write(path, rows, palette):
    index = {colour: i for i, colour in enumerate(palette)}
    body = b"".join(b"\0" + bytes(index[c] for c in row) for row in rows)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        for kind, part in ((b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows),
                                                 8, 3, 0, 0, 0)),
                           (b"PLTE", b"".join(bytes(c) for c in palette)),
                           (b"IDAT", zlib.compress(body, 9)), (b"IEND", b"")):
            file.write(struct.pack(">I", len(part)) + kind + part
                       + struct.pack(">I", zlib.crc32(kind + part)))


def main(path):
    rows = read(path)
    for step in range(1, 129):
        rounded = [[tuple(min(255, (v + step // 2) // step * step) for v in c)
                    for c in row] for row in rows]
        palette = sorted({c for row in rounded for c in row})
        if len(palette) <= 256:
            write(path, rounded, palette)
            return


if __name__ == "__main__":
    main(sys.argv[1])
