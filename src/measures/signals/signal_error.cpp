#include "raytruth/metrics/signal_error.hpp"
#include "experiments/measure.hpp"
#include "measures/quantile_columns.hpp"
#include "measures/ray_study.hpp"
#include "raytruth/catalogue.hpp"
#include "raytruth/signals/ray_ensemble.hpp"
#include "raytruth/signals/trilinear.hpp"
#include "raytruth/statistics/statistics.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace raytruth {

namespace {

// A ratio of xi is only a number where its denominator is; see the conventions in src/NOTATION.md.
constexpr double smallest_denominator = 1e-12;

// xi of two schemes this close to each other, relatively, is a tie.
constexpr double tie = 1e-12;

/// A published xi.
struct Printed {
  std::string scheme;
  double xi = 0;
  std::string field;  ///< empty: to be compared with every field
};

struct Options {
  std::map<std::string, std::string> numerator;  ///< of the ratio shown in the row of the scheme that is the key
  std::vector<Printed> printed;
};

Options read_options(const Experiment& experiment, const JsonReader& json) {
  json.only({"kind", "ratios", "printed"});
  const std::vector<std::string_view> schemes(experiment.schemes.begin(), experiment.schemes.end());
  Options options;
  if (const auto ratios = json.find("ratios"))
    for (const JsonReader& ratio : ratios->items()) {
      const auto pair = ratio.items(2);
      if (pair.size() != 2) ratio.refuse(fmt::format("{} items", pair.size()), "a pair of schemes");
      if (!options.numerator.emplace(pair[1].word(schemes), pair[0].word(schemes)).second)
        ratio.refuse("a second ratio over " + pair[1].text(), "one ratio for each scheme");
    }
  if (const auto printed = json.find("printed"))
    for (const JsonReader& item : printed->items()) {
      item.only({"scheme", "xi", "field"});
      const auto field = item.find("field");
      options.printed.push_back(
          {item.at("scheme").word(schemes), item.at("xi").positive_number(), field ? field->text() : std::string()});
    }
  return options;
}

std::optional<double> find_printed(const Options& options, const std::string& scheme, const std::string& field) {
  for (const Printed& printed : options.printed)
    if (printed.scheme == scheme && (printed.field.empty() || printed.field == field)) return printed.xi;
  return {};
}

/// The errors of every ray that is not constant.
struct Errors {
  std::vector<double> xi;
  std::vector<double> xi_max;
  std::vector<double> fetches;
};

struct Scratch {
  Chain<3> signal;
  Samples<double> samples;
  Chain<3> approximation;
};

/// Errors by scheme; the rays are worked on in parallel, each writing to places of its own.
std::map<std::string, Errors> measure_rays(const Experiment& experiment, const Sampling& sampling, const Field& field) {
  const auto count = static_cast<std::size_t>(experiment.rays.count);
  constexpr double constant = std::numeric_limits<double>::quiet_NaN();
  std::map<std::string, Errors> errors;
  for (const std::string& scheme : experiment.schemes) {
    const std::vector<double> unset(count, constant);
    errors[scheme] = {unset, unset, unset};
  }
  tbb::enumerable_thread_specific<Scratch> scratches;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count), [&](const auto& range) {
    auto& [signal, samples, approximation] = scratches.local();
    for (std::size_t ray = range.begin(); ray < range.end(); ++ray) {
      trace_trilinear(field.grid, random_ray(field.grid, experiment.rays.length, experiment.seed, ray), signal);
      if (signal.is_constant()) continue;
      sample(signal, sampling, samples);
      for (auto& entry : errors) {
        Errors& error = entry.second;
        catalogue::visit_scheme(entry.first, [&]<class S>() {
          approximate<S>(signal, samples, approximation);
          error.xi[ray] = xi(signal, approximation);
          error.xi_max[ray] = xi_max(signal, approximation);
          error.fetches[ray] = static_cast<double>(fetches<S>(samples));
        });
      }
    }
  });
  return errors;
}

