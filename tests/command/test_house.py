"""The folders of the sources: who includes whom, and that the lists are where src/README.md says."""

import re
import subprocess
import unittest

from support import SOURCE, ProgramTest

INCLUDE = re.compile(r'^#include "([^"]+)"', re.MULTILINE)
# Headers that are not installed: what a consumer includes must not lead to them.
INTERNAL = re.compile(r"raytruth/(gl|kernels|reference/arb|render/techniques)/|raytruth/rules/twin|raytruth/reference/piece_integral")


def sources():
    return [path for path in sorted((SOURCE / "src").rglob("*")) if path.suffix in (".hpp", ".cpp", ".glsl")]


def includes(path):
    return INCLUDE.findall(path.read_text(encoding="utf-8"))


def folder(name):
    return name.rpartition("/")[0]


def cycle(graph):
    """Folders that lead back to the first of them; none: the graph has no cycle."""
    done, path = set(), []

    def visit(node):
        if node in path:
            return path[path.index(node):] + [node]
        if node in done:
            return []
        path.append(node)
        for other in sorted(graph.get(node, ())):
            if found := visit(other):
                return found
        done.add(path.pop())
        return []

    for node in sorted(graph):
        if found := visit(node):
            return found
    return []


class Folders(unittest.TestCase):
    def test_the_finder_of_cycles_finds_them(self):
        self.assertEqual(cycle({"a": {"b"}, "b": {"c"}}), [])
        self.assertEqual(cycle({"a": {"b"}, "b": {"c"}, "c": {"b"}}), ["b", "c", "b"])

    def test_no_folders_include_each_other(self):
        """Not even by way of others."""
        graph = {}
        for path in sources():
            here = path.relative_to(SOURCE / "src").parent.as_posix()
            others = {folder(name) for name in includes(path)} - {here}
            graph.setdefault(here, set()).update(others)
        self.assertGreater(len(graph), 25)
        self.assertEqual(cycle(graph), [])

    def test_every_include_names_a_file_from_the_root(self):
        for path in sources():
            for name in includes(path):
                self.assertTrue((SOURCE / "src" / name).is_file(), f"{path}: {name}")

    def test_targets_stand_on_top_of_each_other(self):
        """The library knows no documents, documents no experiments, experiments no program, no Python module, no page."""
        floors = ["raytruth/", "raytruth/documents/", ("experiments/", "measures/"), ("program/", "python/", "explorer/")]

        def floor(name):
            return max(i for i, prefix in enumerate(floors) if name.startswith(prefix))

        for path in sources():
            name = path.relative_to(SOURCE / "src").as_posix()
            for included in includes(path):
                self.assertLessEqual(floor(included), floor(name), f"{name} includes {included}")

    def test_the_library_reads_no_json_and_no_xml(self):
        for path in sources():
            name = path.relative_to(SOURCE / "src").as_posix()
            if name.startswith("raytruth/") and not name.startswith("raytruth/documents/"):
                self.assertNotRegex(path.read_text(encoding="utf-8"), r"#include <(nlohmann|pugixml|CLI)", name)

    def test_public_headers_include_public_ones(self):
        public = [path for path in sources() if path.suffix == ".hpp" and path.is_relative_to(SOURCE / "src/raytruth")]
        for path in public:
            name = path.relative_to(SOURCE / "src").as_posix()
            if not INTERNAL.match(name):
                self.assertEqual([other for other in includes(path) if INTERNAL.match(other)], [], name)

    def test_nothing_below_includes_the_catalogue(self):
        for path in sources():
            name = path.relative_to(SOURCE / "src").as_posix()
            if "raytruth/catalogue.hpp" in includes(path):
                self.assertRegex(name, r"^(raytruth/documents|experiments|measures|program)/")


class Names(ProgramTest):
    def test_the_schema_of_names_is_that_of_the_program(self):
        self.assertEqual((SOURCE / "experiments/schemas/names.json").read_text(), self.output_of("list", "--schema"))

    def test_every_measure_has_a_schema_and_every_schema_a_measure(self):
        measures = {entry["name"] for entry in self.json_of("list", "measures", "--json")}
        self.assertEqual({path.stem for path in (SOURCE / "experiments/schemas/measures").glob("*.json")}, measures)


    def test_every_generated_field_has_a_schema_and_every_schema_a_field(self):
        fields = {entry["name"] for entry in self.json_of("list", "fields", "--json")} - {"volume"}
        self.assertEqual({path.stem for path in (SOURCE / "experiments/schemas/fields").glob("*.json")}, fields)


class Comments(unittest.TestCase):
    def test_comments_have_a_subject(self):
        """Those that begin with these words are parts of a sentence; read aloud, they leave the reader waiting."""
        torn = subprocess.run(["git", "-C", str(SOURCE), "grep", "-nE", r"^[[:space:]]*//[/!]? (Of|The same|Further|That|Besides|Likewise)\b", "--", "src", "tests"], capture_output=True, text=True)
        if torn.returncode > 1:
            self.skipTest("no git history here")
        self.assertEqual(torn.stdout, "")


if __name__ == "__main__":
    unittest.main()
