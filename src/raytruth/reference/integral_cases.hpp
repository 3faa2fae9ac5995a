#pragma once

#include "raytruth/core/chain.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <array>
#include <cstdint>
#include <string_view>
#include <variant>

namespace raytruth {

/// A ray and a transfer function at random, to prove a reference with.
struct IntegralCase {
  std::variant<Chain<3>, Chain<9>> signal;
  PiecewiseLinear transfer;
};

/// What the signal does: polynomials of random degree and coefficients; constants, at points of the transfer function
/// and beside them; parabolas whose tops are at a point, or within rounding of it; nothing but rounding about a point;
/// pieces of length 1e-9 to 1.
enum class SignalShape { random, constant, tangent, level, short_pieces };
inline constexpr std::array<std::string_view, 5> signal_shapes{"random", "constant", "tangent", "level",
                                                               "short_pieces"};

/// What the transfer function is: a ramp, a tent of width 0.02, a box, a step, an isoslab of width 1/256, a random
/// table of 257 points, random points, random points of which each is a jump.
enum class TransferShape { ramp, tent, box, step, isoslab, table, points, jumps };
inline constexpr std::array<std::string_view, 8> transfer_shapes{"ramp",    "tent",  "box",    "step",
                                                                 "isoslab", "table", "points", "jumps"};

/// What a transfer function is that is linear in opacity: one interval up to 0.99; random points, or jumps, up to 0.99;
/// a random table of 257 points; random points of which each has opacity 1 or one below, contacts; a stretch of opacity
/// 1 between others.
enum class OpacityShape { ramp, points, jumps, table, contacts, opaque };
inline constexpr std::array<std::string_view, 6> opacity_shapes{"ramp",  "points",   "jumps",
                                                                "table", "contacts", "opaque"};

/// Case `index` of a seed: one polynomial between two points of the transfer function, of degree 3 or up to 9, the
/// optical depth log-uniform from 1e-3 to 30.
IntegralCase smooth_piece(std::uint64_t seed, std::uint64_t index);

/// A `smooth_piece` between two opacities up to 0.99; the optical depth is that of the signal's mean.
IntegralCase smooth_opacity_piece(std::uint64_t seed, std::uint64_t index);

/// Case `index` of a seed: 1 to 10 pieces of these shapes; the largest extinction times the length is log-uniform from
/// 1e-9 to 1e5. A function of its arguments alone.
IntegralCase random_case(SignalShape signal, TransferShape transfer, std::uint64_t seed, std::uint64_t index);

/// A random ray with the opacity linear between points; it is 1e-3 to 30 times as long as what the opacities are of.
IntegralCase random_opacity_case(SignalShape signal, OpacityShape transfer, std::uint64_t seed, std::uint64_t index);

/// The largest difference of a channel or of the opacity, in units of the sum of both radii: above 1 one of them is no
/// bound. Infinite where an answer is not a number.
double difference_in_radii(const Certified& a, const Certified& b);

}  // namespace raytruth
