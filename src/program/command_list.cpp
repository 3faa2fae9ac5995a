#include "experiments/listing.hpp"
#include "experiments/measure.hpp"
#include "experiments/output.hpp"
#include "program/command.hpp"
#include "raytruth/catalogue.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/shading/slab_shading.hpp"
#include "raytruth/volume/files/find_volume.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <string>

namespace raytruth {

namespace {

struct ListOptions {
  std::string kind;  ///< empty: all
  bool json = false;
  bool schema = false;
  VolumeOptions volumes;
};

using Json = nlohmann::ordered_json;

Json words_json(const std::vector<std::string_view>& words) { return {{"enum", words}}; }

/// The names of the measures for which `is_asked` holds.
template <class IsAsked>
Json measures_json(const IsAsked& is_asked) {
  std::vector<std::string_view> names;
  for (const Measure* measure : measures())
    if (is_asked(*measure)) names.push_back(measure->name);
  return words_json(names);
}

/// What experiments/schemas/names.json holds: a JSON Schema of the names that the other schemas refer to.
Json schema_of_names() {
  const auto files = [](std::string_view folder, const std::vector<std::string_view>& names) {
    Json list = Json::array();
    for (const std::string_view name : names) list.push_back({{"$ref", fmt::format("{}/{}.json", folder, name)}});
    return Json{{"oneOf", list}};
  };
  return {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
          {"title", "The names that the program knows, as `raytruth list --schema` writes them"},
          {"$defs",
           {{"scheme", words_json(names_of(catalogue::integral_schemes()))},
            {"surface_scheme", words_json(names_of(catalogue::surface_schemes()))},
            {"signal_scheme", words_json(catalogue::scheme_names())},
            {"shading", words_json(names_of(catalogue::shadings()))},
            {"highlight", words_json(names_of(catalogue::highlights()))},
            {"table_builder", words_json(names_of(catalogue::table_builders()))},
            {"second_order_builder", words_json(names_of(catalogue::second_order_builders))},
            {"quadratic_gray_builder", words_json(names_of(catalogue::quadratic_gray_builders()))},
            {"generated_field", files("fields", names_of(generated_field_kinds))},
            {"measure", files("measures", names_of(measures()))},
            {"measure_name", measures_json([](const Measure& /*measure*/) { return true; })},
            {"measure_of_fields", measures_json([](const Measure& measure) { return measure.is_of_fields; })},
            {"measure_of_signals", measures_json([](const Measure& measure) { return measure.needs.signal_schemes; })},
            {"measure_of_schemes", measures_json([](const Measure& measure) { return measure.needs.schemes; })},
            {"measure_of_transfers", measures_json([](const Measure& measure) { return measure.needs.transfers; })}}}};
}

std::string text_of(const std::string& kind, const std::vector<std::filesystem::path>& folders) {
  const Json list = list_of(kind, folders);
  std::size_t width = 0;
  for (const Json& entry : list) width = std::max(width, entry.at("name").get_ref<const std::string&>().size());
  // Where experiments are found depends on the folder that the program runs in.
  const std::string where =
      kind == "experiments" && !list.empty()
          ? ", in " + std::filesystem::path(list.front().at("file").get<std::string>()).parent_path().string()
          : "";
  std::string text = fmt::format("{}{}{}\n", kind, where, list.empty() ? ": none" : "");
  for (const Json& entry : list)
    text += fmt::format("  {:<{}}  {}\n", entry.at("name").get<std::string>(), width,
                        entry.at("summary").get<std::string>());
  return text;
}

int list_ingredients(const ListOptions& options) {
  if (options.schema) {
    print(schema_of_names().dump(2) + "\n");
    return 0;
  }
  const auto folders = volume_access(options.volumes).folders;
  if (options.kind == "volumes")
    for (const auto& folder : absent_folders(folders_of_environment()))
      say(fmt::format("warning: RAYTRUTH_DATA: {}: there is no such folder", folder.string()));
  if (options.json) {
    Json all = Json::object();
    for (const std::string& kind : listed_kinds()) all[kind] = list_of(kind, folders);
    print((options.kind.empty() ? all : all.at(options.kind)).dump(2) + "\n");
    return 0;
  }
  for (const std::string& kind : options.kind.empty() ? listed_kinds() : std::vector{options.kind})
    print(text_of(kind, folders));
  return 0;
}

std::function<int()> describe(CommandOptions& add) {
  const auto options = std::make_shared<ListOptions>();
  add.optional_operand("kind", options->kind, listed_kinds(), "Of what (default: everything)");
  add.flag("--json", options->json, "As JSON");
  add.data(options->volumes);
  add.flag("--schema", options->schema, "Write the names as experiments/schemas/names.json has them");
  return [options] { return list_ingredients(*options); };
}

}  // namespace

extern const Command list_command;
const Command list_command{.name = "list",
                           .summary = "List what there is",
                           .example = "raytruth list schemes --json",
                           .notes = "",
                           .describe = describe};

}  // namespace raytruth
