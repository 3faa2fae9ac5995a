from defect import Defect, main

import numpy as np

DEFECT = Defect(
    title="VTK draws the images of its CPU ray casters stretched by one pixel, and blurred",
    where="Rendering/VolumeOpenGL2/vtkOpenGLRayCastImageDisplayHelper.cxx, RenderTextureInternal, lines 139-157 of d5345fac (2026-08-22).",
    what="""The image is drawn as a textured quadrilateral. Its texture coordinates are inset by half a texel at both ends; its corners are
        not, but lie at the borders of the outermost pixels. So the centres of N texels are spread from border to border of N pixels:
        pixel i reads the texel at (i + 1/2)(N - 1)/N, up to half a pixel off where the image ends, and linear filtering blurs it. The image
        in use follows the volume's bounds on the screen, so that the volume swells and shrinks while it turns. The buffer before it is
        drawn is right. Users: vtkFixedPointVolumeRayCastMapper, vtkUnstructuredGridVolumeRayCastMapper and ...ZSweepMapper.""",
    repair="leave the texture coordinates at 0 and InUseSize / MemorySize (each texel then covers its pixel), or inset the corners by half a pixel too.",
    quantity="by how many pixels the window's image is larger than the buffer's: least squares over all pixels",
    tolerance=0.1,
)


def registered(reference, image):
    """(wider, taller) in pixels: least squares of the error on the reference's derivatives, as `compare --register` does."""
    height, width = reference.shape
    down, right = np.gradient(reference)
    row, column = np.mgrid[0:height, 0:width]
    x, y = (column - (width - 1) / 2) / width, (row - (height - 1) / 2) / height
    blur = np.gradient(right, axis=1) + np.gradient(down, axis=0)
    terms = np.stack([right, right * x, down, down * y, blur], -1).reshape(-1, 5)
    found = np.linalg.lstsq(terms, (image - reference).ravel(), rcond=None)[0]
    # What is wider by w reads its pixel at x from x (1 - w / width): the error is -w x times the derivative, per width.
    return -found[1], -found[3]


def measure():
    import vtk_raycasters

    n = 33
    z, y, x = np.mgrid[0:n, 0:n, 0:n] - (n - 1) / 2
    voxels = np.exp(-(x**2 + (y / 1.2) ** 2 + (z / 0.8) ** 2) / 60)
    scene = {"voxels": voxels, "spacing": [1, 1, 1], "colors": [(0, (1, 1, 1)), (1, (1, 1, 1))], "opacities": [(0, 0), (1, 0.2)], "unit": 1,
             "camera": {"eye": [16, 16, 100], "target": [16, 16, 16], "up": [0, 1, 0], "height": n - 1, "size": [96, 96]}}
    buffer, window = (vtk_raycasters.render(scene, [name], {"step": 0.5})[..., 3] for name in ("fixed_point_buffer", "fixed_point_window"))
    wider, taller = registered(buffer, window)
    yield "wider", 0, wider
    yield "taller", 0, taller


if __name__ == "__main__":
    from vtk_window import VERSION

    main(DEFECT, VERSION, measure)
