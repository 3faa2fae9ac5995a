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
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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

struct Options {
  std::vector<double> angles;
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "angles"});
  Options options;
  for (const JsonReader& angle : json.at("angles").items()) options.angles.push_back(angle.number(0.01, largest_angle));
  return options;
}

Real50 radians(double degrees) { return Real50(degrees) * boost::math::constants::pi<Real50>() / 180; }

double degrees(const Real50& radians) {
  return to_double(Real50(radians * 180 / boost::math::constants::pi<Real50>()));
}

/// How far a length eta is from the one that it is held against.
struct LengthErrors {
  double largest = 0;  ///< magnitude over the slab
  double largest_relative = 0;
  double mean = 0;  ///< magnitude over the slab
  double at_quarter = 0;
  double relative_at_quarter = 0;
  double at_half = 0;
  double at_three_quarters = 0;
};

LengthErrors length_errors(Length length, Length reference, const Real50& a) {
  const auto error = [=](const Real50& s) { return Real50(length(s, a) - reference(s, a)); };
  const auto magnitude = [=](const Real50& s) { return Real50(abs(error(s))); };
  const auto relative = [=](const Real50& s) { return Real50(magnitude(s) / reference(s, a)); };
  const double mean = boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
      [&](double s) { return to_double(magnitude(s)); }, 0.0, 0.5, 10, 1e-13);
  return {.largest = to_double(largest_over_slab<Real50>(magnitude).second),
          .largest_relative = to_double(largest_over_slab<Real50>(relative).second),
          .mean = 2 * mean,  // both halves are alike
          .at_quarter = to_double(error(0.25)),
          .relative_at_quarter = to_double(relative(0.25)),
          .at_half = to_double(error(0.5)),
          .at_three_quarters = to_double(error(0.75))};
}

/// How far an interpolated normal is from another one, the largest over the slab.
struct NormalDistance {
  double direction = 0;  ///< degrees between them
  double distance = 0;
};

/// How far the interpolated normal is from a unit one, and from two targets.
struct NormalErrors {
  double norm_deviation = 0;
  NormalDistance linear;
  NormalDistance slerp;
};

NormalErrors normal_errors(const Normalization& normalization, double angle) {
  const Real50 a = radians(angle) / 2;
  const Real50 cosine = cos(2 * a);
  const auto normal = [&](const Real50& s) -> PlaneVector<Real50> {
    if (normalization.length == nullptr)
      return normal_at(*find_named(catalogue::normal_curves(), normalization.curve), s, cosine);
    const Real50 length = normalization.length(s, a);
    return plane_vector<Real50>((1 - s) / length, s / length, cosine);
  };
  const auto to = [&](std::string_view curve) -> NormalDistance {
    const auto target = [&cosine, &of = *find_named(catalogue::normal_curves(), curve)](const Real50& s) {
      return normal_at(of, s, cosine);
    };
    const auto turn = [&](const Real50& s) { return Real50(abs(normal(s).direction() - target(s).direction())); };
    const auto distance = [&](const Real50& s) { return between(normal(s), target(s)); };
    return {degrees(largest_over_slab<Real50>(turn).second), to_double(largest_over_slab<Real50>(distance).second)};
  };
  const auto norm_deviation = [&](const Real50& s) { return Real50(abs(normal(s).norm() - 1)); };
  return {.norm_deviation = to_double(largest_over_slab<Real50>(norm_deviation).second),
          .linear = to("normalized_linear"),
          .slerp = to("slerp")};
}

/// A normalisation at an angle, or how its error grows with the angle.
struct Record {
  std::optional<double> angle;  ///< none: of the fit
  const Normalization* normalization = nullptr;
  std::optional<std::string_view> against = {};  ///< one of `references`; none: a curve
  std::optional<LengthErrors> length = {};
  std::optional<NormalErrors> normal = {};
  std::optional<FittedOrder> fit = {};
};

std::vector<Record> records_at(double angle) {
  std::vector<Record> records;
  for (const Normalization& normalization : normalizations) {
    const Record of_curve{
        .angle = angle, .normalization = &normalization, .normal = normal_errors(normalization, angle)};
    if (normalization.length == nullptr) {
      records.push_back(of_curve);
      continue;
    }
    for (const auto& [name, reference] : references) {
      if (normalization.name == name) continue;
      Record& record = records.emplace_back(of_curve);
      record.against = name;
      record.length = length_errors(normalization.length, reference, radians(angle) / 2);
    }
  }
  return records;
}

