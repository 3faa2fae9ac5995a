#include "tables/second_order.hpp"

#include "schemes/slab_integrals.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
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

PiecewiseLinear clamped(const PiecewiseLinear& transfer, double low, double high) {
  std::vector<TransferPoint> points{{low, transfer.at(low)}};
  for (const TransferPoint& point : transfer.points())
    if (low < point.s && point.s < high) points.push_back(point);
  // A jump at the upper end is met only from below, but for the end itself, which has no extent.
  const auto& all = transfer.points();
  const auto at_high =
      std::find_if(all.begin(), all.end(), [high](const TransferPoint& point) { return point.s == high; });
  points.push_back({high, at_high != all.end() ? at_high->optics : transfer.at(high)});
  return PiecewiseLinear(std::move(points));
}

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
  const Certified slab = integrate_(slab_);
  evaluations_ += slab.evaluations;
  return slab;
}

Table3<float> second_order_table(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission,
                                 const SecondOrderMethod& method) {
  Table3<float> table(axes);
  const auto* const iterations = std::get_if<Iterations>(&method);
  if (iterations != nullptr && emission == Emission::associated && is_linear_between_entries(transfer, axes)) {
    fill_second_order_table(table, transfer, *iterations, *slab_kernel_versions().front());
    return table;
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

bool is_linear_between_entries(const PiecewiseLinear& transfer, const TableAxes& axes) {
  const auto& points = transfer.points();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double place = (points[i].s - axes.low) / (axes.high - axes.low) * static_cast<double>(axes.size - 1);
    if (std::abs(place - std::round(place)) > 1e-9) return false;
    if (i > 0 && points[i - 1].s == points[i].s) return false;
  }
  return true;
}

void fill_second_order_table(Table3<float>& table, const PiecewiseLinear& transfer, const Iterations& iterations,
                             const SlabKernels& kernels) {
  const TableAxes& axes = table.axes;
  constexpr std::size_t padding = 16;
  constexpr double most_rate = 0.5;
  const std::size_t n = axes.size;
  const double step = axes.length / iterations.count;

  // The rate and three channels, each with its differences behind it.
  std::array<std::vector<float>, 4> values;
  std::array<std::vector<float>, 4> differences;
  for (auto* const lists : {&values, &differences})
    for (auto& list : *lists) list.resize(n + padding);
  double largest_rate = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Optics optics = transfer.at(axes.scalar(i));
    const double rate = optics.extinction * step * std::numbers::log2e;
    largest_rate = std::max(largest_rate, rate);
    values[3][i] = static_cast<float>(rate);
    for (std::size_t c = 0; c < 3; ++c) values[c][i] = static_cast<float>(optics.color[static_cast<Eigen::Index>(c)]);
  }
  for (std::size_t c = 0; c < 4; ++c)
    for (std::size_t i = 0; i + 1 < n; ++i) differences[c][i] = values[c][i + 1] - values[c][i];
  const TransferEntries entries{
      .count = n,
      .rate = values[3].data(),
      .rate_difference = differences[3].data(),
      .color = {values[0].data(), values[1].data(), values[2].data()},
      .color_difference = {differences[0].data(), differences[1].data(), differences[2].data()}};
  std::array<std::vector<float>, 3> weights;
  for (int k = 0; k < iterations.count; ++k) {
    const double t = (k + (iterations.is_left ? 0 : 0.5)) / iterations.count;
    weights[0].push_back(static_cast<float>((1 - t) * (1 - 2 * t)));
    weights[1].push_back(static_cast<float>(4 * t * (1 - t)));
    weights[2].push_back(static_cast<float>(t * (2 * t - 1)));
  }
  const SecondOrderSteps steps{.count = weights[0].size(),
                               .front_weight = weights[0].data(),
                               .middle_weight = weights[1].data(),
                               .back_weight = weights[2].data(),
                               .is_thin = largest_rate <= most_rate};
  tbb::parallel_for(std::size_t{0}, n, [&](std::size_t back) {
    for (std::size_t middle = 0; middle < n; ++middle)
      kernels.second_order_row(entries, steps, middle, back, table.texel(0, middle, back));
  });
}

}  // namespace raytruth
