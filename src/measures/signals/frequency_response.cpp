#include "raytruth/metrics/frequency_response.hpp"
#include "experiments/measure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace raytruth {

namespace {

using Complex = std::complex<double>;

constexpr double lowest_level = -300;

// Maxima are taken over steps of 1/1000 cycle per voxel from 0 to 2; every 25th of these is a row.
constexpr int frequencies_per_cycle = 1000;
constexpr int cycles = 2;
constexpr int row_spacing = 25;

constexpr double closed_form_radius = 64 * std::numeric_limits<double>::epsilon();

struct Options {
  std::vector<double> phases;
  std::vector<int> samples_per_voxel;
};

Options read_options(const JsonReader& json) {
  json.only({"kind", "phases", "samples_per_voxel"});
  constexpr std::int64_t most_samples_per_voxel = 4096;
  Options options;
  for (const JsonReader& phase : json.at("phases").items()) options.phases.push_back(phase.number(0, 0.999));
  for (const JsonReader& count : json.at("samples_per_voxel").items())
    options.samples_per_voxel.push_back(static_cast<int>(count.integer(3, most_samples_per_voxel)));
  return options;
}

double level(double amplitude) {
  return amplitude > 0 ? std::max(20 * std::log10(amplitude), lowest_level) : lowest_level;
}

double frequency_at(int index) { return static_cast<double>(index) / frequencies_per_cycle; }

/// The response of one path by one way to find it, at all frequencies.
struct Spectrum {
  ReconstructionPath path;
  int samples_per_voxel = 0;  ///< 0: closed form
  std::vector<Complex> response;
  double radius = 0;   ///< rounding of every response
  double aliases = 0;  ///< bound on what the samples read add to the true response
};

Spectrum closed_spectrum(const ReconstructionPath& path) {
  Spectrum spectrum{.path = path, .samples_per_voxel = 0, .response = {}, .radius = closed_form_radius, .aliases = 0};
  for (int i = 0; i <= cycles * frequencies_per_cycle; ++i)
    spectrum.response.push_back(frequency_response(path, frequency_at(i)));
  return spectrum;
}

Spectrum measured_spectrum(const ReconstructionPath& path, int samples_per_voxel) {
  const ImpulseResponse impulse(path, samples_per_voxel);
  Spectrum spectrum{.path = path,
                    .samples_per_voxel = samples_per_voxel,
                    .response = {},
                    .radius = impulse.radius(),
                    .aliases = impulse.aliases()};
  for (int i = 0; i <= cycles * frequencies_per_cycle; ++i) spectrum.response.push_back(impulse.at(frequency_at(i)));
  return spectrum;
}

/// A largest value between two frequencies, in cycles per voxel, and where it is.
struct Peak {
  double value = 0;
  double frequency = 0;
};

template <class ValueAt>
Peak find_peak(double low, double high, ValueAt&& value_at) {
  Peak peak;
  for (int i = 0; i <= cycles * frequencies_per_cycle; ++i) {
    const double f = frequency_at(i);
    if (f < low || f > high) continue;
    const double value = value_at(static_cast<std::size_t>(i));
    if (value > peak.value) peak = {value, f};
  }
  return peak;
}

/// The largest distance of two responses, phase included.
Peak largest_difference(const Spectrum& a, const Spectrum& b, double low, double high) {
  return find_peak(low, high, [&](std::size_t i) { return std::abs(a.response[i] - b.response[i]); });
}

/// The cells by which rows are known.
Row key_cells(const Spectrum& spectrum, const char* part) {
  const auto& phase = spectrum.path.virtual_phase;
  const bool is_closed = spectrum.samples_per_voxel == 0;
  return {{"part", part},
          {"reconstruction", spectrum.path.prefiltered ? "prefiltered" : "raw"},
          {"curve", phase ? fmt::format("virtual, phase {}", *phase) : std::string("true")},
          {"phase", phase ? Value(*phase) : Value()},
          {"samples_per_voxel", is_closed ? Value() : Value(std::int64_t{spectrum.samples_per_voxel})}};
}

void add_curve(std::vector<Row>& rows, const Spectrum& spectrum) {
  for (std::size_t i = 0; i < spectrum.response.size(); i += row_spacing) {
    Row row = key_cells(spectrum, "curve");
    const double amplitude = std::abs(spectrum.response[i]);
    row.emplace_back("frequency", frequency_at(static_cast<int>(i)));
    row.emplace_back("amplitude", amplitude);
    row.emplace_back("amplitude_radius", spectrum.radius);
    row.emplace_back("level_db", level(amplitude));
    row.emplace_back("level_db_radius", std::max(level(amplitude + spectrum.radius) - level(amplitude),
                                                 level(amplitude) - level(std::max(amplitude - spectrum.radius, 0.0))));
    rows.push_back(std::move(row));
  }
}

void add_peak(Row& row, const std::string& name, const Peak& peak) {
  row.emplace_back(name + "_db", level(peak.value));
  row.emplace_back(name + "_frequency", peak.frequency);
}

Row summary(const Spectrum& spectrum, const Spectrum& closed, const Spectrum& true_samples) {
  Row row = key_cells(spectrum, "summary");
  const auto amplitude = [&](std::size_t i) { return std::abs(spectrum.response[i]); };
  add_peak(row, "peak_from_half", find_peak(0.5, cycles, amplitude));
  add_peak(row, "peak_from_one", find_peak(1, cycles, amplitude));
  if (spectrum.path.virtual_phase) {
    add_peak(row, "difference_pass", largest_difference(spectrum, true_samples, 0, 0.5));
    add_peak(row, "difference_transition", largest_difference(spectrum, true_samples, 0.5, 1));
    add_peak(row, "difference_stop", largest_difference(spectrum, true_samples, 1, cycles));
  }
  row.emplace_back("amplitude_radius", spectrum.radius);
  if (spectrum.samples_per_voxel > 0) {
    const double difference = largest_difference(spectrum, closed, 0, cycles).value;
    row.emplace_back("alias_bound", spectrum.aliases);
    row.emplace_back("closed_form_difference", difference);
    row.emplace_back("closed_form_difference_over_bound",
                     difference / (spectrum.aliases + spectrum.radius + closed.radius));
  }
  return row;
}

}  // namespace

