#include "raytruth/documents/rendering_json.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace raytruth {

nlohmann::ordered_json radius_json(const Rendering& rendering) {
  const auto largest = std::max_element(rendering.radii.begin(), rendering.radii.end());
  const auto index = largest - rendering.radii.begin();
  const std::array<std::int64_t, 2> place{index % rendering.image.size[0], index / rendering.image.size[0]};
  nlohmann::ordered_json result{{"certified", rendering.is_certified}};
  if (rendering.is_certified) {
    result["error_bound"] = *largest;
    result["bound_of"] = rendering.covers_camera
                             ? "the scene as its numbers say it: the rounding of the camera's rays is covered"
                             : "the camera's rays as rounded to binary64";
  } else {
    result["measured_radius"] = *largest;
    // Lit surfaces are added up, not integrated.
    result["radius"] =
        rendering.unresolved
            ? "by how much the light of isosurfaces differs where their crossings may lie, and all light "
              "behind an unresolved contact: measured, not a bound"
            : "sum of the differences of two quadratures (7 and 15 nodes) over all panels of a ray: an "
              "estimate, not a bound; rounding is left out";
  }
  if (rendering.unresolved) result["unresolved_contacts"] = *rendering.unresolved;
  result["not_converged"] = rendering.not_converged;
  result["tolerance"] = rendering.tolerance;
  if (rendering.not_converged == 0) return result;
  const std::string of_pixels = fmt::format("{} of {} pixels", rendering.not_converged, rendering.radii.size());
  const std::string the_largest = fmt::format("{}, in pixel [{}, {}]", *largest, place[0], place[1]);
  if (rendering.is_certified)
    result["why_not_converged"] = fmt::format(
        "{} have a bound above {} times the brightest light that a ray can have (at least 1); the largest is {}. All "
        "bounds hold: they are wide where a ray grazes a jump of the transfer function or the border of the volume, so "
        "that rounding decides what it meets",
        of_pixels, rendering.tolerance, the_largest);
  else if (rendering.unresolved)
    result["why_not_converged"] = fmt::format(
        "in {} the light of isosurfaces differs by more than {} times the brightest (at least 1) within what their "
        "crossings may be off by, or a contact is not resolved; the largest measured radius is {}",
        of_pixels, rendering.tolerance, the_largest);
  else
    result["why_not_converged"] = fmt::format(
        "on a part of the rays of {} two quadratures still differ by more than {} times its light (at least 1) after "
        "as "
        "many halvings as there may be, as where the normal turns quickly; what they differ by is in the measured "
        "radius, "
        "of which the largest is {}",
        of_pixels, rendering.tolerance, the_largest);
  return result;
}

std::vector<double> radii_in_binary32(const Rendering& rendering) {
  std::vector<double> result = rendering.radii;
  for (std::size_t i = 0; i < result.size(); ++i) {
    double rounding = 0;
    for (const double number : rendering.image.pixels[i])
      rounding = std::max(rounding, std::abs(static_cast<double>(static_cast<float>(number)) - number));
    // The difference is exact for all but numbers that binary32 takes for 0 or infinity; the sum is rounded up.
    if (rounding > 0) result[i] = std::nextafter(result[i] + rounding, std::numeric_limits<double>::infinity());
  }
  return result;
}

}  // namespace raytruth
