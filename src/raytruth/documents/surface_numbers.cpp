#include "raytruth/documents/surface_numbers.hpp"

#include "raytruth/core/named.hpp"
#include "raytruth/schemes/surface_method.hpp"
#include "raytruth/tables/lit/moment_table.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace raytruth {

namespace {

/// Whether one of the schemes is of isoslabs, of this density if one is given.
bool has_isoslabs(const std::vector<std::string>& schemes, std::optional<IsoslabDensity> density = {}) {
  return std::any_of(schemes.begin(), schemes.end(), [&](const std::string& name) {
    const SurfaceScheme* const scheme = find_named(catalogue::surface_schemes(), name);
    return scheme != nullptr && scheme->isoslab && (!density || scheme->isoslab == density);
  });
}

Isoslab read_isoslab(const JsonReader& json, bool needs_slope) {
  json.only({"size", "width", "slope"});
  Isoslab isoslab;
  isoslab.size =
      static_cast<std::size_t>(json.at("size").integer(2, static_cast<std::int64_t>(MomentTable::largest_size)));
  isoslab.width = json.at("width").positive_number();
  const auto slope = json.find("slope");
  if (needs_slope) isoslab.slope = json.at("slope").positive_number();
  if (!needs_slope && slope) slope->refuse("it without the scheme isoslab_per_length", "it beside that scheme");
  return isoslab;
}

}  // namespace

SurfaceNumbers read_surface_numbers(const JsonReader& json, const std::vector<std::string>& schemes) {
  SurfaceNumbers numbers;
  const bool has_threshold = std::find(schemes.begin(), schemes.end(), "threshold") != schemes.end();
  const auto tolerance = json.find("surface_tolerance");
  if (tolerance && !has_threshold) tolerance->refuse("it without the scheme threshold", "it beside that scheme");
  if (has_threshold) numbers.tolerance = json.at("surface_tolerance").positive_number();
  const auto isoslab = json.find("isoslab");
  if (isoslab && !has_isoslabs(schemes))
    isoslab->refuse("it without a scheme of isoslabs", "it beside isoslab_per_crossing or isoslab_per_length");
  if (has_isoslabs(schemes))
    numbers.isoslab = read_isoslab(json.at("isoslab"), has_isoslabs(schemes, IsoslabDensity::per_length));
  return numbers;
}

}  // namespace raytruth