std::vector<Column> frequency_response_columns(const Experiment& /*experiment*/, const JsonReader& options) {
  read_options(options);
  std::vector<Column> columns{
      {.name = "part", .unit = "", .description = "curve: at one frequency; summary: of all", .is_key = true},
      {.name = "reconstruction",
       .unit = "",
       .description = "cubic B-spline: raw, or prefiltered to pass through the voxels",
       .is_key = true},
      {.name = "curve",
       .unit = "",
       .description = "true: the spline itself; virtual: Catmull-Rom through its samples at unit steps",
       .is_key = true},
      {.name = "phase",
       .unit = "voxel",
       .description = "of the samples at unit steps, on a ray parallel to an axis",
       .is_key = true},
      {.name = "samples_per_voxel",
       .unit = "1/voxel",
       .description = "at which the signal of an impulse in a voxel grid is read; null: closed form",
       .is_key = true},
      {.name = "frequency", .unit = "cycles/voxel", .description = "0 to 2", .is_key = true},
      {.name = "amplitude",
       .unit = "",
       .description = "of the response; 1 at frequency 0",
       .radius = "amplitude_radius"},
      {.name = "amplitude_radius", .unit = "", .description = "bound on the rounding error of the amplitude"},
      {.name = "level_db",
       .unit = "dB",
       .description = "20 log10 of the amplitude; -300 stands for all below, so for 0 too",
       .radius = "level_db_radius"},
      {.name = "level_db_radius", .unit = "dB", .description = "what the amplitude's radius makes of the level"},
  };
  const auto add_peak_columns = [&columns](const std::string& name, const std::string& description) {
    columns.push_back({.name = name + "_db", .unit = "dB", .description = description});
    columns.push_back({.name = name + "_frequency", .unit = "cycles/voxel", .description = "where that is"});
  };
  add_peak_columns("peak_from_half", "largest level from 0.5 cycles per voxel on");
  add_peak_columns("peak_from_one", "largest level from 1 cycle per voxel on");
  const std::string difference = "largest difference from the response of true samples read alike, as a level: ";
  add_peak_columns("difference_pass", difference + "from 0 to 0.5 cycles per voxel");
  add_peak_columns("difference_transition", difference + "from 0.5 to 1 cycle per voxel");
  add_peak_columns("difference_stop", difference + "from 1 cycle per voxel on");
  columns.push_back({.name = "alias_bound",
                     .unit = "",
                     .description = "bound on the aliases of a measured response: its samples repeat the spectrum"});
  columns.push_back({.name = "closed_form_difference",
                     .unit = "",
                     .description = "largest difference of a measured response from the closed form"});
  columns.push_back({.name = "closed_form_difference_over_bound",
                     .unit = "",
                     .description = "the same over the bounds on aliases and rounding"});
  return columns;
}

std::vector<Row> frequency_response_rows(const Experiment& /*experiment*/, const JsonReader& options,
                                         const Field& /*field*/) {
  const Options asked = read_options(options);
  std::vector<std::optional<double>> phases{{}};
  phases.insert(phases.end(), asked.phases.begin(), asked.phases.end());
  std::vector<int> ways{0};
  ways.insert(ways.end(), asked.samples_per_voxel.begin(), asked.samples_per_voxel.end());
  std::vector<Row> curves;
  std::vector<Row> rows;
  for (const bool prefiltered : {false, true})
    for (const int way : ways) {
      std::optional<Spectrum> true_samples;
      for (const auto& phase : phases) {
        const ReconstructionPath path{.prefiltered = prefiltered, .virtual_phase = phase};
        const Spectrum closed = closed_spectrum(path);
        const Spectrum spectrum = way == 0 ? closed : measured_spectrum(path, way);
        if (!phase) true_samples = spectrum;
        rows.push_back(summary(spectrum, closed, *true_samples));
        add_curve(curves, spectrum);
      }
    }
  rows.insert(rows.end(), std::make_move_iterator(curves.begin()), std::make_move_iterator(curves.end()));
  return rows;
}

}  // namespace raytruth
