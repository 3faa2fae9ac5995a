"""VTK's ray casters of regular grids render a scene: vtk_raycasters.py NAME [step=VOXELS] < scene.json > image.npy

NAME: gpu (vtkOpenGLGPUVolumeRayCastMapper), fixed_point_buffer and fixed_point_window (vtkFixedPointVolumeRayCastMapper,
before and after its buffer is drawn into the window).
"""

import ctypes

import numpy as np

from vtk_window import VERSION, image_data, property_of, renderer_of, run_adapter, vtk, window_of
from vtk_window import render as render_window


def version():
    return VERSION


def mapper_of(name, scene, step, kind="f4"):
    if name == "gpu":
        mapper = vtk.vtkOpenGLGPUVolumeRayCastMapper()
        mapper.UseJitteringOff()
    else:
        mapper = vtk.vtkFixedPointVolumeRayCastMapper()
        mapper.SetNumberOfThreads(1)
    mapper.SetInputData(image_data(scene["voxels"], scene["spacing"], kind))
    mapper.AutoAdjustSampleDistancesOff()
    mapper.SetSampleDistance(step)
    mapper.SetImageSampleDistance(1)
    return mapper


def buffer_of(mapper, width, height):
    """What the fixed point mapper computed, 15 bits a channel; Python knows of it only an address."""
    image = mapper.GetRayCastImage()
    left, bottom = image.GetImageOrigin()
    used, stored = image.GetImageInUseSize(), image.GetImageMemorySize()
    address = int(image.GetImage().split("_")[1], 16)
    numbers = np.ctypeslib.as_array((ctypes.c_ushort * (4 * stored[0] * stored[1])).from_address(address))
    result = np.zeros((height, width, 4))
    result[bottom:bottom + used[1], left:left + used[0]] = numbers.reshape(stored[1], stored[0], 4)[:used[1], :used[0]] / 32767
    return result[::-1]


def render(scene, words, options):
    name, = words
    step = float(options.get("step", scene.get("step", 1))) * min(scene["spacing"])
    shading = scene.get("shading")
    mapper, volume = mapper_of(name, scene, step, options.get("voxels", "f4")), vtk.vtkVolume()
    volume.SetMapper(mapper)
    volume.SetProperty(property_of(scene["colors"], scene["opacities"], scene["unit"] * min(scene["spacing"]), shading))
    if name != "fixed_point_buffer":
        return render_window(volume, scene["camera"], shading)
    window_of(renderer_of(volume, scene["camera"], shading), scene["camera"]["size"]).Render()
    return buffer_of(mapper, *scene["camera"]["size"])


if __name__ == "__main__":
    run_adapter(render)
