// What numpy costs: a batch of 10^5 rays, and a call with almost nothing to do, by the Python module and by the
// library. CPU time of the process; both sides run on one thread, in turn.

#include "paired.hpp"
#include "raytruth/reference/ray_truth.hpp"
#include "raytruth/signals/piecewise_polynomial.hpp"
#include "raytruth/signals/random_field.hpp"
#include "raytruth/signals/ray_ensemble.hpp"
#include "raytruth/signals/ray_field.hpp"

#include <benchmark/benchmark.h>
#include <pybind11/embed.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <vector>

namespace raytruth {
namespace {

namespace py = pybind11;

constexpr std::size_t ray_count = 100'000;
constexpr double ray_length = 12;

const Grid& field() {
  static const Grid smooth = random_field(64, 1, 1);
  return smooth;
}

const std::vector<Ray>& rays() {
  static const std::vector<Ray> all = [] {
    std::vector<Ray> list;
    for (std::uint64_t i = 0; i < ray_count; ++i) list.push_back(random_ray(field(), ray_length, 1, i));
    return list;
  }();
  return all;
}

PiecewiseLinear transfer() {
  return PiecewiseLinear({{0.2, {0, {0.9, 0.5, 0.4}}}, {0.5, {0.3, {1, 0.9, 0.8}}}, {1, {2, {0.4, 0.7, 0.9}}}});
}

/// The interpreter, and what its calls are given; it lives as long as the program.
struct Python {
  Python() {
    module = py::module_::import("raytruth");
    const auto& size = field().size;
    py::array_t<double> voxels({size[2], size[1], size[0]}, field().values.data());
    volume = module.attr("Volume")(voxels);
    py::list s;
    py::list extinctions;
    py::list colors;
    const PiecewiseLinear stated = transfer();
    for (const TransferPoint& point : stated.points()) {
      s.append(point.s);
      extinctions.append(point.optics.extinction);
      colors.append(py::make_tuple(point.optics.color[0], point.optics.color[1], point.optics.color[2]));
    }
    function = module.attr("TransferFunction").attr("from_extinctions")(s, extinctions, colors);
    py::array_t<double> from({ray_count, std::size_t{3}});
    py::array_t<double> along({ray_count, std::size_t{3}});
    for (std::size_t i = 0; i < ray_count; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        from.mutable_at(i, axis) = rays()[i].origin[axis];
        along.mutable_at(i, axis) = rays()[i].direction[axis];
      }
    origins = from;
    directions = along;
    signal = module.attr("Signal")(std::vector<double>{0, 1}, std::vector<std::vector<double>>{{0.3, 0.1}});
  }

  py::scoped_interpreter interpreter;
  py::module_ module;
  py::object volume;
  py::object function;
  py::object origins;
  py::object directions;
  py::object signal;
};

Python& python() {
  static auto* const started = new Python();  // NOLINT(cppcoreguidelines-owning-memory): Python ends with the process
  return *started;
}

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

template <class Work>
double cpu_seconds_of(const Work& work) {
  const double begin = cpu_seconds();
  work();
  return cpu_seconds() - begin;
}

/// Reports the CPU time of both, and what the subject's is over the peer's.
template <class Subject, class Peer>
void run_in_turn(benchmark::State& state, const Subject& subject, const Peer& peer) {
  double of_subject = 0;
  double of_peer = 0;
  for ([[maybe_unused]] auto _ : state) {
    const double first = cpu_seconds_of(subject);
    const double second = cpu_seconds_of(peer);
    of_subject += first;
    of_peer += second;
    state.SetIterationTime(first + second);
  }
  const auto iterations = static_cast<double>(state.iterations());
  state.counters["subject_seconds"] = of_subject / iterations;
  state.counters["peer_seconds"] = of_peer / iterations;
  state.counters["overhead_percent"] = 100 * (of_subject / of_peer - 1);
}

void batch_of_rays(benchmark::State& state) {
  Python& py = python();
  const auto by_python = [&py] {
    using namespace pybind11::literals;
    benchmark::DoNotOptimize(py.module.attr("rays")(py.volume, py.function, py.origins, py.directions,
                                                    "lengths"_a = ray_length, "threads"_a = 1));
  };
  std::vector<Certified> found(ray_count);
  const auto by_library = [&found] {
    const TrilinearField traced(field());
    RayIntegral integral(transfer(), Emission::associated);
    Chain<3> chain;
    for (std::size_t i = 0; i < ray_count; ++i) {
      Ray ray = rays()[i];
      ray.length = ray_length;
      traced.trace(ray, chain);
      found[i] = ray_truth(integral, chain, traced.error(ray, chain), [&] { return traced.trace_precisely(ray); });
    }
    benchmark::DoNotOptimize(found.data());
  };
  run_in_turn(state, by_python, by_library);
}
BENCHMARK(batch_of_rays)->Unit(benchmark::kMillisecond)->UseManualTime()->Iterations(5);

/// A thousand calls each, of a ray of one piece.
void small_call(benchmark::State& state) {
  Python& py = python();
  constexpr int calls = 1000;
  const py::object call = py.module.attr("integral");
  const auto by_python = [&] {
    for (int i = 0; i < calls; ++i) benchmark::DoNotOptimize(call(py.signal, py.function));
  };
  const std::vector<double> breaks{0, 1};
  const std::vector<std::vector<double>> coefficients{{0.3, 0.1}};
  const auto chain = piecewise_polynomial(breaks, coefficients);
  const SignalError error = piecewise_polynomial_error(breaks, coefficients, chain);
  RayIntegral integral(transfer(), Emission::associated);
  const auto by_library = [&] {
    for (int i = 0; i < calls; ++i) benchmark::DoNotOptimize(integral(chain, error));
  };
  run_in_turn(state, by_python, by_library);
  state.counters["microseconds_of_a_call"] =
      1e6 * (state.counters["subject_seconds"].value - state.counters["peer_seconds"].value) / calls;
}
BENCHMARK(small_call)->Unit(benchmark::kMillisecond)->UseManualTime()->Iterations(20);

}  // namespace
}  // namespace raytruth
