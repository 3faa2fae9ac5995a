#include "raytruth/documents/conformance/vectors.hpp"

#include "raytruth/documents/conformance/draws.hpp"
#include "raytruth/documents/read_transfer_function.hpp"
#include "raytruth/reference/arb_integral.hpp"
#include "raytruth/signals/piecewise_polynomial.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

/// Whole numbers, both ends included.
struct Range {
  int low;
  int high;
};

/// A piecewise polynomial that grows piece by piece.
struct Signal {
  std::vector<double> breaks{0};
  std::vector<std::vector<double>> coefficients;

  /// A piece by its Bernstein coefficients. Its powers are binomial(n, k) times the k-th forward difference of these,
  /// over length^k: exact where the coefficients have few bits and the length is a power of two.
  void append(std::vector<double> bernstein, double length) {
    const std::size_t degree = bernstein.size() - 1;
    std::vector<double> powers;
    double factor = 1;  // binomial(n, k) / length^k
    for (std::size_t k = 0; k <= degree; ++k) {
      powers.push_back(factor * bernstein[0]);
      for (std::size_t i = 0; i + k < degree; ++i) bernstein[i] = bernstein[i + 1] - bernstein[i];
      factor = factor * static_cast<double>(degree - k) / static_cast<double>(k + 1) / length;
    }
    coefficients.push_back(std::move(powers));
    breaks.push_back(breaks.back() + length);
  }
};

/// Bernstein coefficients of signals are multiples of this. Since 63 * 4 is a multiple of every binomial(9, k), they
/// stay exact when the degree is raised to 9; as powers they need 24 bits, which binary32 has.
constexpr double signal_unit = 63.0 / 4096;
constexpr Range any_value{0, 65};  // in these units, from 0 to almost 1

/// What a random signal is like. Values are `base` plus multiples of `unit`.
struct Shape {
  Range pieces{1, 1};
  Range degree{1, 9};
  Range first = any_value;
  Range inside = any_value;
  Range last = any_value;
  double base = 0;
  double unit = signal_unit;
  bool is_continuous = true;
};

double random_length(Draws& draws) { return std::ldexp(1, draws.whole(-1, 1)); }

/// A signal of this shape. A slab is one linear piece of it.
Signal random_signal(Draws& draws, bool is_slab, const Shape& shape) {
  const auto value_in = [&](Range range) { return shape.base + draws.whole(range.low, range.high) * shape.unit; };
  Signal signal;
  const int pieces = is_slab ? 1 : draws.whole(shape.pieces.low, shape.pieces.high);
  double value = value_in(shape.first);
  for (int piece = 0; piece < pieces; ++piece) {
    const int degree = is_slab ? 1 : draws.whole(shape.degree.low, shape.degree.high);
    std::vector<double> bernstein{value};
    for (int i = 1; i < degree; ++i) bernstein.push_back(value_in(shape.inside));
    bernstein.push_back(value_in(piece + 1 == pieces ? shape.last : shape.inside));
    value = shape.is_continuous ? bernstein.back() : value_in(shape.inside);
    signal.append(std::move(bernstein), random_length(draws));
  }
  return signal;
}

Vector3<double> random_color(Draws& draws) {
  const int red = draws.whole(1, 8);  // never black: its digits could not be counted
  const int green = draws.whole(0, 8);
  const int blue = draws.whole(0, 8);
  return Vector3<double>(red, green, blue) / 8;
}

TransferPoint random_point(Draws& draws, double s, Range extinction, double unit) {
  const double drawn = draws.whole(extinction.low, extinction.high) * unit;
  return {s, {drawn, random_color(draws)}};
}

/// Constant up to `s`, another constant from there on.
std::vector<TransferPoint> random_jump(Draws& draws, double s) {
  const Optics below = random_point(draws, s, {1, 8}, 0.125).optics;
  const Optics above = random_point(draws, s, {8, 24}, 0.25).optics;
  return {{0, below}, {s, below}, {s, above}, {1, above}};
}

/// Thin air, but for a tent about `s`.
std::vector<TransferPoint> random_tent(Draws& draws, double s, double half_width, double apex) {
  const Optics air{0.125, random_color(draws)};
  const Optics top{apex, random_color(draws)};
  return {{0, air}, {s - half_width, air}, {s, top}, {s + half_width, air}, {1, air}};
}

