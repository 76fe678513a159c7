#!/bin/sh
# SPDX-License-Identifier: MIT
# Makes docs/courtyard.png, the README's picture: ./demo's scene, lit and the occlusion
# alone, side by side: docs/courtyard_picture.sh [CREVICE]. Needs Debian's
# python3-openimageio.
set -eu
root=$(cd -- "$(dirname -- "$0")/.." && pwd)
crevice=${1:-$root/build/release/tools/crevice/crevice}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$crevice" render builtin:courtyard --size 640x360 --aa 2 -q -o "$work/ao.png" \
    --lit "$work/lit.png"
/usr/bin/python3 - "$work/lit.png" "$work/ao.png" "$root/docs/courtyard.png" <<'END'
import sys
import OpenImageIO as oiio

*halves, out = sys.argv[1:]
both = oiio.ImageBuf(oiio.ImageSpec(1284, 360, 3, "uint8"))
oiio.ImageBufAlgo.fill(both, (1.0, 1.0, 1.0))
for i, half in enumerate(halves):
    picture = oiio.ImageBuf(half)
    three = oiio.ImageBufAlgo.channels(picture, (0, 1, 2) if picture.nchannels > 2 else (0, 0, 0))
    oiio.ImageBufAlgo.paste(both, 644 * i, 0, 0, 0, three)
if not both.write(out):
    sys.exit(both.geterror())
END
