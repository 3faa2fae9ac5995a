"""additions.py SOURCE WORK: adds a toy scheme, measure, table builder, field and command to a copy of the sources, by the steps of
src/README.md only, and sees them in lists, help, schemas and a run. Builds twice, before and after, and counts what a change compiles."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

SOURCE, WORK = Path(sys.argv[1]), Path(sys.argv[2])
TREE = WORK / "tree"
BUILD = TREE / "build/release"
touched = {}


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **options)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: exit {done.returncode}\n{done.stdout[-4000:]}\n{done.stderr[-4000:]}")
    return done.stdout


def expect(holds, what):
    print(("ok: " if holds else "WRONG: ") + what, flush=True)
    if not holds:
        sys.exit(1)


def new(addition, name, text):
    path = TREE / name
    expect(not path.exists(), f"{addition}: {name} is new")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    touched.setdefault(addition, []).append(f"new {name}")


def change(addition, name, before, after):
    path = TREE / name
    text = path.read_text()
    expect(text.count(before) >= 1, f"{addition}: {name} has the place to add")
    path.write_text(text.replace(before, after, 1))
    if f"change {name}" not in touched.setdefault(addition, []):
        touched[addition].append(f"change {name}")


def build():
    """The sources that are compiled."""
    out = run("ninja", "-C", BUILD, "raytruth_program")
    return re.findall(r"Building CXX object \S*?/src/(\S+)\.o", out)


def program(*arguments, **options):
    return run(BUILD / "raytruth", *arguments, **options)


def add_scheme():
    what = "a signal scheme with its rule"
    new(what, "src/raytruth/rules/toy.glsl", """// A toy: linear between two samples, as order1.glsl.

vec4 toy(real front, real back) {
  real third = (back - front) / 3.0;
  return vec4(front, front + third, back - third, back);
}
""")
    new(what, "src/raytruth/schemes/toy.hpp", (TREE / "src/raytruth/schemes/order1.hpp").read_text().replace("Order1", "Toy").replace('"order1"', '"toy"').replace("{}.order1(", "{}.toy("))
    change(what, "src/raytruth/rules/rules.hpp", '#include "raytruth/rules/order1.glsl"\n', '#include "raytruth/rules/order1.glsl"\n#include "raytruth/rules/toy.glsl"\n')
    row = """      sum_twin(
          "order1", [](auto r) { return &decltype(r)::order1; }, {signal, signal}, sum),
"""
    change(what, "src/raytruth/rules/twins.cpp", row, row + row.replace("order1", "toy"))
    change(what, "src/raytruth/schemes/scheme_list.hpp", '#include "raytruth/schemes/order3.hpp"\n', '#include "raytruth/schemes/order3.hpp"\n#include "raytruth/schemes/toy.hpp"\n')
    change(what, "src/raytruth/schemes/scheme_list.hpp", "Order3, VirtualCatmullRom,", "Order3, Toy, VirtualCatmullRom,")


def add_measure():
    what = "a measure"
    new(what, "src/measures/signals/toy_count.cpp", """#include "experiments/measure.hpp"

namespace raytruth {

namespace {

struct Options {
  std::int64_t count = 0;
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "count"});
  return {.count = json.at("count").integer(1, 100)};
}

struct Record {
  std::int64_t number = 0;
  double square = 0;
};

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  return {
      {.name = "number", .description = "a number", .is_key = true, .cell = &Record::number},
      {.name = "square", .description = "its square", .cell = &Record::square},
  };
}

std::vector<Record> records(const Experiment& /*experiment*/, const Options& options) {
  std::vector<Record> records;
  for (std::int64_t i = 0; i < options.count; ++i) records.push_back({i, static_cast<double>(i * i)});
  return records;
}

}  // namespace

extern const Measure toy_count_measure;
const Measure toy_count_measure{MeasureDefinition<Options, Record>{.name = "toy_count",
                                          .summary = "numbers and their squares",
                                          .read = read_options,
                                          .columns = columns,
                                          .of_experiment = records}};

}  // namespace raytruth
""")
    new(what, "experiments/schemas/measures/toy_count.json", json.dumps({
        "$schema": "https://json-schema.org/draft/2020-12/schema", "title": "Options of the measure toy_count", "type": "object",
        "properties": {"kind": {"const": "toy_count"}, "count": {"type": "integer", "minimum": 1, "maximum": 100}}, "required": ["kind", "count"], "additionalProperties": False}, indent=2) + "\n")
    change(what, "src/measures/measures.cpp", "extern const Measure turning_points_measure;\n", "extern const Measure toy_count_measure;\nextern const Measure turning_points_measure;\n")
    change(what, "src/measures/measures.cpp", "&turning_points_measure,", "&turning_points_measure, &toy_count_measure,")


def add_builder():
    what = "a table builder"
    new(what, "src/raytruth/tables/toy_table.hpp", """#pragma once