/// What a vector asks, but for its convention.
struct Problem {
  Problem(Signal the_signal, std::vector<TransferPoint> points)
      : signal(std::move(the_signal)), transfer(std::move(points)) {}
  Problem(Signal the_signal, PiecewiseLinear the_transfer)
      : signal(std::move(the_signal)), transfer(std::move(the_transfer)) {}
  Problem(Signal the_signal, SeparateLists the_lists)
      : signal(std::move(the_signal)), transfer(joined(the_lists)), lists(std::move(the_lists)) {}

  Signal signal;
  PiecewiseLinear transfer;
  std::optional<SeparateLists> lists;
};

/// Which vector of its level is being made, from 0 on; slabs count from 0 on too.
struct Which {
  int index;
  bool is_slab;
  Emission emission;
};

Problem smooth(Draws& draws, const Which& which) {
  const int degree = which.index % 9 + 1;  // each of them
  return {random_signal(draws, which.is_slab, {.pieces = {1, 2}, .degree = {degree, degree}, .inside = {16, 48}}),
          {random_point(draws, 0, {0, 8}, 0.125), random_point(draws, 1, {8, 24}, 0.125)}};
}

Problem between_points(Draws& draws, const Which& which) {
  // Half-way between two entries of 256, on a grid that binary32 holds; half as wide as their distance.
  const double apex = std::round((draws.whole(96, 159) + 0.5) / 255 * 8192) / 8192;
  Shape shape{.pieces = {1, 2}, .first = {0, 16}, .last = {48, 65}};
  if (which.index % 2 == 1) std::swap(shape.first, shape.last);
  Signal signal = random_signal(draws, which.is_slab, shape);
  return {std::move(signal), random_tent(draws, apex, 0x1p-10, 256.0 * draws.whole(1, 4))};
}

Problem nearly_homogeneous(Draws& draws, const Which& which) {
  constexpr double unit = 63 * 0x1p-24;
  Shape shape{.pieces = {1, 3}, .unit = unit};
  const bool crosses_point = which.index % 3 == 0;
  shape.base = crosses_point ? draws.whole(1, 3) / 4.0 - 32 * unit : draws.whole(1, 30) / 32.0 + 1.0 / 64;
  if (which.index % 4 == 1) shape.inside = shape.last = shape.first = {32, 32};  // homogeneous
  Signal signal = random_signal(draws, which.is_slab, shape);
  std::vector<TransferPoint> points;
  for (int i = 0; i <= 4; ++i) points.push_back(random_point(draws, i / 4.0, {1, 12}, 0.25));
  return {std::move(signal), std::move(points)};
}

Problem faint(Draws& draws, const Which& which) {
  constexpr double unit = 0x1p-30;
  Signal signal = random_signal(draws, which.is_slab, {.pieces = {1, 3}});
  std::vector<TransferPoint> points;
  for (const double s : {0.0, 0.25, 0.75, 1.0}) {
    points.push_back(random_point(draws, s, {1, 8}, unit));
    if (which.emission == Emission::plain) points.back().optics.color *= unit;
  }
  return {std::move(signal), std::move(points)};
}

Problem opaque(Draws& draws, const Which& which) {
  Signal signal = random_signal(draws, which.is_slab, {.pieces = {1, 3}, .inside = {32, 65}, .last = {56, 65}});
  const double extinction = std::ldexp(draws.whole(1, 8), draws.whole(6, 12));
  const double empty_until = which.index % 2 == 1 ? 0.25 : 0;
  const Optics dense{extinction, random_color(draws)};
  std::vector<TransferPoint> points{{empty_until, {0, random_color(draws)}}, {1, dense}};
  return {std::move(signal), std::move(points)};
}

Problem non_monotone(Draws& draws, const Which& which) {
  Signal signal = random_signal(draws, which.is_slab, {.pieces = {2, 4}, .degree = {7, 9}});
  std::vector<TransferPoint> points;
  for (int i = 0; i <= 16; ++i) points.push_back(random_point(draws, i / 16.0, {0, 16}, 0.125));
  return {std::move(signal), std::move(points)};
}

