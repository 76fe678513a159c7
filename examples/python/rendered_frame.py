# SPDX-License-Identifier: MIT
"""A rendered frame through OpenImageIO. Usage: rendered_frame.py IN.exr OUT.png VFOV RADIUS

Takes the depth channel ("Z", "ViewLayer.Depth.Z") and reconstructs normals from it. VFOV in
degrees, RADIUS in scene units. The tool (crevice ao) knows the conventions of many
renderers; this does not.
"""
import sys

import matplotlib.image
import OpenImageIO as oiio

import crevice


def depth_of(path):
    """The depth channel of an EXR as an array."""
    image = oiio.ImageInput.open(path)
    if image is None:
        sys.exit(f"{path}: {oiio.geterror()}")
    names = image.spec().channelnames
    depth = [i for i, name in enumerate(names)
             if name == "Z" or name.lower().endswith("depth.z")]
    if not depth:
        sys.exit(f"{path}: no depth channel among {', '.join(names)}")
    return image.read_image(oiio.FLOAT)[..., depth[0]]


def main(path, out, vfov, radius):
    result = crevice.ao(depth_of(path), vfov=float(vfov), radius=float(radius),
                        background=1e9)
    matplotlib.image.imsave(out, result, cmap="gray", vmin=0, vmax=1)


if __name__ == "__main__":
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    main(*sys.argv[1:])
