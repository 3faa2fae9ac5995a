#include "experiments/measure.hpp"
#include "raytruth/catalogue.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/rules/rules.hpp"
#include "raytruth/shading/slab_shading.hpp"
#include "raytruth/tables/table_builders.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

namespace raytruth {

namespace {

struct Options {};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind"});
  return {};
}

constexpr TableAxes axes{.size = 64, .low = 0, .high = 1, .length = 1};

Table<double> table_of(std::string_view builder, const PiecewiseLinear& transfer) {
  return find_named(catalogue::table_builders(), builder)->make(transfer, axes, Emission::associated);
}

/// The largest difference of a channel between any two entries of a constant transfer function's table.
double spread_of_constant(std::string_view builder) {
  const Optics optics{1.5, {0.25, 0.5, 0.75}};
  const Table<double> table = table_of(builder, PiecewiseLinear({{0, optics}, {1, optics}}));
  double largest = 0;
  for (std::size_t i = 0; i < axes.size; ++i)
    for (std::size_t j = 0; j < axes.size; ++j)
      largest = std::max(largest, (table.at(i, j) - table.at(0, 0)).abs().maxCoeff());
  return largest;
}

/// A red spike before a blue one, or the red one alone, both opaque.
PiecewiseLinear spikes(bool are_two) {
  const Optics nothing;
  const auto spike = [&](std::vector<TransferPoint>& points, double at, const Vector3<double>& color) {
    const Optics matter{400, color};
    for (const auto& point :
         {TransferPoint{at - 0.02, nothing}, TransferPoint{at, matter}, TransferPoint{at + 0.02, nothing}})
      points.push_back(point);
  };
  std::vector<TransferPoint> points;
  spike(points, 0.3, {1, 0, 0});
  if (are_two) spike(points, 0.7, {0, 0, 1});
  return PiecewiseLinear(std::move(points));
}

/// How far the hue, the channels' shares of their sum, is without attenuation from the exact one, from end to end of
/// the scalars: of what the front hides nothing should be seen.
double hue_error_without_attenuation(bool are_two) {
  const PiecewiseLinear transfer = spikes(are_two);
  const auto hue = [&](std::string_view builder) {
    const auto color = table_of(builder, transfer).at(0, axes.size - 1).head(3).eval();
    return (color / color.sum()).eval();
  };
  return (hue("no_attenuation") - hue("exact")).abs().maxCoeff();
}

/// How much the table without attenuation changes where front and back change places.
double asymmetry_without_attenuation() {
  const Table<double> table = table_of("no_attenuation", spikes(true));
  return (table.at(0, axes.size - 1) - table.at(axes.size - 1, 0)).abs().maxCoeff();
}

/// The diffuse light of a linear ramp less that along the chord, largest over slabs that the light reaches at both
/// ends.
double ramp_less_chord() {
  const auto& shadings = catalogue::shadings();
  double largest = 0;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const auto [front, back, x, normals] = random_numbers(1, RandomStream::cases, i);
    const SlabCosines cosines{
        .light_front = front, .light_back = back, .half_front = 1, .half_back = 1, .normals = normals};
    const Lighting lighting;
    const auto diffuse = [&](std::string_view name) {
      return find_named(shadings, name)->shader(cosines, lighting).at(x, 0).diffuse;
    };
    largest = std::max(largest, std::abs(diffuse("linear_intensity") - diffuse("linear_gradient")));
  }
  return largest;
}

/// The largest jump of a derivative, the first or the second, of Catmull-Rom curves through random samples.
double jump_of_derivative(int order) {
  Rules<double> rules;
  double largest = 0;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const auto [a, b, c, d] = random_numbers(2, RandomStream::cases, i);
    const double e = random_numbers(3, RandomStream::cases, i)[0];
    const auto left = rules.virtual_catmull_rom(a, b, c, d);
    const auto right = rules.virtual_catmull_rom(b, c, d, e);
    const double jump = order == 1 ? 3 * (left[3] - left[2]) - 3 * (right[1] - right[0])
                                   : 6 * (left[3] - 2 * left[2] + left[1]) - 6 * (right[2] - 2 * right[1] + right[0]);
    largest = std::max(largest, std::abs(jump));
  }
  return largest;
}

/// With which power of the distance to the nearest sample first order's error grows, of random cubics: from `distance`
/// to twice that, in intervals of length 1.
double growth_of_error(double distance) {
  const auto mean_error = [](double u) {
    double sum = 0;
    for (std::uint64_t i = 0; i < 10000; ++i) {
      const auto [a, b, c, d] = random_numbers(4, RandomStream::cases, i);
      const Bernstein<3> cubic{{a, b, c, d}};
      sum += std::abs(cubic.value(u) - ((1 - u) * a + u * d));
    }
    return sum;
  };
  return std::log2(mean_error(2 * distance) / mean_error(distance));
}

struct Record {
  std::string_view identity;
  double value;
};

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  return {
      {.name = "identity", .description = "what is computed", .is_key = true, .cell = &Record::identity},
      {.name = "value", .description = "what comes of it: a difference, or an exponent", .cell = &Record::value},
  };
}

std::vector<Record> records(const Experiment& /*experiment*/, const Options& /*options*/) {
  return {
      {"constant transfer function: spread of the brute-force table", spread_of_constant("brute_force")},
      {"constant transfer function: spread of the subrange table", spread_of_constant("subrange")},
      {"constant transfer function: spread with inclusive sums", spread_of_constant("subrange_inclusive")},
      {"no attenuation: hue with one spike", hue_error_without_attenuation(false)},
      {"no attenuation: hue with two spikes", hue_error_without_attenuation(true)},
      {"no attenuation: front and back exchanged", asymmetry_without_attenuation()},
      {"linear ramp less chord, diffuse", ramp_less_chord()},
      {"Catmull-Rom: jump of the first derivative", jump_of_derivative(1)},
      {"Catmull-Rom: jump of the second derivative", jump_of_derivative(2)},
      {"first order: exponent of the distance, near a sample", growth_of_error(0x1p-10)},
      {"first order: exponent of the distance, to the middle", growth_of_error(0x1p-2)},
  };
}

}  // namespace

extern const Measure paper_identities_measure;
const Measure paper_identities_measure{
    MeasureDefinition<Options, Record>{.name = "paper_identities",
                                       .summary = "sentences of publications that a few numbers decide",
                                       .read = read_options,
                                       .columns = columns,
                                       .of_experiment = records}};

}  // namespace raytruth
