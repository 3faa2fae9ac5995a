#include "explorer/engine.hpp"

#include "raytruth/core/chain.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/metrics/signal_error.hpp"
#include "raytruth/reference/ray_truth.hpp"
#include "raytruth/schemes/integral_schemes.hpp"
#include "raytruth/schemes/samples.hpp"
#include "raytruth/schemes/scheme_integral.hpp"
#include "raytruth/schemes/scheme_list.hpp"
#include "raytruth/signals/marschner_lobb.hpp"
#include "raytruth/signals/piecewise_polynomial.hpp"
#include "raytruth/signals/trilinear.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"
#include "raytruth/volume/grid.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace raytruth {

namespace {

constexpr int most_voxels = 1 << 20;
constexpr double most_samples = 10'000;  // a page answers while a finger moves

/// A signal with what its certified integral needs.
template <int Degree>
struct Signal {
  Chain<Degree> chain;
  SignalError error;
  PreciseChain<Degree> precise;
};

/// What the page has chosen.
struct Choice {
  std::variant<Signal<3>, Signal<largest_degree>> signal;
  std::optional<PiecewiseLinear> transfer;
  Emission emission = Emission::associated;
  std::string answer;  ///< the text that was handed out last
};

Choice& choice() {
  static Choice chosen;
  return chosen;
}

std::string in_quotes(std::string_view text) {
  std::string result = "\"";
  for (const char letter : text) {
    if (letter == '"' || letter == '\\') result += '\\';
    result += letter;
  }
  return result + '"';
}

/// Calls `make`, which returns JSON, and keeps it.
template <class Make>
const char* answered(Make&& make) {
  std::string& answer = choice().answer;
  try {
    answer = make();
  } catch (const InputError& error) {
    answer = fmt::format(R"({{"error": {}}})", in_quotes(error.what()));
  }
  return answer.c_str();
}

Ray ray_of(const double* numbers) {
  return {.origin = {numbers[0], numbers[1], numbers[2]},
          .direction = {numbers[3], numbers[4], numbers[5]},
          .length = numbers[6]};
}

std::string length_json(double length) { return fmt::format(R"({{"length":{}}})", length); }

std::string trace(const Grid& grid, const Ray& ray) {
  Signal<3> signal;
  trace_trilinear(grid, ray, signal.chain);
  signal.error = trilinear_error(grid, ray, signal.chain);
  signal.precise = trace_trilinear_precisely(grid, ray);
  const double length = signal.chain.length();
  choice().signal = std::move(signal);
  return length_json(length);
}

template <int Degree>
void take_samples_from(const Chain<Degree>& signal, double step, double phase, Samples<double>& samples) {
  const double length = signal.length();
  if (!(step > 0)) throw InputError(fmt::format("step {}; a number > 0 is allowed", step));
  if (!(phase >= 0 && phase < 1)) throw InputError(fmt::format("phase {}; from 0 to 1, without 1, is allowed", phase));
  if (!(length / step < most_samples))
    throw InputError(
        fmt::format("step {} on a ray of length {}; at most {} samples are allowed", step, length, most_samples));
  if (phase == 0) return sample_constant(signal, step, samples);
  samples.clear();
  if (signal.pieces.empty()) return;
  const auto add = [&](double t) {
    samples.positions.emplace_back(t);
    samples.values.push_back(signal.value(t));
  };
  add(0);
  const double last = length * (1 - 1e-9);
  for (int i = 0; (i + phase) * step < last; ++i) add((i + phase) * step);
  samples.positions.push_back(signal.end);
  samples.values.push_back(signal.pieces.back().polynomial.coefficients.back());
}

std::string numbers_json(const std::vector<double>& numbers) { return fmt::format("[{}]", fmt::join(numbers, ",")); }

std::string difference_json(const Difference& difference) {
  const auto& [color, opacity] = difference;
  return numbers_json({color[0], color[1], color[2], opacity});
}

std::string scheme_json(const ErrorBudget& budget) {
  const Outcome<>& outcome = budget.outcome;
  if (!outcome.refusal.empty()) return fmt::format(R"({{"why":{}}})", in_quotes(outcome.refusal));
  const auto& color = outcome.color;
  return fmt::format(
      R"({{"color":[{},{},{}],"opacity":{},"error_bound":{},"signal":{},"quadrature":{},"samples":{},"lookups":{}}})",
      color[0], color[1], color[2], outcome.opacity, budget.radius, difference_json(budget.signal),
      difference_json(budget.quadrature), outcome.fetches, outcome.lookups);
}

const PiecewiseLinear& transfer_function() {
  if (!choice().transfer) throw InputError("there is no transfer function");
  return *choice().transfer;
}

template <int Degree>
std::string answer_json(const Signal<Degree>& signal, double step, double phase) {
  const PiecewiseLinear& transfer = transfer_function();
  Samples<double> samples;
  take_samples_from(signal.chain, step, phase, samples);
  RayIntegral integral(transfer, choice().emission);
  const Certified truth = ray_truth(
      integral, signal.chain, signal.error, [&]() -> const auto& { return signal.precise; });

  std::vector<double> breaks;
  for (const auto& piece : signal.chain.pieces) breaks.push_back(static_cast<double>(piece.start));
  breaks.push_back(signal.chain.length());
  std::vector<std::string> places;
  for (std::size_t i = 0; i < samples.positions.size(); ++i)
    places.push_back(numbers_json({static_cast<double>(samples.positions[i]), samples.values[i]}));
  SchemeIntegral integrate(transfer, choice().emission);
  std::vector<std::string> schemes;
  for (const IntegralScheme& scheme : catalogue::integral_schemes())
    schemes.push_back(fmt::format("{}:{}", in_quotes(scheme.name),
                                  scheme_json(integrate.budget(scheme, signal.chain, samples, truth))));
  return fmt::format(
      R"({{"length":{},"breaks":{},"samples":[{}],"reference":{{"color":[{},{},{}],"opacity":{},"error_bound":{},)"
      R"("converged":{}}},"schemes":{{{}}}}})",
      signal.chain.length(), numbers_json(breaks), fmt::join(places, ","), truth.color[0], truth.color[1],
      truth.color[2], truth.opacity, truth.radius, truth.status == Status::converged, fmt::join(schemes, ","));
}

template <int Degree>
std::vector<double> values_of(const Chain<Degree>& chain, double length, int count) {
  std::vector<double> values;
  if (chain.pieces.empty()) return values;
  for (int i = 0; i <= count; ++i) values.push_back(chain.value(length * i / count));
  return values;
}

template <int Degree>
std::string curves_json(const Signal<Degree>& signal, std::string_view name, double step, double phase, int count) {
  if (count < 1 || count > most_samples) throw InputError(fmt::format("{} places; 1 to 10000 are allowed", count));
  const IntegralScheme* const scheme = find_named(catalogue::integral_schemes(), name);
  if (scheme == nullptr) throw InputError(fmt::format("no scheme is named '{}'", name));
  Samples<double> samples;
  take_samples_from(signal.chain, step, phase, samples);
  Chain<3> approximation;
  double error = NAN;
  if (!scheme->signal.empty())
    catalogue::visit_scheme(scheme->signal, [&]<class S>() {
      if (!refusal<S>(samples).empty()) return;
      approximate<S>(signal.chain, samples, approximation);
      error = xi(signal.chain, approximation);
    });
  const double length = signal.chain.length();
  return fmt::format(
      R"({{"signal":{},"approximation":{},"xi":{}}})", numbers_json(values_of(signal.chain, length, count)),
      numbers_json(values_of(approximation, length, count)), std::isnan(error) ? "null" : fmt::format("{}", error));
}

}  // namespace

}  // namespace raytruth

