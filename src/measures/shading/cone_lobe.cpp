#include "experiments/measure.hpp"
#include "raytruth/shading/highlight.hpp"

#include <boost/math/constants/constants.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace raytruth {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double largest_shininess_asked = 1e6;

struct Options {
  std::vector<double> shininess;  ///< infinite where the JSON says null
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "shininess"});
  Options options;
  for (const JsonReader& item : json.at("shininess").items())
    options.shininess.push_back(item.is_null() ? infinity : item.number(1, largest_shininess_asked));
  return options;
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

/// How a highlight differs from the lobe that it stands for.
struct Record {
  const Highlight* highlight = nullptr;
  double shininess = 0;  ///< infinite: the limit, which has no integrals and no threshold
  double deviation = 0;  ///< where its magnitude is largest
  double deviation_angle = 0;
  double l1 = 0;
  double l2 = 0;
  double energy_ratio = 0;
  double threshold = 0;
  double threshold_error = 0;

  [[nodiscard]] bool is_limit() const { return shininess == infinity; }
};

Record record_of(const Highlight& highlight, double shininess) {
  const auto [deviation, fall] = largest_deviation(highlight, shininess);
  Record record{.highlight = &highlight, .shininess = shininess, .deviation = deviation};
  // Integral of f sin(theta): 1/(n+1) of the lobe, q (1 - (1 - m/q)^(q+1)) / (m (q+1)) of the others; in the limit both
  // times n.
  const double degree = highlight.degree;
  if (record.is_limit()) {
    record.energy_ratio = degree / (highlight.ratio(shininess) * (degree + 1));
    return record;
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
  record.deviation_angle = std::acos(1 - fall / shininess) * 180 / boost::math::constants::pi<double>();
  record.l1 = integral(magnitude, 0, foot) + integral(magnitude, foot, right);
  record.l2 = std::sqrt(integral(square, 0, foot) + integral(square, foot, right));
  record.energy_ratio = (shininess + 1) * integral(energy, 0, foot);
  record.threshold = zero_found(highlight, shininess);
  record.threshold_error = std::abs(record.threshold - std::max(1 - degree / exponent, 0.0));
  return record;
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  const auto null_in_limit = [](const Record& record, double value) {
    return record.is_limit() ? std::nullopt : std::optional(value);
  };
  const auto not_in_limit = [](double Record::*value) {
    return [value](const Record& record) { return cell_if(!record.is_limit(), record.*value); };
  };
  return {
      {.name = "highlight",
       .description = "what stands for the lobe",
       .is_key = true,
       .cell = [](const Record& record) { return record.highlight->name; }},
      {.name = "shininess",
       .description = "n, of the lobe; null: the limit of large n",
       .is_key = true,
       .cell = [=](const Record& record) { return null_in_limit(record, record.shininess); }},
      {.name = "exponent",
       .description = "m in max(0, 1 + (m/q) (cosine - 1))^q",
       .cell =
           [=](const Record& record) { return null_in_limit(record, record.highlight->exponent(record.shininess)); }},
      {.name = "exponent_ratio",
       .description = "m/n",
       .cell = [](const Record& record) { return record.highlight->ratio(record.shininess); }},
      {.name = "deviation_max",
       .description = "maximum of |highlight - lobe| over 0 to 90 degrees",
       .cell = [](const Record& record) { return std::abs(record.deviation); }},
      {.name = "deviation_signed", .description = "highlight - lobe there", .cell = &Record::deviation},
      {.name = "deviation_angle_degrees",
       .unit = "degree",
       .description = "where that is",
       .cell = &Record::deviation_angle},
      {.name = "l1",
       .unit = "radian",
       .description = "integral of |highlight - lobe| over 0 to 90 degrees",
       .cell = not_in_limit(&Record::l1)},
      {.name = "l2",
       .unit = "radian^(1/2)",
       .description = "root of the integral of its square",
       .cell = not_in_limit(&Record::l2)},
      {.name = "energy_ratio",
       .description = "light sent out over the hemisphere, integral of f sin(theta), over that of the lobe",
       .cell = &Record::energy_ratio},
      {.name = "threshold",
       .description = "largest cosine at which the highlight is 0, found by bisection",
       .cell = not_in_limit(&Record::threshold)},
      {.name = "threshold_error",
       .description = "its distance from max(0, 1 - q/m); q/m = 1/n for the cone",
       .cell = not_in_limit(&Record::threshold_error)},
  };
}

std::vector<Record> records(const Experiment& /*experiment*/, const Options& options) {
  std::vector<Record> records;
  for (const double shininess : options.shininess)
    for (const Highlight& highlight : catalogue::highlights())
      if (highlight.degree > 0) records.push_back(record_of(highlight, shininess));
  return records;
}

}  // namespace

extern const Measure cone_lobe_measure;
const Measure cone_lobe_measure{
    MeasureDefinition<Options, Record>{.name = "cone_lobe",
                                       .summary = "highlights that stand for the lobe: deviation, energy, threshold",
                                       .read = read_options,
                                       .columns = columns,
                                       .of_experiment = records}};

}  // namespace raytruth
