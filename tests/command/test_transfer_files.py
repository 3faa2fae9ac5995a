"""Transfer functions of other programs: how `raytruth render` understands their files."""

import json
import os
import pathlib
import unittest
import xml.etree.ElementTree as xml

import numpy

from support import ProgramTest, changed
from test_render import SCENE

SAMPLES = pathlib.Path(os.environ.get("RAYTRUTH_DATA", "").split(":")[0] or "/nonexistent").parent / "transfer_functions"

SLICER = """<?xml version="1.0"?>
<MRML>
 <VolumeProperty name="plain" scalarOpacity="4 0 0 1 0.5" gradientOpacity="4 0 1 255 1" colorTransfer="8 0 1 0 0 1 1 0.5 0"/>
 <VolumeProperty name="edges" scalarOpacity="4 0 0 1 0.5" gradientOpacity="4 0 0 255 1" colorTransfer="8 0 1 0 0 1 1 0.5 0"/>
</MRML>
"""
VP = "1\n1\n0.9\n0.1\n0.2\n10\n4 0 0 1 0.5\n4 0 1 255 1\n8 0 1 0 0 1 1 0.5 0\n"
VOREEN = """<?xml version="1.0" ?>
<VoreenData version="1"><TransFuncIntensity type="TransFuncIntensity">
 <alphaMode value="1"/><gammaValue value="1"/><domain x="0" y="1"/><threshold x="0" y="1"/>
 <Keys>
  <key><intensity value="0"/><split value="false"/><colorL r="255" g="0" b="0" a="0"/></key>
  <key><intensity value="1"/><split value="false"/><colorL r="255" g="51" b="0" a="102"/></key>
 </Keys>
</TransFuncIntensity></VoreenData>
"""
INVIWO = """<?xml version="1.0" ?>
<InviwoWorkspace version="2"><maskMin content="0"/><maskMax content="1"/><Points>
 <Point><pos content="0"/><rgba x="1" y="0" z="0" w="0"/></Point>
 <Point><pos content="1"/><rgba x="1" y="0.5" z="0" w="0.5"/></Point>
</Points></InviwoWorkspace>
"""
COLORS = {"Name": "red to orange", "ColorSpace": "RGB", "RGBPoints": [10, 1, 0, 0, 20, 1, 0.5, 0]}
PRESET = {"Name": "volview", "ColorSpace": "RGB", "RGBPoints": [0, 1, 0, 0, 1, 1, 0.5, 0], "OpacityPoints": [0, 0, 1, 0.5]}


