#include "study/case.hpp"

#include "catalogue.hpp"
#include "measures/signal_error.hpp"
#include "signals/analytic.hpp"
#include "signals/marschner_lobb.hpp"
#include "signals/tricubic.hpp"
#include "signals/trilinear.hpp"
#include "study/read_transfer_function.hpp"
#include "study/volume_source.hpp"
#include "volume/read_volume.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

// Differences, and parabolas through values at uneven distances, stay within binary64.
constexpr double largest_value = 0x1p900;

constexpr std::string_view why_no_reference = "the certified reference comes with a later version of raytruth";

std::array<double, 3> read_vector(const JsonReader& json) {
  const auto numbers = json.numbers(3);
  if (numbers.size() != 3) json.refuse_value("a list of 3 numbers");
  return {numbers[0], numbers[1], numbers[2]};
}

Grid read_inline_grid(const JsonReader& json) {
  json.only({"size", "values"});
  const auto sizes = json.at("size").items();
  if (sizes.size() != 3) json.at("size").refuse_value("a list of 3 sizes");
  Grid grid;
  std::int64_t voxels = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    grid.size[axis] = sizes[axis].integer(1, most_voxels);
    if (grid.size[axis] > most_voxels / voxels) json.at("size").refuse("more voxels than 2^33", "fewer");
    voxels *= grid.size[axis];
  }
  grid.values = json.at("values").numbers();
  if (grid.values.size() != static_cast<std::size_t>(voxels))
    json.at("values").refuse_value(fmt::format("a list of {} numbers, as size says,", voxels));
  return grid;
}

Chain<largest_degree> read_piecewise_polynomial(const JsonReader& json) {
  json.only({"kind", "breaks", "coefficients"});
  const auto breaks = json.at("breaks").numbers();
  const auto places = json.at("breaks").items(2);
  if (breaks.front() != 0) places.front().refuse_value("0");
  for (std::size_t i = 1; i < breaks.size(); ++i)
    if (!(breaks[i - 1] < breaks[i])) places[i].refuse_value(fmt::format("a number > {}", breaks[i - 1]));
  std::vector<std::vector<double>> coefficients;
  for (const JsonReader& piece : json.at("coefficients").items())
    coefficients.push_back(piece.numbers(largest_degree + 1));
  return json.at("coefficients").blame_for([&] { return piecewise_polynomial(breaks, coefficients); });
}

/// Its origin, direction and length; the direction is checked.
Ray read_ray(const JsonReader& json) {
  Ray ray{.origin = read_vector(json.at("origin")), .direction = read_vector(json.at("direction"))};
  json.at("direction").blame_for([&ray] { return unit_direction(ray.direction); });
  if (const auto length = json.find("length")) ray.length = length->number(0);
  return ray;
}

Chain<largest_degree> read_marschner_lobb(const JsonReader& json) {
  json.only({"kind", "origin", "direction", "length"});
  const Ray ray = read_ray(json);
  return json.at("origin").blame_for([&] { return trace_marschner_lobb(ray); });
}

Chain<largest_degree> read_analytic(const JsonReader& json) {
  json.only({"kind", "name"});
  std::vector<std::string_view> names;
  for (const AnalyticSignal& signal : analytic_signals()) names.push_back(signal.name);
  const std::string name = json.at("name").word(names);
  return expand(*std::find_if(analytic_signals().begin(), analytic_signals().end(),
                              [&name](const AnalyticSignal& signal) { return signal.name == name; }));
}

std::vector<std::string> read_schemes(const JsonReader& json) {
  std::vector<std::string_view> allowed{"reference"};
  catalogue::for_each_scheme([&allowed]<class S>() { allowed.push_back(S::info.name); });
  std::vector<std::string> schemes;
  for (const JsonReader& item : json.items()) {
    const std::string scheme = item.word(allowed);
    if (std::find(schemes.begin(), schemes.end(), scheme) != schemes.end()) item.refuse_value("each scheme once");
    schemes.push_back(scheme);
  }
  return schemes;
}

template <int Degree>
void check_values(const JsonReader& json, const Chain<Degree>& signal) {
  for (const auto& piece : signal.pieces)
    for (const double value : piece.polynomial.coefficients)
      if (!(std::abs(value) <= largest_value))
        json.refuse(fmt::format("values up to {}", value), "a signal of values up to 2^900 in magnitude");
}

Json refused(std::string_view why) { return {{"status", "refused"}, {"why", why}}; }

template <int Degree>
void take_samples(const Chain<Degree>& signal, const Sampling& sampling, Samples<double>& samples) {
  if (sampling.step) return sample_constant(signal, *sampling.step, samples);
  if (2 * signal.pieces.size() + 1 > largest_sample_count)
    throw InputError(fmt::format("found {} cells on a ray; at most {} samples are allowed", signal.pieces.size(),
                                 largest_sample_count));
  sample_cells(signal, samples);
}