/// How the mean error of a normalisation against a reference grows with the angle; none where the angles are too few.
std::optional<FittedOrder> fit_of(const std::vector<std::vector<Record>>& by_angle, const Record& of) {
  std::vector<StepError> errors;
  for (const std::vector<Record>& at_angle : by_angle)
    for (const Record& record : at_angle)
      if (record.normalization == of.normalization && record.against == of.against &&
          *record.angle <= largest_fitted_angle)
        errors.push_back({.step = *record.angle, .error = record.length->mean});
  if (errors.size() < 2) return std::nullopt;
  return fit_order(errors);
}

Columns<LengthErrors> length_columns() {
  return {
      {.name = "eta_abs_max",
       .description = "maximum over the slab of |eta - eta against|",
       .cell = &LengthErrors::largest},
      {.name = "eta_rel_max",
       .description = "maximum of the same over eta against",
       .cell = &LengthErrors::largest_relative},
      {.name = "eta_abs_mean", .description = "mean over the slab of |eta - eta against|", .cell = &LengthErrors::mean},
      {.name = "eta_error_quarter",
       .description = "eta - eta against at a quarter of the slab",
       .cell = &LengthErrors::at_quarter},
      {.name = "eta_rel_quarter",
       .description = "its magnitude over eta against",
       .cell = &LengthErrors::relative_at_quarter},
      {.name = "eta_error_half", .description = "the same half-way", .cell = &LengthErrors::at_half},
      {.name = "eta_error_three_quarters",
       .description = "the same at three quarters",
       .cell = &LengthErrors::at_three_quarters},
  };
}

Columns<NormalErrors> normal_columns() {
  return {
      {.name = "norm_deviation_max",
       .description = "maximum of | |N| - 1 | of the interpolated normal N",
       .cell = &NormalErrors::norm_deviation},
      {.name = "direction_linear_max_degrees",
       .unit = "degree",
       .description = "largest angle between N and the linear interpolation",
       .cell = [](const NormalErrors& errors) { return errors.linear.direction; }},
      {.name = "distance_linear_max",
       .description = "maximum of |N - normalised linear interpolation|: the largest error of N.L over all lights",
       .cell = [](const NormalErrors& errors) { return errors.linear.distance; }},
      {.name = "direction_slerp_max_degrees",
       .unit = "degree",
       .description = "largest angle between N and the slerp",
       .cell = [](const NormalErrors& errors) { return errors.slerp.direction; }},
      {.name = "distance_slerp_max",
       .description = "maximum of |N - slerp|",
       .cell = [](const NormalErrors& errors) { return errors.slerp.distance; }},
  };
}

Columns<FittedOrder> fit_columns() {
  return {
      {.name = "mean_exponent",
       .description = "slope of log eta_abs_mean over log angle by least squares; of none: of the loss of length",
       .cell = &FittedOrder::order},
      {.name = "mean_exponent_residual",
       .description = "root mean square of log2 about that line",
       .cell = &FittedOrder::residual},
  };
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns{
      {.name = "angle",
       .unit = "degree",
       .description = "between the normals; null: a fit over the angles up to 10 degrees",
       .is_key = true,
       .cell = &Record::angle},
      {.name = "normalization",
       .description = "what the chord is divided by: none: 1; linear_angle: Guetat's eq. 4; quadratic: eq. 5; or the "
                      "curve that takes its place: circle_arc, circle_arc_tuned, minimax_arc, minimax_circle_arc",
       .is_key = true,
       .cell = [](const Record& record) { return record.normalization->name; }},
      {.name = "against",
       .description = "exact: the chord's length; linear_angle: eq. 4; null: a curve, which divides by nothing",
       .is_key = true,
       .cell = &Record::against},
  };
  append_part(columns, &Record::length, length_columns());
  append_part(columns, &Record::normal, normal_columns());
  append_part(columns, &Record::fit, fit_columns());
  return columns;
}

std::vector<Record> records(const Experiment& /*experiment*/, const Options& options) {
  std::vector<std::vector<Record>> by_angle(options.angles.size());
  tbb::parallel_for(std::size_t{0}, by_angle.size(),
                    [&](std::size_t i) { by_angle[i] = records_at(options.angles[i]); });

  std::vector<Record> records;
  for (const std::vector<Record>& at_angle : by_angle) records.insert(records.end(), at_angle.begin(), at_angle.end());
  for (const Record& first : by_angle.front())
    if (first.against)
      if (const auto fit = fit_of(by_angle, first))
        records.push_back(
            {.angle = std::nullopt, .normalization = first.normalization, .against = first.against, .fit = fit});
  return records;
}

}  // namespace

extern const Measure eta_measure;
const Measure eta_measure{MeasureDefinition<Options, Record>{
    .name = "eta",
    .summary = "the length and the direction of the normal between two samples, by ways to normalise it",
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

}  // namespace raytruth