class Reading(ProgramTest):
    def render(self, transfer, *options, **members):
        scene = {**changed(SCENE, "/transfer_function", transfer), **members}
        answer = self.json_of("render", self.write("scene.json", scene), "-o", "image.npy", *options)
        return answer["transfer_function"], numpy.load(self.folder / "image.npy")[0, 0]

    def opacity_over(self, unit_length, peak=0.5):
        """Of the scene's rays: the scalar is 1/2 all along 2 voxels, so the opacity of a unit is half its peak."""
        return 1 - (1 - peak / 2) ** (2 / unit_length)

    def assert_pixel(self, pixel, opacity, green):
        # Exact, but for binary32.
        numpy.testing.assert_allclose(pixel, [opacity, opacity * green, 0, opacity], rtol=2e-7, atol=1e-9)

    def test_slicer(self):
        for name, text in (("presets.xml", SLICER), ("scene.mrml", SLICER)):
            description, pixel = self.render({"file": self.write(name, text), "preset": "plain"})
            self.assert_pixel(pixel, self.opacity_over(1), 0.25)
            self.assertEqual((description["preset"], description["unit_length"]), ("plain", 1))
            self.assertIn("linear", description["color"])
        _, pixel = self.render(self.write("property.vp", VP))
        self.assert_pixel(pixel, self.opacity_over(1), 0.25)

    def test_gradient_opacity_is_refused_unless_ignored(self):
        transfer = {"file": self.write("presets.xml", SLICER), "preset": "edges"}
        scene = self.write("scene.json", changed(SCENE, "/transfer_function", transfer))
        self.assert_refused(self.run_program("render", scene, "-o", "i.npy"), "presets.xml", "gradient", "--ignore-gradient-opacity")
        description, pixel = self.render(transfer, "--ignore-gradient-opacity")
        self.assert_pixel(pixel, self.opacity_over(1), 0.25)
        self.assertEqual(description["gradient_opacity"], "ignored")
        _, again = self.render({**transfer, "ignore_gradient_opacity": True})
        numpy.testing.assert_array_equal(again, pixel)

    def test_voreen_and_inviwo_have_lengths_of_the_longest_side(self):
        description, pixel = self.render(self.write("a.tfi", VOREEN))  # 3 voxels along x
        self.assertEqual(description["unit_length"], 3 / 200)
        self.assert_pixel(pixel, self.opacity_over(3 / 200, 102 / 255), 0.1)
        description, pixel = self.render(self.write("a.itf", INVIWO))
        self.assertEqual(description["unit_length"], 3 / 150)
        self.assert_pixel(pixel, self.opacity_over(3 / 150), 0.25)
        _, pixel = self.render({"file": "a.itf", "unit_length": 4})
        self.assert_pixel(pixel, self.opacity_over(4), 0.25)

    def test_paraview(self):
        for document in (PRESET, [PRESET], [{"Name": "group", "Children": [PRESET]}]):
            _, pixel = self.render(self.write("preset.json", document))
            self.assert_pixel(pixel, self.opacity_over(1), 0.25)

    def test_colour_maps_take_opacity_from_another_file(self):
        self.write("colors.json", COLORS)
        scene = self.write("scene.json", changed(SCENE, "/transfer_function", "colors.json"))
        self.assert_refused(self.run_program("render", scene, "-o", "i.npy"), "colors.json", "--opacity")
        self.write("opacity.json", {"OpacityPoints": [10, 0, 20, 0.5]})
        description, pixel = self.render("colors.json", "--opacity", "opacity.json")
        self.assert_pixel(pixel, self.opacity_over(1), 0.25)  # 10 to 20 become the data's 0 to 1
        self.assertIn("stretched", description["scalars"])
        _, pixel = self.render({"file": "colors.json", "opacity": "opacity.json", "range": [0, 2]})
        self.assert_pixel(pixel, self.opacity_over(1, 0.25), 0.125)

    def test_colour_spaces(self):
        blue_to_red = [0, 0, 0, 1, 1, 1, 0, 0]
        half = {"HSV": [1, 0, 1], "Step": [1, 0, 0], "RGB": [0.5, 0, 0.5]}  # vtk.js takes the shorter way, by magenta
        # By the CSS Color 4 formulas of CIE Lab with D65, independently of this program.
        half["Lab"] = [0.7930, 0.0, 0.5371]
        for space, color in half.items():
            document = {"Name": space, "ColorSpace": space, "RGBPoints": blue_to_red, "OpacityPoints": [0, 0.5, 1, 0.5]}
            _, pixel = self.render(self.write("map.json", document))
            numpy.testing.assert_allclose(pixel[:3] / pixel[3], color, atol=2e-2 if space == "Lab" else 3e-3)
        # Moreland 2009: from blue to red by way of a light grey, which is the middle of his map.
        cool_to_warm = [0, 0.23137254902, 0.298039215686, 0.752941176471, 1, 0.705882352941, 0.0156862745098, 0.149019607843]
        document = {"Name": "cool", "ColorSpace": "Diverging", "RGBPoints": cool_to_warm, "OpacityPoints": [0, 0.5, 1, 0.5]}
        _, pixel = self.render(self.write("map.json", document))
        numpy.testing.assert_allclose(pixel[:3] / pixel[3], [0.865, 0.865, 0.865], atol=3e-3)

    def test_full_opacity_is_taken_as_it_is(self):
        _, pixel = self.render(self.write("a.itf", INVIWO.replace('w="0.5"', 'w="1"')))
        self.assertEqual(pixel[3], 1)

    def test_lengths_are_those_of_the_world(self):
        preset = self.write("a.json", PRESET)
        for spacing, unit_length in (([0.5, 0.5, 0.5], 2), ([2, 4, 3], 0.5)):
            x, y, z = spacing
            volume = {**SCENE["volume"], "spacing": spacing}
            camera = {"eye": [x, y / 2, -9], "target": [x, y / 2, 0], "up": [0, 1, 0], "height": x, "size": [2, 1]}
            description, _ = self.render(preset, volume=volume, camera=camera)
            self.assertEqual(description["unit_length"], unit_length)
            self.assertIn("world unit", description["opacity"])
            _, pixel = self.render({"file": "a.json", "unit_length": 4}, volume=volume, camera=camera)
            self.assertAlmostEqual(float(pixel[3]), 1 - 0.75 ** (2 * z / (4 * min(spacing))), places=6)

    def test_what_paraview_says_of_scalars(self):
        points = {"Name": "p", "RGBPoints": [10, 1, 0, 0, 20, 1, 0.5, 0], "Points": [10, 0, 0.5, 0, 20, 0.5, 0.5, 0]}
        stretched, as_stated = self.opacity_over(1), 0  # the scene's data are 0 to 1, the ray's scalar 1/2
        for document, members, opacity in (
            (points, {}, stretched),
            ({**points, "AbsoluteRange": True}, {}, as_stated),
            ({**points, "AbsoluteRange": True}, {"scalars": "stretched"}, stretched),
            (points, {"scalars": "as_stated"}, as_stated),
            (points, {"range": [0, 2]}, self.opacity_over(1, 0.25)),
            ({**PRESET, "RGBPoints": [0, 1, 0, 0, 2, 1, 0.5, 0], "OpacityPoints": [0, 0, 2, 1], "AbsoluteRange": False}, {}, self.opacity_over(1, 1)),
            ({**PRESET, "RGBPoints": [0, 1, 0, 0, 2, 1, 0.5, 0], "OpacityPoints": [0, 0, 2, 1]}, {}, self.opacity_over(1)),
        ):
            with self.subTest(document=document, members=members):
                _, pixel = self.render({"file": self.write("a.json", document), **members})
                self.assertAlmostEqual(float(pixel[3]), opacity, places=6)

    def test_what_other_parsers_of_json_take(self):
        text = json.dumps([PRESET])
        for written in (text[:-2] + ',}, // ,]"\n ]', "\ufeff" + text[:-1].replace("],", '], /* , ]" */', 1) + ", /* */ ]"):
            _, pixel = self.render(self.write("a.json", written.encode()))
            self.assert_pixel(pixel, self.opacity_over(1), 0.25)

    def test_extensions_in_capital_letters(self):
        _, pixel = self.render(self.write("A.VP", VP))
        self.assert_pixel(pixel, self.opacity_over(1), 0.25)

    def test_hues(self):
        document = {"Name": "hues", "ColorSpace": "HSV", "RGBPoints": [0, 0, 0, 1, 1, 1, 0, 0], "Points": [0, 0.5, 0.5, 0, 1, 0.5, 0.5, 0]}
        vtk_js = {key: value for key, value in document.items() if key != "Points"} | {"OpacityPoints": [0, 0.5, 1, 0.5]}
        for transfer, color in (
            (document, [0, 1, 0]),
            ({**document, "HSVWrap": 1}, [1, 0, 1]),
            (vtk_js, [1, 0, 1]),
            ({**vtk_js, "HSVWrap": False}, [0, 1, 0]),
        ):
            _, pixel = self.render(self.write("map.json", transfer))
            numpy.testing.assert_allclose(pixel[:3] / pixel[3], color, atol=3e-3)
        xml_map = '<ColorMaps><ColorMap name="h" space="{}"><Point x="0" o="0.5" r="0" g="0" b="1"/><Point x="1" o="0.5" r="1" g="0" b="0"/></ColorMap></ColorMaps>'
        for space, color in (("HSV", [0, 1, 0]), ("Wrapped", [1, 0, 1])):
            _, pixel = self.render(self.write("map.xml", xml_map.format(space)))
            numpy.testing.assert_allclose(pixel[:3] / pixel[3], color, atol=3e-3)

    def test_light_that_is_not_taken_is_told(self):
        scene = self.write("scene.json", changed(SCENE, "/transfer_function", self.write("a.vp", VP)))
        done = self.run_program("render", scene, "-o", "i.npy")
        self.assertEqual(done.returncode, 0)
        self.assertIn('"shading": {"light":[0,0,1],"ambient":0.1,"diffuse":0.9,"specular":0.2,"shininess":10', done.stderr.decode())
        shading = json.loads(done.stderr.decode().split('"shading": ')[1].splitlines()[0])
        self.json_of("render", self.write("lit.json", {**SCENE, "shading": shading}), "-o", "i.npy")

    def test_unit_distance_of_a_property(self):
        component = {
            "scalarOpacityUnitDistance": 4,
            "scalarOpacity": {"points": [{"x": 0, "y": 0}, {"x": 1, "y": 0.5}]},
            "rgbTransferFunction": {"points": [{"x": 0, "color": [1, 0, 0]}, {"x": 1, "color": [1, 0.5, 0]}]},
            "gradientOpacity": {"points": [{"x": 0, "y": 0}, {"x": 1, "y": 1}]},
            "disableGradientOpacity": True,
        }
        document = {"volumeProperties": [{"effectiveRange": [0, 1], "components": [component]}]}
        description, pixel = self.render(self.write("a.vp.json", document))
        self.assert_pixel(pixel, self.opacity_over(4), 0.25)
        self.assertEqual(description["ignored"], ["effectiveRange"])
        component["disableGradientOpacity"] = False
        scene = self.write("scene.json", changed(SCENE, "/transfer_function", self.write("a.vp.json", document)))
        self.assert_refused(self.run_program("render", scene, "-o", "i.npy"), "gradient")

    def test_rays_and_tables_take_presets(self):
        self.write("a.json", {"Name": "p", "RGBPoints": [0, 1, 0, 0, 1, 1, 0.5, 0], "Points": [0, 0, 0.5, 0, 1, 0.5, 0.5, 0]})
        ray = {
            "signal": {"kind": "piecewise_polynomial", "breaks": [0, 2], "coefficients": [[0.5]]},
            "transfer_function": {"file": "a.json"},
            "schemes": ["reference"],
        }
        answer = self.json_of("eval", self.write("ray.json", ray))
        self.assertAlmostEqual(answer["reference"]["opacity"], self.opacity_over(1), places=14)
        self.assertEqual(answer["transfer_function"]["unit_length"], 1)
        grid = {"size": [2, 2, 2], "values": [0, 0, 0, 0, 10, 10, 10, 10]}
        signal = {"kind": "trilinear", "volume": grid, "origin": [0.5, 0.5, 0.5], "direction": [1, 0, 0], "length": 0.5}
        answer = self.json_of("eval", self.write("ray.json", {**ray, "signal": signal}))
        self.assertAlmostEqual(answer["reference"]["opacity"], 1 - 0.75**0.5, places=14)  # 0 to 1 stretched over 0 to 10
        table = {"transfer_function": self.write("a.tfi", VOREEN), "builder": "exact", "size": 4, "length": 1, "range": [0, 1]}
        self.assert_refused(self.run_program("table", self.write("t.json", table), "-o", "t.npy"), "longest side", '"unit_length"')
        table["transfer_function"] = {"file": "a.tfi", "unit_length": 1, "range": [0, 1]}
        self.output_of("table", self.write("t.json", table), "-o", "t.npy")
        self.assertAlmostEqual(float(numpy.load(self.folder / "t.npy")[3, 3, 3]), 102 / 255, places=6)

    def test_shown_and_written(self):
        self.write("presets.xml", SLICER)
        self.assertIn("edges", self.output_of("transfer", "presets.xml"))
        self.assertEqual([item["name"] for item in self.json_of("transfer", "presets.xml", "--json")], ["plain", "edges"])
        shown = self.output_of("transfer", "presets.xml", "--preset", "plain", "-o", "own.json")
        for words in ("3D Slicer volume property", "unit length       1.0\n", "range             0.0, 1.0\n", "red, green, blue"):
            self.assertIn(words, shown)
        _, of_preset = self.render({"file": "presets.xml", "preset": "plain"})
        _, of_own = self.render("own.json")
        numpy.testing.assert_array_equal(of_own, of_preset)
        again = self.json_of("transfer", "own.json", "--json")
        self.assertEqual({key: again[key] for key in ("points", "unit_length")}, json.loads((self.folder / "own.json").read_text()))
        self.assert_refused(self.run_program("transfer", "presets.xml", "-o", "x.json"), "--preset")
        self.assert_refused(self.run_program("transfer", "presets.xml", "--preset", "plan"), "perhaps plain")
        self.assert_refused(self.run_program("transfer", "absent.xml"), "absent.xml")
        self.write("colors.json", COLORS)
        self.write("many.json", [{"Name": "a", "OpacityPoints": [10, 0, 20, 1]}, {"Name": "b", "OpacityPoints": [10, 0, 20, 0.5]}])
        self.assert_refused(self.run_program("transfer", "colors.json", "--opacity", "many.json"), "opacity_preset")
        chosen = self.json_of("transfer", "colors.json", "--opacity", "many.json", "--opacity-preset", "b", "--json")
        self.assertEqual([point["opacity"] for point in chosen["points"]], [0, 0.5])

    @unittest.skipUnless(SAMPLES.is_dir(), "needs samples of other programs' files")
    def test_samples(self):
        count = 0
        for path in sorted(SAMPLES.glob("*/*")):
            if path.suffix in (".tfi", ".itf", ".vp"):
                self.render({"file": str(path), "unit_length": 1, "ignore_gradient_opacity": True})
                count += 1
        for node in xml.parse(SAMPLES / "slicer/presets.xml").getroot():
            self.render({"file": str(SAMPLES / "slicer/presets.xml"), "preset": node.get("name"), "ignore_gradient_opacity": True})
            count += 1
        for preset in json.loads((SAMPLES / "volview/MedicalColorPresets.json").read_text()):
            if "OpacityPoints" in preset:
                self.render({"file": str(SAMPLES / "volview/MedicalColorPresets.json"), "preset": preset["Name"]})
                count += 1
        for name in ("paraview/ColorMaps.json", "paraview-glance/Presets.json"):  # the first with a comma that JSON has not
            listed = self.json_of("transfer", str(SAMPLES / name), "--json")
            self.assertTrue(all("problem" not in item or "categories" in item["problem"] for item in listed))
            count += len(listed)
        self.assertGreater(count, 280)