template <Scheme S, int Degree>
Json evaluate_scheme(const Chain<Degree>& signal, const Samples<double>& samples) {
  if (const auto why = refusal<S>(samples); !why.empty()) return refused(why);
  Chain<3> approximation;
  approximate<S>(signal, samples, approximation);
  const double length = signal.length();
  const double error = xi(signal, approximation);
  const double error_max = xi_max(signal, approximation);
  Json answer{{"xi", error}, {"xi_per_length", nullptr}, {"xi_max", error_max}, {"xi_max_per_length", nullptr}};
  if (length > 0) {
    if (!std::isfinite(error) || !std::isfinite(error / length) || !std::isfinite(error_max / length))
      return refused("its error is beyond the range of binary64");
    answer["xi_per_length"] = error / length;
    answer["xi_max_per_length"] = error_max / length;
  } else {
    answer["why"] = "the ray is empty: nothing is per length";
  }
  answer["samples"] = fetches<S>(samples);
  return answer;
}

}  // namespace

Case CaseReader::read(const JsonReader& json) {
  json.only({"signal", "transfer_function", "emission", "sampling", "schemes"});
  const JsonReader signal = json.at("signal");
  std::vector<std::string_view> kinds(catalogue::signals.size());
  std::transform(catalogue::signals.begin(), catalogue::signals.end(), kinds.begin(),
                 [](const catalogue::Entry& entry) { return entry.name; });
  const std::string kind = signal.at("kind").word(kinds);
  Case result{json, {}, read_sampling(json.at("sampling")), read_schemes(json.at("schemes"))};
  if (const auto transfer = json.find("transfer_function")) read_transfer_function(*transfer, warnings_);
  if (const auto emission = json.find("emission")) emission->word({"associated", "plain"});
  if (kind == "trilinear")
    result.signal = read_trilinear(signal);
  else if (kind == "tricubic")
    result.signal = read_tricubic(signal);
  else if (kind == "marschner_lobb")
    result.signal = read_marschner_lobb(signal);
  else if (kind == "analytic")
    result.signal = read_analytic(signal);
  else
    result.signal = read_piecewise_polynomial(signal);
  std::visit([&signal](const auto& chain) { check_values(signal, chain); }, result.signal);
  return result;
}

Chain<3> CaseReader::read_trilinear(const JsonReader& json) {
  json.only({"kind", "volume", "repair", "origin", "direction", "length"});
  const Ray ray = read_ray(json);
  const Grid& grid = read_volume_of(json);
  return json.at("origin").blame_for([&] { return trace_trilinear(grid, ray); });
}

Chain<largest_degree> CaseReader::read_tricubic(const JsonReader& json) {
  json.only({"kind", "volume", "repair", "origin", "direction", "length", "kernel", "prefilter"});
  const Ray ray = read_ray(json);
  const bool is_bspline = json.at("kernel").word({"bspline", "catmull_rom"}) == "bspline";
  const auto prefilter = json.find("prefilter");
  const bool is_prefiltered = prefilter && prefilter->boolean();
  if (is_prefiltered && !is_bspline) prefilter->refuse_value("false: catmull_rom passes through its voxels as it is;");
  const Grid& grid = read_volume_of(json);
  Chain<largest_degree> chain;
  json.at("origin").blame_for([&] {
    trace_tricubic(is_prefiltered ? bspline_coefficients(grid) : grid,
                   is_bspline ? CubicKernel::bspline : CubicKernel::catmull_rom, ray, chain);
    return 0;
  });
  return chain;
}

const Grid& CaseReader::read_volume_of(const JsonReader& signal) {
  const JsonReader volume = signal.at("volume");
  if (volume.is_object()) {
    if (const auto repair = signal.find("repair")) repair->refuse_value("a repair of a file only");
    last_volume_.clear();
    grid_ = read_inline_grid(volume);
    return grid_;
  }
  const auto file = volume.blame_for([&] { return find_sourced_volume(signal, folders_); });
  const std::string which = file.string() + (asks_for_repair(signal) ? " repaired" : "");
  if (which == last_volume_) return grid_;
  SourcedVolume read = read_sourced_volume(signal, folders_);
  warnings_.insert(warnings_.end(), read.warnings.begin(), read.warnings.end());
  grid_ = std::move(read.grid);
  last_volume_ = which;
  return grid_;
}

Json evaluate(const Case& ray) {
  return std::visit(
      [&ray](const auto& signal) -> Json {
        Samples<double> samples;
        ray.json.at("sampling").blame_for([&] { take_samples(signal, ray.sampling, samples); });
        Json schemes = Json::object();
        for (const std::string& scheme : ray.schemes)
          catalogue::visit_scheme(scheme,
                                  [&]<class S>() { schemes[S::info.name] = evaluate_scheme<S>(signal, samples); });
        return {{"length", signal.length()}, {"reference", refused(why_no_reference)}, {"schemes", std::move(schemes)}};
      },
      ray.signal);
}

}  // namespace raytruth
