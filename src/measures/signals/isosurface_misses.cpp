#include "experiments/measure.hpp"
#include "raytruth/reference/surface_hits.hpp"
#include "raytruth/reference/surroundings_of.hpp"
#include "raytruth/schemes/surface_method.hpp"
#include "raytruth/signals/ray_ensemble.hpp"
#include "raytruth/signals/ray_field.hpp"
#include "raytruth/statistics/proportion.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

namespace raytruth {

namespace {

struct Options {
  std::vector<double> steps;
  std::vector<std::vector<double>> sets;  ///< of isosurfaces: where they lie, shares of the data's range
  double tolerance = 0;                   ///< of the method `threshold`, the same
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "steps", "isosurfaces", "tolerance"});
  constexpr double smallest_step = 1.0 / 256;
  constexpr double largest_step = 16;
  Options options{.steps = {}, .sets = {}, .tolerance = json.at("tolerance").number(0, 1)};
  for (const JsonReader& step : json.at("steps").items()) {
    options.steps.push_back(step.number(smallest_step, largest_step));
    if (options.steps.size() > 1 && !(options.steps.back() < options.steps[options.steps.size() - 2]))
      step.refuse_value("a step below the one before");
  }
  for (const JsonReader& set : json.at("isosurfaces").items()) {
    std::vector<double>& shares = options.sets.emplace_back();
    for (const JsonReader& share : set.items()) {
      shares.push_back(share.number(0, 1));
      if (shares.size() > 1 && !(shares.back() > shares[shares.size() - 2]))
        share.refuse_value("a share above the one before");
    }
    const auto is_as_large = [&](const std::vector<double>& other) {
      return &other != &shares && other.size() == shares.size();
    };
    if (std::any_of(options.sets.begin(), options.sets.end(), is_as_large))
      set.refuse_value("as many isosurfaces as no set before has");
  }
  return options;
}

/// What a method makes of one ray.
struct Missed {
  std::int64_t crossings = 0;
  std::int64_t lost = 0;
  std::int64_t false_hits = 0;
  bool is_first_wrong = false;
};

/// Hits of a method are those of crossings of the same surface between the samples around them, each of one.
Missed missed_of(const std::vector<SurfaceHit>& truth, const std::vector<SampledHit>& found,
                 const Samples<double>& samples, SurfaceMethod method) {
  // A threshold looks at samples, so that its crossing may lie on both sides.
  const bool is_of_samples = method == SurfaceMethod::threshold;
  const auto place = [&samples](std::size_t k) {
    return static_cast<double>(samples.positions[std::min(k, samples.positions.size() - 1)]);
  };
  Missed missed{.crossings = std::ssize(truth)};
  std::vector<bool> is_met(truth.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    const SampledHit& hit = found[i];
    const double begin = place(is_of_samples && hit.interval > 0 ? hit.interval - 1 : hit.interval);
    const double end = place(hit.interval + 1);
    std::size_t which = 0;
    for (; which < truth.size(); ++which) {
      const auto t = static_cast<double>(truth[which].t);
      const double slack = truth[which].error;
      if (!is_met[which] && truth[which].surface == hit.surface && t >= begin - slack && t <= end + slack) break;
    }
    if (which == truth.size())
      ++missed.false_hits;
    else
      is_met[which] = true;
  }
  missed.lost = std::count(is_met.begin(), is_met.end(), false);
  missed.is_first_wrong = truth.empty() ? !found.empty() : !is_met.front() || found.front().surface != truth[0].surface;
  return missed;
}

struct Record {
  std::string method;
  double step = 0;
  std::int64_t surfaces = 0;
  std::int64_t rays = 0;
  std::int64_t rays_unresolved = 0;
  std::int64_t crossings = 0;
  std::int64_t lost = 0;
  std::int64_t false_hits = 0;
  Proportion rays_with_loss;
  Proportion first_wrong;
  Proportion rays_with_false;
  std::optional<double> order;
};

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> list{
      {.name = "method", .description = "of `raytruth list surfaces`", .is_key = true, .cell = &Record::method},
      {.name = "surfaces",
       .description = "isosurfaces of the set at shares of the data's range",
       .is_key = true,
       .cell = &Record::surfaces},
      {.name = "step", .unit = "voxel", .description = "between samples", .is_key = true, .cell = &Record::step},
      {.name = "rays", .description = "rays whose crossings are all certified", .cell = &Record::rays},
      {.name = "rays_unresolved",
       .description = "rays with a contact that is not resolved; they are left out",
       .cell = &Record::rays_unresolved},
      {.name = "crossings", .description = "certified crossings of these rays", .cell = &Record::crossings},
      {.name = "crossings_lost",
       .description =
           "crossings without a hit of their surface between the same samples (threshold: at one of the two)",
       .cell = &Record::lost},
      {.name = "crossings_lost_share",
       .description = "their share of all crossings; none without crossings",
       .cell = [](const Record& record) -> std::optional<double> {
         if (record.crossings == 0) return {};
         return static_cast<double>(record.lost) / static_cast<double>(record.crossings);
       }},
      {.name = "false_hits",
       .description = "hits without such a crossing; of one_per_step those that lag behind, whose crossings are lost",
       .cell = &Record::false_hits},
      {.name = "loss_order",
       .description = "log of the ratio of crossings lost at the step before to those lost here, over the log of the "
                      "ratio of steps; none where either is 0, and at the first step",
       .cell = &Record::order}};
  const auto add = [&list](const std::string& name, const std::string& description, Proportion Record::*share) {
    list.push_back({.name = name, .description = "share of rays " + description, .cell = [share](const Record& record) {
                      return (record.*share).estimate;
                    }});
    list.push_back({.name = name + "_low",
                    .description = "95 % interval by ray",
                    .cell = [share](const Record& record) { return (record.*share).low; }});
    list.push_back({.name = name + "_high",
                    .description = "95 % interval by ray",
                    .cell = [share](const Record& record) { return (record.*share).high; }});
  };
  add("rays_with_loss", "with a crossing lost", &Record::rays_with_loss);
  add("first_wrong", "whose first hit is not that of the first crossing, or is one where there is none",
      &Record::first_wrong);
  add("rays_with_false", "with a false hit", &Record::rays_with_false);
  return list;
}

