#include "experiments/measure.hpp"
#include "measures/shading/shading_study.hpp"
#include "raytruth/core/bernstein.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/shading/slab_reference.hpp"
#include "raytruth/shading/slab_shading.hpp"
#include "raytruth/transfer/emission.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <boost/container/static_vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <vector>

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

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
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

/// The angle of the light in the plane, from the bisector.
double in_plane_of(const Input& input) { return (input[0] + input[1]) / 2; }

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
  const Treatment* treatment = nullptr;
  const Shading* shading = nullptr;
  Lighting lighting;  ///< with the treatment's negative values; the direction of the light is searched
  bool is_diffuse = false;
  int sign = 0;
  double largest_angle = 0;
};

Search search_of(const Treatment& treatment, std::optional<double> shininess, int sign, double largest_angle) {
  Search search{.treatment = &treatment,
                .shading = find_named(catalogue::shadings(), treatment.shading),
                .lighting = {},
                .is_diffuse = !shininess,
                .sign = sign,
                .largest_angle = largest_angle};
  search.lighting.diffuse = search.is_diffuse ? 1 : 0;
  search.lighting.specular = search.is_diffuse ? 0 : 1;
  search.lighting.highlight = find_named(catalogue::highlights(), "cone");
  search.lighting.shininess = shininess.value_or(1);
  search.lighting.negative = treatment.negative;
  return search;
}

std::vector<Search> searches(const Options& options) {
  std::vector<Search> list;
  for (const int sign : {-1, 1}) {
    for (const Treatment& treatment : diffuse_treatments)
      list.push_back(search_of(treatment, std::nullopt, sign, options.largest_angle));
    for (const double n : options.shininesses)
      for (const Treatment& treatment : specular_treatments)
        list.push_back(search_of(treatment, n, sign, options.largest_angle));
  }
  return list;
}

// --- The light of a slab ---

Lighting lighting_at(const Search& search, const Input& input) {
  Lighting lighting = search.lighting;
  lighting.light = studied_direction(in_plane_of(input), input[2]);
  lighting.half = lighting.light;
  return lighting;
}

Lighting clamped(Lighting lighting) {
  lighting.negative = Negative::clamp;
  return lighting;
}

SlabCosines cosines_at(const Search& search, const Input& input) {
  return cosines_of(studied_slab(angle_of(input)), lighting_at(search, input));
}

PiecewiseLinear white(double depth) { return PiecewiseLinear({{0, {depth, {1, 1, 1}}}}); }

/// What a slab sends out that faces the light all along.
double full_light(double depth) { return homogeneous_moments(depth)[0]; }

/// The light by a method of the catalogue, as `shade` integrates it along any slab: to rounding, in tens of
/// microseconds. The rows hold it.
double light_by(const Shading& shading, const SlabCosines& cosines, const Lighting& lighting, double depth,
                bool is_diffuse) {
  const SlabOptics optics(white(depth), 0, 0, 1);
  const ShadedRadiance light = shade(shading, cosines, optics, Emission::plain, lighting);
  return is_diffuse ? light.diffuse[0] : light.specular[0];
}

// --- The same light in less than a microsecond, for the search ---

// The slab is white and homogeneous, and the light along it is not smooth only where polynomials change their signs. So
// a rule of few nodes between these places says all, and `check_light` holds it against the above.

// A cubic takes each of two levels at three places at most.
using Breaks = boost::container::static_vector<double, 8>;

/// The light that is seen, integral_0^1 light(x) exp(-depth x) dx, by the rule of Gauss and Legendre of 16 nodes on
/// panels between the breaks, which are ascending in (0, 1). No panel is wider than 1/panels, nor deeper than the rule
/// sees.
template <class Places, class Light>
double seen(double depth, const Places& breaks, double panels, const Light& light) {
  constexpr double largest_panel_depth = 10;
  const SlabRule rule = slab_rule();
  panels = std::max(panels, depth / largest_panel_depth);
  double sum = 0;
  double begin = 0;
  const auto add_to = [&](double end) {
    const int count = std::max(1, static_cast<int>(std::ceil((end - begin) * panels)));
    const double width = (end - begin) / count;
    for (int panel = 0; panel < count; ++panel)
      for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
        const double x = begin + width * (panel + rule.nodes[i]);
        sum += rule.weights[i] * width * std::exp(-depth * x) * light(x);
      }
    begin = end;
  };
  for (const double x : breaks) add_to(x);
  add_to(1);
  return sum;
}

