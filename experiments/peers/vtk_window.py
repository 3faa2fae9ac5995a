"""What the adapters of VTK and the scripts of its defects share: off-screen windows, cameras, images in binary32."""

import os
import sys

import numpy as np

import questions

try:
    import vtkmodules.all as vtk
    from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
except ImportError:
    questions.missing("VTK's Python modules are missing: the package python3-vtk9 has them, and /usr/bin/python3 finds them")

VERSION = "VTK " + vtk.vtkVersion.GetVTKVersion()

_windows = []  # kept: Xvfb begins anew when its last client leaves, and the next window may then fail to connect


def need_display():
    if "DISPLAY" not in os.environ:
        questions.missing("no X display: xvfb-run -a of the packages xvfb and xauth gives one")


def functions_of(colors, opacities):
    color, opacity = vtk.vtkColorTransferFunction(), vtk.vtkPiecewiseFunction()
    color.AllowDuplicateScalarsOn()  # or two points at one scalar are no jump
    opacity.AllowDuplicateScalarsOn()
    for s, rgb in colors:
        color.AddRGBPoint(s, *rgb)
    for s, value in opacities:
        opacity.AddPoint(s, value)
    return color, opacity


def property_of(colors, opacities, unit, shading=None):
    found = vtk.vtkVolumeProperty()
    color, opacity = functions_of(colors, opacities)
    found.SetColor(color)
    found.SetScalarOpacity(opacity)
    found.SetScalarOpacityUnitDistance(unit)
    found.SetInterpolationTypeToLinear()
    if shading:
        found.ShadeOn()
        found.SetAmbient(shading["ambient"])
        found.SetDiffuse(shading["diffuse"])
        found.SetSpecular(shading["specular"])
        found.SetSpecularPower(shading["shininess"])
    return found


def image_data(voxels, spacing, kind="f4"):
    image = vtk.vtkImageData()
    image.SetDimensions(voxels.shape[::-1])
    image.SetSpacing(spacing)
    image.GetPointData().SetScalars(numpy_to_vtk(voxels.astype(kind).ravel(), deep=True))
    return image


def tetrahedra(voxels, spacing, kind="f4"):
    """Every cell as five tetrahedra: inside of them the scalar is linear, not trilinear."""
    cut = vtk.vtkDataSetTriangleFilter()
    cut.SetInputData(image_data(voxels, spacing, kind))
    cut.Update()
    return cut.GetOutput()


def aim(camera, given):
    camera.SetPosition(given["eye"])
    camera.SetFocalPoint(given["target"])
    camera.SetViewUp(given["up"])
    if "fov_y" in given:
        camera.SetViewAngle(given["fov_y"])
    else:
        camera.ParallelProjectionOn()
        camera.SetParallelScale(given["height"] / 2)


def renderer_of(volume, camera, shading=None):
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(0, 0, 0)
    renderer.SetBackgroundAlpha(0)
    renderer.AddVolume(volume)
    aim(renderer.GetActiveCamera(), camera)
    renderer.ResetCameraClippingRange()
    if shading:
        renderer.RemoveAllLights()
        renderer.AutomaticLightCreationOff()
        lamp = vtk.vtkLight()
        lamp.SetLightTypeToSceneLight()
        lamp.PositionalOff()
        lamp.SetFocalPoint(0, 0, 0)
        lamp.SetPosition(shading["light"])
        lamp.SetAmbientColor(1, 1, 1)  # black by default: no ambient light at all
        renderer.AddLight(lamp)
    return renderer


def window_of(renderer, size):
    need_display()
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.AlphaBitPlanesOn()
    window.SetSize(size)
    window.AddRenderer(renderer)
    _windows.append(window)
    return window


def render(volume, camera, shading=None):
    """[row, column, rgba] in binary32: the window would keep 8 bits, a pass of its own does not."""
    renderer = renderer_of(volume, camera, shading)
    width, height = camera["size"]
    window = window_of(renderer, camera["size"])
    target = vtk.vtkFramebufferPass()
    target.SetColorFormat(vtk.vtkTextureObject.Float32)
    target.SetDepthFormat(vtk.vtkTextureObject.Native)  # others leave the GPU mapper's image black, without a word
    target.SetDelegatePass(vtk.vtkRenderStepsPass())
    renderer.SetPass(target)
    window.Render()
    pixels = np.empty((height, width, 4), "f4")
    target.GetColorTexture().Download().Download2D(vtk.VTK_FLOAT, pixels, (width, height), 4, (0, 0))
    return pixels[::-1].astype(float)


def render_8_bits(volume, camera, shading=None):
    """[row, column, rgba] of what the window itself keeps."""
    width, height = camera["size"]
    window = window_of(renderer_of(volume, camera, shading), camera["size"])
    window.Render()
    image = vtk.vtkWindowToImageFilter()  # GetRGBAPixelData finds nothing of projected tetrahedra
    image.SetInput(window)
    image.SetInputBufferTypeToRGBA()
    image.ReadFrontBufferOff()
    image.Update()
    return vtk_to_numpy(image.GetOutput().GetPointData().GetScalars()).reshape(height, width, 4)[::-1] / 255


def run_adapter(render_scene):
    """What the adapters of images do: --version, or a scene in and an image out."""
    words = [word for word in sys.argv[1:] if "=" not in word]
    if words == ["--version"]:
        return print(VERSION)
    scene = questions.ask()
    scene["voxels"] = questions.voxels_of(scene)
    low, high = float(scene["voxels"].min()), float(scene["voxels"].max())
    scene["colors"], scene["opacities"], scene["unit"] = questions.opacity_function(scene, low, high)
    questions.answer_image(render_scene(scene, words, questions.words_of(word for word in sys.argv[1:] if "=" in word)))
