#include "raytruth/tables/look_up_error.hpp"

#include "raytruth/core/random.hpp"
#include "raytruth/shading/slab_reference.hpp"
#include "raytruth/tables/second_order.hpp"
#include "raytruth/tables/table_error.hpp"
#include "raytruth/tables/table_file.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace raytruth {

namespace {

using Vec4 = Rules<double>::vec4;

constexpr std::size_t cells_judged = 32;  ///< along each axis
constexpr std::uint64_t places_judged = 4096;
constexpr std::uint64_t weighted_places_judged = 256;  // each is proven by itself, in milliseconds
constexpr std::uint64_t seed = 1;                      ///< of the places

/// Errors at random places, collected one by one.
class ErrorsAtPlaces {
 public:
  void add(const Vec4& found, const Vec4& truth, double radius) {
    const Vec4 error = (found - truth).abs();
    largest_ = std::max(largest_, error.maxCoeff());
    sum_ += error.mean();
    sum_of_squares_ += error.square().mean();
    radius_ = std::max(radius_, radius);
    ++count_;
  }
  [[nodiscard]] LookUpError summary(std::string_view look_up) const {
    const auto count = static_cast<double>(count_);
    return {.look_up = look_up,
            .max = largest_,
            .mean = sum_ / count,
            .root_mean_square = std::sqrt(sum_of_squares_ / count),
            .places = count_,
            .radius = radius_};
  }

 private:
  double largest_ = 0;
  double sum_ = 0;
  double sum_of_squares_ = 0;
  double radius_ = 0;
  std::uint64_t count_ = 0;
};

template <std::size_t Count>
std::array<double, Count> random_scalars(const TableAxes& axes, std::uint64_t place) {
  const auto random = random_numbers(seed, RandomStream::points, place);
  std::array<double, Count> scalars{};
  for (std::size_t axis = 0; axis < Count; ++axis) scalars[axis] = axes.low + random[axis] * (axes.high - axes.low);
  return scalars;
}

Vec4 in_file(const TableFormat& format, const Vec4& entry) {
  return entry.unaryExpr([&](double value) { return read_back(format, value); });
}

template <class Values>
double largest_rounding(const TableFormat& format, const Values& values) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(read_back(format, value) - value));
  return largest;
}

}  // namespace

LookUpError second_order_look_up_error(const Table3<float>& table, const PiecewiseLinear& transfer,
                                       const TableAxes& axes, Emission emission, const TableFormat& format) {
  SecondOrderSlabs slabs(transfer, axes, emission);
  ErrorsAtPlaces errors;
  for (std::uint64_t i = 0; i < places_judged; ++i) {
    const auto scalars = random_scalars<3>(axes, i);
    const Certified truth = slabs.certified(scalars);
    const Vec4 found = trilinear<double>(
        axes,
        [&](std::size_t front, std::size_t middle, std::size_t back) -> Vec4 {
          return in_file(format, table.at(front, middle, back).cast<double>());
        },
        scalars);
    errors.add(found, truth.rgba(), truth.radius);
  }
  LookUpError error = errors.summary("trilinear");
  error.rounding = largest_rounding(format, table.values);
  return error;
}

LookUpError quadratic_gray_look_up_error(const QuadraticGrayTable<double>& table, const PiecewiseLinear& transfer,
                                         const TableAxes& axes, Emission emission, const TableFormat& format) {
  QuadraticGrayTable<double> in_format = table;
  for (double& value : in_format.values) value = read_back(format, value);
  const QuadraticGrayLookUp<double> look_up(in_format);
  SecondOrderSlabs slabs(transfer, axes, emission);
  Rules<double> rules;
  ErrorsAtPlaces errors;
  for (std::uint64_t i = 0; i < places_judged; ++i) {
    const auto random = random_scalars<3>({.low = 0, .high = 1}, i);
    const std::array ends{axes.low + random[0] * (axes.high - axes.low), axes.low + random[1] * (axes.high - axes.low)};
    const double node = random[2] * static_cast<double>(table.radius.node_count() - 1);
    const auto below = std::min(static_cast<std::size_t>(node), table.radius.node_count() - 2);
    const double weight = node - static_cast<double>(below);
    const double curvature = (1 - weight) * table.radius.curvature(below) + weight * table.radius.curvature(below + 1);
    const double middle = rules.quadratic_gray_middle(ends[0], ends[1], curvature * table.gray, axes.length);
    const Certified truth = slabs.certified({ends[0], middle, ends[1]});
    errors.add(look_up.of_curvature(ends, curvature), truth.rgba(), truth.radius);
  }
  LookUpError error = errors.summary("bilinear, and along the curvatures");
  error.rounding = largest_rounding(format, table.values);
  return error;
}

