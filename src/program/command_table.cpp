#include "experiments/output.hpp"
#include "experiments/result.hpp"
#include "program/command.hpp"
#include "raytruth/documents/table_case.hpp"
#include "raytruth/gl/device.hpp"
#include "raytruth/gl/table_builds.hpp"
#include "raytruth/tables/brute_force.hpp"
#include "raytruth/tables/fast_second_order.hpp"
#include "raytruth/tables/table_file.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>

namespace raytruth {

namespace {

struct TableOptions {
  std::string table_case;
  std::string file;
  int threads = 0;
  std::optional<std::string> gl;
};

using Json = nlohmann::ordered_json;
using MakeBytes = std::string (*)(const std::vector<std::size_t>&, const std::vector<double>&, const TableFormat&);

MakeBytes writer_of(const std::filesystem::path& file) {
  if (file.extension() == ".npy") return npy_bytes;
  if (file.extension() == ".nrrd") return nrrd_bytes;
  throw InputError(fmt::format("command line: -o {}: found a name that ends in \"{}\"; .npy and .nrrd are allowed",
                               file.string(), file.extension().string()));
}

/// The table by a compute shader, and what ran it.
struct TableOfShader {
  MadeTable table;
  GlIdentity device;
};

TableOfShader make_in_shader(const TableCase& asked, const std::string& platform) {
  const JsonReader place = asked.json.at("builder");
  const auto* const builder = std::get_if<const TableBuilder*>(&asked.builder);
  const auto* const method = std::get_if<SecondOrderMethod>(&asked.builder);
  const auto* const iterations = method != nullptr ? std::get_if<Iterations>(method) : nullptr;
  const bool is_brute_force = builder != nullptr && (*builder)->name == "brute_force";
  if (!is_brute_force && iterations == nullptr)
    place.refuse(fmt::format("{} with --gl", place.text()),
                 "brute_force and second_order_iterations, which shaders make, or any builder without --gl");
  if (iterations != nullptr && !is_linear_between_entries(*asked.transfer, asked.axes))
    asked.json.at("transfer_function")
        .refuse("points between the table's entries, or jumps, with --gl",
                "points at low + (high - low) i / (size - 1), which is all that the shader reads, or no --gl");
  const auto device = open_gl(platform == "egl" ? GlPlatform::egl : GlPlatform::osmesa);
  if (iterations != nullptr)
    return {
        judged(asked, second_order_table_in_shader(*device, *asked.transfer, asked.axes, asked.emission, *iterations)),
        device->identity()};
  const Table<float> made =
      brute_force_table_in_shader(*device, sampled(*asked.transfer, asked.axes, asked.emission), asked.axes);
  Table<double> table(asked.axes);
  table.values.assign(made.values.begin(), made.values.end());
  return {judged(asked, **builder, table), device->identity()};
}

int write_table(const TableOptions& options) {
  const int threads = options.threads > 0 ? options.threads : tbb::info::default_concurrency();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  const std::filesystem::path file = options.file;
  const MakeBytes make_bytes = writer_of(file);
  std::vector<std::string> warnings;
  const JsonReader json = JsonReader::from_file(options.table_case);
  const TableCase asked = read_table_case(json, warnings);
  if (make_bytes == nrrd_bytes) json.at("format").blame_for([&] { return nrrd_bytes({}, {}, asked.format); });
  for (const std::string& warning : warnings) say(warning);

  std::optional<GlIdentity> device;
  const MadeTable table = [&] {
    if (!options.gl) return make_table(asked);
    TableOfShader made = make_in_shader(asked, *options.gl);
    device = std::move(made.device);
    return std::move(made.table);
  }();
  if (const auto beyond = clamped_numbers(asked, table); beyond > 0)
    say(fmt::format("warning: {}: {} numbers above 1 are clamped to it, as {} holds no larger ones", options.table_case,
                    beyond, asked.format.name));

  Json text = table_description(asked, table, file.filename().string());
  text["build"] = build_identity();
  if (device) text["gl"] = to_json(*device);

  // Both files or none: the table waits beside its place until its description is written.
  const std::filesystem::path temporary = temporary_beside(file);
  write_temporary(temporary, file, make_bytes(table.shape, table.values, asked.format));
  try {
    write_whole(file.string() + ".json", text.dump(2) + "\n");
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw;
  }
  move_into_place(temporary, file);
  return 0;
}

std::function<int()> describe(CommandOptions& add) {
  const auto options = std::make_shared<TableOptions>();
  add.operand("case", options->table_case, "JSON file; '-' is standard input");
  add.required_text("-o", "FILE", options->file,
                    "Write this file, .npy or .nrrd, and FILE.json beside it, with its error");
  add.threads(options->threads);
  add.word("--gl", options->gl, {"osmesa", "egl"},
           "Make it in a compute shader, by osmesa or by egl, a GPU's driver: brute_force and second_order_iterations");
  return [options] { return write_table(*options); };
}

}  // namespace

extern const Command table_command;
const Command table_command{
    .name = "table",
    .summary = "Make a pre-integration table for a renderer, and measure its error",
    .example = "raytruth table table.json -o table.npy",
    .notes =
        "A case:\n"
        "  {\"transfer_function\": {\"points\": [{\"s\": 0, \"extinction\": 0, \"color\": [0, 0, 0]},\n"
        "                                    {\"s\": 255, \"extinction\": 2, \"color\": [1, 0.5, 0.2]}]},\n"
        "   \"builder\": \"exact\", \"size\": 256, \"length\": 1, \"range\": [0, 255], \"format\": \"float32\"}\n\n"
        "`raytruth list tables` tells the builders. Those over three scalars are for slabs whose scalar is a "
        "parabola;\n"
        "quadratic_gray and quadratic_gray_printed stand over two scalars and the parabola's curvature a = +-1 / R^2, "
        "in\n"
        "gray values (0 to 255 over the range) per squared length, whose nodes \"radius\" states:\n"
        "  \"radius\": {\"axis\": \"signed\", \"low\": 0.125, \"high\": 8, \"count\": 7}\n"
        "or powers_of_two, or equal_steps; `count` radii R for either sign of a, and the linear table between.\n"
        "psi of Moreland and Angel takes \"builder\", \"size\" and \"format\" alone.",
    .describe = describe};

}  // namespace raytruth