using namespace raytruth;

const char* explorer_schemes() {
  return answered([] {
    std::vector<std::string> rows;
    for (const IntegralScheme& scheme : catalogue::integral_schemes())
      rows.push_back(fmt::format(R"({{"name":{},"summary":{},"source":{},"family":{},"color":{}}})",
                                 in_quotes(scheme.name), in_quotes(scheme.summary), in_quotes(scheme.source),
                                 in_quotes(family(scheme)), in_quotes(scheme.color)));
    return fmt::format("[{}]", fmt::join(rows, ","));
  });
}

const char* explorer_trilinear(const int* size, const double* voxels, const double* ray) {
  return answered([&]() -> std::string {
    Grid grid{.size = {size[0], size[1], size[2]}, .values = {}};
    for (int axis = 0; axis < 3; ++axis)
      if (size[axis] < 1 || size[axis] > 1024) throw InputError("1 to 1024 voxels on each axis are allowed");
    const std::int64_t count = grid.size[0] * grid.size[1] * grid.size[2];
    if (count > most_voxels) throw InputError("at most 2^20 voxels are allowed");
    grid.values.assign(voxels, voxels + count);
    for (const double value : grid.values)
      if (!std::isfinite(value)) throw InputError("a voxel is not a finite number");
    return trace(grid, ray_of(ray));
  });
}

const char* explorer_marschner_lobb(int samples, const double* ray) {
  return answered([&]() -> std::string {
    if (samples < 2 || samples > 100) throw InputError("2 to 100 nodes on each axis are allowed");
    return trace(sampled_marschner_lobb(samples), ray_of(ray));
  });
}

const char* explorer_polynomials(int pieces, const double* breaks, int count, const double* coefficients) {
  return answered([&]() -> std::string {
    const std::vector<double> places(breaks, breaks + pieces + 1);
    std::vector<std::vector<double>> powers;
    for (int piece = 0; piece < pieces; ++piece) {
      const double* const first = coefficients + std::ptrdiff_t{piece} * count;
      powers.emplace_back(first, first + count);
    }
    Signal<largest_degree> signal;
    signal.chain = piecewise_polynomial(places, powers);
    signal.error = piecewise_polynomial_error(places, powers, signal.chain);
    signal.precise = precise_piecewise_polynomial(places, powers);
    choice().signal = std::move(signal);
    return length_json(places.back());
  });
}

const char* explorer_transfer(int count, const double* points, double unit_length, int is_plain) {
  return answered([&]() -> std::string {
    std::vector<TransferPoint> extinctions;
    std::vector<OpacityPoint> opacities;
    for (int i = 0; i < count; ++i) {
      const double* const point = points + std::ptrdiff_t{5} * i;
      const Vector3<double> color{point[2], point[3], point[4]};
      extinctions.push_back({point[0], {point[1], color}});
      opacities.push_back({point[0], point[1], color});
    }
    const PiecewiseLinear transfer =
        unit_length != 0 ? from_opacity(opacities, unit_length) : PiecewiseLinear(extinctions);
    const Emission emission = is_plain != 0 ? Emission::plain : Emission::associated;
    (void)RayIntegral(transfer, emission);  // refuses numbers that it cannot calculate with
    choice().transfer = transfer;
    choice().emission = emission;
    return "{}";
  });
}

const char* explorer_answer(double step, double phase) {
  return answered([&] {
    return std::visit([&](const auto& signal) { return answer_json(signal, step, phase); }, choice().signal);
  });
}

const char* explorer_curves(const char* scheme, double step, double phase, int count) {
  return answered([&] {
    return std::visit([&](const auto& signal) { return curves_json(signal, scheme, step, phase, count); },
                      choice().signal);
  });
}
