#include "experiments/measure.hpp"
#include "measures/tables/table_study.hpp"
#include "raytruth/core/real.hpp"
#include "raytruth/core/real50.hpp"
#include "raytruth/tables/weighted.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace raytruth {

namespace {

constexpr std::size_t largest_size = 2048;
constexpr std::size_t largest_in_50_digits = 64;
constexpr std::size_t fronts = 9;  // entries i per width, from 0 to the last that the width leaves
constexpr std::array widths{1U, 4U, 16U, 64U};

TableStudy read_options(const JsonReader& json) {
  json.only({"kind", "sizes", "shapes", "optical_depths"});
  return read_table_study(json, largest_size);
}

/// The colour weighted towards the back as it is defined, interval by interval in 50 digits.
Vector3<Real50> weighted_directly(const DiscreteTransfer& transfer, std::size_t front, std::size_t back) {
  const bool ascends = front < back;
  const std::size_t width = ascends ? back - front : front - back;
  // The length of an interval is that of the tables, rounded to binary64.
  const Real50 length(1 / static_cast<double>(width));
  Vector3<Real50> sum = Vector3<Real50>::Constant(0);
  Real50 transmittance = 1;
  for (std::size_t k = 0; k < width; ++k) {
    const auto slab =
        homogeneous_stretch<Real50>(transfer.intervals[ascends ? front + k : front - 1 - k], transfer.emission, length);
    const Real50 weight = Real50(2 * k + 1) / Real50(2 * width);
    for (int channel = 0; channel < 3; ++channel) sum[channel] += weight * transmittance * slab[channel];
    transmittance *= 1 - slab[3];
  }
  return sum;
}

/// The transfer function seen from the other end; its table's back is this one's front.
DiscreteTransfer mirrored(DiscreteTransfer transfer) {
  std::reverse(transfer.entries.begin(), transfer.entries.end());
  std::reverse(transfer.intervals.begin(), transfer.intervals.end());
  return transfer;
}

/// A table size under one transfer function, and the truth for some of its entries.
struct Study {
  Row keys;
  DiscreteTransfer transfer;
  TableAxes axes;
  std::vector<std::pair<std::size_t, std::size_t>> entries;  ///< front and back
  std::vector<Vector3<Real50>> truths;
};

/// Fronts at equal distances, ranges of few and of many intervals, in both directions.
void choose_entries(Study& study) {
  const std::size_t size = study.axes.size;
  for (const std::size_t width : widths)
    for (std::size_t k = 0; k < fronts && width < size; ++k) {
      const std::size_t low = k * (size - 1 - width) / (fronts - 1);
      for (const auto& entry : {std::pair{low, low + width}, {low + width, low}}) {
        if (std::find(study.entries.begin(), study.entries.end(), entry) != study.entries.end()) continue;
        study.entries.push_back(entry);
        study.truths.push_back(weighted_directly(study.transfer, entry.first, entry.second));
      }
    }
}

Real50 widened(const Real50& x) { return x; }
Real50 widened(double x) { return x; }
Real50 widened(Binary32 x) { return to_double(x); }

/// An arithmetic of that many binary digits.
struct Arithmetic {
  const char* name;
  int digits;
};

template <class Real>
using Make = WeightedTables<Real> (*)(const DiscreteTransfer&, const TableAxes&);

template <class Real>
void add_rows(const Study& study, const Arithmetic& arithmetic, const char* method, Make<Real> make,
              std::vector<Row>& rows) {
  const double unit = std::ldexp(1.0, -arithmetic.digits);
  const auto tables = make(study.transfer, study.axes);
  const auto whole = subrange_table<Real>(study.transfer, study.axes);
  const auto mirror_image = make(mirrored(study.transfer), study.axes);
  const std::size_t last = study.axes.size - 1;
  const auto keys = [&](const char* part) {
    Row row{{"part", part}, {"arithmetic", arithmetic.name}, {"method", method}};
    row.insert(row.end(), study.keys.begin(), study.keys.end());
    return row;
  };

  double identity = 0;
  double asymmetry = 0;
  for (std::size_t back = 0; back <= last; ++back)
    for (std::size_t front = 0; front <= last; ++front)
      for (int channel = 0; channel < 3; ++channel) {
        const auto of = [channel](const auto& texel) { return widened(texel[channel]); };
        const auto to_back = tables.back.at(front, back);
        const Real50 sum = of(tables.front.at(front, back)) + of(to_back);
        const auto apart = [](const Real50& a, const Real50& b) { return static_cast<double>(abs(Real50(a - b))); };
        identity = std::max(identity, apart(sum, of(whole.at(front, back))));
        asymmetry = std::max(asymmetry, apart(of(to_back), of(mirror_image.back.at(last - front, last - back))));
      }
  Row table_row = keys("table");
  // A sum of n positive terms errs by at most n roundings of the largest; front, back and whole are three.
  const double bound = 3 * static_cast<double>(study.axes.size) * unit;
  table_row.insert(table_row.end(), {{"identity_error", identity},
                                     {"identity_over_bound", identity / bound},
                                     {"asymmetry", asymmetry},
                                     {"asymmetry_over_bound", asymmetry / bound}});
  rows.push_back(table_row);

  for (std::size_t i = 0; i < study.entries.size(); ++i) {
    const auto& [front, back] = study.entries[i];
    const auto found = tables.back.at(front, back);
    double error = 0;
    double relative = 0;
    for (int channel = 0; channel < 3; ++channel) {
      const Real50& truth = study.truths[i][channel];
      if (truth == 0) continue;
      const auto difference = static_cast<double>(abs(Real50(widened(found[channel]) - truth)));
      error = std::max(error, difference);
      relative = std::max(relative, difference / to_double(truth));
    }
    Row row = keys("entry");
    row.insert(row.end(), {{"front", static_cast<std::int64_t>(front)},
                           {"back", static_cast<std::int64_t>(back)},
                           {"width", static_cast<std::int64_t>(front < back ? back - front : front - back)},
                           {"weighted_error", error},
                           {"relative_error", relative},
                           {"digits_lost", relative > unit ? std::log10(relative / unit) : 0.0}});
    rows.push_back(row);
  }
}

}  // namespace

