#include "raytruth/documents/field_document.hpp"

#include "raytruth/core/memory_limit.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/signals/fields/generated_fields.hpp"
#include "raytruth/volume/files/read_volume.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

namespace raytruth {

namespace {

template <class Field>
concept Random = requires(Field field) {
  field.seed;
};

/// Calls `visit(option)` for all options of a kind of field.
template <class Field, class Visit>
void for_each_option(const Visit& visit) {
  std::apply([&visit](const auto&... option) { (visit(option), ...); }, Field::options());
}

/// Calls `visit.template operator()<Field>()` for the kind of this name; false where no generator has it.
template <class Visit>
bool visit_kind(std::string_view kind, const Visit& visit) {
  return [&]<std::size_t... index>(std::index_sequence<index...>) {
    const auto visit_one = [&]<class Field>() {
      if (Field::kind.name != kind) return false;
      visit.template operator()<Field>();
      return true;
    };
    return (visit_one.template operator()<std::variant_alternative_t<index, GeneratedField>>() || ...);
  }
  (std::make_index_sequence<std::variant_size_v<GeneratedField>>());
}

template <class Field>
Field read_options(const JsonReader& json, std::vector<std::string_view> keys, std::uint64_t seed) {
  Field field;
  for_each_option<Field>([&keys](const auto& option) { keys.push_back(option.name); });
  if constexpr (Random<Field>) keys.emplace_back("seed");
  json.only(keys);
  for_each_option<Field>([&]<class Number>(const FieldOption<Field, Number>& option) {
    const auto stated = json.find(option.name);
    if (!stated) return;
    if constexpr (std::is_integral_v<Number>)
      field.*option.member = stated->integer(option.least, option.most);
    else
      field.*option.member = stated->number(option.least, option.most);
  });
  if constexpr (Random<Field>) {
    const auto stated = json.find("seed");
    constexpr std::int64_t largest_seed = std::numeric_limits<std::int64_t>::max();
    field.seed = stated ? static_cast<std::uint64_t>(stated->integer(0, largest_seed)) : seed;
  }
  try {
    check(field);
  } catch (const FieldOptionError& error) {
    const JsonReader place = json.find(error.option).value_or(json);
    place.blame_for([&error] { throw error; });
  }
  return field;
}

GeneratedField read_generated(const JsonReader& json, const std::string& kind, std::vector<std::string_view> keys,
                              std::uint64_t seed) {
  GeneratedField field;
  keys.emplace_back("kind");
  visit_kind(kind, [&]<class Field>() { field = read_options<Field>(json, std::move(keys), seed); });
  return field;
}

Grid read_inline_grid(const JsonReader& json, bool has_spacing) {
  if (has_spacing)
    json.only({"size", "values", "spacing"});
  else
    json.only({"size", "values"});
  const auto sizes = json.at("size").items();
  if (sizes.size() != 3) json.at("size").refuse_value("a list of 3 sizes");
  Grid grid;
  std::int64_t voxels = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    grid.size[axis] = sizes[axis].integer(1, most_voxels);
    if (grid.size[axis] > most_voxels / voxels) json.at("size").refuse("more voxels than 2^33", "fewer");
    voxels *= grid.size[axis];
  }
  grid.values = json.at("values").numbers();
  if (grid.values.size() != static_cast<std::size_t>(voxels))
    json.at("values").refuse_value(fmt::format("a list of {} numbers, as size says,", voxels));
  if (const auto spacing = json.find("spacing")) {
    const auto lengths = spacing->items();
    if (lengths.size() != 3) spacing->refuse_value("a list of 3 numbers > 0");
    for (std::size_t axis = 0; axis < 3; ++axis) grid.spacing[axis] = lengths[axis].positive_number();
  }
  return grid;
}

/// How many voxels a generated field has along each side.
std::int64_t side_of(const GeneratedField& field) {
  return std::visit(
      [](const auto& kind) {
        if constexpr (requires { kind.samples; })
          return kind.samples;
        else
          return kind.size;
      },
      field);
}

Grid make_within_memory(const GeneratedField& field) {
  const std::int64_t side = side_of(field);
  // Smoothing has a second grid.
  need_memory(2 * sizeof(double) * static_cast<std::uint64_t>(side * side * side),
              fmt::format("a generated field of {0} x {0} x {0} voxels", side));
  return make_grid(field);
}

}  // namespace

FieldDocument read_named_field(const JsonReader& json, std::uint64_t seed) {
  const std::string kind = json.at("kind").word(names_of(catalogue::fields));
  if (find_named(generated_field_kinds, kind) != nullptr) return read_generated(json, kind, {"name"}, seed);
  json.only({"name", "kind", "volume", "repair", "nan", "time_step", "spacing"});
  return read_volume_file(json);
}

FieldDocument read_volume_member(const JsonReader& owner, bool has_spacing) {
  const JsonReader place = owner.at("volume");
  if (!place.is_object()) return read_volume_file(owner);
  for (const std::string_view of_a_file : {"repair", "nan", "time_step", "spacing"})
    if (const auto stated = owner.find(of_a_file)) stated->refuse_value(fmt::format("{} of a file only", of_a_file));
  if (!place.find("kind")) return read_inline_grid(place, has_spacing);
  constexpr std::uint64_t default_seed = 1;
  return read_generated(place, place.at("kind").word(names_of(generated_field_kinds)), {}, default_seed);
}

void fill_in_field_defaults(nlohmann::ordered_json& field) {
  if (!field.is_object() || !field.contains("kind") || !field["kind"].is_string()) return;
  visit_kind(field["kind"].get<std::string>(), [&field]<class Field>() {
    for_each_option<Field>([&field](const auto& option) {
      const auto value = static_cast<double>(Field().*option.member);
      // A whole number is written as one, whatever its type.
      if (value == std::trunc(value))
        field.emplace(option.name, static_cast<std::int64_t>(value));
      else
        field.emplace(option.name, value);
    });
  });
}

SourcedVolume make_volume(const FieldDocument& field, const VolumeAccess& volumes) {
  if (const auto* const generated = std::get_if<GeneratedField>(&field))
    return {.grid = make_within_memory(*generated)};
  if (const auto* const file = std::get_if<VolumeFile>(&field)) return read_sourced_volume(*file, volumes);
  return {.grid = std::get<Grid>(field)};
}

}  // namespace raytruth
