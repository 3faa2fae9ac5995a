"""`raytruth vectors --hits` and `score` of hits: against signs in rational numbers, and what wrong answers are worth."""

import json
import unittest
from fractions import Fraction

import jsonschema
from support import SOURCE, ProgramTest

SCHEMAS = SOURCE / "experiments/schemas"


def value(coefficients, u):
    result = Fraction(0)
    for coefficient in reversed(coefficients):
        result = result * u + Fraction(coefficient)
    return result


def csv(answers):
    lines = ["id,hit,t,surface"]
    for name, hits in answers.items():
        lines += [f"{name},{i},{t!r},{surface}" for i, (t, surface) in enumerate(hits)] or [f"{name},,,"]
    return "\n".join(lines) + "\n"


class HitVectors(ProgramTest):
    def setUp(self):
        super().setUp()
        self.document = self.json_of("vectors", "--hits")
        self.vectors = self.document["vectors"]
        self.truth = {v["id"]: [(hit["t"], hit["surface"]) for hit in v["hits"]] for v in self.vectors}

    def scored(self, answers, *options):
        self.write("hits.json", self.document)
        (self.folder / "answers.csv").write_text(answers)
        return self.json_of("score", "hits.json", "answers.csv", "--json", *options)

    def test_schema_describes_them(self):
        store = {path.as_uri(): json.loads(path.read_text()) for path in sorted(SCHEMAS.rglob("*.json"))}
        path = SCHEMAS / "hit_vectors.json"
        resolver = jsonschema.RefResolver(base_uri=path.as_uri(), referrer=store[path.as_uri()], store=store)
        jsonschema.Draft202012Validator(store[path.as_uri()], resolver=resolver).validate(self.document)
        self.assertEqual(len(self.vectors), 200)
        self.assertEqual(len(self.truth), 200)
        self.assertNotEqual(self.json_of("vectors", "--hits", "--seed", "2")["vectors"], self.vectors)

    def test_signs_change_at_hits_and_nowhere_else(self):
        # Between two neighbouring hits of a surface the scalar does not change sides: signs at 64 places of each piece.
        for vector in self.vectors:
            breaks, pieces = vector["signal"]["breaks"], vector["signal"]["coefficients"]
            for index, scalar in enumerate(vector["isosurfaces"]):
                hits = [hit for hit in vector["hits"] if hit["surface"] == index]
                side = None
                passed = 0
                for begin, coefficients in zip(breaks, pieces):
                    for k in range(1, 64):
                        t = Fraction(begin) + Fraction(k, 64)
                        while passed < len(hits) and Fraction(hits[passed]["t"]) + Fraction(hits[passed]["radius"]) < t:
                            if side is not None:
                                self.assertEqual(side < 0, hits[passed]["rising"], vector["id"])
                            side = 1 if hits[passed]["rising"] else -1
                            passed += 1
                        difference = value(coefficients, Fraction(k, 64)) - Fraction(scalar)
                        near = passed < len(hits) and t >= Fraction(hits[passed]["t"]) - Fraction(hits[passed]["radius"])
                        if difference == 0 or near:
                            continue
                        sign = 1 if difference > 0 else -1
                        if side is not None:
                            self.assertEqual(sign, side, (vector["id"], index, float(t)))
                        side = sign

    def test_polynomials_are_the_volumes(self):
        seen = 0
        for vector in self.vectors:
            if "ray" not in vector:
                continue
            seen += 1
            ray = vector["ray"]
            size, values = ray["volume"]["size"], ray["volume"]["values"]
            for begin, coefficients in zip(vector["signal"]["breaks"], vector["signal"]["coefficients"]):
                for u in (Fraction(0), Fraction(1, 3), Fraction(1)):
                    place = [Fraction(o) + (Fraction(begin) + u) * Fraction(d) for o, d in zip(ray["origin"], ray["direction"])]
                    cells = [min(int(x), n - 2) for x, n in zip(place, size)]
                    total = Fraction(0)
                    for corner in range(8):
                        bits = [corner >> axis & 1 for axis in range(3)]
                        weight = Fraction(1)
                        for x, cell, bit in zip(place, cells, bits):
                            weight *= x - cell if bit else 1 - (x - cell)
                        x, y, z = (cell + bit for cell, bit in zip(cells, bits))
                        total += weight * Fraction(values[(z * size[1] + y) * size[0] + x])
                    self.assertEqual(value(coefficients, u), total, vector["id"])
        self.assertEqual(seen, 40)

    def test_levels_are_what_they_say(self):
        near = [vector for vector in self.vectors if vector["level"] == "near_contacts"]
        gaps = []
        for vector in near:
            for before, after in zip(vector["hits"], vector["hits"][1:]):
                if before["surface"] == after["surface"]:
                    gaps.append(after["t"] - before["t"])
        self.assertLess(min(gaps), 2**-13)
        for vector in self.vectors:
            for hit in vector["hits"]:
                self.assertLess(hit["radius"], 1e-13, vector["id"])

    def test_the_truth_has_all_digits(self):
        for level in self.scored(csv(self.truth)):
            self.assertEqual(level["right"], level["cases"])
            self.assertEqual((level["missed"], level["false_hits"]), (0, 0))
            self.assertGreater(level["digits_min"], 13)

    def test_wrong_answers(self):
        name = next(v["id"] for v in self.vectors if len(v["hits"]) > 1)
        empty = next(v["id"] for v in self.vectors if not v["hits"])
        length = next(v["signal"]["breaks"][-1] for v in self.vectors if v["id"] == name)
        hits = self.truth[name]
        for answer, missed, false in ((hits[1:], 1, 0), ([*hits, (1.0, 0)], 0, 1), ([], len(hits), 0)):
            row = next(line for line in self.scored(csv({name: answer}), "--per-vector") if line["id"] == name)
            self.assertEqual((row["right"], row["missed"], row["false_hits"], row["digits"]), (False, missed, false, None))
        moved = [(t + 1e-6 * length, surface) for t, surface in hits]
        row = next(line for line in self.scored(csv({name: moved}), "--per-vector") if line["id"] == name)
        self.assertTrue(row["right"])
        self.assertAlmostEqual(row["digits"], 6, delta=1e-6)
        row = next(line for line in self.scored(csv({empty: []}), "--per-vector") if line["id"] == empty)
        self.assertTrue(row["right"])

    def test_refusals(self):
        name = next(v["id"] for v in self.vectors if v["hits"])
        self.write("hits.json", self.document)
        for text, words in (
            ("id,hit,t\n", "found 3 fields; id,hit,t,surface is allowed"),
            (f"id,hit,t,surface\n{name},1,0.5,0\n", "hit 0"),
            (f"id,hit,t,surface\n{name},0,0.5,-1\n", "surface '-1'"),
            (f"id,hit,t,surface\n{name},,,\n{name},0,0.5,0\n", "which has no hits"),
            ("id,hit,t,surface\nnobody,0,0.5,0\n", "found the id 'nobody'"),
        ):
            with self.subTest(words):
                (self.folder / "answers.csv").write_text(text)
                self.assert_refused(self.run_program("score", "hits.json", "answers.csv"), words)
        self.assert_refused(self.run_program("vectors", "--hits", "--volumes", "x"), "--volumes: found it beside --hits")


if __name__ == "__main__":
    unittest.main()