/// The rays of a method at a step, one after the other.
Record record_of(const std::vector<std::optional<Missed>>& rays) {
  Record record;
  std::vector<Cluster> loss;
  std::vector<Cluster> first;
  std::vector<Cluster> false_hits;
  for (const auto& ray : rays) {
    if (!ray) {
      ++record.rays_unresolved;
      continue;
    }
    ++record.rays;
    record.crossings += ray->crossings;
    record.lost += ray->lost;
    record.false_hits += ray->false_hits;
    loss.push_back({.hits = ray->lost > 0 ? 1 : 0, .trials = 1});
    first.push_back({.hits = ray->is_first_wrong ? 1 : 0, .trials = 1});
    false_hits.push_back({.hits = ray->false_hits > 0 ? 1 : 0, .trials = 1});
  }
  record.rays_with_loss = clustered_proportion(loss);
  record.first_wrong = clustered_proportion(first);
  record.rays_with_false = clustered_proportion(false_hits);
  return record;
}

std::optional<double> order_between(const Record& before, const Record& here) {
  if (before.lost == 0 || here.lost == 0) return {};
  return std::log(static_cast<double>(before.lost) / static_cast<double>(here.lost)) /
         std::log(before.step / here.step);
}

std::vector<Record> records_of_set(const Experiment& experiment, const Options& options, const Field& field,
                                   const std::vector<double>& scalars) {
  const TrilinearField traced(field.grid);
  // Random rays are along no axis.
  const Surroundings surroundings{.steepest = steepest_slope(traced)};
  std::vector<SurfaceScheme> methods = catalogue::surface_schemes();
  std::erase_if(methods, [](const SurfaceScheme& scheme) { return scheme.isoslab.has_value(); });
  const std::size_t kinds = methods.size() * options.steps.size();
  const auto count = static_cast<std::size_t>(experiment.rays.count);

  std::vector<std::vector<std::optional<Missed>>> rays(kinds, std::vector<std::optional<Missed>>(count));
  struct Buffers {
    Chain<3> signal;
    Samples<double> samples;
  };
  tbb::enumerable_thread_specific<Buffers> buffers;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count), [&](const auto& range) {
    auto& [signal, samples] = buffers.local();
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const Ray ray = random_ray(field.grid, experiment.rays.length, experiment.seed, i);
      const SurfaceHits truth = surface_hits(traced.trace_precisely(ray), scalars, surroundings);
      if (!truth.unresolved.empty()) continue;
      traced.trace(ray, signal);
      for (std::size_t step = 0; step < options.steps.size(); ++step) {
        sample_constant(signal, options.steps[step], samples);
        for (std::size_t method = 0; method < methods.size(); ++method) {
          const SurfaceMethod how = methods[method].method;
          rays[method * options.steps.size() + step][i] =
              missed_of(truth.hits, sampled_hits(how, signal, samples, scalars, options.tolerance), samples, how);
        }
      }
    }
  });

  std::vector<Record> records;
  for (std::size_t method = 0; method < methods.size(); ++method)
    for (std::size_t step = 0; step < options.steps.size(); ++step) {
      Record record = record_of(rays[method * options.steps.size() + step]);
      record.method = methods[method].name;
      record.step = options.steps[step];
      record.surfaces = std::ssize(scalars);
      if (step > 0) record.order = order_between(records.back(), record);
      records.push_back(std::move(record));
    }
  return records;
}

std::vector<Record> records_of_field(const Experiment& experiment, const Options& options, const Field& field) {
  std::vector<Record> records;
  for (const std::vector<double>& shares : options.sets) {
    // A field's values are shares of its range.
    std::vector<Record> of_set = records_of_set(experiment, options, field, shares);
    records.insert(records.end(), std::make_move_iterator(of_set.begin()), std::make_move_iterator(of_set.end()));
  }
  return records;
}

}  // namespace

extern const Measure isosurface_misses_measure;
// Pairs of crossings that a step h holds become rarer as h^2 along a smooth signal, since what rises above a scalar
// between two samples is as high as h^2; along a trilinear one as h, since it has kinks, at which that is as high as h.
const Measure isosurface_misses_measure{
    MeasureDefinition<Options, Record>{.name = "isosurface_misses",
                                       .summary = "crossings of isosurfaces that samples lose, and hits that are none",
                                       .read = read_options,
                                       .columns = columns,
                                       .of_field = records_of_field}};

}  // namespace raytruth
