"""What the tests of the program share: they drive it from outside, as a user does."""

import copy
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["RAYTRUTH"]
SOURCE = pathlib.Path(os.environ["RAYTRUTH_SOURCE"])

# The ray example of the program's interface.
RAY = {
    "signal": {
        "kind": "piecewise_polynomial",
        "breaks": [0, 1, 2.5],
        "coefficients": [[0.1, 0.5], [0.6, -0.2, 0.05, 0.01]],
    },
    "transfer_function": {
        "points": [
            {"s": 0, "extinction": 0, "color": [0, 0, 0]},
            {"s": 1, "extinction": 8, "color": [1, 0.5, 0.2]},
        ]
    },
    "emission": "associated",
    "sampling": {"kind": "constant", "step": 0.25},
    "schemes": ["reference", "order0_mid", "order1", "order2", "virtual_catmull_rom"],
}

# A ray from corner to corner through one cell: x y z with all coordinates t / sqrt(3).
VOLUME_RAY = {
    "signal": {
        "kind": "trilinear",
        "volume": {"size": [2, 2, 2], "values": [0, 0, 0, 0, 0, 0, 0, 1]},
        "origin": [0, 0, 0],
        "direction": [1, 1, 1],
        "length": 3**0.5,
    },
    "sampling": {"kind": "cells"},
    "schemes": ["order0_left", "order0_right", "order0_mid", "order1", "order2"],
}

# The slab example of the program's interface.
SLAB = {
    "slab": {"front": 0.2, "back": 0.7, "length": 1.0, "front_normal": [0, 0, 1], "back_normal": [0, 1, 0]},
    "transfer_function": RAY["transfer_function"],
    "emission": "plain",
    "lighting": {
        "light": [0, 0.6, 0.8],
        "half": [0, 0, 1],
        "ambient": 0.1,
        "diffuse": 1,
        "specular": 0.5,
        "shininess": 20,
        "highlight": "lobe",
        "negative": "clamp",
    },
    "schemes": ["reference", "mean_gradient", "linear_gradient", "quadratic_arc"],
}

EXPERIMENT = {
    "raytruth": "experiment/1",
    "name": "small",
    "question": "Does it run?",
    "source": "none",
    "fields": [
        {"name": "white", "kind": "random_field", "size": 16, "smoothing": 0},
        {"name": "smooth", "kind": "random_field", "size": 16, "smoothing": 1},
    ],
    "rays": {"count": 64, "length": 4},
    "samplings": [{"kind": "cells"}],
    "schemes": ["order0_mid", "order1", "order2"],
    "measures": [{"kind": "signal_error", "ratios": [["order1", "order2"]]}, {"kind": "cell_cubic"}],
    "published": [
        {
            "claim": "figure",
            "stated": 0.1,
            "resolution": 0.1,
            "row": {"measure": "signal_error", "field": "white", "scheme": "order0_mid"},
            "measured": "xi_p50",
            "low": "xi_p05",
            "high": "xi_p95",
        },
        {
            "claim": "sentence",
            "stated": "cubic inside",
            "rows": {"measure": "cell_cubic"},
            "test": {"column": "value_error_max", "at_most": 1e-12},
        },
        {"claim": "elsewhere", "stated": 30, "why": "needs their hardware"},
    ],
    "checks": [
        {
            "bound": "continuous",
            "rows": {"measure": "cell_cubic", "field": ["white", "smooth"]},
            "column": "value_jump_max",
            "at_most": 0,
        }
    ],
    "plot": {
        "title": "small",
        "panels": [
            {
                "kind": "quantiles",
                "rows": {"measure": "signal_error"},
                "value": "xi",
                "group": "field",
                "series": "scheme",
                "label": "xi",
            }
        ],
    },
    "quick": {"rays": {"count": 16}},
}

# An experiment on colour and opacity.
STUDY = {
    "raytruth": "experiment/1",
    "name": "study",
    "question": "Does it integrate?",
    "source": "tests",
    "seed": 1,
    "fields": [{"name": "white", "kind": "random_field", "size": 8, "smoothing": 0}],
    "rays": {"count": 3, "length": 4},
    "transfer_functions": [
        {"name": "tent", "kind": "tent", "optical_depth": 3},
        {"name": "own", "kind": "points", "transfer_function": RAY["transfer_function"]},
    ],
    "emission": "plain",
    "samplings": [{"kind": "constant", "step": 1}],
    "schemes": ["order1", "order2"],
    "measures": [
        {"kind": "work_precision"},
        {"kind": "xi_versus_integral"},
        {"kind": "iterations", "signal": "order2", "counts": [8, 64]},
        {"kind": "opacity_conventions", "shapes": ["ramp"], "peaks": [0.1], "steps": [0.5]},
    ],
    "checks": [
        {
            "bound": "half the look-ups",
            "rows": {"measure": "work_precision", "field": "white", "transfer": ["tent", "own"], "scheme": "order2"},
            "column": "lookups_ratio",
            "at_most": 0.5,
        }
    ],
}


def changed(document, pointer, value):
    """A copy of the document with another value, or a new one, at a JSON pointer; `...` removes the member."""
    result = copy.deepcopy(document)
    *path, last = [part.replace("~1", "/").replace("~0", "~") for part in pointer.split("/")[1:]]
    place = result
    for part in path:
        place = place[int(part)] if isinstance(place, list) else place[part]
    last = int(last) if isinstance(place, list) else last
    if value is ...:
        del place[last]
    elif isinstance(place, list) and last == len(place):
        place.append(value)
    else:
        place[last] = value
    return result


class ProgramTest(unittest.TestCase):
    """Each test has a folder of its own, in which the program runs."""

    maxDiff = None

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, content):
        """Writes bytes, text or JSON into the folder, and returns the name."""
        if not isinstance(content, (bytes, str)):
            content = json.dumps(content)
        if isinstance(content, str):
            content = content.encode()
        (self.folder / name).write_bytes(content)
        return name

    def run_program(self, *arguments, stdin=b"", environment=None):
        """Runs the program without any data folders; stdin may be bytes or a JSON value."""
        if not isinstance(stdin, bytes):
            stdin = json.dumps(stdin).encode()
        environment = {**os.environ, "RAYTRUTH_DATA": "", **(environment or {})}
        return subprocess.run(
            [PROGRAM, *map(str, arguments)],
            cwd=self.folder,
            input=stdin,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env=environment,
            timeout=300,
        )

    def output_of(self, *arguments, **options):
        """Standard output of a run that must succeed."""
        done = self.run_program(*arguments, **options)
        self.assertEqual(done.returncode, 0, done.stderr.decode())
        return done.stdout.decode()

    def json_of(self, *arguments, **options):
        return json.loads(self.output_of(*arguments, **options))

    def assert_refused(self, done, *expected, code=2):
        """One line on standard error that holds all that is expected, nothing on standard output."""
        message = done.stderr.decode()
        self.assertEqual(done.returncode, code, message)
        self.assertEqual(done.stdout, b"")
        self.assertTrue(message.startswith("raytruth: ") and message.endswith("\n"), message)
        self.assertEqual(message.count("\n"), 1, message)
        for part in expected:
            self.assertIn(part, message)

    def names_in_folder(self):
        return sorted(path.name for path in self.folder.iterdir())