namespace {

/// A slab's weighted light in RGB and its opacity, by ball arithmetic: as the diffuse light of a surface whose cosine
/// is the weight. The tent is 1 - |2 x - 1|, light without shading less that of a surface lit from both sides.
CertifiedRadiance weighted_light(const ShadedSlab& slab, const PiecewiseLinear& transfer, Emission emission,
                                 LightWeight weight) {
  Cubic cosine{1, 0, 0, 0};
  if (weight == LightWeight::to_front) cosine = {1, -1, 0, 0};
  if (weight == LightWeight::x) cosine = {0, 1, 0, 0};
  if (weight == LightWeight::x_squared) cosine = {0, 0, 1, 0};
  if (weight == LightWeight::x_cubed) cosine = {0, 0, 0, 1};
  if (weight == LightWeight::tent) cosine = {-1, 2, 0, 0};
  const Lighting lighting{
      .ambient = 1, .diffuse = 1, .negative = weight == LightWeight::tent ? Negative::mirror : Negative::none};
  CertifiedRadiance light = cubic_reference(slab, transfer, emission, lighting, cosine, {1, 0, 0, 0});
  if (weight == LightWeight::tent) {
    light.diffuse = light.ambient - light.diffuse;
    light.radius *= 2;
  }
  return light;
}

}  // namespace

LookUpError weighted_look_up_error(const Table<double>& table, const TableContent& content,
                                   const PiecewiseLinear& transfer, Emission emission, const TableFormat& format) {
  const TableAxes& axes = table.axes;
  const PiecewiseLinear linear = linear_in_extinction(transfer);
  const PiecewiseLinear white = whitened(linear);
  ErrorsAtPlaces errors;
  for (std::uint64_t i = 0; i < weighted_places_judged; ++i) {
    const auto scalars = random_scalars<2>(axes, i);
    const ShadedSlab slab{.front = scalars[0], .back = scalars[1], .length = axes.length};
    const auto light = weighted_light(slab, content.is_white ? white : linear, emission, content.weight);
    Vec4 truth(light.diffuse[0], light.diffuse[1], light.diffuse[2], light.opacity);
    double radius = light.radius;
    if (content.has_white_as_alpha) {
      const auto of_white = weighted_light(slab, white, emission, content.weight);
      truth[3] = of_white.diffuse[0];
      radius = std::max(radius, of_white.radius);
    }
    const Vec4 found = bilinear<double>(
        axes, [&](std::size_t front, std::size_t back) -> Vec4 { return in_file(format, table.at(front, back)); },
        scalars);
    errors.add(found, truth, radius);
  }
  LookUpError error = errors.summary("bilinear");
  error.rounding = largest_rounding(format, table.values);
  return error;
}

LookUpError linear_look_up_error(const Table<double>& table, const PiecewiseLinear& transfer, Emission emission,
                                 const TableFormat& format) {
  const CertifiedCells truth = certified_cells(transfer, table.axes, emission, cells_judged, seed);
  const TableError error =
      bilinear_error(truth, [&](const CertifiedCell& /*cell*/, std::size_t front, std::size_t back) -> Vec4 {
        return in_file(format, table.at(front, back));
      });
  return {.look_up = "bilinear",
          .max = error.max,
          .max_at = std::array{error.front, error.back},
          .mean = error.mean,
          .root_mean_square = error.root_mean_square,
          .band_max = error.band_max,
          .places = truth.cells.size() * places_per_axis * places_per_axis,
          .radius = truth.radius,
          .rounding = largest_rounding(format, table.values)};
}

}  // namespace raytruth
