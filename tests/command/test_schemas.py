"""The program's own checks and the JSON Schemas must accept and refuse the same documents."""

import json
import re
import unittest

import jsonschema

import test_eval
import test_render
import test_run
import test_tetrahedra
from support import EXPERIMENT, RAY, SLAB, SOURCE, STUDY, VOLUME_RAY, ProgramTest, changed

SCHEMAS = {name: json.loads((SOURCE / f"experiments/schemas/{name}.json").read_text()) for name in ("experiment", "case", "result", "scene", "table", "vectors")}
# They refer to each other by file, so a validator needs nothing but the folder that they lie in.
FOLDER = SOURCE / "experiments/schemas"
STORE = {path.as_uri(): json.loads(path.read_text()) for path in sorted(FOLDER.rglob("*.json"))}


def validator(name):
    path = FOLDER / f"{name}.json"
    resolver = jsonschema.RefResolver(base_uri=path.as_uri(), referrer=SCHEMAS[name], store=STORE)
    return jsonschema.Draft202012Validator(SCHEMAS[name], resolver=resolver)


def places(document, pointer=""):
    """Every place in a document but its root: (JSON pointer, value)."""
    items = document.items() if isinstance(document, dict) else enumerate(document) if isinstance(document, list) else []
    for key, value in items:
        place = f"{pointer}/{key}"
        yield place, value
        yield from places(value, place)


def mutations(document):
    """Documents that differ in one place: another type, a number out of range, a member less, an unknown one more."""
    for pointer, value in places(document):
        for wrong in (None, True, -1, 1e300, "", "word", [], {}, [None], {"a": 1}):
            yield f"{pointer} = {json.dumps(wrong)}", changed(document, pointer, wrong)
        if isinstance(value, dict):
            yield f"{pointer}/unknown", changed(document, pointer + "/unknown", 1)
        if not pointer.rpartition("/")[2].isdigit():
            yield f"{pointer} removed", changed(document, pointer, ...)
    yield "/unknown", changed(document, "/unknown", 1)


# What no schema can say, as mutations that it lets pass: order, files that exist, names that occur elsewhere.
BEYOND_CASE_SCHEMA = re.compile(
    r"""
      /signal/breaks/[12]\ =\ (1e\+300|-1)  # not ascending, or a power of a length overflows
    | /signal/(coefficients/\d/\d|volume/values/\d)\ =\ 1e\+300
    | /signal/origin/\d\ =\ 1e\+300
    | /signal/volume\ =\ "word"
    | /transfer_function\ =\ "word"
    | /transfer_function/points/./(s|extinction|color/.)\ =\ 1e\+300
    | /transfer_function/points/1/s\ =\ -1
    | /transfer_function/isosurfaces/(0/s\ =\ 1e\+300|1/s\ =\ -1)  # not ascending
    | /(slab/(front|back)_normal|lighting/(light|half))/\d\ =\ (-1|1e\+300)  # no unit vector
    """,
    re.VERBOSE,
)
BEYOND_MESH_SCHEMA = re.compile(
    r"""
      (/signal)?/mesh/points/0/\d\ =\ 1e\+300  # too far
    | (/signal)?/mesh/tetrahedra/0/\d\ =\ 1e\+300  # no such point
    | (/signal)?/mesh\ =\ "word"  # no such file
    | /signal/volume\ =\ "word"
    | /signal/(mesh/scalars|origin|volume/values)/0\ =\ 1e\+300
    """,
    re.VERBOSE,
)
BEYOND_EXPERIMENT_SCHEMA = re.compile(
    r"""
      /fields/\d/name\ =\ "word"  # the checks name the fields
    | /rays/length\ =\ 1e\+300
    | .*/rows?(\ =\ {"a":\ 1}|/unknown)
    | .*/rows?/(field|scheme)(/\d)?\ =\ "word"
    | /published/0/(measured|low|high)\ =\ "word"
    | .*/column\ =\ "word"
    | /plot/panels/0/(group|series)\ =\ "word"
    | /transfer_functions/\d/name\ =\ "word"  # the checks name them
    | .*/rows/transfer(/\d)?\ =\ "word"
    | /transfer_functions/1/transfer_function\ =\ "word"
    | .*/points/(./(s|extinction|color/.)\ =\ 1e\+300|1/s\ =\ -1)
    """,
    re.VERBOSE,
)