class Refusals(ProgramTest):
    def test_bad_files(self):
        files = [
            ("a.xml", SLICER[:200], "line"),
            ("a.xml", "<a/>", "no transfer function"),
            ("a.xml", SLICER, "preset"),
            ("a.xml", SLICER.replace("edges", "x").replace("4 0 0 1 0.5", "5 0 0 1 0.5"), "preset"),
            ("a.vp", VP.replace("4 0 0 1 0.5", "5 0 0 1 0.5"), "scalarOpacity"),
            ("a.vp", VP.replace("4 0 0 1 0.5", "4 0 0 1 nan"), "finite"),
            ("a.vp", VP.replace("4 0 0 1 0.5", "4 0 0 1 2"), "opacity 2"),
            ("a.vp.json", {"volumeProperties": []}, "/volumeProperties"),
            ("a.vp.json", {"volumeProperties": [{"components": [{}]}]}, "/scalarOpacity"),
            ("a.xml", '<ColorMaps><ColorMap space="XYZ"><Point x="0" o="0" r="0" g="0" b="0"/></ColorMap></ColorMaps>', "@space"),
            ("a.xml", '<ColorMaps><ColorMap><Point x="0" o="1" r="0" g="0" b="0"/></ColorMap></ColorMaps>', "without opacity"),
            ("a.json", {**PRESET, "UseLogScale": 1}, "logarithm"),
            ("a.vp", "1\n1\n", "lines"),
            ("a.tfi", VOREEN.replace('r="255"', 'r="red"'), "red"),
            ("a.tfi", VOREEN.replace('r="255"', 'r="256"'), "from 0 to 1"),
            ("a.tfi", VOREEN.replace('<gammaValue value="1"/>', '<gammaValue value="2"/>'), "gamma"),
            ("a.tfi", VOREEN.replace('<intensity value="0"/>', ""), "intensity"),
            ("a.itf", INVIWO.replace('content="1"', 'content="1e999"'), "content"),
            ("a.itf", INVIWO.replace("Point>", "Pint>"), "no colours"),
            ("a.json", {**PRESET, "RGBPoints": [0, 1, 0]}, "multiple of 4"),
            ("a.json", {**PRESET, "RGBPoints": [0, 1, 0, "x"]}, "/RGBPoints/3"),
            ("a.json", {**PRESET, "ColorSpace": "XYZ"}, "/ColorSpace"),
            ("a.json", {"Name": "categories", "IndexedColors": [0, 0, 0]}, "categories"),
            ("a.json", json.dumps(PRESET)[:-10], "JSON"),
            ("a.json", json.dumps(PRESET).replace("0.5", "NaN"), "JSON"),
            ("a.json", 3, "colour map"),
            ("a.png", "", "extension"),
            ("b.json", None, "b.json"),
        ]
        for name, content, words in files:
            with self.subTest(name=name, words=words):
                if content is not None:
                    self.write(name, content)
                scene = self.write("scene.json", changed(SCENE, "/transfer_function", name))
                done = self.run_program("render", scene, "-o", "image.npy")
                self.assert_refused(done, "scene.json", name, words)

    def test_misspelt_preset(self):
        self.write("a.xml", SLICER)
        scene = self.write("scene.json", changed(SCENE, "/transfer_function", {"file": "a.xml", "preset": "plane"}))
        self.assert_refused(self.run_program("render", scene, "-o", "i.npy"), "perhaps plain")


if __name__ == "__main__":
    unittest.main()
