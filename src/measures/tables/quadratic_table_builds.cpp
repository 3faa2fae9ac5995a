#include "experiments/measure.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/schemes/quadratic_gray_printed.hpp"
#include "raytruth/statistics/order.hpp"
#include "raytruth/tables/table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace raytruth {

namespace {

constexpr std::int64_t largest_gray_count = 256;

struct Options {
  std::vector<std::size_t> sizes;  ///< of tables; each divides 256
  std::size_t slabs = 0;           ///< random entries from which the cost of a table over three scalars is told
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "sizes", "slabs"});
  Options options{.sizes = {}, .slabs = static_cast<std::size_t>(json.at("slabs").integer(1, 1'000'000))};
  for (const JsonReader& item : json.at("sizes").items(2)) {
    const std::int64_t size = item.integer(2, largest_gray_count);
    if (largest_gray_count % size != 0) item.refuse(std::to_string(size), "a divisor of 256");
    options.sizes.push_back(static_cast<std::size_t>(size));
  }
  return options;
}

/// What a build takes.
struct BuildCost {
  std::size_t size = 0;
  std::int64_t points = 0;  ///< of the transfer function
  std::int64_t entries = 0;
  double composites = 0;
  double evaluations = 0;
  double exponentials = 0;
  std::optional<double> over_second_order = {};  ///< composites over those of the table over three scalars
};

/// How it grows.
struct CostOrders {
  std::optional<double> composites;
  std::optional<double> evaluations;
};

struct Record {
  std::string_view method;
  std::string_view growing;  ///< the transfer function: 256 points, or as many as the table has entries
  std::variant<BuildCost, CostOrders> found;
};

PiecewiseLinear random_points(std::size_t count, std::uint64_t seed) {
  std::vector<TransferPoint> points;
  for (std::size_t i = 0; i < count; ++i) {
    const auto random = random_numbers(seed, RandomStream::points, i);
    points.push_back({largest_gray * static_cast<double>(i) / static_cast<double>(count - 1),
                      {random[0], {random[1], random[2], random[3]}}});
  }
  return PiecewiseLinear(points);
}

/// Algorithm 9's opacities of seven radii, and colours that need as many sums over the same gray values for each of
/// three channels.
BuildCost printed_cost(std::size_t size, std::uint64_t seed) {
  QuadraticGrayPrinted printed(random_points(largest_gray_count, seed), 0, largest_gray, 1, Emission::associated);
  const RadiusAxis axis = printed_radius_axis();
  const std::size_t step = largest_gray_count / size;
  BuildCost cost{.size = size, .points = largest_gray_count};
  for (std::size_t node = 1; node < axis.node_count(); ++node)
    for (std::size_t front = 0; front < size; ++front)
      for (std::size_t back = front; back < size; ++back) {
        printed.omega(front * step, back * step, axis.curvature(node));
        ++cost.exponentials;
      }
  cost.entries = static_cast<std::int64_t>(axis.count * size * size);
  cost.evaluations = static_cast<double>(printed.evaluations());
  cost.composites = cost.evaluations / 3;
  return cost;
}

std::vector<double> equal_scalars(std::size_t count) {
  std::vector<double> scalars;
  for (std::size_t i = 0; i < count; ++i)
    scalars.push_back(largest_gray * static_cast<double>(i) / static_cast<double>(count - 1));
  return scalars;
}

/// The mean number of intervals of a slab, from random ones.
template <class Slab>
double mean_intervals(std::size_t slabs, std::uint64_t seed, const std::vector<double>& scalars, const Slab& slab) {
  std::vector<QuadraticGrayCut> cuts;
  double sum = 0;
  for (std::size_t i = 0; i < slabs; ++i) {
    cut(slab(random_numbers(seed, RandomStream::points, i)), scalars, cuts);
    sum += static_cast<double>(cuts.size() - 1);
  }
  return sum / static_cast<double>(slabs);
}

std::size_t random_index(double random, std::size_t count) {
  return static_cast<std::size_t>(random * static_cast<double>(count));
}

/// Ours: the same radii and both signs, the linear table between. Where the points are the table's entries the slabs of
/// a diagonal meet them at the same places: these are counted at the diagonal's middle.
BuildCost corrected_cost(std::size_t size, bool points_grow, std::size_t slabs, std::uint64_t seed) {
  const TableAxes axes{.size = size, .low = 0, .high = largest_gray, .length = 1};
  const RadiusAxis radius;
  const std::size_t points = points_grow ? size : static_cast<std::size_t>(largest_gray_count);
  const std::vector<double> scalars = equal_scalars(points);
  BuildCost cost{.size = size,
                 .points = static_cast<std::int64_t>(points),
                 .entries = static_cast<std::int64_t>(radius.node_count() * size * size)};
  cost.composites = static_cast<double>(cost.entries) *
                    mean_intervals(slabs, seed, scalars, [&](const std::array<double, 4>& random) {
                      return QuadraticGray::of_curvature(
                          axes.scalar(random_index(random[0], size)), axes.scalar(random_index(random[1], size)),
                          radius.curvature(random_index(random[2], radius.node_count())), 1);
                    });
  cost.exponentials = cost.composites;
  cost.evaluations = cost.composites;
  if (!points_grow) return cost;
  cost.evaluations = 0;
  std::vector<QuadraticGrayCut> cuts;
  for (std::size_t node = 0; node < radius.node_count(); ++node)
    for (std::size_t i = 0; i + 1 < 2 * size; ++i) {
      const std::size_t first = i + 1 < size ? size - 1 - i : 0;
      const std::size_t middle = first + (size - (i + 1 < size ? size - 1 - i : i + 1 - size)) / 2;
      const std::size_t front = std::min(middle, size - 1);
      const std::size_t back = std::min(front + i + 1 - size, size - 1);
      cut(QuadraticGray::of_curvature(axes.scalar(front), axes.scalar(back), radius.curvature(node), 1), scalars, cuts);
      cost.evaluations += static_cast<double>(cuts.size() - 1);
    }
  return cost;
}

