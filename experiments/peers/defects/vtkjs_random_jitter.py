from defect import Defect, main

DEFECT = Defect(
    title="vtk.js shows another image of the same scene every time",
    where="Sources/Rendering/OpenGL/VolumeMapper/index.js of vtk.js 37.4.3: the jitter texture is made by Math.random(), and always used.",
    what="""The first sample of each ray is moved by a random share of the step, which hides wood-grain artefacts; but the shares are new in every
        page, can be neither seeded nor switched off, so that images cannot be compared, not by a test nor by a physician. At large steps the
        two images here differ in the first decimal.""",
    repair="make the texture from a fixed seed, and let jitter be switched off as VTK's UseJittering does.",
    quantity="largest difference of two images of one scene",
    tolerance=0.5 / 255,
)


def measure():
    import numpy as np

    import vtkjs

    n = 17
    z, y, x = np.mgrid[0:n, 0:n, 0:n] - (n - 1) / 2
    scene = {"voxels": np.exp(-(x**2 + y**2 + z**2) / 20), "spacing": [1, 1, 1], "border": "voxel_centres", "colors": [(0, (1, 1, 1)), (1, (1, 1, 1))], "opacities": [(0, 0), (0.4, 0), (0.5, 0.9), (0.6, 0), (1, 0)], "unit": 1,
             "camera": {"eye": [40, 30, 50], "target": [8, 8, 8], "up": [0, 1, 0], "height": 16, "size": [32, 32]}}
    first, second = (vtkjs.render(scene, [], {"step": 1}) for _ in range(2))
    yield "step 1", 0, abs(first - second).max()


if __name__ == "__main__":
    import vtkjs

    main(DEFECT, vtkjs.version(), measure)