Problem jump(Draws& draws, const Which& which) {
  Shape shape{.pieces = {2, 4}, .first = {0, 20}, .last = {45, 65}};
  shape.is_continuous = which.index % 2 == 0;
  Signal signal = random_signal(draws, which.is_slab, shape);
  const double low = draws.whole(350, 450) / 1024.0;
  const double high = draws.whole(550, 650) / 1024.0;
  const Optics outside = random_point(draws, 0, {0, 4}, 0.125).optics;
  const Optics inside = random_point(draws, 0, {8, 32}, 0.125).optics;
  return {std::move(signal),
          {{0, outside}, {low, outside}, {low, inside}, {high, inside}, {high, outside}, {1, outside}}};
}

Problem spike(Draws& draws, const Which& which) {
  if (which.is_slab || which.index % 2 == 0) {
    Signal signal = random_signal(draws, which.is_slab, {.pieces = {1, 3}, .first = {0, 10}, .last = {55, 65}});
    return {std::move(signal), random_tent(draws, draws.whole(400, 600) / 1024.0, 0x1p-14, 0x1p14)};
  }
  // A calm ray, and on 1/256 of its unit of length a spike into what is dense.
  Signal signal;
  const auto calm = [&] { return draws.whole(8, 24) * signal_unit; };
  const double before = calm();
  const double after = calm();
  const double top = draws.whole(56, 65) * signal_unit;
  signal.append({before, calm(), before}, random_length(draws));
  signal.append({before, before, top, top, after, after}, 0x1p-8);
  signal.append({after, calm(), calm(), after}, random_length(draws));
  const Optics air{0.125, random_color(draws)};
  return {std::move(signal), {{0, air}, {0.5, air}, {1, {512.0 * draws.whole(1, 4), random_color(draws)}}}};
}

/// The Bernstein coefficients of base + reach (2u - 1)^power.
std::vector<double> flat_contact(double base, double reach, int power) {
  std::vector<double> bernstein;
  for (int i = power; i >= 0; --i) bernstein.push_back(i % 2 == 0 ? base + reach : base - reach);
  return bernstein;
}

Problem grazing_slab(Draws& draws, const Which& which) {
  const double s = draws.whole(24, 40) / 64.0;
  const double reach = draws.whole(2, 16) * signal_unit;
  const double length = random_length(draws);
  const std::array<std::pair<double, double>, 4> ends{{{s, s}, {s - reach, s}, {s, s - reach}, {s, s + reach}}};
  const auto [front, back] = ends[static_cast<std::size_t>(which.index)];
  Signal signal;
  signal.append({front, back}, length);
  return {std::move(signal), random_jump(draws, s)};
}

Problem grazing(Draws& draws, const Which& which) {
  if (which.is_slab) return grazing_slab(draws, which);
  constexpr double offset = 0x1p-20;
  const double s = draws.whole(24, 40) / 64.0;
  const double reach = draws.whole(8, 20) * signal_unit;
  const double length = random_length(draws);
  const int order = 2 * draws.whole(1, 4);
  Signal signal;
  switch (which.index % 4) {
    case 0:
      signal.append(flat_contact(which.index % 8 == 0 ? s + offset : s - offset, -reach, order), length);
      return {std::move(signal), random_jump(draws, s)};
    case 1:
      signal.append(flat_contact(s, reach, 2), length);
      return {std::move(signal), random_jump(draws, s)};
    case 2:
      signal.append(flat_contact(s, -reach, order), length);
      break;
    default:
      signal.append(flat_contact(s, reach, order + 1), length);
  }
  return {std::move(signal),
          {random_point(draws, 0, {16, 24}, 0.25), random_point(draws, s, {0, 2}, 0.25),
           random_point(draws, 1, {16, 24}, 0.25)}};
}

/// What a renderer makes of a row of samples: a signal that is linear between them, a step of `random_length` / 4
/// apart. A slab lies between two of them.
Signal random_samples(Draws& draws, bool is_slab, Range first, Range last) {
  const auto value_in = [&](Range range) { return draws.whole(range.low, range.high) * signal_unit; };
  const double step = random_length(draws) / 4;
  const int pieces = is_slab ? 1 : draws.whole(6, 10);
  Signal signal;
  double value = value_in(first);
  for (int piece = 1; piece <= pieces; ++piece) {
    const double next = value_in(piece == pieces ? last : any_value);
    signal.append({value, next}, step);
    value = next;
  }
  return signal;
}