/// What lighting makes of a cosine.
double lit(const Illumination& illumination, bool is_diffuse, double cosine) {
  return is_diffuse ? illumination.diffuse(cosine) : illumination.specular(cosine);
}

/// Below it, where negative values are clamped, a cosine is dark.
double threshold(const Illumination& illumination, bool is_diffuse) {
  return is_diffuse ? 0 : illumination.threshold();
}

/// The light by the reference: the cosine is the linear interpolation (1-x) F + x B over the normal's length, whose
/// square is the polynomial of the Bernstein coefficients 1, c, 1, where c is the cosine of the angle between the
/// normals. The length is 0 at the complex places x = 1/2 +- i/2 cot(angle/2), from which panels of a width of
/// cot(angle/2) are far enough for 1e-12.
double clamped_light(const SlabCosines& cosines, const Lighting& lighting, double depth, bool is_diffuse) {
  const Illumination illumination(clamped(lighting));
  const double front = cosines.light_front;
  const double back = cosines.light_back;
  const double c = cosines.normals;
  const double dark = threshold(illumination, is_diffuse);
  Breaks breaks;
  const auto add = [&breaks](const auto& polynomial) {
    const auto places = polynomial.sign_changes();
    breaks.assign(places.begin(), places.end());
  };
  if (dark == 0)
    add(Bernstein<1>{{front, back}});
  else
    add(Bernstein<2>{{front * front - dark * dark, front * back - dark * dark * c, back * back - dark * dark}});
  return seen(depth, breaks, std::sqrt((1 - c) / (1 + c)), [&](double x) {
    const double y = 1 - x;
    return lit(illumination, is_diffuse, (y * front + x * back) / std::sqrt(y * y + 2 * c * x * y + x * x));
  });
}

/// The light by the quadratic arc, whose cosine is a cubic, treated at every point.
double arc_light(const SlabCosines& cosines, const Lighting& lighting, double depth, bool is_diffuse) {
  static const NormalCurve& arc = *find_named(catalogue::normal_curves(), "quadratic_arc");
  const Illumination illumination(lighting);
  const auto a = arc.coefficients(cosines.light_front, cosines.light_back, cosines.normals);
  const double dark = threshold(illumination, is_diffuse);
  Breaks breaks;
  const auto add = [&](double level) {
    const double front = a[0] - level;
    const Bernstein<3> above{{front, front + a[1] / 3, front + (2 * a[1] + a[2]) / 3, front + a[1] + a[2] + a[3]}};
    const auto places = above.sign_changes();
    breaks.insert(breaks.end(), places.begin(), places.end());
  };
  if (lighting.negative != Negative::none) add(dark);
  if (lighting.negative == Negative::mirror && dark > 0) add(-dark);
  std::sort(breaks.begin(), breaks.end());
  return seen(depth, breaks, 1,
              [&](double x) { return lit(illumination, is_diffuse, a[0] + x * (a[1] + x * (a[2] + x * a[3]))); });
}

/// The light by fades, which is a polynomial between their breaks.
double faded_light(const SlabShader& shader, double depth, bool is_diffuse) {
  const auto breaks = shader.breaks();
  const auto sum = [&](double LitPoint::*term) {
    return seen(depth, breaks, 1, [&](double x) { return shader.at(x, 0).*term; });
  };
  if (is_diffuse) return sum(&LitPoint::diffuse);
  const double specular = sum(&LitPoint::specular);
  return shader.has_two_highlights ? std::max(specular, sum(&LitPoint::other_specular)) : specular;
}

double treated_light(const Search& search, const SlabCosines& cosines, const Lighting& lighting, double depth) {
  if (search.treatment->shading == "quadratic_arc") return arc_light(cosines, lighting, depth, search.is_diffuse);
  return faded_light(search.shading->shader(cosines, lighting), depth, search.is_diffuse);
}

/// Throws std::logic_error unless the light that the search takes of an input is that of `shade`.
void check_light(const Search& search, const Input& input) {
  constexpr double largest_difference = 1e-9;  // of the light; rounding makes 1e-13, 1e-11 at shininess 10^6
  const Lighting lighting = lighting_at(search, input);
  const SlabCosines cosines = cosines_at(search, input);
  const double depth = input[3];
  const auto need_same = [&](double quick, const Shading& shading, const Lighting& of_shading) {
    const double slow = light_by(shading, cosines, of_shading, depth, search.is_diffuse);
    if (!(std::abs(quick - slow) <= largest_difference * std::max(full_light(depth), std::abs(slow))))
      throw std::logic_error(fmt::format("{} of a slab of {} degrees and depth {} is {} by one way, {} by another",
                                         shading.name, angle_of(input), depth, quick, slow));
  };
  need_same(clamped_light(cosines, lighting, depth, search.is_diffuse),
            *find_named(catalogue::shadings(), "normalized_linear"), clamped(lighting));
  need_same(treated_light(search, cosines, lighting, depth), *search.shading, lighting);
}

