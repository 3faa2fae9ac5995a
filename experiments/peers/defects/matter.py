"""Volumes of which the truth is known without Raytruth, for the scripts of defects: a scene as adapters render it."""

import math

import numpy as np


def slab(shape=(9, 5, 5), opacity=0.1, color=(1, 1, 1), spacing=(1, 1, 1), value=0.5, size=9, along="z"):
    """A block of homogeneous matter, `opacity` per unit of length, seen along an axis through its middle."""
    voxels = np.full(shape, value)
    voxels.flat[0], voxels.flat[-1] = 0, 1  # some programs refuse volumes of one value; the middle does not see these corners
    middle = [(n - 1) * h / 2 for n, h in zip(shape[::-1], spacing)]
    axis = "xyz".index(along)
    eye = list(middle)
    eye[axis] += 50
    return {"voxels": voxels, "spacing": list(spacing), "border": "voxel_centres", "colors": [(0, color), (1, color)], "opacities": [(0, opacity), (1, opacity)], "unit": 1 / min(spacing),
            "camera": {"eye": eye, "target": middle, "up": [0, 1, 0] if along != "y" else [0, 0, 1], "height": 0.5, "size": [size, size]}}


def length_of(scene, along="z"):
    axis = "xyz".index(along)
    return (scene["voxels"].shape[2 - axis] - 1) * scene["spacing"][axis]


def opacity_of(scene, opacity, length):
    return 1 - (1 - opacity) ** length


def middle(image):
    return image[image.shape[0] // 2, image.shape[1] // 2]


def emitted(depth):
    return -math.expm1(-depth)