Problem linear_ray(Draws& draws, const Which& which) {
  Signal signal = random_samples(draws, which.is_slab, any_value, any_value);
  std::vector<TransferPoint> points;
  for (int i = 0; i <= 8; ++i) points.push_back(random_point(draws, i / 8.0, {0, 16}, 0.125));
  return {std::move(signal), std::move(points)};
}

/// Scalars from `first` on to 1 at most, in distances that are powers of two, so that what is linear between two of
/// them has few bits in between too.
std::vector<double> random_scalars(Draws& draws, double first, Range exponents_of_distances) {
  std::vector<double> scalars{first};
  for (;;) {
    const double next =
        scalars.back() + std::ldexp(1, draws.whole(exponents_of_distances.low, exponents_of_distances.high));
    if (next > 1) return scalars;
    scalars.push_back(next);
  }
}

Problem separate_lists(Draws& draws, const Which& which) {
  Signal signal = random_samples(draws, which.is_slab, {0, 12}, {53, 65});
  const bool is_opacity = which.index % 2 == 1;
  SeparateLists lists{.colors = {}, .densities = {}, .unit_length = is_opacity ? random_length(draws) : 0.0};
  for (const double s : random_scalars(draws, 0, {-3, -1})) lists.colors.push_back({s, random_color(draws)});
  // High and low in turn: a program that drops a point, or moves it to one of the other list, is far off.
  const double unit = is_opacity ? 1.0 / 64 : 1.0 / 16;
  const auto density = [&](std::size_t i) { return (i % 2 == 0 ? draws.whole(0, 4) : draws.whole(32, 60)) * unit; };
  std::vector<double> scalars = random_scalars(draws, (2 * draws.whole(0, 3) + 1) / 32.0, {-4, -3});
  if (which.index % 3 == 2) {
    const auto jump = scalars.begin() + draws.whole(1, static_cast<int>(scalars.size()) - 1);
    scalars.insert(jump, *jump);
  }
  for (std::size_t i = 0; i < scalars.size(); ++i) lists.densities.push_back({scalars[i], density(i)});
  return {std::move(signal), std::move(lists)};
}

Problem opacity_linear(Draws& draws, const Which& which) {
  Signal signal = random_samples(draws, which.is_slab, {0, 12}, {53, 65});
  std::vector<OpacityPoint> points;
  for (int i = 0; i <= 8; ++i)
    points.push_back({i / 8.0, draws.whole(i % 2 == 0 ? 0 : 24, i % 2 == 0 ? 16 : 63) / 64.0, random_color(draws)});
  const double unit_length = random_length(draws);
  if (which.index % 3 != 0) points[5].opacity = 1;
  if (which.index % 3 == 2) points[6].opacity = 1;  // the ray ends between the two
  return {std::move(signal), from_opacity(points, unit_length)};
}

Problem isoslab(Draws& draws, const Which& which) {
  Signal signal = random_samples(draws, which.is_slab, {0, 12}, {53, 65});
  const Optics nothing{};
  std::vector<TransferPoint> points{{0, nothing}};
  const bool are_two = which.index % 3 == 2;
  for (const Range low : are_two ? std::vector<Range>{{300, 420}, {580, 700}} : std::vector<Range>{{300, 700}}) {
    const double from = draws.whole(low.low, low.high) / 1024.0;
    const double width = std::ldexp(1, draws.whole(-10, -4));
    const Optics matter = random_point(draws, from, {1, 8}, 0.25 / width).optics;
    points.insert(points.end(), {{from, nothing}, {from, matter}, {from + width, matter}, {from + width, nothing}});
  }
  points.push_back({1, nothing});
  return {std::move(signal), std::move(points)};
}

/// How the vectors of a level are made.
struct Recipe {
  VectorLevel level;
  Problem (*make)(Draws& draws, const Which& which) = nullptr;
  int slabs = 4;
  VectorForm form = VectorForm::first;  ///< that knows it first
};

constexpr int rays_per_level = 12;

