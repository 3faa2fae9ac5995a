#include "experiments/measure.hpp"
#include "measures/tables/table_study.hpp"
#include "raytruth/core/real.hpp"
#include "raytruth/core/real50.hpp"
#include "raytruth/tables/weighted.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace raytruth {

namespace {

constexpr std::size_t largest_size = 2048;
constexpr std::size_t largest_in_50_digits = 64;
constexpr std::size_t fronts = 9;  // entries i per width, from 0 to the last that the width leaves
constexpr std::array widths{1U, 4U, 16U, 64U};

TableStudy read_options(const Experiment& /*experiment*/, const JsonReader& json) {
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
  TableKeys keys;
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

/// What holds of all entries of a table.
struct WholeTable {
  double identity_error = 0;
  double asymmetry = 0;
  double bound = 0;  ///< on either
};

/// The errors of one entry, the largest of its channels.
struct Entry {
  std::size_t front = 0;
  std::size_t back = 0;
  double error = 0;
  double relative_error = 0;
  double digits_lost = 0;
};

struct Record {
  const char* arithmetic;
  const char* method;
  TableKeys keys;
  std::variant<WholeTable, Entry> found;
};

template <class Real>
void add_records(const Study& study, const Arithmetic& arithmetic, const char* method, Make<Real> make,
                 std::vector<Record>& records) {
  const double unit = std::ldexp(1.0, -arithmetic.digits);
  const auto tables = make(study.transfer, study.axes);
  const auto whole = subrange_table<Real>(study.transfer, study.axes);
  const auto mirror_image = make(mirrored(study.transfer), study.axes);
  const std::size_t last = study.axes.size - 1;
  const auto add = [&](const auto& found) { records.push_back({arithmetic.name, method, study.keys, found}); };

  // A sum of n positive terms errs by at most n roundings of the largest; front, back and whole are three.
  WholeTable of_all{.bound = 3 * static_cast<double>(study.axes.size) * unit};
  for (std::size_t back = 0; back <= last; ++back)
    for (std::size_t front = 0; front <= last; ++front)
      for (int channel = 0; channel < 3; ++channel) {
        const auto of = [channel](const auto& texel) { return widened(texel[channel]); };
        const auto to_back = tables.back.at(front, back);
        const Real50 sum = of(tables.front.at(front, back)) + of(to_back);
        const auto apart = [](const Real50& a, const Real50& b) { return static_cast<double>(abs(Real50(a - b))); };
        of_all.identity_error = std::max(of_all.identity_error, apart(sum, of(whole.at(front, back))));
        of_all.asymmetry =
            std::max(of_all.asymmetry, apart(of(to_back), of(mirror_image.back.at(last - front, last - back))));
      }
  add(of_all);

  for (std::size_t i = 0; i < study.entries.size(); ++i) {
    const auto& [front, back] = study.entries[i];
    const auto found = tables.back.at(front, back);
    Entry entry{.front = front, .back = back};
    for (int channel = 0; channel < 3; ++channel) {
      const Real50& truth = study.truths[i][channel];
      if (truth == 0) continue;
      const auto difference = static_cast<double>(abs(Real50(widened(found[channel]) - truth)));
      entry.error = std::max(entry.error, difference);
      entry.relative_error = std::max(entry.relative_error, difference / to_double(truth));
    }
    if (entry.relative_error > unit) entry.digits_lost = std::log10(entry.relative_error / unit);
    add(entry);
  }
}

Columns<Entry> entry_columns() {
  return {
      {.name = "front", .description = "i", .is_key = true, .cell = &Entry::front},
      {.name = "back", .description = "j", .is_key = true, .cell = &Entry::back},
      {.name = "width",
       .description = "|j - i|",
       .cell =
           [](const Entry& entry) {
             return entry.front < entry.back ? entry.back - entry.front : entry.front - entry.back;
           }},
      {.name = "weighted_error",
       .description = "of the back-weighted colour, against its sum in 50 digits",
       .cell = &Entry::error},
      {.name = "relative_error",
       .description = "the same as a share of the channel, the largest of three",
       .cell = &Entry::relative_error},
      {.name = "digits_lost",
       .description = "log10 of relative_error over half a unit in the last place",
       .cell = &Entry::digits_lost},
  };
}

Columns<WholeTable> whole_table_columns() {
  return {
      {.name = "identity_error",
       .description = "largest |front + back - unweighted|",
       .cell = &WholeTable::identity_error},
      {.name = "identity_over_bound",
       .description = "over 3 n half units in the last place of 1",
       .cell = [](const WholeTable& table) { return table.identity_error / table.bound; }},
      {.name = "asymmetry",
       .description = "largest difference to the table of the mirrored transfer function, read from the other end",
       .cell = &WholeTable::asymmetry},
      {.name = "asymmetry_over_bound",
       .description = "over 3 n half units in the last place of 1",
       .cell = [](const WholeTable& table) { return table.asymmetry / table.bound; }},
  };
}

Columns<Record> columns(const Experiment& /*experiment*/, const TableStudy& /*study*/) {
  Columns<Record> columns{
      {.name = "part",
       .description = "table: all entries; entry: one of them",
       .is_key = true,
       .cell = [](const Record& record) { return std::holds_alternative<Entry>(record.found) ? "entry" : "table"; }},
      {.name = "arithmetic",
       .description = "binary64, binary32, or 50 digits up to n = 64",
       .is_key = true,
       .cell = &Record::arithmetic},
      {.name = "method",
       .description = "difference: C^W = (C^G - i C^1)/(j - i) as printed; sums: slabs (C, M)",
       .is_key = true,
       .cell = &Record::method},
  };
  append_part(columns, &Record::keys, table_key_columns());
  append_part(
      columns, [](const Record& record) { return std::get_if<Entry>(&record.found); }, entry_columns());
  append_part(
      columns, [](const Record& record) { return std::get_if<WholeTable>(&record.found); }, whole_table_columns());
  return columns;
}

std::vector<Record> records(const Experiment& experiment, const TableStudy& asked) {
  std::vector<Record> records;
  for (const std::string& shape : asked.shapes)
    for (const double depth : asked.optical_depths) {
      const PiecewiseLinear transfer = TableStudy::transfer(shape, depth, experiment.seed);
      for (const std::size_t size : asked.sizes) {
        const TableAxes axes = TableStudy::axes(size);
        Study study{.keys = {shape, depth, size},
                    .transfer = interval_means(transfer, axes, experiment.emission),
                    .axes = axes,
                    .entries = {},
                    .truths = {}};
        choose_entries(study);
        const auto add = [&]<class Real>(const Arithmetic& arithmetic) {
          add_records<Real>(study, arithmetic, "difference", weighted_tables_by_difference<Real>, records);
          add_records<Real>(study, arithmetic, "sums", weighted_tables<Real>, records);
        };
        if (size <= largest_in_50_digits)
          add.template operator()<Real50>({"decimal50", std::numeric_limits<Real50>::digits});
        add.template operator()<double>({"binary64", std::numeric_limits<double>::digits});
        add.template operator()<Binary32>({"binary32", std::numeric_limits<float>::digits});
      }
    }
  return records;
}

}  // namespace

extern const Measure weighted_tables_measure;
const Measure weighted_tables_measure{MeasureDefinition<TableStudy, Record>{
    .name = "weighted_tables",
    .summary = "digits that weighted tables lose, as the printed difference and as sums",
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

}  // namespace raytruth
