"""Deformed volumes in `eval` and `render`: against the undeformed ones, and what is refused."""

import json

import numpy

from support import ProgramTest

POINTS = [{"s": 0, "extinction": 0, "color": [0.2, 0.4, 0.9]}, {"s": 1, "extinction": 0.4, "color": [1, 0.8, 0.3]}]
FIELD = {"kind": "random_field", "size": 16, "smoothing": 0, "seed": 4}
RAY = {
    "signal": {"kind": "trilinear", "volume": FIELD, "origin": [-20, 3, 5], "direction": [3, 0.4, 0.3]},
    "transfer_function": {"points": POINTS},
    "schemes": ["reference"],
}
SPACED = {"size": [9, 8, 7], "spacing": [1, 1.5, 2], "values": [(37 * i * i + 11 * i) % 101 / 101 for i in range(504)]}
SCENE = {
    "volume": SPACED,
    "transfer_function": {"points": POINTS},
    "camera": {"eye": [60, -50, 40], "target": [4, 5, 6], "up": [0, 0, 1], "fov_y": 15, "size": [24, 20]},
    "scheme": "reference",
}
TWIST = {"cells": [2, 2, 3], "displace": [{"kind": "twist", "axis": "z", "degrees": 30}]}


class DeformedTest(ProgramTest):
    def eval(self, case, code=0):
        self.write("case.json", json.dumps(case))
        done = self.run_program("eval", "case.json")
        self.assertEqual(done.returncode, code, done.stderr.decode())
        return json.loads(done.stdout) if code == 0 else done.stderr.decode()

    def image(self, scene):
        self.write("scene.json", json.dumps(scene))
        text = self.output_of("render", "scene.json", "-o", "image.npy", "--binary64")
        return numpy.load(self.folder / "image.npy"), text

    def test_a_lattice_that_moves_nothing(self):
        straight = self.eval(RAY)
        deformed = self.eval({**RAY, "deformation": {"cells": [2, 3, 4]}})
        self.assertTrue(deformed["deformation"]["certified"])
        self.assertAlmostEqual(deformed["length"], straight["length"], delta=1e-12)
        bound = deformed["reference"]["error_bound"] + straight["reference"]["error_bound"]
        self.assertLess(bound, 1e-9)
        self.assertLess(abs(deformed["reference"]["opacity"] - straight["reference"]["opacity"]), bound)

    def test_images(self):
        straight, _ = self.image(SCENE)
        same, _ = self.image({**SCENE, "deformation": {"cells": [2, 2, 2]}})
        self.assertLess(numpy.abs(same - straight).max(), 1e-9)
        twisted, _ = self.image({**SCENE, "deformation": TWIST})
        self.assertGreater(numpy.abs(twisted - straight).max(), 0.1)
        self.assertEqual(twisted.shape, straight.shape)

    def test_turning_the_lattice_is_turning_the_camera(self):
        # A quarter turn about z of a cube, by an affine displacement, against a camera that goes round.
        volume = {**SCENE, "volume": FIELD}
        camera = {"eye": [60, 20, 30], "target": [7.5, 7.5, 7.5], "up": [0, 0, 1], "fov_y": 30, "size": [20, 16]}
        turned = {"cells": [2, 2, 2], "displace": [{"kind": "affine", "matrix": [[0, -1, 0], [1, 0, 0], [0, 0, 1]]}]}
        # The object turns by 90 degrees; seen from an eye that is turned back it looks as it did.
        back = {**camera, "eye": [7.5 + (20 - 7.5), 7.5 - (60 - 7.5), 30]}
        self.assertLess(numpy.abs(self.image({**volume, "camera": camera, "deformation": turned})[0] - self.image({**volume, "camera": back})[0]).max(), 1e-9)

    def test_what_is_refused(self):
        far = {"cells": [4, 4, 4], "displace": [{"kind": "random", "amplitude": 3}]}
        for case, words in (
            ({**RAY, "deformation": far}, ("/deformation", "folds in the lattice's cell")),
            ({**RAY, "deformation": {"cells": [0, 2, 2]}}, ("/deformation/cells/0",)),
            ({**RAY, "deformation": {"cells": [2, 2]}}, ("/deformation/cells",)),
            ({**RAY, "deformation": {"cells": [1, 1, 1], "points": [[0, 0, 0]] * 26}}, ("/deformation/points", "27")),
            ({**RAY, "deformation": {"cells": [2, 2, 2], "box": {"origin": [0, 0, 0], "u": [9, 0, 0], "v": [0, 9, 0], "w": [0, 0, 9]}}}, ("/deformation/box", "corner")),
            ({**RAY, "deformation": {"cells": [2, 2, 2], "box": {"origin": [0, 0, 0], "u": [9, 0, 0], "v": [9, 0, 0], "w": [0, 0, 9]}}}, ("/deformation/box", "no volume")),
            ({**RAY, "deformation": {"cells": [2, 2, 2], "displace": [{"kind": "bend", "axis": "x", "towards": "x", "degrees": 3}]}}, ("/deformation/displace/0/axis",)),
            ({**RAY, "deformation": TWIST, "signal": {**RAY["signal"], "length": 3}}, ("/signal/length",)),
            ({**RAY, "deformation": TWIST, "signal": {**RAY["signal"], "kind": "tricubic", "kernel": "catmull_rom"}}, ("/deformation", "tricubic")),
            ({**SCENE, "deformation": TWIST, "scheme": "cell_cubic"}, ("/scheme", "cell_cubic of a deformed volume")),
        ):
            message = self.eval(case, code=2)
            self.assertEqual(message.count("\n"), 1, message)
            for word in words:
                self.assertIn(word, message)

    def test_schemes_of_a_ray_are_refused_by_name(self):
        answer = self.eval({**RAY, "deformation": TWIST, "schemes": ["reference", "order1"], "sampling": {"kind": "constant", "step": 1}})
        self.assertEqual(answer["schemes"]["order1"]["status"], "refused")
        self.assertLess(answer["reference"]["error_bound"], 1e-9)