BEYOND_SCENE_SCHEMA = re.compile(
    r"""
      /volume\ =\ "word"
    | /transfer_function\ =\ "word"
    | /transfer_function/points/./(s|extinction|color/.)\ =\ 1e\+300
    | /transfer_function/points/1/s\ =\ -1
    | /camera/(eye/.|target/1|up/2|height)\ =\ 1e\+300  # too far, or parallel to up
    | /table/builder\ =\ "word"
    | /shading/(method|highlight)\ =\ "word"
    """,
    re.VERBOSE,
)


class Agreement(ProgramTest):
    def program_accepts(self, command, document):
        output = ["-o", "image.npy"] if command == "render" else []
        done = self.run_program(command, self.write("document.json", document), *output)
        self.assertIn(done.returncode, (0, 2), done.stderr)
        return done.returncode == 0

    def assert_agreement(self, command, schema, documents, beyond):
        """Both say the same, but for what is beyond the schema: that the program alone refuses."""
        for what, document in documents:
            with self.subTest(what=what):
                verdicts = schema.is_valid(document), self.program_accepts(command, document)
                if beyond.fullmatch(what):
                    self.assertEqual(verdicts, (True, False), "(schema, program)")
                else:
                    self.assertEqual(*verdicts, "schema and program disagree")

    def test_cases(self):
        schema = validator("case")
        opacity = {"points": [{"s": s, "opacity": 0.5, "color": [1, 1, 1]} for s in (0, 1)], "unit_length": 2}
        for case in (RAY, VOLUME_RAY, SLAB, [RAY, VOLUME_RAY, SLAB], changed(RAY, "/transfer_function", opacity)):
            self.assertTrue(schema.is_valid(case))
            self.assertTrue(self.program_accepts("eval", case))
        # Normals and directions that no change of a component leaves as long as they are.
        tilted = changed(changed(SLAB, "/slab/front_normal", [0, 0.6, 0.8]), "/slab/back_normal", [0.6, 0, 0.8])
        tilted = changed(changed(tilted, "/lighting/light", [0, 0.6, 0.8]), "/lighting/half", [0.6, 0, 0.8])
        surfaces = changed(RAY, "/transfer_function/isosurfaces", [{"s": s, "opacity": 0.5, "color": [1, 1, 1]} for s in (0.25, 0.5)])
        alone = changed(RAY, "/transfer_function", {"isosurfaces": surfaces["transfer_function"]["isosurfaces"]})
        for case in ({"raytruth": "case/1"} | RAY, VOLUME_RAY, {"raytruth": "case/1"} | tilted, changed(RAY, "/transfer_function", opacity), surfaces, alone):
            self.assert_agreement("eval", schema, mutations(case), BEYOND_CASE_SCHEMA)

    def test_what_is_said_of_files(self):
        """The members beside "volume"; a series of one volume, so that only its first step is there."""
        self.write("v.nrrd", b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 16 16 16\nencoding: raw\n\n" + bytes(range(256)) * 16)
        members = {"nan": 0, "time_step": 0, "spacing": [1, 2, 3]}
        case = {**VOLUME_RAY, "signal": {**VOLUME_RAY["signal"], "volume": "v.nrrd", **members}}
        scene = {**test_render.SCENE, "volume": "v.nrrd", **members}
        field = {"name": "white", "kind": "volume", "volume": "v.nrrd", **members}
        experiment = changed(EXPERIMENT, "/fields/0", field)
        for name, command, document, prefix in (("case", "eval", case, "/signal"), ("scene", "render", scene, ""), ("experiment", "run", experiment, "/fields/0")):
            self.assertTrue(validator(name).is_valid(document))
            self.assertTrue(self.program_accepts(command, document))
            said = [(what, mutation) for what, mutation in mutations(document) if what.startswith(tuple(f"{prefix}/{member}" for member in members))]
            self.assertGreater(len(said), 40)
            self.assert_agreement(command, validator(name), said, re.compile("none"))

    def test_meshes(self):
        """Tetrahedra on a ray and in a scene: with scalars of points or of cells, and a grid that is split."""
        mesh = {"points": test_tetrahedra.POINTS[:4], "tetrahedra": [[0, 1, 2, 3]]}
        ray = test_tetrahedra.RAY
        grid = {"size": [2, 2, 2], "values": [0, 1, 0, 1, 0, 1, 0, 1]}
        split = {key: value for key, value in ray["signal"].items() if key != "mesh"} | {"volume": grid, "split": 5, "parity": "odd"}
        scene = {"mesh": {**mesh, "cell_scalars": [0.5]}, "transfer_function": test_tetrahedra.LINEAR, "scheme": "reference", "camera": {"size": [2, 2]}}
        for name, command, document, prefix in (
            ("case", "eval", changed(ray, "/signal/mesh", {**mesh, "scalars": [0, 1, 0.25, 0.5]}), "/signal"),
            ("case", "eval", {**ray, "signal": split}, "/signal"),
            ("scene", "render", scene, "/mesh"),
        ):
            self.assertTrue(validator(name).is_valid(document))
            self.assertTrue(self.program_accepts(command, document))
            # Of each list the first element: the others are alike.
            said = [(what, mutation) for what, mutation in mutations(document) if what.startswith(prefix) and not re.search("/[1-9]", what)]
            self.assertGreater(len(said), 40)
            self.assert_agreement(command, validator(name), said, BEYOND_MESH_SCHEMA)

    def test_experiments(self):
        schema = validator("experiment")
        recursion = {"kind": "opacity_recursion", "opacities": [0.5], "parts": [4]}
        alone = {key: STUDY[key] for key in ("raytruth", "name", "question", "source")} | {"measures": [recursion]}
        for experiment in (EXPERIMENT, STUDY, alone):
            self.assertTrue(schema.is_valid(experiment))
            self.assertTrue(self.program_accepts("run", experiment))
            self.assert_agreement("run", schema, mutations(experiment), BEYOND_EXPERIMENT_SCHEMA)

    def test_programs(self):
        """In place of schemes; nothing is run."""
        program = {"program": ["cat", "x"], "name": "mine", "version": ["cat"], "package": "coreutils", "seconds": 10, "megabytes": 1}
        ray = changed(RAY, "/schemes", ["order1", program])
        scene = {**test_render.SCENE, "scheme": program}
        experiment = {key: STUDY[key] for key in ("raytruth", "name", "question", "source")} | {
            "schemes": ["order1", program], "measures": [{"kind": "conformance", "intervals": 2, "emission": "associated", "against": ["samples"]}]}
        for name, command, document, place in (("case", "eval", ray, "/schemes/1"), ("case", "eval", scene, "/scheme"), ("experiment", "run", experiment, "/schemes/1")):
            self.assertTrue(validator(name).is_valid(document))
            self.assertTrue(self.program_accepts(command, document))
            said = [(what, mutation) for what, mutation in mutations(document) if what.startswith(place + "/")]
            self.assertGreater(len(said), 40)
            self.assert_agreement(command, validator(name), said, re.compile("none"))
        for wrong in ("ray", ["ray", "ray"], ["noise"], []):
            document = changed(experiment, "/measures/0/against", wrong)
            self.assertFalse(validator("experiment").is_valid(document))
            self.assertFalse(self.program_accepts("run", document))
        elsewhere = changed(EXPERIMENT, "/schemes", ["order1", program])
        self.assertFalse(validator("experiment").is_valid(elsewhere))
        self.assertFalse(self.program_accepts("run", elsewhere))

    def test_scenes(self):
        schema = validator("scene")
        scene = {"raytruth": "scene/1", **test_render.SCENE, "scheme": "order1", "step": 0.5, "table": {"size": 16, "builder": "exact", "format": "unorm8", "filter": "nearest"},
                 "early_termination": 0.9, "empty_space": {"block": 4, "bounds": "printed"}, "reconstruction": "catmull_rom", "emission": "plain"}
        gooch = {"light": [0, 0, 1], "gooch": {"cool": [0, 0, 1], "warm_share": 0.5}}
        lit_table = {**test_render.SCENE, "scheme": "order1", "table": {"size": 8}, "shading": {**gooch, "method": "slerp"}}
        second_order = {**test_render.SCENE, "scheme": "order2", "table": {"size": 8, "builder": "second_order_iterations", "iterations": 8}}
        for document in (test_render.SCENE, test_render.NOISE, scene, {**test_render.SCENE, "shading": gooch}, lit_table, second_order):
            self.assertTrue(schema.is_valid(document))
            self.assertTrue(validator("case").is_valid(document))
            self.assertTrue(self.program_accepts("render", document))
            self.assertTrue(self.program_accepts("eval", document))
        self.assert_agreement("render", schema, mutations(scene), BEYOND_SCENE_SCHEMA)
        shading = {"method": "quadratic_arc", "light": [0, 0, -1], "ambient": 0.25, "diffuse": 1, "specular": 1, "shininess": 10,
                   "highlight": "cone", "negative": "mirror", "normal": "gradient"}
        lit = {**test_render.SCENE, "scheme": "order1", "step": 0.5, "shading": shading}
        self.assertTrue(self.program_accepts("render", lit))
        documents = [(f"/shading{what}", {**lit, "shading": part}) for what, part in mutations(shading)]
        self.assert_agreement("render", schema, documents, BEYOND_SCENE_SCHEMA)

    def test_refused_documents_of_the_other_tests(self):
        """Listed by pointer and words: those that only the program can refuse."""
        only_program = {
            ("/signal/breaks/1", "a number > 0"),
            ("/signal/coefficients", "3 lists"),
            ("/signal/coefficients", "overflow"),
            ("/signal", "2^900"),
            ("/sampling", "10000000 samples"),
            ("/transfer_function/points/1", "sorted"),
            ("/transfer_function/points/2", "third"),
            ("/transfer_function", "no.json"),
            ("/transfer_function", "2^500"),
            ("/signal/origin", "2^40"),
            ("/signal/direction", "direction"),
            ("/signal/volume/values", "12 numbers"),
            ("/signal/volume/size", "2^33"),
            ("/signal/volume", "nowhere"),
            ("/signal/volume", "nowhere.nrrd"),
            ("/signal/repair", "file"),
            ("/slab/back_normal", "antiparallel"),
            ("/slab/front_normal", "1e-6"),
            ("/lighting/light", "length 0"),
            ("/fields/1/name", "each name once"),
            ("/fields/0/smoothing", "16"),
            ("/measures/0", "constant step"),
            ("/published/0/measured", "perhaps xi_p50"),
            ("/published/1/claim", "once"),
            ("/published/1/test", "at_least <= at_most"),
            ("/published/0/row/field", "white"),
            ("/published/0/row/colour", "column"),
            ("/checks/0/rows/field/0", "white"),
            ("/checks/0/column", "one of"),
            ("/transfer_functions/1/name", "each name once"),
            ("/transfer_functions/1/transfer_function/points/1", "sorted"),
            ("/transfer_functions/1/transfer_function", "2^500"),
            ("/measures/2/counts/1", "65"),
            ("/checks/0/rows/transfer", "tent"),
        }
        for name, bad in (("case", test_eval.Refusals.bad), ("experiment", test_run.Refusals.bad)):
            schema = validator(name)
            for document, pointer, words in bad:
                with self.subTest(pointer=pointer, words=words):
                    self.assertEqual(schema.is_valid(document), (pointer, words) in only_program)


class Validity(ProgramTest):
    def test_schemas_are_schemas(self):
        for schema in STORE.values():
            jsonschema.Draft202012Validator.check_schema(schema)

    def test_committed_experiments(self):
        paths = sorted(SOURCE.glob("experiments/*.json"))
        self.assertTrue(paths)
        for path in paths:
            validator("experiment").validate(json.loads(path.read_text()))

    def test_committed_results(self):
        for path in sorted(SOURCE.glob("results/*.json")):
            document = json.loads(path.read_text())
            validator(document["raytruth"].partition("/")[0]).validate(document)

    def test_results(self):
        absent = {"name": "absent", "kind": "volume", "volume": "no_such_volume"}
        for document in (EXPERIMENT, STUDY, changed(EXPERIMENT, "/fields/2", absent)):
            validator("result").validate(self.json_of("run", self.write("small.json", document)))

    def test_the_experiment_in_a_result_runs_and_gives_the_same_rows(self):
        result = self.json_of("run", self.write("small.json", EXPERIMENT))
        again = self.json_of("run", self.write("again.json", result["experiment"]))
        self.assertEqual(again["experiment"], result["experiment"])
        self.assertEqual(again["rows"], result["rows"])

    def test_names_are_those_of_the_catalogue(self):
        names = STORE[(FOLDER / "names.json").as_uri()]["$defs"]
        for kind, place in [("schemes", "scheme"), ("shadings", "shading"), ("measures", "measure_name")]:
            self.assertEqual(names[place]["enum"], [entry["name"] for entry in self.json_of("list", kind, "--json")])
        signal_schemes = [entry["name"] for entry in self.json_of("list", "schemes", "--json") if "signal_order" in entry]
        self.assertEqual(names["signal_scheme"]["enum"], signal_schemes)
        for kind, name, place in [("transfers", "experiment", "transfer"), ("samplings", "experiment", "sampling"),
                                  ("samplings", "case", "sampling"), ("signals", "case", "signal")]:
            listed = {entry["name"] for entry in self.json_of("list", kind, "--json")}
            kinds = [option["properties"]["kind"] for option in SCHEMAS[name]["$defs"][place]["oneOf"]]
            stated = {word for kind_schema in kinds for word in kind_schema.get("enum", [kind_schema.get("const")])}
            self.assertEqual(stated, listed)


if __name__ == "__main__":
    unittest.main()