/// Exact slabs over three scalars.
BuildCost second_order_cost(std::size_t size, std::size_t points, std::size_t slabs, std::uint64_t seed) {
  const TableAxes axes{.size = size, .low = 0, .high = largest_gray, .length = 1};
  const auto entries = static_cast<std::int64_t>(size * size * size);
  const double composites =
      static_cast<double>(entries) *
      mean_intervals(slabs, seed, equal_scalars(points), [&](const std::array<double, 4>& random) {
        const auto entry = [&](std::size_t k) { return axes.scalar(random_index(random[k], size)); };
        return QuadraticGray::of_samples(entry(0), entry(1), entry(2), 1);
      });
  return {.size = size,
          .points = static_cast<std::int64_t>(points),
          .entries = entries,
          .composites = composites,
          .evaluations = composites,
          .exponentials = composites};
}

void add(std::vector<Record>& records, std::string_view method, std::string_view growing,
         const std::vector<BuildCost>& costs) {
  std::vector<StepError> composites;
  std::vector<StepError> evaluations;
  for (const BuildCost& cost : costs) {
    records.push_back({method, growing, cost});
    composites.push_back({static_cast<double>(cost.size), cost.composites});
    evaluations.push_back({static_cast<double>(cost.size), cost.evaluations});
  }
  records.push_back({method, growing, CostOrders{fit_order(composites).order, fit_order(evaluations).order}});
}

Columns<BuildCost> cost_columns() {
  return {
      {.name = "size",
       .description = "n, entries along each axis of scalars",
       .is_key = true,
       .cell = &BuildCost::size},
      {.name = "points", .description = "of the transfer function", .cell = &BuildCost::points},
      {.name = "entries", .description = "of the table, all radii", .cell = &BuildCost::entries},
      {.name = "composites",
       .description = "intervals between gray values, or points, that the build sums up or composites",
       .cell = &BuildCost::composites},
      {.name = "evaluations",
       .description =
           "printed: of the transfer function (algorithm 11), each with a square root; others: places where "
           "parabolas meet points, each with a square root, once for a diagonal where the points are entries",
       .cell = &BuildCost::evaluations},
      {.name = "exponentials",
       .description = "one for each opacity as printed; for a composite, others",
       .cell = &BuildCost::exponentials},
      {.name = "composites_over_second_order",
       .description = "composites over those of the exact table over three scalars of the same n and points",
       .cell = &BuildCost::over_second_order},
  };
}

Columns<CostOrders> order_columns() {
  return {{.name = "order_composites",
           .description = "slope of log composites over log n, least squares",
           .cell = &CostOrders::composites},
          {.name = "order_evaluations",
           .description = "slope of log evaluations over log n",
           .cell = &CostOrders::evaluations}};
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns{
      {.name = "part",
       .description = "cost: what a build takes; fit: exponents over all sizes",
       .is_key = true,
       .cell =
           [](const Record& record) {
             constexpr std::array parts{"cost", "fit"};
             return parts[record.found.index()];
           }},
      {.name = "method",
       .description =
           "quadratic_gray_printed: opacities of R = 2^-3 to 2^3, a > 0; quadratic_gray: colours and "
           "opacities of the same radii and both signs; second_order_exact: over three scalars; the last two "
           "counted at random entries",
       .is_key = true,
       .cell = &Record::method},
      {.name = "transfer_points",
       .description = "256: whatever n is; n: as many as the table has entries",
       .is_key = true,
       .cell = &Record::growing}};
  append_part(
      columns, [](const Record& record) { return std::get_if<BuildCost>(&record.found); }, cost_columns());
  append_part(
      columns, [](const Record& record) { return std::get_if<CostOrders>(&record.found); }, order_columns());
  return columns;
}

std::vector<Record> records(const Experiment& experiment, const Options& options) {
  std::vector<Record> records;
  std::vector<BuildCost> printed;
  for (const std::size_t size : options.sizes) printed.push_back(printed_cost(size, experiment.seed));
  add(records, "quadratic_gray_printed", "256", printed);
  for (const bool grows : {false, true}) {
    std::vector<BuildCost> second_order;
    std::vector<BuildCost> corrected;
    for (const std::size_t size : options.sizes) {
      second_order.push_back(second_order_cost(size, grows ? size : static_cast<std::size_t>(largest_gray_count),
                                               options.slabs, experiment.seed));
      corrected.push_back(corrected_cost(size, grows, options.slabs, experiment.seed));
      corrected.back().over_second_order = corrected.back().composites / second_order.back().composites;
    }
    add(records, "quadratic_gray", grows ? "n" : "256", corrected);
    add(records, "second_order_exact", grows ? "n" : "256", second_order);
  }
  return records;
}

}  // namespace

extern const Measure quadratic_table_builds_measure;
const Measure quadratic_table_builds_measure{MeasureDefinition<Options, Record>{
    .name = "quadratic_table_builds",
    .summary = "what builds of quadratic tables take, as printed and corrected, and how that grows",
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

}  // namespace raytruth
