#pragma once

#include "raytruth/core/vector3.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

namespace raytruth {

/// In which space colours between the points of a colour map are interpolated, as VTK does it.
enum class ColorSpace {
  rgb,
  hsv,          ///< hue, saturation and value, hue the way that does not pass 0 (red)
  hsv_wrapped,  ///< the hue takes the shorter way instead
  lab,          ///< CIE L*a*b* of sRGB, D65
  diverging,    ///< Msh, by way of white between saturated colours (Moreland 2009)
  step,         ///< the colour of the upper point
};

/// A number or a colour at a scalar. At one scalar there may be two: the value from the left and that from the right.
/// The way to the next one is straight with the values below; else it is VTK's curve, which is half-way at `midpoint`,
/// a share of the interval, and the nearer a jump there the larger `sharpness`, from 0 to 1.
template <class Value>
struct Keyed {
  double s = 0;
  Value value = {};
  double midpoint = 0.5;
  double sharpness = 0;
};

/// Colour and opacity as other programs keep them: two lists of their own.
struct ColorMap {
  ColorSpace space = ColorSpace::rgb;
  bool is_logarithmic = false;  ///< colours are interpolated over log(s), not s
  std::vector<Keyed<Vector3<double>>> colors = {};
  std::vector<Keyed<double>> opacities = {};
};

/// The colour between two others, x = 0 ... 1 from `a` to `b`; channels of [0, 1] stay in it. What L*a*b* and Msh hold
/// beyond the colours of a screen is divided by its largest channel where that is above 1, and clamped at 0, as VTK
/// does.
Vector3<double> color_between(ColorSpace space, const Vector3<double>& a, const Vector3<double>& b, double x);

/// Whether `transfer_of` samples the map's colours, which are not linear in s between its points.
bool is_sampled(const ColorMap& map);

/// The transfer function of a colour map whose opacities are those of a length `unit_length`, linear between points. In
/// the spaces other than rgb and step, and over log(s), the colours are sampled at 1025 equally spaced scalars or
/// logarithms of them; a curve between two points at 257 places. Beyond both ends colour and opacity are constant.
/// Throws InputError unless both lists have items, sorted by s, at most two at one s, finite, opacities, channels,
/// midpoints and sharpnesses in [0, 1], scalars of logarithms > 0, and unit_length > 0.
PiecewiseLinear transfer_of(const ColorMap& map, double unit_length);

}  // namespace raytruth
