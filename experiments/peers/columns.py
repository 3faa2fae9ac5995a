"""Any renderer of voxels answers vectors: a ray becomes a volume of 3 x 3 columns, seen along z through one pixel.

    columns.py ADAPTER [WORD...] [samples=1024] < vectors.json > answers.csv

ADAPTER is a module here that has render(scene, words, options). It samples every ray, and every slab, so often.
"""

import importlib
import sys

import numpy as np

import questions


def scene_of(vector):
    """Voxel k is sample k, so lengths are in voxels, and extinctions per voxel."""
    length, front, back = questions.segments_of(vector)
    samples = np.array([*front, back[-1]])
    count = len(front)
    colors, densities, unit = questions.lists_of(vector)
    low, high = (choose([*samples, colors[0][0], colors[-1][0], densities[0][0], densities[-1][0]]) for choose in (min, max))
    colors, opacities, unit = questions.opacity_function(vector, low, high, length)
    # The front is next to the eye, which looks along -z.
    voxels = np.broadcast_to(samples[::-1, None, None], (count + 1, 3, 3)).copy()
    camera = {"eye": [1, 1, 2 * count + 4], "target": [1, 1, count / 2], "up": [0, 1, 0], "height": 0.5, "size": [5, 5]}
    return {"voxels": voxels, "spacing": [1, 1, 1], "border": "voxel_centres", "colors": colors, "opacities": opacities, "unit": unit / length, "camera": camera}


def main():
    adapter = importlib.import_module(sys.argv[1])
    words = [word for word in sys.argv[2:] if "=" not in word]
    options = questions.words_of(word for word in sys.argv[2:] if "=" in word)
    if words == ["--version"]:
        return print(adapter.version())
    samples, answers = float(options.pop("samples", 1024)), {}
    for vector in questions.associated(questions.ask()["vectors"]):
        scene = scene_of(vector)
        image = adapter.render(scene, words, {**options, "step": (len(scene["voxels"]) - 1) / samples})
        if image is not None:
            answers[vector["id"]] = image[2, 2]
    questions.answer_vectors(answers)


if __name__ == "__main__":
    main()