#include "raytruth/tables/exact.hpp"

namespace raytruth {

/// A toy: the exact table.
inline Table<double> toy_table(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission) {
  return exact_table(transfer, axes, emission);
}

}  // namespace raytruth
""")
    change(what, "src/raytruth/tables/table_builders.cpp", '#include "raytruth/tables/subrange.hpp"\n', '#include "raytruth/tables/subrange.hpp"\n#include "raytruth/tables/toy_table.hpp"\n')
    change(what, "src/raytruth/tables/table_builders.cpp", "  return list;\n}\n", '  list.push_back({.name = "toy_table", .summary = "a toy", .source = "nowhere", .make = toy_table});\n  return list;\n}\n')


def add_field():
    what = "a field"
    new(what, "src/raytruth/signals/fields/toy_slope.hpp", """#pragma once

#include "raytruth/core/named.hpp"
#include "raytruth/signals/field_option.hpp"
#include "raytruth/volume/grid.hpp"

#include <cstdint>
#include <tuple>

namespace raytruth {

/// A toy: s = x / (n - 1).
struct ToySlope {
  static constexpr Named kind{"toy_slope", "a slope along x, at n^3 nodes"};

  std::int64_t size = 8;

  static constexpr auto options() {
    return std::tuple{FieldOption<ToySlope, std::int64_t>{"size", &ToySlope::size, 2, largest_generated_size}};
  }
};

inline void check(const ToySlope& slope) { check_options(slope); }

inline Grid make_grid(const ToySlope& slope) {
  check(slope);
  Grid grid;
  grid.size = {slope.size, slope.size, slope.size};
  for (std::int64_t i = 0; i < slope.size * slope.size * slope.size; ++i)
    grid.values.push_back(static_cast<double>(i % slope.size) / static_cast<double>(slope.size - 1));
  return grid;
}

}  // namespace raytruth
""")
    new(what, "experiments/schemas/fields/toy_slope.json", json.dumps({
        "$schema": "https://json-schema.org/draft/2020-12/schema", "title": "Options of the field toy_slope",
        "properties": {"kind": {"const": "toy_slope"}, "size": {"type": "integer", "minimum": 2, "maximum": 2048, "default": 8}}}, indent=2) + "\n")
    change(what, "src/raytruth/signals/fields/generated_fields.hpp", '#include "raytruth/signals/fields/molecule.hpp"\n', '#include "raytruth/signals/fields/molecule.hpp"\n#include "raytruth/signals/fields/toy_slope.hpp"\n')
    change(what, "src/raytruth/signals/fields/generated_fields.hpp", "Molecule, CtPhantom>", "Molecule, CtPhantom, ToySlope>")


def add_command():
    what = "a command"
    new(what, "src/program/command_toy.cpp", """#include "experiments/output.hpp"
#include "program/command.hpp"