constexpr std::array recipes{
    Recipe{{"smooth", "nothing: a polynomial signal under a transfer function of one linear piece"}, smooth},
    Recipe{{"nearly_homogeneous",
            "the scalar varies by less than 2^-11, so that differences of integrals over it cancel; some rays are "
            "homogeneous, some cross a point of the transfer function all the same"},
           nearly_homogeneous},
    Recipe{{"faint", "opacities about 1e-9: 1 - exp(-x) cancels"}, faint},
    Recipe{{"opaque",
            "extinctions from 2^6 to 2^15: all light comes from a thin layer at the front, or behind an empty stretch"},
           opaque},
    Recipe{{"non_monotone", "signals of degree 7 to 9 turn back among 17 points of the transfer function"},
           non_monotone,
           0},
    Recipe{{"between_points",
            "a tent that lies wholly between two entries of a table of 256, i/255: a program that samples the transfer "
            "function there never sees it"},
           between_points},
    Recipe{{"jump", "a box as transfer function; along every second ray the signal jumps too"}, jump},
    Recipe{{"spike",
            "a tent of the transfer function, 2^-13 wide, or a signal that leaves its calm for 2^-8 of length: between "
            "samples, all of it"},
           spike},
    Recipe{
        {"grazing",
         "at one moment the signal touches a kink of the transfer function, with a contact of order 2 to 9, or a jump "
         "with one of order 2, or it passes a jump, or falls short of it, by 2^-20; slabs begin or end on a jump"},
        grazing},
    Recipe{{"linear_rays",
            "nothing but the integral: between equidistant places the signal is linear, as a renderer takes it between "
            "its samples, so one that samples there has no error of its signal"},
           linear_ray,
           4,
           VectorForm::second},
    Recipe{{"separate_lists",
            "colours and extinctions, or opacities, are lists of their own, with points at scalars of their own: a "
            "program that looks at the points of one list only, or moves them, is far off"},
           separate_lists,
           4,
           VectorForm::second},
    Recipe{{"opacity_linear",
            "opacity of a unit of length, not extinction, is linear between points, up to 1: at single scalars, where "
            "the depth is finite, or up to the next point, where the ray ends"},
           opacity_linear,
           4,
           VectorForm::second},
    Recipe{{"isoslab",
            "one or two slabs of constant matter between isovalues, 2^-10 to 2^-4 apart, and nothing outside: where a "
            "ray enters them decides everything"},
           isoslab,
           4,
           VectorForm::second},
};

bool has(VectorForm form, const Recipe& recipe) {
  return form == VectorForm::second || recipe.form == VectorForm::first;
}

Json color_of(const Vector3<double>& color) { return {color[0], color[1], color[2]}; }

Json lists_json(const SeparateLists& lists) {
  Json colors = Json::array();
  for (const auto& [s, color] : lists.colors) colors.push_back({{"s", s}, {"color", color_of(color)}});
  Json densities = Json::array();
  const bool is_opacity = lists.unit_length != 0;
  const char* const name = is_opacity ? "opacity" : "extinction";
  for (const auto& [s, value] : lists.densities) densities.push_back({{"s", s}, {name, value}});
  Json result{{"color", std::move(colors)}, {name, std::move(densities)}};
  if (is_opacity) result["unit_length"] = lists.unit_length;
  return result;
}

Json vector_json(const ConformanceVector& vector) {
  Json json = question_json(vector);
  const Certified truth = truth_of(vector);
  json["reference"] = {{"color", {truth.color[0], truth.color[1], truth.color[2]}},
                       {"opacity", truth.opacity},
                       {"error_bound", truth.radius}};
  return json;
}

}  // namespace

Json question_json(const ConformanceVector& vector) {
  Json json{{"id", vector.id},
            {"level", vector.level},
            {"emission", vector.emission == Emission::associated ? "associated" : "plain"}};
  if (vector.is_slab) {
    const auto& line = vector.coefficients.front();
    const double length = vector.breaks.back();
    json["slab"] = {{"front", line[0]}, {"back", line[0] + line[1] * length}, {"length", length}};
  } else {
    json["signal"] = {
        {"kind", "piecewise_polynomial"}, {"breaks", vector.breaks}, {"coefficients", vector.coefficients}};
  }
  json["transfer_function"] = transfer_function_json(vector.transfer);
  if (vector.lists) json["separate_lists"] = lists_json(*vector.lists);
  return json;
}

std::vector<VectorLevel> vector_levels(VectorForm form) {
  std::vector<VectorLevel> levels;
  for (const Recipe& recipe : recipes)
    if (has(form, recipe)) levels.push_back(recipe.level);
  return levels;
}

