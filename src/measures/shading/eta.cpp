#include "experiments/measure.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/core/real50.hpp"
#include "raytruth/metrics/slab_extremes.hpp"
#include "raytruth/shading/normal_curve.hpp"
#include "raytruth/shading/normal_curve50.hpp"
#include "raytruth/statistics/order.hpp"

#include <tbb/parallel_for.h>
#include <boost/math/constants/constants.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace raytruth {

namespace {

constexpr double largest_angle = 179;
constexpr double largest_fitted_angle = 10;  ///< of the exponents

/// What the chord between two unit normals is divided by, s along the slab and a half the angle between them.
using Length = Real50 (*)(const Real50& s, const Real50& a);

Real50 exact_length(const Real50& s, const Real50& a) {
  const Real50 sine = sin(a);
  return sqrt(1 - 4 * s * (1 - s) * sine * sine);
}

/// Guetat 2010, eq. 4 with the angle linear in s.
Real50 linear_angle_length(const Real50& s, const Real50& a) { return cos(a) / cos((2 * s - 1) * a); }

/// Guetat 2010, eq. 5.
Real50 quadratic_length(const Real50& s, const Real50& a) {
  const Real50 x = 2 * s - 1;
  return cos(a) / (x * x * (cos(a) - 1) + 1);
}

/// A way to normalise: a length by which the chord is divided, or a curve.
struct Normalization {
  std::string name;
  Length length = nullptr;
  std::string_view curve = {};
};

const std::array normalizations{
    Normalization{"none", [](const Real50&, const Real50&) { return Real50(1); }},
    Normalization{"linear_angle", linear_angle_length},
    Normalization{"quadratic", quadratic_length},
    Normalization{"circle", nullptr, "circle_arc"},
    Normalization{"circle_tuned", nullptr, "circle_arc_tuned"},
    Normalization{"minimax", nullptr, "minimax_arc"},
    Normalization{"minimax_circle", nullptr, "minimax_circle_arc"},
};

const std::array references{std::pair{"exact", &exact_length}, std::pair{"linear_angle", &linear_angle_length}};

std::vector<double> read_angles(const JsonReader& options) {
  options.only({"kind", "angles"});
  std::vector<double> angles;
  for (const JsonReader& angle : options.at("angles").items()) angles.push_back(angle.number(0.01, largest_angle));
  return angles;
}

Real50 radians(double degrees) { return Real50(degrees) * boost::math::constants::pi<Real50>() / 180; }

double degrees(const Real50& radians) {
  return to_double(Real50(radians * 180 / boost::math::constants::pi<Real50>()));
}

/// Maximum, mean and values of length - reference.
void add_length_errors(Row& row, Length length, Length reference, const Real50& a) {
  const auto error = [=](const Real50& s) { return Real50(length(s, a) - reference(s, a)); };
  const auto magnitude = [=](const Real50& s) { return Real50(abs(error(s))); };
  const auto relative = [=](const Real50& s) { return Real50(magnitude(s) / reference(s, a)); };
  const double mean = boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
      [&](double s) { return to_double(magnitude(s)); }, 0.0, 0.5, 10, 1e-13);
  row.insert(row.end(), {{"eta_abs_max", to_double(largest_over_slab<Real50>(magnitude).second)},
                         {"eta_rel_max", to_double(largest_over_slab<Real50>(relative).second)},
                         {"eta_abs_mean", 2 * mean},  // both halves are alike
                         {"eta_error_quarter", to_double(error(0.25))},
                         {"eta_rel_quarter", to_double(relative(0.25))},
                         {"eta_error_half", to_double(error(0.5))},
                         {"eta_error_three_quarters", to_double(error(0.75))}});
}

/// How far the interpolated normal is from a unit one, and from two targets.
void add_normal_errors(Row& row, const Normalization& normalization, double angle) {
  const Real50 a = radians(angle) / 2;
  const Real50 cosine = cos(2 * a);
  const auto normal = [&](const Real50& s) -> PlaneVector<Real50> {
    if (normalization.length == nullptr)
      return normal_at(*find_named(catalogue::normal_curves(), normalization.curve), s, cosine);
    const Real50 length = normalization.length(s, a);
    return plane_vector<Real50>((1 - s) / length, s / length, cosine);
  };
  row.emplace_back(
      "norm_deviation_max",
      to_double(largest_over_slab<Real50>([&](const Real50& s) { return Real50(abs(normal(s).norm() - 1)); }).second));
  for (const auto& [name, curve] :
       {std::pair{std::string("linear"), "normalized_linear"}, std::pair{std::string("slerp"), "slerp"}}) {
    const auto target = [&cosine, &of = *find_named(catalogue::normal_curves(), curve)](const Real50& s) {
      return normal_at(of, s, cosine);
    };
    const auto turn = [&](const Real50& s) { return Real50(abs(normal(s).direction() - target(s).direction())); };
    const auto distance = [&](const Real50& s) { return between(normal(s), target(s)); };
    row.emplace_back("direction_" + name + "_max_degrees", degrees(largest_over_slab<Real50>(turn).second));
    row.emplace_back("distance_" + name + "_max", to_double(largest_over_slab<Real50>(distance).second));
  }
}

