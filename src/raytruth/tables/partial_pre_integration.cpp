#include "raytruth/tables/partial_pre_integration.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/reference/piece_integral.hpp"
#include "raytruth/tables/look_up.hpp"
#include "raytruth/transfer/emission.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>
#include <utility>

namespace raytruth {

namespace {

/// The axes of the table over gamma.
TableAxes gamma_axes(std::size_t size) { return {.size = size, .low = 0, .high = 1, .length = 1}; }

double gamma_of(double depth) { return std::isinf(depth) ? 1 : depth / (depth + 1); }
double depth_of(double gamma) { return gamma < 1 ? gamma / (1 - gamma) : std::numeric_limits<double>::infinity(); }

}  // namespace

double partial_pre_integration_psi(double front_depth, double back_depth) {
  if (std::isinf(front_depth) || std::isinf(back_depth)) return 0;
  // The certified weight of the back colour is psi - zeta.
  const LinearPiece<3> piece{
      .x = {0, 1.0 / 3, 2.0 / 3, 1}, .extinction_at_0 = front_depth, .extinction_at_1 = back_depth, .length = 1};
  const PieceIntegral<> integral = integrate(piece, Emission::associated);
  return integral.weight_1 + std::exp(-integral.depth);
}

PsiTable::PsiTable(std::size_t size) : size_(size) {
  const TableAxes axes = gamma_axes(size);
  check(axes);
  values_.resize(size * size);
  tbb::parallel_for(std::size_t{0}, size, [&](std::size_t back) {
    for (std::size_t front = 0; front < size; ++front)
      values_[back * size + front] =
          partial_pre_integration_psi(depth_of(axes.scalar(front)), depth_of(axes.scalar(back)));
  });
}

PsiTable::PsiTable(std::size_t size, std::vector<double> values) : size_(size), values_(std::move(values)) {
  if (values_.size() != size * size)
    throw InputError(fmt::format("{} numbers; {} x {} are allowed", values_.size(), size, size));
}

double PsiTable::operator()(double front_depth, double back_depth, PsiLookUp look_up) const {
  const TableAxes axes = gamma_axes(size_);
  const auto front = TablePlace<double>::of(axes, gamma_of(front_depth), 0);
  const auto back = TablePlace<double>::of(axes, gamma_of(back_depth), 0);
  if (look_up == PsiLookUp::nearest) return values_[back.nearest() * size_ + front.nearest()];
  const auto row = [&](std::size_t b) {
    return std::lerp(values_[b * size_ + front.first], values_[b * size_ + front.second], front.weight);
  };
  return std::lerp(row(back.first), row(back.second), back.weight);
}

Rules<double>::vec4 partially_pre_integrated_slab(const Optics& front, const Optics& back, double length, double psi) {
  const double opacity = Rules<double>{}.absorption(0.5 * length * (front.extinction + back.extinction), false);
  const Vector3<double> color = (1 - psi) * front.color + (psi - (1 - opacity)) * back.color;
  return {color[0], color[1], color[2], opacity};
}

}  // namespace raytruth