PiecewiseLinear joined(const SeparateLists& lists) {
  std::vector<TransferPoint> of_colors;
  std::vector<TransferPoint> of_densities;
  std::set<double> scalars;
  for (const auto& [s, color] : lists.colors) {
    of_colors.push_back({s, {0, color}});
    scalars.insert(s);
  }
  for (const auto& [s, value] : lists.densities) {
    of_densities.push_back({s, {value}});
    scalars.insert(s);
  }
  const PiecewiseLinear colors(std::move(of_colors));
  const PiecewiseLinear densities(std::move(of_densities));
  std::vector<TransferPoint> points;
  std::vector<OpacityPoint> opacity_points;
  const auto add = [&](double s, double density, const Vector3<double>& color) {
    points.push_back({s, {density, color}});
    opacity_points.push_back({s, density, color});
  };
  for (const double s : scalars) {
    const double below = densities.before(s).extinction;
    const double here = densities.at(s).extinction;
    const Vector3<double> color_below = colors.before(s).color;
    const Vector3<double> color_here = colors.at(s).color;
    if (below != here || (color_below != color_here).any()) add(s, below, color_below);
    add(s, here, color_here);
  }
  if (lists.unit_length == 0) return PiecewiseLinear(std::move(points));
  return from_opacity(opacity_points, lists.unit_length);
}

std::vector<ConformanceVector> conformance_vectors(std::uint64_t seed, VectorForm form) {
  std::vector<ConformanceVector> vectors;
  for (const Recipe& recipe : recipes) {
    if (!has(form, recipe)) continue;
    for (int i = 0; i < rays_per_level + recipe.slabs; ++i) {
      const bool is_slab = i >= rays_per_level;
      const int index = is_slab ? i - rays_per_level : i;
      // The convention does not follow parity alone, which decides within levels what a vector is like.
      const auto emission = (index / 2 + index) % 2 == 0 ? Emission::associated : Emission::plain;
      Draws draws(seed, vectors.size());
      Problem problem = recipe.make(draws, {index, is_slab, emission});
      vectors.push_back({fmt::format("{}_{}_{:02}", recipe.level.name, is_slab ? "slab" : "ray", index + 1),
                         recipe.level.name, is_slab, emission, std::move(problem.signal.breaks),
                         std::move(problem.signal.coefficients), std::move(problem.transfer),
                         std::move(problem.lists)});
    }
  }
  return vectors;
}

std::vector<double> samples_of(const ConformanceVector& vector, std::int64_t intervals) {
  const auto signal = signal_of(vector);
  const std::int64_t count = vector.is_slab ? 1 : intervals;
  std::vector<double> samples;
  for (std::int64_t i = 0; i <= count; ++i)
    samples.push_back(signal.value(
        i == count ? signal.length() : signal.length() * (static_cast<double>(i) / static_cast<double>(count))));
  return samples;
}

ConformanceVector sampled(const ConformanceVector& vector, const std::vector<double>& samples) {
  ConformanceVector result = vector;
  const std::size_t count = samples.size() - 1;
  const double step = vector.breaks.back() / static_cast<double>(count);
  result.breaks.clear();
  result.coefficients.clear();
  for (std::size_t i = 0; i < count; ++i) {
    result.breaks.push_back(static_cast<double>(i) * step);
    result.coefficients.push_back({samples[i], (samples[i + 1] - samples[i]) / step});
  }
  result.breaks.push_back(vector.breaks.back());
  return result;
}

Chain<largest_degree> signal_of(const ConformanceVector& vector) {
  return piecewise_polynomial(vector.breaks, vector.coefficients);
}

Certified truth_of(const ConformanceVector& vector) {
  return arb_integral(signal_of(vector), vector.transfer, vector.emission);
}

Json vectors_json(std::uint64_t seed, VectorForm form) {
  return vectors_json(seed, form, conformance_vectors(seed, form));
}

Json vectors_json(std::uint64_t seed, VectorForm form, const std::vector<ConformanceVector>& asked) {
  Json levels = Json::array();
  for (const VectorLevel& level : vector_levels(form))
    levels.push_back({{"level", level.name}, {"difficulty", levels.size() + 1}, {"why", level.why}});
  Json vectors = Json::array();
  for (const ConformanceVector& vector : asked) vectors.push_back(vector_json(vector));
  return {{"raytruth", vector_form_names[static_cast<std::size_t>(form)]},
          {"seed", seed},
          {"levels", std::move(levels)},
          {"vectors", std::move(vectors)}};
}

}  // namespace raytruth