std::vector<Column> weighted_tables_columns(const Experiment& /*experiment*/, const JsonReader& options) {
  read_options(options);
  std::vector<Column> columns{
      {.name = "part", .unit = "", .description = "table: all entries; entry: one of them", .is_key = true},
      {.name = "arithmetic",
       .unit = "",
       .description = "binary64, binary32, or 50 digits up to n = 64",
       .is_key = true},
      {.name = "method",
       .unit = "",
       .description = "difference: C^W = (C^G - i C^1)/(j - i) as printed; sums: slabs (C, M)",
       .is_key = true},
  };
  append(columns, table_key_columns());
  columns.insert(
      columns.end(),
      {
          {.name = "front", .unit = "", .description = "i", .is_key = true},
          {.name = "back", .unit = "", .description = "j", .is_key = true},
          {.name = "width", .unit = "", .description = "|j - i|"},
          {.name = "weighted_error",
           .unit = "",
           .description = "of the back-weighted colour, against its sum in 50 digits"},
          {.name = "relative_error",
           .unit = "",
           .description = "the same as a share of the channel, the largest of three"},
          {.name = "digits_lost",
           .unit = "",
           .description = "log10 of relative_error over half a unit in the last place"},
          {.name = "identity_error", .unit = "", .description = "largest |front + back - unweighted|"},
          {.name = "identity_over_bound", .unit = "", .description = "over 3 n half units in the last place of 1"},
          {.name = "asymmetry",
           .unit = "",
           .description = "largest difference to the table of the mirrored transfer function, read from the other end"},
          {.name = "asymmetry_over_bound", .unit = "", .description = "over 3 n half units in the last place of 1"},
      });
  return columns;
}

std::vector<Row> weighted_tables_rows(const Experiment& experiment, const JsonReader& options, const Field& /*field*/) {
  const TableStudy asked = read_options(options);
  std::vector<Row> rows;
  for (const std::string& shape : asked.shapes)
    for (const double depth : asked.optical_depths) {
      const PiecewiseLinear transfer = TableStudy::transfer(shape, depth, experiment.seed);
      for (const std::size_t size : asked.sizes) {
        const TableAxes axes = TableStudy::axes(size);
        Study study{.keys = table_keys(shape, depth, size),
                    .transfer = interval_means(transfer, axes, experiment.emission),
                    .axes = axes,
                    .entries = {},
                    .truths = {}};
        choose_entries(study);
        const auto add = [&]<class Real>(const Arithmetic& arithmetic) {
          add_rows<Real>(study, arithmetic, "difference", weighted_tables_by_difference<Real>, rows);
          add_rows<Real>(study, arithmetic, "sums", weighted_tables<Real>, rows);
        };
        if (size <= largest_in_50_digits)
          add.template operator()<Real50>({"decimal50", std::numeric_limits<Real50>::digits});
        add.template operator()<double>({"binary64", std::numeric_limits<double>::digits});
        add.template operator()<Binary32>({"binary32", std::numeric_limits<float>::digits});
      }
    }
  return rows;
}

}  // namespace raytruth