double number(const Row& row, std::string_view name) {
  for (const auto& [key, value] : row)
    if (key == name) return std::get<double>(value);
  return 0;
}

}  // namespace

std::vector<Column> eta_columns(const Experiment& /*experiment*/, const JsonReader& options) {
  read_angles(options);
  return {
      {.name = "angle",
       .unit = "degree",
       .description = "between the normals; null: a fit over the angles up to 10 degrees",
       .is_key = true},
      {.name = "normalization",
       .unit = "",
       .description = "what the chord is divided by: none: 1; linear_angle: Guetat's eq. 4; quadratic: eq. 5; or the "
                      "curve that takes its place: circle_arc, circle_arc_tuned, minimax_arc, minimax_circle_arc",
       .is_key = true},
      {.name = "against",
       .unit = "",
       .description = "exact: the chord's length; linear_angle: eq. 4; null: a curve, which divides by nothing",
       .is_key = true},
      {.name = "eta_abs_max", .unit = "", .description = "maximum over the slab of |eta - eta against|"},
      {.name = "eta_rel_max", .unit = "", .description = "maximum of the same over eta against"},
      {.name = "eta_abs_mean", .unit = "", .description = "mean over the slab of |eta - eta against|"},
      {.name = "eta_error_quarter", .unit = "", .description = "eta - eta against at a quarter of the slab"},
      {.name = "eta_rel_quarter", .unit = "", .description = "its magnitude over eta against"},
      {.name = "eta_error_half", .unit = "", .description = "the same half-way"},
      {.name = "eta_error_three_quarters", .unit = "", .description = "the same at three quarters"},
      {.name = "norm_deviation_max", .unit = "", .description = "maximum of | |N| - 1 | of the interpolated normal N"},
      {.name = "direction_linear_max_degrees",
       .unit = "degree",
       .description = "largest angle between N and the linear interpolation"},
      {.name = "distance_linear_max",
       .unit = "",
       .description = "maximum of |N - normalised linear interpolation|: the largest error of N.L over all lights"},
      {.name = "direction_slerp_max_degrees", .unit = "degree", .description = "largest angle between N and the slerp"},
      {.name = "distance_slerp_max", .unit = "", .description = "maximum of |N - slerp|"},
      {.name = "mean_exponent",
       .unit = "",
       .description = "slope of log eta_abs_mean over log angle by least squares; of none: of the loss of length"},
      {.name = "mean_exponent_residual", .unit = "", .description = "root mean square of log2 about that line"},
  };
}

std::vector<Row> eta_rows(const Experiment& /*experiment*/, const JsonReader& options, const Field& /*field*/) {
  const std::vector<double> angles = read_angles(options);
  std::vector<std::vector<Row>> by_angle(angles.size());
  tbb::parallel_for(std::size_t{0}, angles.size(), [&](std::size_t i) {
    for (const Normalization& normalization : normalizations) {
      Row normal_errors;
      add_normal_errors(normal_errors, normalization, angles[i]);
      const auto add_row = [&](const Value& against, const auto& add_errors) {
        Row& row = by_angle[i].emplace_back(
            Row{{"angle", angles[i]}, {"normalization", normalization.name}, {"against", against}});
        add_errors(row);
        row.insert(row.end(), normal_errors.begin(), normal_errors.end());
      };
      if (normalization.length == nullptr) {
        add_row({}, [](Row&) {});
        continue;
      }
      for (const auto& [name, reference] : references)
        if (normalization.name != name)
          add_row(name, [&, length = reference](Row& row) {
            add_length_errors(row, normalization.length, length, radians(angles[i]) / 2);
          });
    }
  });

  std::vector<Row> rows;
  for (const std::vector<Row>& of_angle : by_angle) rows.insert(rows.end(), of_angle.begin(), of_angle.end());
  for (const Row& first : by_angle.front()) {
    if (first[2].second == Value()) continue;
    std::vector<StepError> errors;
    for (const Row& row : rows)
      if (row[1] == first[1] && row[2] == first[2] && number(row, "angle") <= largest_fitted_angle)
        errors.push_back({.step = number(row, "angle"), .error = number(row, "eta_abs_mean")});
    if (errors.size() < 2) continue;
    const FittedOrder fit = fit_order(errors);
    rows.push_back({{"angle", Value()},
                    first[1],
                    first[2],
                    {"mean_exponent", fit.order},
                    {"mean_exponent_residual", fit.residual}});
  }
  return rows;
}

}  // namespace raytruth
