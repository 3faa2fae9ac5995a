"""Studies that run shaders: `raytruth run --gl`."""

import json
import unittest

from support import SOURCE, ProgramTest, changed

EXPERIMENT = json.loads((SOURCE / "experiments/gl_cross_check.json").read_text())

# Mesa says that it has no more than OpenGL 3.3.
OLD_MESA = {"MESA_GL_VERSION_OVERRIDE": "3.3"}


def quick(experiment):
    """Rays only, and few of them."""
    return {
        **{key: value for key, value in experiment.items() if key not in ("quick", "plot")},
        **experiment["quick"],
        "rays": {**experiment["rays"], **experiment["quick"]["rays"]},
        "measures": [{"kind": "gl_rays"}],
        "checks": [check for check in experiment["checks"] if check["rows"]["measure"] == "gl_rays"],
    }


class CrossCheck(ProgramTest):
    def result(self, platform, document, *arguments):
        """The result, or a skip where the platform is not here."""
        self.write("experiment.json", document)
        done = self.run_program("run", "experiment.json", "--gl", platform, *arguments)
        if done.returncode == 3:
            self.skipTest(done.stderr.decode())
        self.assertEqual(done.returncode, 0, done.stderr.decode())
        return json.loads(done.stdout)

    def check_result(self, result, platform):
        self.assertEqual(result["experiment"]["gl"], platform)
        self.assertTrue(result["provenance"]["gl"]["platform"].startswith(platform))
        self.assertTrue(result["provenance"]["gl"]["renderer"])
        self.assertTrue(all(check["holds"] for check in result["checks"]), result["checks"])

    def test_osmesa(self):
        result = self.result("osmesa", EXPERIMENT, "--profile", "quick", "--check")
        self.check_result(result, "osmesa")
        functions = [row for row in result["rows"] if row["measure"] == "gl_functions"]
        self.assertEqual({row["inputs"] for row in functions}, {"random", "adversarial"})
        self.assertIn("simpson_slab", {row["function"] for row in functions})

    def test_egl(self):
        self.check_result(self.result("egl", quick(EXPERIMENT), "--check"), "egl")

    def test_same_bytes(self):
        rows = [json.dumps(self.result("osmesa", quick(EXPERIMENT), "-j", threads)["rows"]) for threads in (1, 3)]
        self.assertEqual(*rows)

    def test_terms_telescope(self):
        rows = self.result("osmesa", quick(EXPERIMENT))["rows"]
        keys = ("transfer", "step", "scheme")
        budgets = {}
        for row in rows:
            budgets.setdefault(tuple(row[key] for key in keys), {})[row["term"]] = row
        self.assertEqual(len(budgets), 2 * 2 * len(EXPERIMENT["schemes"]))
        for terms in budgets.values():
            for column in ("opacity_bias", "color_bias"):
                parts = sum(terms[term][column] for term in ("method", "round64", "round32", "gl"))
                self.assertAlmostEqual(terms["total"][column], parts, delta=1e-15)
            self.assertGreater(terms["method"]["opacity_rms"], 100 * terms["gl"]["opacity_rms"])
            self.assertGreaterEqual(terms["round32"]["opacity_rms"], 100 * terms["round64"]["opacity_rms"])


class Refusals(ProgramTest):
    def assert_refused(self, code, *words, document=EXPERIMENT, arguments=(), environment=None):
        self.write("experiment.json", document)
        done = self.run_program("run", "experiment.json", *arguments, environment=environment)
        error = done.stderr.decode()
        self.assertEqual((done.returncode, done.stdout, error.count("\n")), (code, b"", 1), error)
        for word in words:
            self.assertIn(word, error)

    def test_what_the_machine_lacks(self):
        self.assert_refused(3, "libosmesa6", environment=OLD_MESA)
        self.assert_refused(3, "libegl", arguments=("--gl", "egl"), environment=OLD_MESA)

    def test_bad_input(self):
        self.assert_refused(2, "--gl", "osmesa", "vulkan", arguments=("--gl", "vulkan"))
        self.assert_refused(2, "/gl", "vulkan", document=changed(EXPERIMENT, "/gl", "vulkan"))
        self.assert_refused(2, "/schemes/0", "order1", document=changed(EXPERIMENT, "/schemes/0", "order1"))
        self.assert_refused(2, "/samplings/0", document=changed(EXPERIMENT, "/samplings/0", {"kind": "cells"}))
        self.assert_refused(2, "/measures/0/inputs", document=changed(EXPERIMENT, "/measures/0/inputs", 0))

    def test_gl_without_a_shader(self):
        document = json.loads((SOURCE / "experiments/opacity_recursion.json").read_text())
        self.assert_refused(2, "/gl", "a measure of shaders", document={**document, "gl": "osmesa"})


if __name__ == "__main__":
    unittest.main()