namespace raytruth {

namespace {

struct ToyOptions {
  std::string word;
};

int say_word(const ToyOptions& options) {
  print(options.word + "\\n");
  return 0;
}

std::function<int()> describe(CommandOptions& add) {
  const auto options = std::make_shared<ToyOptions>();
  add.operand("word", options->word, "Any word");
  return [options] { return say_word(*options); };
}

}  // namespace

extern const Command toy_command;
const Command toy_command{.name = "toy", .summary = "Say a word", .example = "raytruth toy word", .notes = "", .describe = describe};

}  // namespace raytruth
""")
    change(what, "src/program/commands.cpp", "extern const Command vectors_command;\n", "extern const Command toy_command;\nextern const Command vectors_command;\n")
    change(what, "src/program/commands.cpp", "&vectors_command,", "&vectors_command, &toy_command,")


def main():
    shutil.rmtree(WORK, ignore_errors=True)
    TREE.mkdir(parents=True)
    for name in run("git", "-C", SOURCE, "ls-files", "CMakeLists.txt", "CMakePresets.json", "src", "experiments").splitlines():
        (TREE / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(SOURCE / name, TREE / name)
    os.environ.setdefault("CCACHE_SLOPPINESS", "pch_defines,time_macros")
    run("cmake", "-S", TREE, "--preset", "release", "-D", "RAYTRUTH_TESTS=OFF", "-D", "RAYTRUTH_BENCHMARKS=OFF")
    print(f"before: {len(build())} sources compiled", flush=True)

    path = TREE / "src/measures/signals/turning_points.cpp"
    path.write_text(path.read_text().replace("how often the cubic", "How often the cubic"))
    compiled = build()
    expect(compiled == ["measures/signals/turning_points.cpp"], f"an edit of one measure compiles one source: {compiled}")

    add_measure()
    compiled = sorted(build())
    expect(compiled == ["measures/measures.cpp", "measures/signals/toy_count.cpp"], f"a new measure compiles two sources: {compiled}")
    add_command()
    compiled = sorted(build())
    expect(compiled == ["program/command_toy.cpp", "program/commands.cpp"], f"a new command compiles two sources: {compiled}")
    add_builder()
    add_scheme()
    add_field()
    print(f"scheme, builder and field: {len(build())} sources compiled", flush=True)
    (TREE / "experiments/schemas/names.json").write_text(program("list", "--schema"))

    for kind, name in (("schemes", "toy"), ("measures", "toy_count"), ("tables", "toy_table"), ("fields", "toy_slope")):
        names = [entry["name"] for entry in json.loads(program("list", kind, "--json"))]
        expect(name in names, f"`list {kind}` knows {name}")
    expect("toy" in program("--help") and "Any word" in program("toy", "--help"), "--help knows the command")
    expect(program("toy", "hello") == "hello\n", "the command works")

    experiment = {
        "raytruth": "experiment/1", "name": "toys", "question": "Do toys work?", "source": "nowhere",
        "fields": [{"name": "slope", "kind": "toy_slope", "size": 16}, {"name": "noise", "kind": "random_field", "size": 16}],
        "rays": {"count": 20, "length": 6}, "schemes": ["order1", "toy"], "measures": [{"kind": "signal_error"}, {"kind": "toy_count", "count": 3}]}
    (TREE / "toys.json").write_text(json.dumps(experiment))
    result = json.loads(program("run", TREE / "toys.json"))
    rows = [row for row in result["rows"] if row["measure"] == "signal_error"]
    of = {(row["field"], row.get("scheme")): row for row in rows if row.get("scheme")}
    expect(of["noise", "toy"]["xi_p50"] == of["noise", "order1"]["xi_p50"] > 0, "the toy scheme errs as linear interpolation does")
    expect(of["slope", "toy"]["xi_p50"] < 1e-12, "and is exact on the toy field")
    expect([row["square"] for row in result["rows"] if row["measure"] == "toy_count"] == [0, 1, 4], "the toy measure counts")
    case = {"transfer_function": {"points": [{"s": 0, "extinction": 1, "color": [1, 1, 1]}, {"s": 1, "extinction": 2, "color": [1, 0, 0]}]},
            "builder": "toy_table", "size": 8, "length": 1, "range": [0, 1]}
    (TREE / "table.json").write_text(json.dumps(case))
    program("table", TREE / "table.json", "-o", TREE / "table.npy")
    expect((TREE / "table.npy").exists(), "the toy builder builds")

    try:
        import jsonschema
    except ImportError:
        print("without jsonschema the schemas are not checked")
    else:
        folder = TREE / "experiments/schemas"
        store = {path.as_uri(): json.loads(path.read_text()) for path in folder.rglob("*.json")}
        path = folder / "experiment.json"
        schema = store[path.as_uri()]
        validator = jsonschema.Draft202012Validator(schema, resolver=jsonschema.RefResolver(base_uri=path.as_uri(), referrer=schema, store=store))
        errors = [error.message[:300] for error in validator.iter_errors(experiment)]
        expect(errors == [], f"the schemas take the toys: {errors}")

    for addition, files in touched.items():
        print(f"{addition}: {sum(f.startswith('new') for f in files)} + {sum(f.startswith('change') for f in files)}: {', '.join(files)}")


main()
