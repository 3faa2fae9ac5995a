#include "experiments/measure.hpp"
#include "raytruth/shading/highlight.hpp"

#include <boost/math/constants/constants.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>

#include <cmath>
#include <limits>

namespace raytruth {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double largest_shininess_asked = 1e6;

/// Shininess; infinite where the JSON says null.
std::vector<double> read_shininess(const JsonReader& options) {
  options.only({"kind", "shininess"});
  std::vector<double> list;
  for (const JsonReader& item : options.at("shininess").items())
    list.push_back(item.is_null() ? infinity : item.number(1, largest_shininess_asked));
  return list;
}

template <class Function>
double integral(const Function& function, double low, double high) {
  return low < high ? boost::math::quadrature::gauss_kronrod<double, 31>::integrate(function, low, high, 15, 1e-13) : 0;
}

/// The largest cosine at which the highlight is 0, found by bisection of its values.
double zero_found(const Highlight& highlight, double shininess) {
  const double exponent = highlight.exponent(shininess);
  double zero = 0;
  double positive = 1;
  double middle = 0.5;
  while (zero < middle && middle < positive) {
    (highlight.value_at_exponent(middle, exponent) > 0 ? positive : zero) = middle;
    middle = zero + (positive - zero) / 2;
  }
  return zero;
}

Row row_of(const Highlight& highlight, double shininess) {
  const auto [deviation, fall] = largest_deviation(highlight, shininess);
  const double ratio = highlight.ratio(shininess);
  Row row{{"highlight", std::string(highlight.name)},
          {"shininess", shininess == infinity ? Value() : Value(shininess)},
          {"exponent", shininess == infinity ? Value() : Value(highlight.exponent(shininess))},
          {"exponent_ratio", ratio},
          {"deviation_max", std::abs(deviation)},
          {"deviation_signed", deviation}};
  // Integral of f sin(theta): 1/(n+1) of the lobe, q (1 - (1 - m/q)^(q+1)) / (m (q+1)) of the others; in the limit both
  // times n.
  const double degree = highlight.degree;
  if (shininess == infinity) {
    row.insert(row.end(), {{"deviation_angle_degrees", 0.0}, {"energy_ratio", degree / (ratio * (degree + 1))}});
    return row;
  }
  const double exponent = highlight.exponent(shininess);
  const auto difference = [&](double theta) {
    return highlight.value_at_exponent(std::cos(theta), exponent) - std::pow(std::cos(theta), shininess);
  };
  const double foot = std::acos(std::max(highlight.threshold(shininess), 0.0));
  const double right = boost::math::constants::half_pi<double>();
  const auto magnitude = [&](double theta) { return std::abs(difference(theta)); };
  const auto square = [&](double theta) { return difference(theta) * difference(theta); };
  const auto energy = [&](double theta) {
    return highlight.value_at_exponent(std::cos(theta), exponent) * std::sin(theta);
  };
  const double zero = zero_found(highlight, shininess);
  row.insert(row.end(),
             {{"deviation_angle_degrees", std::acos(1 - fall / shininess) * 180 / boost::math::constants::pi<double>()},
              {"l1", integral(magnitude, 0, foot) + integral(magnitude, foot, right)},
              {"l2", std::sqrt(integral(square, 0, foot) + integral(square, foot, right))},
              {"energy_ratio", (shininess + 1) * integral(energy, 0, foot)},
              {"threshold", zero},
              {"threshold_error", std::abs(zero - std::max(1 - degree / exponent, 0.0))}});
  return row;
}

}  // namespace

std::vector<Column> cone_lobe_columns(const Experiment& /*experiment*/, const JsonReader& options) {
  read_shininess(options);
  return {
      {.name = "highlight", .unit = "", .description = "what stands for the lobe", .is_key = true},
      {.name = "shininess", .unit = "", .description = "n, of the lobe; null: the limit of large n", .is_key = true},
      {.name = "exponent", .unit = "", .description = "m in max(0, 1 + (m/q) (cosine - 1))^q"},
      {.name = "exponent_ratio", .unit = "", .description = "m/n"},
      {.name = "deviation_max", .unit = "", .description = "maximum of |highlight - lobe| over 0 to 90 degrees"},
      {.name = "deviation_signed", .unit = "", .description = "highlight - lobe there"},
      {.name = "deviation_angle_degrees", .unit = "degree", .description = "where that is"},
      {.name = "l1", .unit = "radian", .description = "integral of |highlight - lobe| over 0 to 90 degrees"},
      {.name = "l2", .unit = "radian^(1/2)", .description = "root of the integral of its square"},
      {.name = "energy_ratio",
       .unit = "",
       .description = "light sent out over the hemisphere, integral of f sin(theta), over that of the lobe"},
      {.name = "threshold",
       .unit = "",
       .description = "largest cosine at which the highlight is 0, found by bisection"},
      {.name = "threshold_error",
       .unit = "",
       .description = "its distance from max(0, 1 - q/m); q/m = 1/n for the cone"},
  };
}

std::vector<Row> cone_lobe_rows(const Experiment& /*experiment*/, const JsonReader& options, const Field& /*field*/) {
  std::vector<Row> rows;
  for (const double shininess : read_shininess(options))
    for (const Highlight& highlight : catalogue::highlights())
      if (highlight.degree > 0) rows.push_back(row_of(highlight, shininess));
  return rows;
}

}  // namespace raytruth