// --- The search ---

/// The treatment's error, of the light of a slab that faces the light: positive where it is what is searched for.
double excess(const Search& search, const Input& input) {
  const double angle = angle_of(input);
  if (angle < smallest_angle || angle > search.largest_angle) return -std::numeric_limits<double>::infinity();
  const Lighting lighting = lighting_at(search, input);
  const SlabCosines cosines = cosines_of(studied_slab(angle), lighting);
  const double depth = input[3];
  const double truth = clamped_light(cosines, lighting, depth, search.is_diffuse);
  const double found = treated_light(search, cosines, lighting, depth);
  return search.sign * (found - truth) / full_light(depth);
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

// A round tries all directions. Few climbs take half as many rounds; one that takes more crawls, in steps that
// gain next to nothing, along a ridge far below the top that other starts reach, and would do so for minutes.
constexpr int most_rounds = 400;

/// Steps as long as that helps, then halves them: no derivatives, which kinks and jumps do not have.
Found climb_once(const Search& search, const Input& high, Found best, int& rounds) {
  constexpr int halvings = 24;
  constexpr std::uint64_t directions = 24;
  constexpr double least_step_gain = 1e-9;  // or rounding would never end
  double step = 1.0 / 16;
  std::uint64_t round = 0;
  for (int halving = 0; halving < halvings && rounds < most_rounds; ++round, ++rounds) {
    bool is_better = false;
    for (std::uint64_t i = 0; i < directions; ++i) {
      const Input along = direction(round, i);
      for (const double signed_step : {-step, step}) {
        Input input = best.input;
        for (std::size_t axis = 0; axis < input.size(); ++axis)
          input[axis] = std::clamp(input[axis] + signed_step * along[axis] * (high[axis] - lowest[axis]), lowest[axis],
                                   high[axis]);
        const double here = excess(search, input);
        if (!(here > best.excess + least_step_gain)) continue;
        best = {here, input};
        is_better = true;
      }
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
  for (int rounds = 0;;) {
    const Found next = climb_once(search, high, best, rounds);
    if (!(next.excess > best.excess + least_gain) || rounds >= most_rounds) return next;
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
  const double dark = std::acos(threshold(Illumination(search.lighting), search.is_diffuse)) * 180 / std::numbers::pi;
  for (const double sign : {-1, 1})
    for (const double place : {dark - near, dark + near, dark / 2}) places.push_back(sign * place);
  return places;
}

/// The worst inputs of a grid, the worst first.
std::vector<Found> starts_of(const Search& search, const Options& options) {
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
  std::stable_sort(starts.begin(), starts.end(), [](const Found& a, const Found& b) { return a.excess > b.excess; });
  starts.resize(std::min(starts.size(), static_cast<std::size_t>(options.starts)));
  return starts;
}

/// The worst input of every search, of several the first in the order of the starts, on any number of threads. Each
/// climb is a task of its own, for some last longer than others by far.
std::vector<Input> worst(const std::vector<Search>& list, const Options& options) {
  std::vector<std::vector<Found>> starts(list.size());
  tbb::parallel_for(std::size_t{0}, list.size(), [&](std::size_t i) { starts[i] = starts_of(list[i], options); });
  const Input high = highest(options);
  const auto most = static_cast<std::size_t>(options.starts);
  std::vector<std::vector<Found>> tops = starts;
  tbb::parallel_for(std::size_t{0}, list.size() * most, [&](std::size_t task) {
    const std::size_t search = task / most;
    const std::size_t start = task % most;
    if (start < starts[search].size()) tops[search][start] = climb(list[search], high, starts[search][start]);
  });
  std::vector<Input> inputs;
  for (std::size_t i = 0; i < list.size(); ++i) {
    Found best = starts[i].front();
    for (const Found& top : tops[i])
      if (top.excess > best.excess) best = top;
    inputs.push_back(best.input);
  }
  return inputs;
}

// --- Rows ---

/// What a search has found; light in units of that of a slab that faces the light.
struct Record {
  Search search;
  Input input{};
  double light = 0;
  double truth = 0;
  double radius = 0;
  double error = 0;
  SlabCosines cosines;
};

/// The error found, against the certified reference.
Record record_of(const Search& search, const Input& input) {
  const double depth = input[3];
  const double full = full_light(depth);
  const Lighting lighting = lighting_at(search, input);
  const SlabCosines cosines = cosines_at(search, input);
  const CertifiedRadiance truth =
      slab_reference(studied_slab(angle_of(input)), white(depth), Emission::plain, clamped(lighting));
  const double certified = search.is_diffuse ? truth.diffuse[0] : truth.specular[0];
  const double found = light_by(*search.shading, cosines, lighting, depth, search.is_diffuse);
  return {.search = search,
          .input = input,
          .light = found / full,
          .truth = certified / full,
          .radius = truth.radius / full,
          .error = (found - certified) / full,
          .cosines = cosines};
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  return {
      {.name = "term",
       .description = "diffuse light, or a cone's specular light",
       .is_key = true,
       .cell = [](const Record& record) { return record.search.is_diffuse ? "diffuse" : "specular"; }},
      {.name = "shininess",
       .description = "of the cone",
       .is_key = true,
       .cell =
           [](const Record& record) {
             return record.search.is_diffuse ? std::nullopt : std::optional(record.search.lighting.shininess);
           }},
      {.name = "treatment",
       .description =
           "of negative values of the quadratic arc: clamped, mirrored or left at every point; Guetat's three "
           "cases with fades, as corrected, with I'', and as printed",
       .is_key = true,
       .cell = [](const Record& record) { return record.search.treatment->name; }},
      {.name = "side",
       .description = "the largest over- or underestimate found",
       .is_key = true,
       .cell = [](const Record& record) { return record.search.sign > 0 ? "over" : "under"; }},
      {.name = "error",
       .description = "treatment - clamped reference, of the light of a slab that faces the light",
       .radius = "radius",
       .cell = &Record::error},
      {.name = "error_magnitude",
       .description = "magnitude of error",
       .radius = "radius",
       .cell = [](const Record& record) { return std::abs(record.error); }},
      {.name = "light", .description = "by the treatment, likewise", .cell = &Record::light},
      {.name = "truth",
       .description = "of the clamped reference, likewise",
       .radius = "radius",
       .cell = &Record::truth},
      {.name = "radius", .description = "of the certified reference", .cell = &Record::radius},
      {.name = "angle_degrees",
       .unit = "degree",
       .description = "full angle between the normals where that is",
       .cell = [](const Record& record) { return angle_of(record.input); }},
      {.name = "light_in_plane_degrees",
       .unit = "degree",
       .description = "the light (specular: the half vector) there, from the bisector towards the back normal",
       .cell = [](const Record& record) { return in_plane_of(record.input); }},
      {.name = "light_tilt_degrees",
       .unit = "degree",
       .description = "and out of the plane of the normals",
       .cell = [](const Record& record) { return record.input[2]; }},
      {.name = "optical_depth",
       .description = "of the homogeneous white slab there",
       .cell = [](const Record& record) { return record.input[3]; }},
      {.name = "front_cosine",
       .description = "cosine at the front there",
       .cell = [](const Record& record) { return record.cosines.light_front; }},
      {.name = "back_cosine",
       .description = "and at the back",
       .cell = [](const Record& record) { return record.cosines.light_back; }},
  };
}

/// An input that is anywhere, for checks.
Input random_input(const Options& options, std::uint64_t index) {
  const auto random = random_numbers(0, RandomStream::cases, index);
  const Input high = highest(options);
  const double angle = std::lerp(smallest_angle, options.largest_angle, random[0]);
  const double from_back = std::lerp(lowest[1], high[1] - angle, random[1]);
  return {from_back + angle, from_back, high[2] * random[2], high[3] * random[3]};
}

std::vector<Record> records(const Experiment& /*experiment*/, const Options& options) {
  constexpr std::uint64_t checks = 64;
  const std::vector<Search> list = searches(options);
  tbb::parallel_for(std::size_t{0}, list.size(), [&](std::size_t i) {
    for (std::uint64_t j = 0; j < checks; ++j) check_light(list[i], random_input(options, j));
  });
  const std::vector<Input> inputs = worst(list, options);
  std::vector<Record> records(list.size());
  tbb::parallel_for(std::size_t{0}, list.size(), [&](std::size_t i) {
    check_light(list[i], inputs[i]);
    records[i] = record_of(list[i], inputs[i]);
  });
  return records;
}

}  // namespace

extern const Measure clamps_measure;
const Measure clamps_measure{MeasureDefinition<Options, Record>{
    .name = "clamps",
    .summary = "the worst that treatments of negative cosines make of a slab, found by search",
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

}  // namespace raytruth
