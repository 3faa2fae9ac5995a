#pragma once

#include "raytruth/core/chain.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/schemes/integral_scheme.hpp"
#include "raytruth/schemes/optics_lookup.hpp"
#include "raytruth/tables/table3.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

namespace raytruth {

/// As many iterations as Nyquist's theorem asks for (El Hajjar 2008, section 7): two for each entry of an 8-bit
/// transfer function that the fastest part of the parabola P(t) = A t^2 + B t + C crosses in the time of the slab,
///
///     N = max(8, ceil(2 max(|B|, |2 A + B|))),  P in units of 1/255 of the scalar range,
///
/// |P'| being largest at an end. Up to 2040, not 256 as the paper has it.
struct NyquistIterations {};

/// How a slab of second order is integrated; Ideal: exactly.
using SecondOrderMethod = std::variant<Iterations, NyquistIterations, Ideal>;

/// Steps that Nyquist's theorem asks for.
int nyquist_iterations(const TableAxes& axes, const std::array<double, 3>& scalars);

/// Slabs of second order (El Hajjar 2008, section 6.2): the scalar is the parabola through front, middle and back
/// scalar, clamped to the range of the axes. N iterations look the transfer function up at (k + 1/2) / N (or k / N) and
/// composite homogeneous steps, opacity 1 - exp(-tau length / N). Exact ones are certified: between the transfer
/// function's points by the reference.
///
/// Holds buffers: one object per thread.
class SecondOrderSlabs {
 public:
  using vec4 = Rules<double>::vec4;

  /// Throws InputError as `check` and RayIntegral do.
  SecondOrderSlabs(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission);

  /// The slab whose scalar is front, middle and back at 0, 1/2 and 1.
  vec4 operator()(const std::array<double, 3>& scalars, const SecondOrderMethod& method);

  /// The exact one, with the reference's radius.
  Certified certified(const std::array<double, 3>& scalars);

  /// Places where the transfer function was looked up so far, or nodes of quadratures.
  [[nodiscard]] std::int64_t evaluations() const { return evaluations_; }

 private:
  vec4 iterated(const std::array<double, 3>& scalars, const Iterations& iterations);

  TableAxes axes_;
  OpticsLookup<double> look_up_;
  RayIntegral integrate_;
  Chain<3> slab_;
  std::int64_t evaluations_ = 0;
};

/// The table of all slabs. Throws InputError as Table3 and SecondOrderSlabs do. Where `is_linear_between_entries`
/// allows it, iterations and exact slabs of associated emission go by the kernels of fast_second_order.hpp, in
/// binary32: errors of some 1e-6.
Table3<float> second_order_table(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission,
                                 const SecondOrderMethod& method);

/// A way to a table over three scalars: a row of the list below.
struct SecondOrderBuilder {
  std::string_view name;
  std::string_view summary;
  std::string_view source;
  bool takes_iterations;  ///< else `method` leaves its argument alone
  SecondOrderMethod (*method)(int iterations);
};

namespace catalogue {

inline constexpr std::array second_order_builders{
    SecondOrderBuilder{"second_order_exact",
                       "slabs of parabolas, over front, middle and back scalar: every entry exactly", "this project",
                       false, [](int /*iterations*/) -> SecondOrderMethod { return Ideal{}; }},
    SecondOrderBuilder{"second_order_nyquist", "the same by as many steps as Nyquist's theorem asks for",
                       "El Hajjar 2008, section 7", false,
                       [](int /*iterations*/) -> SecondOrderMethod { return NyquistIterations{}; }},
    SecondOrderBuilder{"second_order_iterations", "the same by \"iterations\" steps", "El Hajjar 2008, section 7", true,
                       [](int iterations) -> SecondOrderMethod { return Iterations{iterations}; }},
};

}  // namespace catalogue

}  // namespace raytruth
