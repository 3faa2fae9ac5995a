"""`raytruth advise`: what it promises holds for whole images, and what it says of mistaken scenes."""

import json

import numpy

from support import ProgramTest

POINTS = [
    {"s": 0.2, "extinction": 0, "color": [0.9, 0.5, 0.4]},
    {"s": 0.5, "extinction": 0.3, "color": [1, 0.9, 0.8]},
    {"s": 1, "extinction": 0.7, "color": [0.4, 0.7, 0.95]},
]
SCENE = {
    "volume": {"kind": "marschner_lobb", "samples": 24},
    "transfer_function": {"points": POINTS},
    "camera": {"eye": [40, -60, 30], "target": [11.5, 11.5, 11.5], "up": [0, 0, 1], "height": 36, "size": [28, 24]},
}


class AdviseTest(ProgramTest):
    def advise(self, *options, scene=None, code=0):
        self.write("scene.json", json.dumps(SCENE if scene is None else scene))
        done = self.run_program("advise", "scene.json", "--json", *options)
        self.assertEqual(done.returncode, code, done.stderr.decode())
        return json.loads(done.stdout)

    def image(self, **members):
        self.write("view.json", json.dumps({**SCENE, **members}))
        self.output_of("render", "view.json", "-o", "view.npy", "--binary64")
        return numpy.load(self.folder / "view.npy")[..., :3]

    def assert_promise_holds(self, result, error):
        best = result["advice"]["best"]
        way = {"scheme": best["scheme"]}
        if best["step"] is not None:
            way["step"] = best["step"]
        if best["table_size"] is not None:
            way["table"] = {"builder": best["builder"], "size": best["table_size"], "format": best["format"]}
        difference = self.image(**way) - self.image(scheme="reference")
        self.assertLessEqual(error(difference), result["advice"]["error"]["at_most"])
        return best

    def test_promises_hold(self):
        rmse = lambda difference: numpy.sqrt(numpy.mean(difference**2))
        dear = self.assert_promise_holds(self.advise("--error", "0.0005"), rmse)
        cheap = self.assert_promise_holds(self.advise("--error", "0.02"), rmse)
        self.assertLess(cheap["reads"], dear["reads"])
        self.assert_promise_holds(self.advise("--error", "0.005", "--of", "largest"), lambda difference: numpy.abs(difference).max())

    def test_the_largest_error_is_found_though_few_pixels_are_looked_at(self):
        camera = {**SCENE["camera"], "size": [160, 128]}
        scene = {**SCENE, "camera": camera}
        advice = self.advise("--error", "0.01", "--of", "largest", "--rays", "4096", scene=scene)["advice"]
        self.assertLess(advice["rays"], advice["pixels"] / 4)
        best = advice["best"]
        difference = self.image(camera=camera, scheme=best["scheme"], step=best["step"]) - self.image(camera=camera, scheme="reference")
        self.assertAlmostEqual(numpy.abs(difference).max(), best["error_low"], delta=1e-12)

    def test_the_best_is_the_cheapest_that_keeps_the_error(self):
        result = self.advise("--error", "0.002")
        advice = result["advice"]
        self.assertTrue(advice["settled"])
        self.assertTrue(advice["truth"]["certified"])
        cost = lambda row: (row["reads"], row["table_bytes"])
        rows = [row for row in result["rows"] if row["status"] == "ok"]
        self.assertEqual(rows, sorted(rows, key=cost))
        keeping = [row for row in rows if row["standing"] == "keeps"]
        self.assertEqual(advice["best"], keeping[0])
        self.assertTrue(all(row["error_high"] <= 0.002 for row in keeping))
        cheaper = [row for row in rows if cost(row) < cost(keeping[0])]
        self.assertEqual({row["standing"] for row in cheaper}, {"exceeds"})
        self.assertEqual(advice["next_cheaper"]["error"], min(row["error"] for row in cheaper))

    def test_equal_questions_have_equal_answers(self):
        answers = {json.dumps(self.advise("--error", "0.01", "-j", threads)["rows"]) for threads in "12"}
        self.assertEqual(len(answers), 1)

    def test_without_a_camera_views_are_from_all_around(self):
        scene = {key: value for key, value in SCENE.items() if key != "camera"}
        scene["camera"] = {"size": [32, 32]}
        advice = self.advise("--error", "0.01", "--views", "3", scene=scene)["advice"]
        self.assertEqual((len(advice["views"]), advice["pixels"]), (3, 3 * 32 * 32))
        self.assertEqual(len({tuple(view["eye"]) for view in advice["views"]}), 3)

    def test_lit_scenes(self):
        lit = {**SCENE, "shading": {"method": "mean_gradient", "light": [0, 0, 1], "ambient": 0.2, "diffuse": 0.7, "specular": 0, "shininess": 1}}
        result = self.advise("--error", "0.05", scene=lit)
        self.assertFalse(result["advice"]["truth"]["certified"])
        self.assertEqual(result["advice"]["best"]["scheme"], "order1")
        large = {**lit, "camera": {**lit["camera"], "size": [80, 80]}}
        sampled = self.advise("--error", "0.05", scene=large)["advice"]
        self.assertLess(sampled["rays"], sampled["pixels"])
        self.assertEqual(sampled["best"]["scheme"], "order1")
        dear = self.advise("--error", "0.015", scene=lit)["advice"]
        self.assertLess(dear["next_cheaper"]["reads"], dear["best"]["reads"])

    def test_nothing_may_keep_an_error(self):
        result = self.advise("--error", "1e-18", code=1)
        self.assertIsNone(result["advice"]["best"])
        self.assertLess(result["advice"]["closest"]["error"], 1e-6)
        done = self.run_program("advise", "scene.json", "--error", "1e-18")
        self.assertIn(b"nothing that was tried keeps it", done.stdout)

    def test_for_people_and_for_plots(self):
        self.write("scene.json", json.dumps(SCENE))
        text = self.output_of("advise", "scene.json", "--error", "invisible", "-o", "advice.json")
        for words in ("take ", "next cheaper", "reads", "keeps", "exceeds", "<-"):
            self.assertIn(words, text)
        self.output_of("plot", "advice.json")
        self.assertIn("What keeps the error", (self.folder / "advice.svg").read_text())

    def test_signs_of_mistakes(self):
        points = lambda **last: {"points": [POINTS[0], {**POINTS[2], **last}]}
        for transfer, words in (
            (points(extinction=1), "as if it were an opacity"),
            (points(extinction=200), "opaque within a tenth"),
            (points(s=0.5), "are taken as it"),
            ({"unit_length": 100, "points": [{"s": 0, "opacity": 0, "color": [1, 1, 1]}, {"s": 1, "opacity": 0.9, "color": [1, 1, 1]}]}, "far from 1"),
        ):
            warnings = self.advise("--error", "0.5", scene={**SCENE, "transfer_function": transfer})["advice"]["warnings"]
            self.assertIn(words, " ".join(warnings))
        levels = {"size": [4, 4, 4], "values": [i % 3 / 2 for i in range(64)]}
        self.assertIn("3 levels", " ".join(self.advise("--error", "0.5", scene={**SCENE, "volume": levels, "camera": {"size": [16, 16]}})["advice"]["warnings"]))
        self.assertEqual(self.advise("--error", "0.5")["advice"]["warnings"], [])

    def test_what_is_refused(self):
        self.write("scene.json", json.dumps(SCENE))
        for options, words in (
            (["--error", "0"], "--error"),
            (["--error", "small"], "invisible"),
            (["--error", "nan"], "--error"),
            (["--error", "0.1", "--of", "psnr"], "--of"),
            (["--error", "0.1", "--views", "0"], "--views"),
            ([], "--error"),
        ):
            self.assert_refused(self.run_program("advise", "scene.json", *options), words)
        surfaces = {**SCENE, "transfer_function": {"points": POINTS, "isosurfaces": [{"s": 0.5, "opacity": 0.5, "color": [1, 1, 1]}]}}
        self.write("surfaces.json", json.dumps(surfaces))
        self.assert_refused(self.run_program("advise", "surfaces.json", "--error", "0.1"), "isosurfaces")
        self.write("away.json", json.dumps({**SCENE, "camera": {**SCENE["camera"], "target": [500, -300, 30]}}))
        done = self.run_program("advise", "away.json", "--error", "0.1")
        self.assertEqual(done.returncode, 2)
        self.assertIn("no pixel of the views sees the volume", done.stderr.decode().splitlines()[-1])