std::vector<double> sorted_numbers(const std::vector<double>& values) {
  std::vector<double> numbers;
  std::copy_if(values.begin(), values.end(), std::back_inserter(numbers), [](double x) { return !std::isnan(x); });
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// The ratios, ray by ray, that have a meaning, and how far rounding can move any of their quantiles.
struct Ratios {
  std::vector<double> sorted;
  std::size_t undefined = 0;
  double radius = 0;
  // Shares of the rays on which the denominator's scheme has the smaller, the larger, the same xi.
  double better = 0;
  double worse = 0;
  double tied = 0;
};

Ratios measure_ratios(const Errors& numerator, const Errors& denominator, double length) {
  Ratios ratios;
  std::vector<double> low;
  std::vector<double> high;
  const double radius = signal_radius * length;
  for (std::size_t ray = 0; ray < denominator.xi.size(); ++ray) {
    if (std::isnan(denominator.xi[ray])) continue;
    const double difference = denominator.xi[ray] - numerator.xi[ray];
    const bool is_tied = std::abs(difference) <= tie * std::max(denominator.xi[ray], numerator.xi[ray]);
    (is_tied ? ratios.tied : difference < 0 ? ratios.better : ratios.worse) += 1;
    if (denominator.xi[ray] < smallest_denominator * length) {
      ++ratios.undefined;
      continue;
    }
    ratios.sorted.push_back(numerator.xi[ray] / denominator.xi[ray]);
    low.push_back((numerator.xi[ray] - radius) / (denominator.xi[ray] + radius));
    high.push_back((numerator.xi[ray] + radius) / (denominator.xi[ray] - radius));
  }
  const double rays = ratios.better + ratios.worse + ratios.tied;
  for (double* share : {&ratios.better, &ratios.worse, &ratios.tied}) *share /= std::max(rays, 1.0);
  for (auto* values : {&ratios.sorted, &low, &high}) std::sort(values->begin(), values->end());
  if (ratios.sorted.empty()) return ratios;
  // Quantiles are monotone in every value, so those of the lower and upper ends enclose the true ones.
  for (const int percent : shown_percents) {
    const double value = quantile(ratios.sorted, percent / 100.0);
    ratios.radius =
        std::max({ratios.radius, value - quantile(low, percent / 100.0), quantile(high, percent / 100.0) - value});
  }
  return ratios;
}

/// xi of another scheme over that of the row's.
struct RatioFound {
  std::string numerator;
  std::string denominator;
  Ratios ratios;
};

/// A figure that was published, and the share of rays below it; none without rays.
struct PrintedFigure {
  double value = 0;
  std::optional<double> percentile;
};

struct PrintedFound {
  PrintedFigure xi;
  std::optional<PrintedFigure> ratio = {};
};

PrintedFigure printed_among(const std::vector<double>& sorted, double printed) {
  return {printed, sorted.empty() ? std::nullopt : std::optional(percentile_of(sorted, printed))};
}

/// A scheme with one way of sampling, over the rays of a field.
struct Record {
  Sampling sampling;
  std::string scheme;
  std::pair<double, double> data_range;
  RayCounts rays;
  std::optional<double> fetches_mean = {};
  double length = 0;              ///< of a ray
  std::vector<double> sorted_xi;  ///< of rays that are not constant
  std::vector<double> sorted_xi_max;
  std::optional<RatioFound> ratio = {};
  std::optional<PrintedFound> printed = {};
};

/// The quantiles of a distribution over rays, and NAME_radius, the bound on their rounding error.
template <class Part, class Quantiles, class Radius>
void append_quantiles(Columns<Part>& columns, const std::string& name, const std::string& unit,
                      const std::string& description, Quantiles quantiles, Radius radius) {
  append_part(columns, quantiles, shown_quantile_columns(name, unit, description + " over rays", name + "_radius"));
  columns.push_back({.name = name + "_radius",
                     .unit = unit,
                     .description = "bound on the rounding error of the columns above",
                     .cell = radius});
}

Columns<RatioFound> ratio_columns() {
  Columns<RatioFound> columns{{.name = "ratio_of",
                               .description = "the scheme whose xi is divided by this one's",
                               .cell = &RatioFound::numerator}};
  append_quantiles(
      columns, "ratio", "", "xi of the scheme ratio_of over xi of this scheme",
      [](const RatioFound& ratio) { return shown_quantiles(ratio.ratios.sorted); },
      [](const RatioFound& ratio) {
        return ratio.ratios.sorted.empty() ? std::nullopt : std::optional(ratio.ratios.radius);
      });
  append(columns, {{.name = "ratio_undefined",
                    .description = "rays left out of the ratio: its denominator is below 1e-12 of range times length",
                    .cell = [](const RatioFound& ratio) { return ratio.ratios.undefined; }},
                   {.name = "better_share",
                    .description = "rays on which xi is smaller than that of ratio_of",
                    .cell = [](const RatioFound& ratio) { return ratio.ratios.better; }},
                   {.name = "worse_share",
                    .description = "rays on which xi is larger than that of ratio_of",
                    .cell = [](const RatioFound& ratio) { return ratio.ratios.worse; }},
                   {.name = "tied_share",
                    .description = "rays on which they differ by at most 1e-12 of themselves",
                    .cell = [](const RatioFound& ratio) { return ratio.ratios.tied; }},
                   {.name = "ratio_why", .description = "why there is no ratio", .cell = [](const RatioFound& ratio) {
                      return ratio.ratios.sorted.empty()
                                 ? std::optional("xi of " + ratio.denominator +
                                                 " is below 1e-12 of range times length on every ray")
                                 : std::nullopt;
                    }}});
  return columns;
}

/// NAME and NAME_percentile.
Columns<PrintedFigure> printed_columns(const std::string& name, const std::string& unit, const std::string& description,
                                       const std::string& quantity) {
  return {{.name = name, .unit = unit, .description = description, .cell = &PrintedFigure::value},
          {.name = name + "_percentile",
           .description = "share of rays with a smaller " + quantity,
           .cell = &PrintedFigure::percentile}};
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns{{.name = "signal",
                           .description = "reconstruction along the ray",
                           .is_key = true,
                           .cell = [](const Record& /*record*/) { return "trilinear"; }}};
  append_part(columns, &Record::sampling, sampling_key_columns());
  append(columns, {{.name = "scheme", .description = "the approximation", .is_key = true, .cell = &Record::scheme},
                   {.name = "data_min",
                    .unit = "data",
                    .description = "the field's smallest value, scaled to 0",
                    .cell = [](const Record& record) { return record.data_range.first; }},
                   {.name = "data_max",
                    .unit = "data",
                    .description = "the field's largest value, scaled to 1",
                    .cell = [](const Record& record) { return record.data_range.second; }}});
  append_part(columns, &Record::rays, ray_count_columns());
  columns.push_back({.name = "fetches_mean",
                     .description = "samples and extra fetches of a ray, mean over rays",
                     .cell = &Record::fetches_mean});
  append_quantiles(
      columns, "xi", "scalar*voxel", "integral of |s - s^| along the ray, s scaled to [0, 1]",
      [](const Record& record) { return shown_quantiles(record.sorted_xi); },
      [](const Record& record) { return signal_radius * record.length; });
  append_quantiles(
      columns, "xi_per_length", "scalar", "xi over the ray's length",
      [](const Record& record) { return shown_quantiles(record.sorted_xi, 1 / record.length); },
      [](const Record& /*record*/) { return signal_radius; });
  append_quantiles(
      columns, "xi_max", "scalar", "largest |s - s^| on the ray",
      [](const Record& record) { return shown_quantiles(record.sorted_xi_max); },
      [](const Record& /*record*/) { return signal_radius; });
  append_quantiles(
      columns, "xi_max_per_length", "scalar/voxel", "xi_max over the ray's length",
      [](const Record& record) { return shown_quantiles(record.sorted_xi_max, 1 / record.length); },
      [](const Record& record) { return signal_radius / record.length; });
  append_part(columns, &Record::ratio, ratio_columns());
  Columns<PrintedFound> of_printed;
  append_part(of_printed, &PrintedFound::xi,
              printed_columns("printed_xi", "scalar*voxel", "the published figure", "xi"));
  append_part(of_printed, &PrintedFound::ratio,
              printed_columns("printed_ratio", "", "the quotient of the published figures", "ratio"));
  append_part(columns, &Record::printed, of_printed);
  return columns;
}

/// The published figures of a scheme, if there are any: of its xi, and of its ratio where it has one.
std::optional<PrintedFound> compare_with_printed(const Options& options, const std::string& field,
                                                 const std::string& scheme, const Record& record) {
  const auto printed = find_printed(options, scheme, field);
  if (!printed) return std::nullopt;
  PrintedFound found{.xi = printed_among(record.sorted_xi, *printed)};
  if (record.ratio)
    if (const auto numerator = find_printed(options, record.ratio->numerator, field))
      found.ratio = printed_among(record.ratio->ratios.sorted, *numerator / *printed);
  return found;
}

std::vector<Record> records_of_field(const Experiment& experiment, const Options& options, const Field& field) {
  const double length = experiment.rays.length;
  std::vector<Record> records;
  for (const Sampling& sampling : experiment.samplings) {
    const auto errors = measure_rays(experiment, sampling, field);
    for (const std::string& scheme : experiment.schemes) {
      const Errors& error = errors.at(scheme);
      const auto fetches = sorted_numbers(error.fetches);
      Record& record = records.emplace_back(Record{.sampling = sampling,
                                                   .scheme = scheme,
                                                   .data_range = field.data_range,
                                                   .rays = ray_counts(experiment, fetches.size()),
                                                   .length = length,
                                                   .sorted_xi = sorted_numbers(error.xi),
                                                   .sorted_xi_max = sorted_numbers(error.xi_max)});
      if (!fetches.empty()) record.fetches_mean = mean(fetches);
      if (const auto numerator = options.numerator.find(scheme); numerator != options.numerator.end())
        record.ratio = {numerator->second, scheme, measure_ratios(errors.at(numerator->second), error, length)};
      record.printed = compare_with_printed(options, field.name, scheme, record);
    }
  }
  return records;
}

}  // namespace

extern const Measure signal_error_measure;
const Measure signal_error_measure{MeasureDefinition<Options, Record>{
    .name = "signal_error",
    .summary = "xi and xi_max of every scheme along random rays: quantiles, and ratios between schemes",
    .needs = {.signal_schemes = true, .usable_samplings = true},
    .read = read_options,
    .columns = columns,
    .of_field = records_of_field}};

}  // namespace raytruth
