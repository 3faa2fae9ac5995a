#include "raytruth/metrics/frequency_response.hpp"
#include "experiments/measure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <vector>

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

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
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

/// The response at one frequency.
struct CurvePoint {
  double frequency = 0;
  double amplitude = 0;
  double radius = 0;
};

/// What the amplitude's radius makes of its level.
double level_radius(const CurvePoint& point) {
  const double middle = level(point.amplitude);
  return std::max(level(point.amplitude + point.radius) - middle,
                  middle - level(std::max(point.amplitude - point.radius, 0.0)));
}

/// Largest differences of virtual samples from true ones that are read alike.
struct Differences {
  Peak pass;
  Peak transition;
  Peak stop;
};

/// A measured response beside the closed form.
struct AgainstClosedForm {
  double alias_bound = 0;
  double difference = 0;
  double difference_over_bound = 0;
};

/// What the response comes to at all frequencies.
struct Summary {
  Peak from_half;
  Peak from_one;
  std::optional<Differences> differences = {};  ///< none: of true samples
  double radius = 0;
  std::optional<AgainstClosedForm> against_closed_form = {};  ///< none: of the closed form
};

struct Record {
  ReconstructionPath path;
  int samples_per_voxel = 0;  ///< 0: closed form
  std::optional<Summary> summary = {};
  std::optional<CurvePoint> point = {};
};

void add_curve(std::vector<Record>& records, const Spectrum& spectrum) {
  for (std::size_t i = 0; i < spectrum.response.size(); i += row_spacing)
    records.push_back(
        {.path = spectrum.path,
         .samples_per_voxel = spectrum.samples_per_voxel,
         .point = CurvePoint{frequency_at(static_cast<int>(i)), std::abs(spectrum.response[i]), spectrum.radius}});
}

Summary summary_of(const Spectrum& spectrum, const Spectrum& closed, const Spectrum& true_samples) {
  const auto amplitude = [&](std::size_t i) { return std::abs(spectrum.response[i]); };
  Summary summary{.from_half = find_peak(0.5, cycles, amplitude),
                  .from_one = find_peak(1, cycles, amplitude),
                  .radius = spectrum.radius};
  if (spectrum.path.virtual_phase)
    summary.differences = {.pass = largest_difference(spectrum, true_samples, 0, 0.5),
                           .transition = largest_difference(spectrum, true_samples, 0.5, 1),
                           .stop = largest_difference(spectrum, true_samples, 1, cycles)};
  if (spectrum.samples_per_voxel > 0) {
    const double difference = largest_difference(spectrum, closed, 0, cycles).value;
    summary.against_closed_form = {
        .alias_bound = spectrum.aliases,
        .difference = difference,
        .difference_over_bound = difference / (spectrum.aliases + spectrum.radius + closed.radius)};
  }
  return summary;
}

/// NAME_db and NAME_frequency.
Columns<Peak> peak_columns(const std::string& name, const std::string& description) {
  return {
      {.name = name + "_db",
       .unit = "dB",
       .description = description,
       .cell = [](const Peak& peak) { return level(peak.value); }},
      {.name = name + "_frequency", .unit = "cycles/voxel", .description = "where that is", .cell = &Peak::frequency}};
}

Columns<Record> key_columns() {
  return {
      {.name = "part",
       .description = "curve: at one frequency; summary: of all",
       .is_key = true,
       .cell = [](const Record& record) { return record.summary ? "summary" : "curve"; }},
      {.name = "reconstruction",
       .description = "cubic B-spline: raw, or prefiltered to pass through the voxels",
       .is_key = true,
       .cell = [](const Record& record) { return record.path.prefiltered ? "prefiltered" : "raw"; }},
      {.name = "curve",
       .description = "true: the spline itself; virtual: Catmull-Rom through its samples at unit steps",
       .is_key = true,
       .cell =
           [](const Record& record) {
             const auto& phase = record.path.virtual_phase;
             return phase ? fmt::format("virtual, phase {}", *phase) : std::string("true");
           }},
      {.name = "phase",
       .unit = "voxel",
       .description = "of the samples at unit steps, on a ray parallel to an axis",
       .is_key = true,
       .cell = [](const Record& record) { return record.path.virtual_phase; }},
      {.name = "samples_per_voxel",
       .unit = "1/voxel",
       .description = "at which the signal of an impulse in a voxel grid is read; null: closed form",
       .is_key = true,
       .cell =
           [](const Record& record) {
             return record.samples_per_voxel > 0 ? std::optional(record.samples_per_voxel) : std::nullopt;
           }},
  };
}

