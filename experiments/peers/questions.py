"""What Raytruth asks a program from outside, and how it is answered: every adapter here uses this, and nothing of Raytruth's.

A question comes as JSON on standard input: vectors, to be answered by CSV, or a scene, to be answered by a .npy image.
"""

import csv
import io
import json
import math
import os
import pathlib
import sys

import numpy as np

MISSING = 3  # the exit code that says that something is missing on this machine


def missing(what):
    """Ends the program: Raytruth makes a refused row of it, which quotes `what`."""
    print(what, file=sys.stderr)
    sys.exit(MISSING)


def ask():
    return json.load(sys.stdin)


# --- vectors ---


def length_of(vector):
    return vector["slab"]["length"] if "slab" in vector else vector["signal"]["breaks"][-1]


def scalar_at(vector, t):
    if "slab" in vector:
        slab = vector["slab"]
        return slab["front"] + (slab["back"] - slab["front"]) * (t / slab["length"])
    breaks, pieces = vector["signal"]["breaks"], vector["signal"]["coefficients"]
    i = next((i for i in range(len(pieces) - 1) if t < breaks[i + 1]), len(pieces) - 1)
    value = 0.0
    for coefficient in reversed(pieces[i]):
        value = value * (t - breaks[i]) + coefficient
    return value


def samples_of(vector, count=64):
    """Those of the question; of vectors as `raytruth vectors` writes them, so many intervals' along a ray, one slab's."""
    if "samples" in vector:
        return vector["samples"]
    count = 1 if "slab" in vector else count
    return [scalar_at(vector, length_of(vector) * i / count) for i in range(count + 1)]


def segments_of(vector):
    """Their length, and the scalars at their fronts and at their backs, front to back."""
    samples = samples_of(vector)
    return length_of(vector) / (len(samples) - 1), samples[:-1], samples[1:]


def associated(vectors):
    """Those that shipping renderers can answer: none has emission that does not need matter."""
    return [vector for vector in vectors if vector["emission"] == "associated"]


def answer_vectors(answers):
    """Writes {id: (r, g, b, opacity)}; a copy goes to the folder of PEERS_ANSWERS, which experiments/peers/run sets."""
    text = io.StringIO()
    out = csv.writer(text, lineterminator="\n")
    out.writerow(["id", "r", "g", "b", "opacity"])
    for name, rgba in answers.items():
        out.writerow([name, *(repr(float(x)) for x in rgba)])
    sys.stdout.write(text.getvalue())
    if folder := os.environ.get("PEERS_ANSWERS"):
        pathlib.Path(folder, name_of_answers(sys.argv)).write_text(text.getvalue())


def name_of_answers(words):
    """vtk_integrators_linear.csv of the words vtk_integrators.py linear: options are left out."""
    return "_".join(pathlib.Path(word).stem for word in words if "=" not in word) + ".csv"


# --- transfer functions: colours and densities, each a list of (scalar, value), two of them at one scalar for a jump ---


def lists_of(question):
    """(colours, densities, unit): densities are opacities of the length `unit`, or extinctions where it is None."""
    lists = question.get("separate_lists")
    if lists:
        name = "opacity" if "opacity" in lists else "extinction"
        return [(p["s"], p["color"]) for p in lists["color"]], [(p["s"], p[name]) for p in lists[name]], lists.get("unit_length")
    function = question["transfer_function"]
    unit = function.get("unit_length")
    name = "extinction" if unit is None else "opacity"
    points = function["points"]
    return [(p["s"], p["color"]) for p in points], [(p["s"], p[name]) for p in points], unit


def widened(points, low, high):
    """The same list where it is said for all scalars from low to high: beyond its ends it is constant."""
    front = [(low, points[0][1])] if low < points[0][0] else []
    back = [(high, points[-1][1])] if high > points[-1][0] else []
    return front + points + back


def opacities_of(extinctions, length, parts=256):
    """Extinctions that are linear between points as opacities of `length`, which are not: through so many points each."""
    points = []
    for (a, x), (b, y) in zip(extinctions, extinctions[1:]):
        count = 1 if a == b or x == y else parts
        points += [(a + i / count * (b - a), -math.expm1(-(x + i / count * (y - x)) * length)) for i in range(count)]
    s, x = extinctions[-1]
    return points + [(s, -math.expm1(-x * length))]


def opacity_function(question, low, high, length=1.0):
    """(colours, opacities, unit) from low to high, whatever the question states: extinctions are taken over `length`."""
    colors, densities, unit = lists_of(question)
    colors, densities = widened(colors, low, high), widened(densities, low, high)
    if unit is not None:
        return colors, densities, unit
    return colors, opacities_of(densities, length), length


# --- scenes ---


def voxels_of(scene):
    """As [z, y, x]; a question's volume is a file, or stands in the scene."""
    volume = scene["volume"]
    if isinstance(volume, dict):
        return np.array(volume["values"], float).reshape(volume["size"][::-1])
    return np.load(volume)


def answer_image(image):
    """Writes [row, column, (r, g, b, opacity)], opacity-weighted linear light, the topmost row first."""
    np.save(sys.stdout.buffer, np.ascontiguousarray(image, "<f4"))


def words_of(text):
    """{"step": "0.25"} of ["step=0.25"]."""
    return dict(word.split("=", 1) for word in text)
