#include "raytruth/metrics/signal_error.hpp"
#include "experiments/measure.hpp"
#include "measures/quantile_columns.hpp"
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
  need_signal_schemes(experiment);
  need_usable_samplings(experiment, json);
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

/// Of every ray that is not constant.
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
      if (sampling.step)
        sample_constant(signal, *sampling.step, samples);
      else
        sample_cells(signal, samples);
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

Value percentile(const std::vector<double>& sorted, double printed) {
  return sorted.empty() ? Value() : Value(percentile_of(sorted, printed));
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

}  // namespace

std::vector<Column> signal_error_columns(const Experiment& experiment, const JsonReader& options) {
  read_options(experiment, options);
  std::vector<Column> columns{
      {.name = "signal", .unit = "", .description = "reconstruction along the ray", .is_key = true},
      {.name = "sampling", .unit = "", .description = "where samples are taken", .is_key = true},
      {.name = "step", .unit = "voxel", .description = "distance of samples, constant sampling only", .is_key = true},
      {.name = "scheme", .unit = "", .description = "the approximation", .is_key = true},
      {.name = "data_min", .unit = "data", .description = "the field's smallest value, scaled to 0"},
      {.name = "data_max", .unit = "data", .description = "the field's largest value, scaled to 1"},
      {.name = "rays", .unit = "", .description = "rays drawn"},
      {.name = "rays_constant", .unit = "", .description = "of these, rays with a constant signal, left out"},
      {.name = "fetches_mean", .unit = "", .description = "samples and extra fetches of a ray, mean over rays"},
  };
  const auto add = [&columns](const std::string& name, const std::string& unit, const std::string& description) {
    const auto quantiles = quantile_columns(name, unit, description + " over rays", name + "_radius");
    columns.insert(columns.end(), quantiles.begin(), quantiles.end());
    columns.push_back(
        {.name = name + "_radius", .unit = unit, .description = "bound on the rounding error of the columns above"});
  };
  add("xi", "scalar*voxel", "integral of |s - s^| along the ray, s scaled to [0, 1]");
  add("xi_per_length", "scalar", "xi over the ray's length");
  add("xi_max", "scalar", "largest |s - s^| on the ray");
  add("xi_max_per_length", "scalar/voxel", "xi_max over the ray's length");
  columns.push_back({.name = "ratio_of", .unit = "", .description = "the scheme whose xi is divided by this one's"});
  add("ratio", "", "xi of the scheme ratio_of over xi of this scheme");
  columns.push_back(
      {.name = "ratio_undefined",
       .unit = "",
       .description = "rays left out of the ratio: its denominator is below 1e-12 of range times length"});
  columns.push_back(
      {.name = "better_share", .unit = "", .description = "rays on which xi is smaller than that of ratio_of"});
  columns.push_back(
      {.name = "worse_share", .unit = "", .description = "rays on which xi is larger than that of ratio_of"});
  columns.push_back(
      {.name = "tied_share", .unit = "", .description = "rays on which they differ by at most 1e-12 of themselves"});
  columns.push_back({.name = "ratio_why", .unit = "", .description = "why there is no ratio"});
  columns.push_back({.name = "printed_xi", .unit = "scalar*voxel", .description = "the published figure"});
  columns.push_back({.name = "printed_xi_percentile", .unit = "", .description = "share of rays with a smaller xi"});
  columns.push_back({.name = "printed_ratio", .unit = "", .description = "the quotient of the published figures"});
  columns.push_back(
      {.name = "printed_ratio_percentile", .unit = "", .description = "share of rays with a smaller ratio"});
  return columns;
}

std::vector<Row> signal_error_rows(const Experiment& experiment, const JsonReader& options, const Field& field) {
  const Options asked = read_options(experiment, options);
  const double length = experiment.rays.length;
  std::vector<Row> rows;
  for (const Sampling& sampling : experiment.samplings) {
    const auto errors = measure_rays(experiment, sampling, field);
    for (const std::string& scheme : experiment.schemes) {
      const Errors& error = errors.at(scheme);
      const auto sorted_xi = sorted_numbers(error.xi);
      const auto sorted_xi_max = sorted_numbers(error.xi_max);

      Row& row = rows.emplace_back();
      row.emplace_back("signal", "trilinear");
      row.emplace_back("sampling", sampling.kind);
      row.emplace_back("step", sampling.step ? Value(*sampling.step) : Value());
      row.emplace_back("scheme", scheme);
      row.emplace_back("data_min", field.data_range.first);
      row.emplace_back("data_max", field.data_range.second);
      row.emplace_back("rays", experiment.rays.count);
      row.emplace_back("rays_constant", experiment.rays.count - static_cast<std::int64_t>(sorted_xi.size()));
      row.emplace_back("fetches_mean", sorted_xi.empty() ? Value() : Value(mean(sorted_numbers(error.fetches))));
      add_quantiles(row, "xi", sorted_xi);
      row.emplace_back("xi_radius", signal_radius * length);
      add_quantiles(row, "xi_per_length", sorted_xi, 1 / length);
      row.emplace_back("xi_per_length_radius", signal_radius);
      add_quantiles(row, "xi_max", sorted_xi_max);
      row.emplace_back("xi_max_radius", signal_radius);
      add_quantiles(row, "xi_max_per_length", sorted_xi_max, 1 / length);
      row.emplace_back("xi_max_per_length_radius", signal_radius / length);

      const auto numerator = asked.numerator.find(scheme);
      Ratios ratios;
      if (numerator != asked.numerator.end()) {
        ratios = measure_ratios(errors.at(numerator->second), error, length);
        row.emplace_back("ratio_of", numerator->second);
        add_quantiles(row, "ratio", ratios.sorted);
        row.emplace_back("ratio_radius", ratios.sorted.empty() ? Value() : Value(ratios.radius));
        row.emplace_back("ratio_undefined", static_cast<std::int64_t>(ratios.undefined));
        row.emplace_back("better_share", ratios.better);
        row.emplace_back("worse_share", ratios.worse);
        row.emplace_back("tied_share", ratios.tied);
        row.emplace_back("ratio_why",
                         ratios.sorted.empty()
                             ? Value("xi of " + scheme + " is below 1e-12 of range times length on every ray")
                             : Value());
      }
      if (const auto printed = find_printed(asked, scheme, field.name)) {
        row.emplace_back("printed_xi", *printed);
        row.emplace_back("printed_xi_percentile", percentile(sorted_xi, *printed));
        const auto printed_numerator =
            numerator == asked.numerator.end() ? std::nullopt : find_printed(asked, numerator->second, field.name);
        if (printed_numerator) {
          const double printed_ratio = *printed_numerator / *printed;
          row.emplace_back("printed_ratio", printed_ratio);
          row.emplace_back("printed_ratio_percentile", percentile(ratios.sorted, printed_ratio));
        }
      }
    }
  }
  return rows;
}

}  // namespace raytruth
