#include "experiments/listing.hpp"

#include "experiments/experiment_folder.hpp"
#include "experiments/measure.hpp"
#include "raytruth/catalogue.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/shading/slab_shading.hpp"
#include "raytruth/volume/files/find_volume.hpp"
#include "raytruth/volume/files/stored_volume.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <string_view>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

template <class Entries>
Json entries_json(const Entries& entries) {
  Json list = Json::array();
  for (const std::string_view name : names_of(entries))
    list.push_back({{"name", name}, {"summary", find_named(entries, name)->summary}});
  return list;
}

Json schemes_json() {
  Json list = Json::array();
  for (const IntegralScheme& scheme : catalogue::integral_schemes()) {
    Json& entry = list.emplace_back(Json{{"name", scheme.name},
                                         {"summary", scheme.summary},
                                         {"source", scheme.source},
                                         {"family", family(scheme)},
                                         {"color_order", scheme.order.color},
                                         {"opacity_order", scheme.order.opacity}});
    catalogue::visit_scheme(scheme.name, [&entry]<class S>() {
      entry.update({{"signal_order", S::info.order},
                    {"exact_degree", S::info.exact_degree},
                    {"extra_fetches_per_interval", S::info.extra_fetches_per_interval}});
    });
  }
  return list;
}

Json experiments_json() {
  Json list = Json::array();
  for (const auto& [name, question, file] : find_experiments())
    list.push_back({{"name", name}, {"summary", question}, {"file", file.string()}});
  return list;
}

/// What a volume's header says of it, in a few words.
std::string summary_of(const std::filesystem::path& file) {
  try {
    const StoredVolume stored = read_volume_header(file, {.time_step = 0});
    const auto& volume = stored.volume;
    return fmt::format("{}, {}, {}{}", volume.format, facts(volume.type).name, fmt::join(volume.grid.size, " x "),
                       stored.series.count > 1 ? fmt::format(", a series of {}", stored.series.count) : "");
  } catch (const InputError& error) {
    return fmt::format("cannot be read: {}", error.what());
  }
}

Json volumes_json(const std::vector<std::filesystem::path>& folders) {
  Json list = Json::array();
  for (const auto& [name, file] : volumes_in(folders))
    list.push_back({{"name", name}, {"summary", summary_of(file)}, {"file", file.string()}});
  return list;
}

/// The builders of tables over two scalars, over three, over two and a curvature, and of psi.
Json tables_json() {
  Json list = entries_json(catalogue::table_builders());
  for (const Json& row : entries_json(catalogue::second_order_builders)) list.push_back(row);
  for (const Json& row : entries_json(catalogue::quadratic_gray_builders())) list.push_back(row);
  list.push_back({{"name", catalogue::psi_builder.name}, {"summary", catalogue::psi_builder.summary}});
  return list;
}

}  // namespace

const std::vector<std::string>& listed_kinds() {
  static const std::vector<std::string> kinds{"signals",  "fields",   "transfers", "samplings",   "schemes", "surfaces",
                                              "measures", "shadings", "tables",    "experiments", "volumes"};
  return kinds;
}

Json list_of(const std::string& kind, const std::vector<std::filesystem::path>& folders) {
  if (kind == "signals") return entries_json(catalogue::signals);
  if (kind == "fields") return entries_json(catalogue::fields);
  if (kind == "transfers") return entries_json(catalogue::transfers);
  if (kind == "samplings") return entries_json(catalogue::samplings);
  if (kind == "schemes") return schemes_json();
  if (kind == "surfaces") return entries_json(catalogue::surface_schemes());
  if (kind == "measures") return entries_json(measures());
  if (kind == "shadings") return entries_json(catalogue::shadings());
  if (kind == "tables") return tables_json();
  if (kind == "experiments") return experiments_json();
  if (kind == "volumes") return volumes_json(folders);
  return Json::array();
}

}  // namespace raytruth
