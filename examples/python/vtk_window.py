# SPDX-License-Identifier: MIT
"""Ambient occlusion for a VTK window, off screen: its z-buffer in, its picture darkened.
Usage: vtk_window.py OUT.png (without a display: xvfb-run vtk_window.py OUT.png)
"""
import sys

import matplotlib.image
import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

import crevice


def window():
    """A torus of spheres on a plane."""
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    parts = [(vtk.vtkPlaneSource(), (0, 0, 0), 12)]
    for angle in np.linspace(0, 2 * np.pi, 12, endpoint=False):
        sphere = vtk.vtkSphereSource()
        sphere.SetThetaResolution(48)
        sphere.SetPhiResolution(48)
        parts.append((sphere, (3 * np.cos(angle), 3 * np.sin(angle), 0.9), 2))
    for source, place, scale in parts:
        mapper = vtk.vtkPolyDataMapper()
        mapper.SetInputConnection(source.GetOutputPort())
        actor = vtk.vtkActor()
        actor.SetMapper(mapper)
        actor.SetPosition(*place)
        actor.SetScale(scale)
        renderer.AddActor(actor)
    result = vtk.vtkRenderWindow()
    result.SetOffScreenRendering(1)
    result.SetMultiSamples(0)
    result.SetSize(640, 480)
    result.AddRenderer(renderer)
    camera = renderer.GetActiveCamera()
    camera.SetPosition(0, -9, 7)
    camera.SetFocalPoint(0, 0, 0)
    camera.SetViewUp(0, 0, 1)
    renderer.ResetCameraClippingRange()
    result.Render()
    return result, camera


def main(out):
    shown, camera = window()
    columns, rows = shown.GetSize()
    z, colours = vtk.vtkFloatArray(), vtk.vtkUnsignedCharArray()
    shown.GetZbufferData(0, 0, columns - 1, rows - 1, z)
    shown.GetPixelData(0, 0, columns - 1, rows - 1, 1, colours, 0)
    depth = vtk_to_numpy(z).reshape(rows, columns)[::-1]  # VTK's first row is the lowest
    picture = vtk_to_numpy(colours).reshape(rows, columns, 3)[::-1] / 255
    near, far = camera.GetClippingRange()
    result = crevice.ao(depth, vfov=camera.GetViewAngle(), radius=1.2,
                        encoding="hardware", near=near, far=far)
    matplotlib.image.imsave(out, picture * result[..., None])


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