Columns<CurvePoint> point_columns() {
  return {
      {.name = "frequency",
       .unit = "cycles/voxel",
       .description = "0 to 2",
       .is_key = true,
       .cell = &CurvePoint::frequency},
      {.name = "amplitude",
       .description = "of the response; 1 at frequency 0",
       .radius = "amplitude_radius",
       .cell = &CurvePoint::amplitude},
      {.name = "amplitude_radius",
       .description = "bound on the rounding error of the amplitude",
       .cell = &CurvePoint::radius},
      {.name = "level_db",
       .unit = "dB",
       .description = "20 log10 of the amplitude; -300 stands for all below, so for 0 too",
       .radius = "level_db_radius",
       .cell = [](const CurvePoint& point) { return level(point.amplitude); }},
      {.name = "level_db_radius",
       .unit = "dB",
       .description = "what the amplitude's radius makes of the level",
       .cell = level_radius},
  };
}

Columns<Differences> difference_columns() {
  const std::string difference = "largest difference from the response of true samples read alike, as a level: ";
  Columns<Differences> columns;
  append_part(columns, &Differences::pass,
              peak_columns("difference_pass", difference + "from 0 to 0.5 cycles per voxel"));
  append_part(columns, &Differences::transition,
              peak_columns("difference_transition", difference + "from 0.5 to 1 cycle per voxel"));
  append_part(columns, &Differences::stop, peak_columns("difference_stop", difference + "from 1 cycle per voxel on"));
  return columns;
}

Columns<AgainstClosedForm> closed_form_columns() {
  return {{.name = "alias_bound",
           .description = "bound on the aliases of a measured response: its samples repeat the spectrum",
           .cell = &AgainstClosedForm::alias_bound},
          {.name = "closed_form_difference",
           .description = "largest difference of a measured response from the closed form",
           .cell = &AgainstClosedForm::difference},
          {.name = "closed_form_difference_over_bound",
           .description = "the same over the bounds on aliases and rounding",
           .cell = &AgainstClosedForm::difference_over_bound}};
}

Columns<Summary> summary_columns() {
  Columns<Summary> columns;
  append_part(columns, &Summary::from_half,
              peak_columns("peak_from_half", "largest level from 0.5 cycles per voxel on"));
  append_part(columns, &Summary::from_one, peak_columns("peak_from_one", "largest level from 1 cycle per voxel on"));
  append_part(columns, &Summary::differences, difference_columns());
  columns.push_back(written_here<Summary>("amplitude_radius", &Summary::radius));
  append_part(columns, &Summary::against_closed_form, closed_form_columns());
  return columns;
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns = key_columns();
  append_part(columns, &Record::point, point_columns());
  append_part(columns, &Record::summary, summary_columns());
  return columns;
}

/// The summaries of all ways, then their curves.
std::vector<Record> records(const Experiment& /*experiment*/, const Options& options) {
  std::vector<std::optional<double>> phases{{}};
  phases.insert(phases.end(), options.phases.begin(), options.phases.end());
  std::vector<int> ways{0};
  ways.insert(ways.end(), options.samples_per_voxel.begin(), options.samples_per_voxel.end());
  std::vector<Record> curves;
  std::vector<Record> records;
  for (const bool prefiltered : {false, true})
    for (const int way : ways) {
      std::optional<Spectrum> true_samples;
      for (const auto& phase : phases) {
        const ReconstructionPath path{.prefiltered = prefiltered, .virtual_phase = phase};
        const Spectrum closed = closed_spectrum(path);
        const Spectrum spectrum = way == 0 ? closed : measured_spectrum(path, way);
        if (!phase) true_samples = spectrum;
        records.push_back(
            {.path = path, .samples_per_voxel = way, .summary = summary_of(spectrum, closed, *true_samples)});
        add_curve(curves, spectrum);
      }
    }
  records.insert(records.end(), std::make_move_iterator(curves.begin()), std::make_move_iterator(curves.end()));
  return records;
}

}  // namespace

extern const Measure frequency_response_measure;
const Measure frequency_response_measure{MeasureDefinition<Options, Record>{
    .name = "frequency_response",
    .summary = "Fourier transforms of the B-spline and of virtual samples, closed form and measured",
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

}  // namespace raytruth
