// Nanoseconds per shaded slab, tables at hand: of every method in binary64, in binary32, and on a register of binary32
// numbers; the quadratic arc against linear interpolation, with the look-ups of their tables (claim guetat-cost).

#include "paired.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/rules/rules.hpp"
#include "raytruth/shading/slab_shading.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/study_transfers.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

namespace raytruth {

/// Eight binary32 numbers side by side, as the rules' `real`.
struct Wide {
  using Vector = float __attribute__((vector_size(32)));
  Vector vector{};

  Wide() = default;
  Wide(double x) : vector(static_cast<float>(x) - Vector{}) {}  // NOLINT(google-explicit-constructor)
  static Wide of(Vector vector) {
    Wide result;
    result.vector = vector;
    return result;
  }
  friend Wide operator+(const Wide& a, const Wide& b) { return of(a.vector + b.vector); }
  friend Wide operator-(const Wide& a, const Wide& b) { return of(a.vector - b.vector); }
  friend Wide operator*(const Wide& a, const Wide& b) { return of(a.vector * b.vector); }
  friend Wide operator/(const Wide& a, const Wide& b) { return of(a.vector / b.vector); }
  friend Wide sqrt(Wide a) {
    for (std::size_t i = 0; i < 8; ++i) a.vector[i] = std::sqrt(a.vector[i]);
    return a;
  }
};

/// max(0, x) lane by lane; what has branches in its text has no other form here.
template <class Real>
Real positive(const Real& x) {
  return Rules<Real>{}.lighting_clamped(x);
}
template <>
Wide positive(const Wide& x) {
  return Wide::of(x.vector > 0.0F ? x.vector : Wide::Vector{});
}

namespace {

/// What a renderer knows of a slab besides its table entries.
template <class Real>
struct Slab {
  Real light_front, light_back, half_front, half_back, cosine;
};

/// Table entries: of 1, s, s^2, s^3, the light with colour and, last, white.
template <class Real>
using Entries = std::array<typename Rules<Real>::vec4, 4>;

constexpr double shininess = 20;
constexpr std::size_t slab_count = 1 << 14;
constexpr int table_size = 256;

/// Light of a slab from `Count` tables, diffuse in three channels and, last, the cone's.
template <std::size_t Count, class Real>
typename Rules<Real>::vec4 light_of(const typename Rules<Real>::vec4& light, const typename Rules<Real>::vec4& cone,
                                    const Entries<Real>& entries) {
  typename Rules<Real>::vec4 sum = light[0] * entries[0];
  Real highlight = cone[0] * entries[0][3];
  for (std::size_t k = 1; k < Count; ++k) {
    const auto power = static_cast<Eigen::Index>(k);
    sum = sum + light[power] * entries[k];
    highlight = highlight + cone[power] * entries[k][3];
  }
  sum[3] = highlight;
  return sum;
}

struct MeanGradient {
  static constexpr std::size_t tables = 1;
  template <class Real>
  static auto curve(Real front, Real back, Real cosine) {
    return Rules<Real>{}.mean_gradient(front, back, cosine);
  }
};
struct LinearGradient {
  static constexpr std::size_t tables = 2;
  template <class Real>
  static auto curve(Real front, Real back, Real /*cosine*/) {
    return Rules<Real>{}.linear_gradient(front, back);
  }
};
struct LinearIntensity {
  static constexpr std::size_t tables = 2;
  template <class Real>
  static auto curve(Real front, Real back, Real /*cosine*/) {
    return Rules<Real>{}.linear_gradient(positive(front), positive(back));
  }
};
struct QuadraticArc {
  static constexpr std::size_t tables = 4;
  template <class Real>
  static auto curve(Real front, Real back, Real cosine) {
    return Rules<Real>{}.quadratic_arc(front, back, cosine);
  }
};
struct CircleArcTuned {
  static constexpr std::size_t tables = 4;
  template <class Real>
  static auto curve(Real front, Real back, Real cosine) {
    return Rules<Real>{}.circle_arc_tuned(front, back, cosine);
  }
};
struct MinimaxArc {
  static constexpr std::size_t tables = 4;
  template <class Real>
  static auto curve(Real front, Real back, Real cosine) {
    return Rules<Real>{}.minimax_arc(front, back, cosine);
  }
};

template <class Method, class Real>
typename Rules<Real>::vec4 shaded(const Slab<Real>& slab, const Entries<Real>& entries) {
  const auto light = Method::template curve<Real>(slab.light_front, slab.light_back, slab.cosine);
  const auto cone = Rules<Real>{}.fades_cone(Method::template curve<Real>(slab.half_front, slab.half_back, slab.cosine),
                                             Real(shininess));
  return light_of<Method::tables, Real>(light, cone, entries);
}

/// Guetat's three cases, with the tent's table in place of a fifth one.
template <class Real>
typename Rules<Real>::vec4 faded(const Slab<Real>& slab, const Entries<Real>& entries) {
  using Vec4 = typename Rules<Real>::vec4;
  Rules<Real> rules;
  const Vec4 light = rules.quadratic_arc(slab.light_front, slab.light_back, slab.cosine);
  const Vec4 cone =
      rules.fades_cone(rules.quadratic_arc(slab.half_front, slab.half_back, slab.cosine), Real(shininess));
  const auto moments = [&entries](Eigen::Index channel) {
    return Vec4{entries[0][channel], entries[1][channel], entries[2][channel], entries[3][channel]};
  };
  Vec4 result;
  for (Eigen::Index i = 0; i < 3; ++i)
    result[i] = rules.fades_integral(moments(i), light, slab.light_front, slab.light_back);
  const Real n(shininess);
  result[3] = rules.fades_highlight(moments(3), entries[1][3], cone, Real(1) + n * (slab.half_front - Real(1)),
                                    Real(1) + n * (slab.half_back - Real(1)));
  return result;
}

template <class Real>
struct Inputs {
  std::vector<Slab<Real>> slabs;
  std::vector<Entries<Real>> entries;
};

template <class Real>
Inputs<Real> make_inputs() {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto cosine = [&] { return Real(uniform(generator)); };
  Inputs<Real> inputs;
  for (std::size_t i = 0; i < slab_count; ++i) {
    inputs.slabs.push_back({cosine(), cosine(), cosine(), cosine(), cosine()});
    Entries<Real> entries;
    for (auto& entry : entries) entry = {cosine(), cosine(), cosine(), cosine()};
    inputs.entries.push_back(entries);
  }
  return inputs;
}

template <class Real, class Work>
void per_slab(benchmark::State& state, std::size_t lanes, const Work& work) {
  const Inputs<Real> inputs = make_inputs<Real>();
  for ([[maybe_unused]] auto _ : state)
    for (std::size_t i = 0; i < slab_count; ++i) {
      auto light = work(inputs.slabs[i], inputs.entries[i]);
      benchmark::DoNotOptimize(light);
    }
  state.counters["nanoseconds_per_slab"] =
      benchmark::Counter(static_cast<double>(slab_count * lanes) * 1e-9,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

template <class Method, class Real>
void shade_slabs(benchmark::State& state) {
  per_slab<Real>(state, sizeof(Real) == sizeof(Wide) ? 8 : 1, shaded<Method, Real>);
}

template <class Real>
void fade_slabs(benchmark::State& state) {
  per_slab<Real>(state, 1, faded<Real>);
}

BENCHMARK(shade_slabs<MeanGradient, double>);
BENCHMARK(shade_slabs<MeanGradient, Binary32>);
BENCHMARK(shade_slabs<MeanGradient, Wide>);
BENCHMARK(shade_slabs<LinearGradient, double>);
BENCHMARK(shade_slabs<LinearGradient, Binary32>);
BENCHMARK(shade_slabs<LinearGradient, Wide>);
BENCHMARK(shade_slabs<LinearIntensity, double>);
BENCHMARK(shade_slabs<LinearIntensity, Binary32>);
BENCHMARK(shade_slabs<LinearIntensity, Wide>);
BENCHMARK(shade_slabs<QuadraticArc, double>);
BENCHMARK(shade_slabs<QuadraticArc, Binary32>);
BENCHMARK(shade_slabs<QuadraticArc, Wide>);
BENCHMARK(shade_slabs<CircleArcTuned, double>);
BENCHMARK(shade_slabs<CircleArcTuned, Binary32>);
BENCHMARK(shade_slabs<CircleArcTuned, Wide>);
BENCHMARK(shade_slabs<MinimaxArc, double>);
BENCHMARK(shade_slabs<MinimaxArc, Binary32>);
BENCHMARK(shade_slabs<MinimaxArc, Wide>);
BENCHMARK(fade_slabs<double>);
BENCHMARK(fade_slabs<Binary32>);

// --- Guetat's cost: the same with bilinear look-ups ---

using Vec4 = Rules<Binary32>::vec4;

/// A table of a moment over front and back scalars.
using Table = std::vector<Vec4>;

std::array<Table, 4> make_tables() {
  std::array<Table, 4> tables;
  const PiecewiseLinear transfer = tent_transfer(4);
  for (Table& table : tables) table.resize(std::size_t{table_size} * table_size);
  for (std::size_t back = 0; back < table_size; ++back)
    for (std::size_t front = 0; front < table_size; ++front) {
      const auto scalar = [](std::size_t i) { return static_cast<double>(i) / (table_size - 1); };
      const auto moments = slab_moments(SlabOptics(transfer, scalar(front), scalar(back), 1), Emission::associated);
      for (std::size_t k = 0; k < 4; ++k) {
        const auto& c = moments.colored[k];
        tables[k][back * table_size + front] = {c[0], c[1], c[2], moments.white[k]};
      }
    }
  return tables;
}

Vec4 look_up(const Table& table, float front, float back) {
  const auto place = [](float s) { return s * (table_size - 1); };
  const auto column = static_cast<std::size_t>(place(front));
  const auto row = static_cast<std::size_t>(place(back));
  const Binary32 u = place(front) - static_cast<float>(column);
  const Binary32 v = place(back) - static_cast<float>(row);
  const Vec4* const corner = table.data() + row * table_size + column;
  const auto mix = [](const Vec4& a, const Vec4& b, Binary32 weight) { return Vec4(a + weight * (b - a)); };
  return mix(mix(corner[0], corner[1], u), mix(corner[table_size], corner[table_size + 1], u), v);
}

template <class Method>
double shade_by_tables(const std::array<Table, 4>& tables, const std::vector<std::array<float, 2>>& scalars,
                       const std::vector<Slab<Binary32>>& slabs) {
  Vec4 sum = Vec4::Constant(0.0);
  for (std::size_t i = 0; i < slabs.size(); ++i) {
    Entries<Binary32> entries;
    for (std::size_t k = 0; k < Method::tables; ++k) entries[k] = look_up(tables[k], scalars[i][0], scalars[i][1]);
    sum = sum + shaded<Method>(slabs[i], entries);
  }
  return to_double(sum[0]) + to_double(sum[3]);
}

/// Scalars of consecutive samples are close in coherent rays, anywhere in random ones.
template <class Method>
void linear_against_arc(benchmark::State& state) {
  const bool is_coherent = state.range(0) != 0;
  static const auto tables = make_tables();
  const auto slabs = make_inputs<Binary32>().slabs;
  std::mt19937 generator(2);
  std::uniform_real_distribution<float> uniform(0, 0.999F);
  std::vector<std::array<float, 2>> scalars;
  float s = 0.5F;
  for (std::size_t i = 0; i < slabs.size(); ++i) {
    const float next =
        is_coherent ? std::min(0.999F, std::max(0.0F, s + (uniform(generator) - 0.5F) * 0.05F)) : uniform(generator);
    scalars.push_back({s, next});
    s = next;
  }
  benchmarks::run_paired(
      state, [&] { return shade_by_tables<LinearGradient>(tables, scalars, slabs); },
      [&] { return shade_by_tables<Method>(tables, scalars, slabs); });
  const auto count = static_cast<double>(slabs.size());
  state.counters["linear_nanoseconds"] = 1e9 * state.counters["subject_seconds"] / count;
  state.counters["arc_nanoseconds"] = 1e9 * state.counters["peer_seconds"] / count;
  state.counters["slower"] = state.counters["speedup"] - 1;
}
BENCHMARK(linear_against_arc<QuadraticArc>)->Arg(0)->Arg(1)->UseManualTime();
BENCHMARK(linear_against_arc<MinimaxArc>)->Arg(0)->Arg(1)->UseManualTime();

// --- The integrals themselves, where no table is at hand ---

void integrate(benchmark::State& state, const Shading& shading) {
  Lighting lighting;
  lighting.specular = 1;
  lighting.highlight = find_named(catalogue::highlights(), "cone");
  const PiecewiseLinear transfer = tent_transfer(4);
  const SlabOptics optics(transfer, 0.42, 0.55, 1);
  const SlabCosines cosines{0.9, 0.3, 0.98, 0.8, 0.7};
  for ([[maybe_unused]] auto _ : state)
    benchmark::DoNotOptimize(shade(shading, cosines, optics, Emission::associated, lighting));
}

[[maybe_unused]] const bool are_registered = [] {
  for (const Shading& shading : catalogue::shadings())
    benchmark::RegisterBenchmark(("integrate/" + shading.name).c_str(),
                                 [&shading](benchmark::State& state) { integrate(state, shading); });
  return true;
}();

}  // namespace
}  // namespace raytruth
