#include "experiments/measure.hpp"
#include "measures/shading/shading_study.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/shading/slab_reference.hpp"
#include "raytruth/shading/slab_shading.hpp"
#include "raytruth/transfer/emission.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace raytruth {

namespace {

constexpr double smallest_angle = 1;
constexpr double largest_angle_asked = 170;
constexpr std::int64_t most_starts = 1000;

struct Options {
  double largest_angle;
  double largest_depth;
  std::vector<double> shininesses;
  std::int64_t starts;  ///< of the search, from the worst inputs of a grid
};

Options read_options(const JsonReader& json) {
  json.only({"kind", "largest_angle", "largest_depth", "shininess", "starts"});
  Options options{json.at("largest_angle").number(smallest_angle, largest_angle_asked),
                  json.at("largest_depth").number(0, 100),
                  {},
                  json.at("starts").integer(1, most_starts)};
  for (const JsonReader& n : json.at("shininess").items())
    options.shininesses.push_back(n.number(1, largest_shininess));
  return options;
}

/// What is searched: where the light (specular: the half vector) is in the plane of the normals, from the front and
/// from the back one, so that ends become dark at the same places of these axes whatever the rest; its place out of the
/// plane; the optical depth of the homogeneous white slab. Angles in degrees.
using Input = std::array<double, 4>;

double angle_of(const Input& input) { return input[0] - input[1]; }

/// Of the light in the plane, from the bisector.
double in_plane_of(const Input& input) { return (input[0] + input[1]) / 2; }

struct Case {
  ShadedSlab slab;
  Lighting lighting;
  PiecewiseLinear transfer;
};

struct Treatment {
  std::string_view name;
  std::string_view shading;
  Negative negative;
};

// A highlight is 0 where the cone is below 0: without a treatment it has no other form.
constexpr std::array diffuse_treatments{Treatment{"arc_clamped", "quadratic_arc", Negative::clamp},
                                        Treatment{"arc_mirrored", "quadratic_arc", Negative::mirror},
                                        Treatment{"arc_as_it_is", "quadratic_arc", Negative::none},
                                        Treatment{"fades", "quadratic_arc_fades", Negative::clamp},
                                        Treatment{"fades_printed", "quadratic_arc_fades_printed", Negative::clamp}};
constexpr std::array specular_treatments{Treatment{"arc_clamped", "quadratic_arc", Negative::clamp},
                                         Treatment{"arc_mirrored", "quadratic_arc", Negative::mirror},
                                         Treatment{"fades", "quadratic_arc_fades", Negative::clamp},
                                         Treatment{"fades_maximum", "quadratic_arc_fades_maximum", Negative::clamp},
                                         Treatment{"fades_printed", "quadratic_arc_fades_printed", Negative::clamp}};

/// One search: for the largest error of a sign.
struct Search {
  const Treatment* treatment;
  bool is_diffuse;
  double shininess;
  int sign;
  double largest_angle;
};

Case case_of(const Search& search, const Input& input) {
  const double tilt = input[2];
  const double depth = input[3];
  Case result{
      .slab = studied_slab(angle_of(input)), .lighting = {}, .transfer = PiecewiseLinear({{0, {depth, {1, 1, 1}}}})};
  result.lighting.light = studied_direction(in_plane_of(input), tilt);
  result.lighting.half = result.lighting.light;
  result.lighting.diffuse = search.is_diffuse ? 1 : 0;
  result.lighting.specular = search.is_diffuse ? 0 : 1;
  result.lighting.highlight = find_named(catalogue::highlights(), "cone");
  result.lighting.shininess = search.shininess;
  return result;
}

/// What a slab sends out that faces the light all along.
double full_light(double depth) { return homogeneous_moments(depth)[0]; }

double light_of(const Search& search, std::string_view shading, Negative negative, const Case& asked) {
  Lighting lighting = asked.lighting;
  lighting.negative = negative;
  const SlabOptics optics(asked.transfer, 0, 0, 1);
  const ShadedRadiance light = shade(*find_named(catalogue::shadings(), shading), cosines_of(asked.slab, lighting),
                                     optics, Emission::plain, lighting);
  return search.is_diffuse ? light.diffuse[0] : light.specular[0];
}

/// The treatment's error, of the light of a slab that faces the light: positive where it is what is searched for.
double excess(const Search& search, const Input& input) {
  const double angle = angle_of(input);
  if (angle < smallest_angle || angle > search.largest_angle) return -std::numeric_limits<double>::infinity();
  const Case asked = case_of(search, input);
  const double truth = light_of(search, "normalized_linear", Negative::clamp, asked);
  const double found = light_of(search, search.treatment->shading, search.treatment->negative, asked);
  return search.sign * (found - truth) / full_light(input[3]);
}

struct Found {
  double excess;
  Input input;
};

// Half a turn from the bisector, and from there to the normals.
constexpr Input lowest{-270, -270, 0, 0};

Input highest(const Options& options) { return {270, 270, 90, options.largest_depth}; }

/// Along the axes, along both angles in the plane at once, then along random ones, in every round others: they follow
/// ridges.
Input direction(std::uint64_t round, std::uint64_t index) {
  constexpr std::array<Input, 5> first{{{1, 0, 0, 0}, {0, 1, 0, 0}, {1, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
  if (index < first.size()) return first[index];
  Input result = random_numbers(round, RandomStream::cases, index);
  for (double& component : result) component = 2 * component - 1;
  return result;
}

/// Steps as long as that helps, then halves them: no derivatives, which kinks and jumps do not have.
Found climb_once(const Search& search, const Input& high, Found best) {
  constexpr int halvings = 24;
  constexpr std::uint64_t directions = 24;
  constexpr double least_step_gain = 1e-9;  // or rounding would never end
  double step = 1.0 / 16;
  std::uint64_t round = 0;
  for (int halving = 0; halving < halvings; ++round) {
    bool is_better = false;
    for (std::uint64_t i = 0; i < directions; ++i)
      for (const double signed_step : {-step, step}) {
        const Input along = direction(round, i);
        Input input = best.input;
        for (std::size_t axis = 0; axis < input.size(); ++axis)
          input[axis] = std::clamp(input[axis] + signed_step * along[axis] * (high[axis] - lowest[axis]), lowest[axis],
                                   high[axis]);
        const double here = excess(search, input);
        if (!(here > best.excess + least_step_gain)) continue;
        best = {here, input};
        is_better = true;
      }
    if (is_better) continue;
    ++halving;
    step /= 2;
  }
  return best;
}

/// Again with wide steps, for at a jump narrow ones lead nowhere, until that helps no more.
Found climb(const Search& search, const Input& high, Found best) {
  constexpr double least_gain = 1e-7;
  for (;;) {
    const Found next = climb_once(search, high, best);
    if (!(next.excess > best.excess + least_gain)) return next;
    best = next;
  }
}

/// Places of the light from a normal: all around, and about the place from where on this end is dark, but not there,
/// where rounding decides.
std::vector<double> places_from_normal(const Search& search) {
  constexpr int cells = 37;
  constexpr double near = 0.1;
  std::vector<double> places;
  for (int i = 0; i <= cells; ++i) places.push_back(lowest[0] - 2 * lowest[0] * i / cells);
  const double dark = std::acos(search.is_diffuse ? 0 : 1 - 1 / search.shininess) * 180 / std::numbers::pi;
  for (const double sign : {-1, 1})
    for (const double place : {dark - near, dark + near, dark / 2}) places.push_back(sign * place);
  return places;
}

Input worst(const Search& search, const Options& options) {
  constexpr int tilts = 6;
  constexpr int depths = 3;
  const Input high = highest(options);
  const auto places = places_from_normal(search);
  std::vector<Found> starts;
  for (const double from_front : places)
    for (const double from_back : places)
      for (int i = 0; i <= tilts; ++i)
        for (int j = 0; j <= depths; ++j) {
          const Input input{from_front, from_back, high[2] * i / tilts, high[3] * j / depths};
          const double here = excess(search, input);
          if (std::isfinite(here)) starts.push_back({here, input});
        }
  const auto count = std::min(starts.size(), static_cast<std::size_t>(options.starts));
  std::stable_sort(starts.begin(), starts.end(), [](const Found& a, const Found& b) { return a.excess > b.excess; });
  Found best = starts.front();
  for (std::size_t i = 0; i < count; ++i) {
    const Found top = climb(search, high, starts[i]);
    if (top.excess > best.excess) best = top;
  }
  return best.input;
}

std::vector<Search> searches(const Options& options) {
  std::vector<Search> list;
  for (const int sign : {-1, 1}) {
    for (const Treatment& treatment : diffuse_treatments)
      list.push_back({&treatment, true, 1, sign, options.largest_angle});
    for (const double n : options.shininesses)
      for (const Treatment& treatment : specular_treatments)
        list.push_back({&treatment, false, n, sign, options.largest_angle});
  }
  return list;
}

/// The error found, against the certified reference.
Row row_of(const Search& search, const Input& input) {
  const Case asked = case_of(search, input);
  const double full = full_light(input[3]);
  const CertifiedRadiance truth = slab_reference(asked.slab, asked.transfer, Emission::plain, asked.lighting);
  const double clamped = search.is_diffuse ? truth.diffuse[0] : truth.specular[0];
  const double found = light_of(search, search.treatment->shading, search.treatment->negative, asked);
  const SlabCosines cosines = cosines_of(asked.slab, asked.lighting);
  return {{"term", search.is_diffuse ? "diffuse" : "specular"},
          {"shininess", search.is_diffuse ? Value() : Value(search.shininess)},
          {"treatment", std::string(search.treatment->name)},
          {"side", search.sign > 0 ? "over" : "under"},
          {"error", (found - clamped) / full},
          {"error_magnitude", std::abs(found - clamped) / full},
          {"light", found / full},
          {"truth", clamped / full},
          {"radius", truth.radius / full},
          {"angle_degrees", angle_of(input)},
          {"light_in_plane_degrees", in_plane_of(input)},
          {"light_tilt_degrees", input[2]},
          {"optical_depth", input[3]},
          {"front_cosine", cosines.light_front},
          {"back_cosine", cosines.light_back}};
}

}  // namespace

std::vector<Column> clamps_columns(const Experiment& /*experiment*/, const JsonReader& options) {
  read_options(options);
  return {
      {.name = "term", .unit = "", .description = "diffuse light, or a cone's specular light", .is_key = true},
      {.name = "shininess", .unit = "", .description = "of the cone", .is_key = true},
      {.name = "treatment",
       .unit = "",
       .description =
           "of negative values of the quadratic arc: clamped, mirrored or left at every point; Guetat's three "
           "cases with fades, as corrected, with I'', and as printed",
       .is_key = true},
      {.name = "side", .unit = "", .description = "the largest over- or underestimate found", .is_key = true},
      {.name = "error",
       .unit = "",
       .description = "treatment - clamped reference, of the light of a slab that faces the light",
       .radius = "radius"},
      {.name = "error_magnitude", .unit = "", .description = "magnitude of error", .radius = "radius"},
      {.name = "light", .unit = "", .description = "by the treatment, likewise"},
      {.name = "truth", .unit = "", .description = "of the clamped reference, likewise", .radius = "radius"},
      {.name = "radius", .unit = "", .description = "of the certified reference"},
      {.name = "angle_degrees", .unit = "degree", .description = "full angle between the normals where that is"},
      {.name = "light_in_plane_degrees",
       .unit = "degree",
       .description = "the light (specular: the half vector) there, from the bisector towards the back normal"},
      {.name = "light_tilt_degrees", .unit = "degree", .description = "and out of the plane of the normals"},
      {.name = "optical_depth", .unit = "", .description = "of the homogeneous white slab there"},
      {.name = "front_cosine", .unit = "", .description = "cosine at the front there"},
      {.name = "back_cosine", .unit = "", .description = "and at the back"},
  };
}

std::vector<Row> clamps_rows(const Experiment& /*experiment*/, const JsonReader& options, const Field& /*field*/) {
  const Options asked = read_options(options);
  const std::vector<Search> list = searches(asked);
  std::vector<Row> rows(list.size());
  tbb::parallel_for(std::size_t{0}, list.size(),
                    [&](std::size_t i) { rows[i] = row_of(list[i], worst(list[i], asked)); });
  return rows;
}

}  // namespace raytruth
