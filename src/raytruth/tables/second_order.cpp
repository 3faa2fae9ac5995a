#include "raytruth/tables/second_order.hpp"

#include "raytruth/kernels/slab_kernels.hpp"
#include "raytruth/schemes/slab_integrals.hpp"
#include "raytruth/tables/fast_second_order.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace raytruth {

namespace {

constexpr int fewest_iterations = 8;
constexpr double steps_of_8_bits = 255;

/// A and B of P(t) = A t^2 + B t + C through the scalars at 0, 1/2 and 1 (El Hajjar 2008, eq. 2).
std::array<double, 2> parabola(const std::array<double, 3>& scalars) {
  const auto [front, middle, back] = scalars;
  return {2 * front - 4 * middle + 2 * back, -3 * front + 4 * middle - back};
}

Bernstein<3> signal_of(const std::array<double, 3>& scalars) {
  const auto [front, middle, back] = scalars;
  return Bernstein<2>{{front, 2 * middle - 0.5 * (front + back), back}}.elevated<3>();
}

}  // namespace

int nyquist_iterations(const TableAxes& axes, const std::array<double, 3>& scalars) {
  const auto [a, b] = parabola(scalars);
  const double fastest = std::max(std::abs(b), std::abs(2 * a + b)) * steps_of_8_bits / (axes.high - axes.low);
  return std::max(fewest_iterations, static_cast<int>(std::ceil(2 * fastest)));
}

SecondOrderSlabs::SecondOrderSlabs(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission)
    : axes_((check(axes), axes)),
      look_up_(clamped(transfer, axes.low, axes.high), emission),
      integrate_(clamped(transfer, axes.low, axes.high), emission),
      slab_{.pieces = {{.start = 0.0, .length = axes.length, .polynomial = {}}}, .end = axes.length} {}

SecondOrderSlabs::vec4 SecondOrderSlabs::operator()(const std::array<double, 3>& scalars,
                                                    const SecondOrderMethod& method) {
  if (const auto* const iterations = std::get_if<Iterations>(&method)) return iterated(scalars, *iterations);
  if (std::holds_alternative<NyquistIterations>(method))
    return iterated(scalars, {.count = nyquist_iterations(axes_, scalars)});
  const Certified exact = certified(scalars);
  return {exact.color[0], exact.color[1], exact.color[2], exact.opacity};
}

SecondOrderSlabs::vec4 SecondOrderSlabs::iterated(const std::array<double, 3>& scalars, const Iterations& iterations) {
  slab_.pieces.front().polynomial = signal_of(scalars);
  evaluations_ += iterations.count;
  return iterated_slab(slab_.pieces, look_up_, iterations);
}

Certified SecondOrderSlabs::certified(const std::array<double, 3>& scalars) {
  slab_.pieces.front().polynomial = signal_of(scalars);
  Certified slab = integrate_(slab_);
  evaluations_ += slab.evaluations;
  return slab;
}

Table3<float> second_order_table(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission,
                                 const SecondOrderMethod& method) {
  Table3<float> table(axes);
  if (emission == Emission::associated && is_linear_between_entries(transfer, axes)) {
    const SlabKernels& kernels = *slab_kernel_versions().front();
    if (const auto* const iterations = std::get_if<Iterations>(&method)) {
      fill_second_order_table(table, transfer, *iterations, kernels);
      return table;
    }
    if (std::holds_alternative<Ideal>(method)) {
      fill_exact_second_order_table(table, transfer, kernels);
      return table;
    }
  }
  tbb::parallel_for(std::size_t{0}, axes.size, [&](std::size_t back) {
    SecondOrderSlabs slab(transfer, axes, emission);
    for (std::size_t middle = 0; middle < axes.size; ++middle)
      for (std::size_t front = 0; front < axes.size; ++front)
        table.set(front, middle, back,
                  slab({axes.scalar(front), axes.scalar(middle), axes.scalar(back)}, method).cast<float>());
  });
  return table;
}

}  // namespace raytruth
