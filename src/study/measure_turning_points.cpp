#include "measures/proportion.hpp"
#include "measures/ray_ensemble.hpp"
#include "signals/trilinear.hpp"
#include "study/measure.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

namespace raytruth {

namespace {

/// How many of a ray's cells, the first and the last excluded since the ray crosses them in part only, have 0, 1 and 2
/// turning points: sign changes of s' strictly inside.
std::array<std::int64_t, 3> count_cells(const Chain<3>& signal) {
  std::array<std::int64_t, 3> cells{};
  for (std::size_t i = 1; i + 1 < signal.pieces.size(); ++i)
    ++cells[signal.pieces[i].polynomial.derivative().sign_changes().size()];
  return cells;
}

}  // namespace

std::vector<Column> turning_points_columns(const Experiment& /*experiment*/, const JsonReader& options) {
  options.only({"kind"});
  return {
      {.name = "rays", .unit = "", .description = "rays drawn"},
      {.name = "cells",
       .unit = "",
       .description = "cells crossed from border to border; the ends of rays are left out"},
      {.name = "cells_constant", .unit = "", .description = "of these, cells with a constant signal"},
      {.name = "one_turning_point", .unit = "", .description = "cells in which the slope changes sign once"},
      {.name = "two_turning_points", .unit = "", .description = "cells in which the slope changes sign twice"},
      {.name = "probability", .unit = "", .description = "of two turning points in a cell: their share"},
      {.name = "probability_low", .unit = "", .description = "95 % interval, clustered by ray"},
      {.name = "probability_high", .unit = "", .description = "95 % interval, clustered by ray"},
      {.name = "probability_not_constant", .unit = "", .description = "the share among cells that are not constant"},
  };
}

std::vector<Row> turning_points_rows(const Experiment& experiment, const JsonReader& /*options*/, const Field& field) {
  struct Ray {
    std::array<std::int64_t, 3> cells{};
    std::int64_t constant = 0;
  };
  std::vector<Ray> rays(static_cast<std::size_t>(experiment.rays.count));
  tbb::enumerable_thread_specific<Chain<3>> signals;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rays.size()), [&](const auto& range) {
    Chain<3>& signal = signals.local();
    for (std::size_t ray = range.begin(); ray < range.end(); ++ray) {
      trace_trilinear(field.grid, random_ray(field.grid, experiment.rays.length, experiment.seed, ray), signal);
      rays[ray].cells = count_cells(signal);
      for (std::size_t i = 1; i + 1 < signal.pieces.size(); ++i) {
        const auto& b = signal.pieces[i].polynomial.coefficients;
        rays[ray].constant += b[0] == b[1] && b[0] == b[2] && b[0] == b[3] ? 1 : 0;
      }
    }
  });

  std::vector<Cluster> clusters;
  Ray all;
  for (const Ray& ray : rays) {
    clusters.push_back({.hits = ray.cells[2], .trials = ray.cells[0] + ray.cells[1] + ray.cells[2]});
    for (std::size_t i = 0; i < 3; ++i) all.cells[i] += ray.cells[i];
    all.constant += ray.constant;
  }
  const std::int64_t cells = all.cells[0] + all.cells[1] + all.cells[2];
  const Proportion probability = clustered_proportion(clusters);
  return {{{"rays", experiment.rays.count},
           {"cells", cells},
           {"cells_constant", all.constant},
           {"one_turning_point", all.cells[1]},
           {"two_turning_points", all.cells[2]},
           {"probability", probability.estimate},
           {"probability_low", probability.low},
           {"probability_high", probability.high},
           {"probability_not_constant", cells == all.constant ? Value()
                                                              : Value(static_cast<double>(all.cells[2]) /
                                                                      static_cast<double>(cells - all.constant))}}};
}

}  // namespace raytruth
