#include "raytruth/transfer/color_map.hpp"

#include "raytruth/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace raytruth {

namespace {

constexpr int samples_of_space = 1024;  // intervals
constexpr int samples_of_curve = 256;   // intervals

// --- Colour spaces ---

/// The reference white of D65.
const Vector3<double> white{0.9505, 1, 1.089};

double linear_light(double channel) {
  return channel > 0.04045 ? std::pow((channel + 0.055) / 1.055, 2.4) : channel / 12.92;
}

double encoded(double light) { return light > 0.0031308 ? 1.055 * std::pow(light, 1 / 2.4) - 0.055 : 12.92 * light; }

Vector3<double> lab_of(const Vector3<double>& rgb) {
  const Vector3<double> light = rgb.unaryExpr(&linear_light);
  const Vector3<double> xyz{light[0] * 0.4124 + light[1] * 0.3576 + light[2] * 0.1805,
                            light[0] * 0.2126 + light[1] * 0.7152 + light[2] * 0.0722,
                            light[0] * 0.0193 + light[1] * 0.1192 + light[2] * 0.9505};
  const Vector3<double> f =
      (xyz / white).unaryExpr([](double x) { return x > 0.008856 ? std::cbrt(x) : 7.787 * x + 16.0 / 116; });
  return {116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

Vector3<double> rgb_of_lab(const Vector3<double>& lab) {
  const double y = (lab[0] + 16) / 116;
  const Vector3<double> f{lab[1] / 500 + y, y, y - lab[2] / 200};
  const Vector3<double> xyz = white * f.unaryExpr([](double x) {
    const double cube = x * x * x;
    return cube > 0.008856 ? cube : (x - 16.0 / 116) / 7.787;
  });
  const Vector3<double> light{xyz[0] * 3.2406 - xyz[1] * 1.5372 - xyz[2] * 0.4986,
                              -xyz[0] * 0.9689 + xyz[1] * 1.8758 + xyz[2] * 0.0415,
                              xyz[0] * 0.0557 - xyz[1] * 0.2040 + xyz[2] * 1.0570};
  const Vector3<double> rgb = light.unaryExpr(&encoded);
  return (rgb / std::max(1.0, rgb.maxCoeff())).max(0);
}

Vector3<double> hsv_of(const Vector3<double>& rgb) {
  const double most = rgb.maxCoeff();
  const double spread = most - rgb.minCoeff();
  if (spread == 0) return {0, 0, most};
  double sixths = 0;
  if (rgb[0] == most)
    sixths = (rgb[1] - rgb[2]) / spread;
  else if (rgb[1] == most)
    sixths = 2 + (rgb[2] - rgb[0]) / spread;
  else
    sixths = 4 + (rgb[0] - rgb[1]) / spread;
  return {(sixths < 0 ? sixths + 6 : sixths) / 6, spread / most, most};
}

Vector3<double> rgb_of_hsv(const Vector3<double>& hsv) {
  const auto channel = [&hsv](double offset) {
    const double sixths = std::fmod(offset + 6 * hsv[0], 6);
    return hsv[2] * (1 - hsv[1] * std::clamp(std::min(sixths, 4 - sixths), 0.0, 1.0));
  };
  return {channel(5), channel(3), channel(1)};
}

/// Half-way round the circle of hues and more is the longer way: one hue is moved by a turn.
Vector3<double> wrapped_hsv_between(Vector3<double> a, Vector3<double> b, double x) {
  if (a[0] - b[0] > 0.5) a[0] -= 1;
  if (b[0] - a[0] > 0.5) b[0] -= 1;
  Vector3<double> hsv = a + x * (b - a);
  if (hsv[0] < 0) hsv[0] += 1;
  return rgb_of_hsv(hsv);
}

/// Polar coordinates of L*a*b*: magnitude, angle from the axis of greys, hue.
Vector3<double> msh_of(const Vector3<double>& rgb) {
  const Vector3<double> lab = lab_of(rgb);
  const double magnitude = lab.matrix().norm();
  const double saturation = magnitude > 0.001 ? std::acos(std::min(1.0, lab[0] / magnitude)) : 0;
  return {magnitude, saturation, saturation > 0.001 ? std::atan2(lab[2], lab[1]) : 0};
}

Vector3<double> rgb_of_msh(const Vector3<double>& msh) {
  return rgb_of_lab({msh[0] * std::cos(msh[1]), msh[0] * std::sin(msh[1]) * std::cos(msh[2]),
                     msh[0] * std::sin(msh[1]) * std::sin(msh[2])});
}

/// The hue that a grey of this magnitude is given at the end of a way from a colour, so that the way is even.
double hue_of_grey(const Vector3<double>& msh, double magnitude) {
  if (msh[0] >= magnitude - 0.1) return msh[2];
  const double spin = msh[1] * std::sqrt(magnitude * magnitude - msh[0] * msh[0]) / (msh[0] * std::sin(msh[1]));
  return msh[2] > -0.3 * std::numbers::pi ? msh[2] + spin : msh[2] - spin;
}

double hue_difference(double a, double b) {
  const double difference = std::abs(a - b);
  return std::min(difference, 2 * std::numbers::pi - difference);
}

/// K. Moreland, Diverging color maps for scientific visualization, 2009.
Vector3<double> diverging_between(Vector3<double> a, Vector3<double> b, double x) {
  constexpr double grey = 0.05;  // saturations below are none
  constexpr double whitest = 88;
  a = msh_of(a);
  b = msh_of(b);
  if (a[1] > grey && b[1] > grey && hue_difference(a[2], b[2]) > 0.33 * std::numbers::pi) {
    const Vector3<double> middle{std::max({a[0], b[0], whitest}), 0, 0};
    if (x < 0.5) {
      b = middle;
      x = 2 * x;
    } else {
      a = middle;
      x = 2 * x - 1;
    }
  }
  if (a[1] < grey && b[1] > grey)
    a[2] = hue_of_grey(b, a[0]);
  else if (b[1] < grey && a[1] > grey)
    b[2] = hue_of_grey(a, b[0]);
  return rgb_of_msh(a + x * (b - a));
}

// --- Functions of the scalar ---

void check_share(double value, std::string_view what) {
  if (!(value >= 0 && value <= 1))
    throw InputError(fmt::format("found {} {}; a number from 0 to 1 is allowed", what, value));
}

template <class Value>
void check_keys(const std::vector<Keyed<Value>>& keys, std::string_view what) {
  if (keys.empty()) throw InputError(fmt::format("found no {}; one or more are allowed", what));
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (!std::isfinite(keys[i].s))
      throw InputError(fmt::format("found scalar {} among {}; finite ones are allowed", keys[i].s, what));
    if (i > 0 && keys[i].s < keys[i - 1].s)
      throw InputError(
          fmt::format("found scalar {} after {} among {}; ascending ones are allowed", keys[i].s, keys[i - 1].s, what));
    if (i > 1 && keys[i].s == keys[i - 2].s)
      throw InputError(fmt::format("found a third of the {} at scalar {}; at most two are allowed", what, keys[i].s));
    check_share(keys[i].midpoint, "midpoint");
    check_share(keys[i].sharpness, "sharpness");
  }
}

// --- Curves between keys ---

/// Where a scalar lies between two others, from 0 to 1, and the way back: in s itself or in its logarithm.
struct Scale {
  bool is_logarithmic = false;

  [[nodiscard]] double share(double s, double low, double high) const {
    return is_logarithmic ? std::log(s / low) / std::log(high / low) : (s - low) / (high - low);
  }
  [[nodiscard]] double at(double share, double low, double high) const {
    return is_logarithmic ? low * std::pow(high / low, share) : std::lerp(low, high, share);
  }
};

/// VTK takes curves that are nearly a jump for one, and those that are nearly straight for a line.
constexpr double jump_sharpness = 0.99;
constexpr double straight_sharpness = 0.01;

/// The share of the way from one value to the next, x = 0 ... 1 of the way from one scalar to the next: a line broken
/// at the midpoint, made steeper there, through a Hermite cubic whose slope at both ends sharpness lessens (VTK 9,
/// vtkPiecewiseFunction and vtkColorTransferFunction).
double curved(double x, double midpoint, double sharpness) {
  x = x < midpoint ? 0.5 * x / midpoint : 0.5 + 0.5 * (x - midpoint) / (1 - midpoint);
  const double power = 1 + 10 * sharpness;
  x = x < 0.5 ? 0.5 * std::pow(2 * x, power) : 1 - 0.5 * std::pow(2 * (1 - x), power);
  const double slope = 1 - sharpness;
  return std::clamp(x * x * (3 - 2 * x) + slope * x * (1 + x * (2 * x - 3)), 0.0, 1.0);
}

/// The keys, with others where the way between two of them is not straight.
template <class Value, class Between>
std::vector<Keyed<Value>> straightened(const std::vector<Keyed<Value>>& keys, const Scale& scale,
                                       const Between& between) {
  constexpr double nearest = 1e-5;  // of a midpoint to a key, as in VTK
  std::vector<Keyed<Value>> result;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    result.push_back({keys[i].s, keys[i].value});
    if (i + 1 == keys.size() || keys[i].s == keys[i + 1].s) continue;
    const Value& a = keys[i].value;
    const Value& b = keys[i + 1].value;
    const double midpoint = std::clamp(keys[i].midpoint, nearest, 1 - nearest);
    const double sharpness = keys[i].sharpness;
    const auto add = [&](double x, const Value& value) {
      const double s = scale.at(x, keys[i].s, keys[i + 1].s);
      if (keys[i].s < s && s < keys[i + 1].s) result.push_back({s, value});
    };
    if (sharpness > jump_sharpness) {
      add(midpoint, a);
      add(midpoint, b);
    } else if (sharpness >= straight_sharpness) {
      for (int k = 1; k < samples_of_curve; ++k) {
        const double x = static_cast<double>(k) / samples_of_curve;
        add(x, between(a, b, curved(x, midpoint, sharpness)));
      }
    } else if (midpoint != 0.5) {
      add(midpoint, between(a, b, 0.5));
    }
  }
  return result;
}

// --- Limits ---

enum class Side { left, right };

/// The limit at s from one side; `between(a, b, x)` is the value between two keys.
template <class Value, class Between>
Value limit_at(const std::vector<Keyed<Value>>& keys, double s, Side side, const Scale& scale, const Between& between) {
  const auto first_at =
      std::lower_bound(keys.begin(), keys.end(), s, [](const auto& key, double x) { return key.s < x; });
  const auto behind =
      std::upper_bound(keys.begin(), keys.end(), s, [](double x, const auto& key) { return x < key.s; });
  const auto a = side == Side::left ? first_at : behind;  // the first key that does not lie before the limit
  if (first_at == behind) {                               // no key at s
    if (a == keys.begin()) return keys.front().value;
    if (a == keys.end()) return keys.back().value;
    return between((a - 1)->value, a->value, scale.share(s, (a - 1)->s, a->s));
  }
  if (side == Side::left) {
    if (first_at == keys.begin()) return first_at->value;
    return between((first_at - 1)->value, first_at->value, 1.0);
  }
  if (behind == keys.end()) return (behind - 1)->value;
  return between((behind - 1)->value, behind->value, 0.0);
}

/// The scalars between which both functions are linear, after sampling.
std::vector<double> knots_of(const ColorMap& map, const Scale& scale) {
  std::vector<double> knots;
  for (const auto& key : map.colors) knots.push_back(key.s);
  if (is_sampled(map))
    for (int i = 1; i < samples_of_space; ++i)
      knots.push_back(scale.at(static_cast<double>(i) / samples_of_space, map.colors.front().s, map.colors.back().s));
  for (const auto& key : map.opacities) knots.push_back(key.s);
  std::sort(knots.begin(), knots.end());
  knots.erase(std::unique(knots.begin(), knots.end()), knots.end());
  return knots;
}

}  // namespace

Vector3<double> color_between(ColorSpace space, const Vector3<double>& a, const Vector3<double>& b, double x) {
  // The colours themselves, without the rounding of a way there and back.
  if (x == 0 && space != ColorSpace::step) return a;
  if (x == 1) return b;
  const auto mean = [x](const Vector3<double>& p, const Vector3<double>& q) -> Vector3<double> {
    return p + x * (q - p);
  };
  switch (space) {
    case ColorSpace::rgb:
      return mean(a, b);
    case ColorSpace::hsv:
      return rgb_of_hsv(mean(hsv_of(a), hsv_of(b))).max(0).min(1);
    case ColorSpace::hsv_wrapped:
      return wrapped_hsv_between(hsv_of(a), hsv_of(b), x).max(0).min(1);
    case ColorSpace::lab:
      return rgb_of_lab(mean(lab_of(a), lab_of(b))).max(0).min(1);
    case ColorSpace::diverging:
      return diverging_between(a, b, x).max(0).min(1);
    default:
      return b;
  }
}

bool is_sampled(const ColorMap& map) {
  return map.is_logarithmic || (map.space != ColorSpace::rgb && map.space != ColorSpace::step);
}

PiecewiseLinear transfer_of(const ColorMap& map, double unit_length) {
  check_keys(map.colors, "colours");
  check_keys(map.opacities, "opacities");
  for (const auto& key : map.colors)
    for (const double channel : key.value) check_share(channel, "color");
  for (const auto& key : map.opacities) check_share(key.value, "opacity");
  if (map.is_logarithmic && !(map.colors.front().s > 0))
    throw InputError(
        fmt::format("found scalar {} among colours over the logarithm; numbers > 0 are allowed", map.colors.front().s));
  if (!(unit_length > 0) || !std::isfinite(unit_length))
    throw InputError(fmt::format("found unit_length {}; a finite number > 0 is allowed", unit_length));

  const Scale plain;
  const Scale scale{map.is_logarithmic};
  const auto mean = [](double a, double b, double x) { return std::lerp(a, b, x); };
  const auto mixed = [&map](const Vector3<double>& a, const Vector3<double>& b, double x) {
    return color_between(map.space, a, b, x);
  };
  const ColorMap straight{.space = map.space,
                          .is_logarithmic = map.is_logarithmic,
                          .colors = straightened(map.colors, scale, mixed),
                          .opacities = straightened(map.opacities, plain, mean)};
  std::vector<OpacityPoint> points;
  for (const double s : knots_of(straight, scale)) {
    const auto point_at = [&](Side side) -> OpacityPoint {
      return {s, limit_at(straight.opacities, s, side, plain, mean), limit_at(straight.colors, s, side, scale, mixed)};
    };
    const OpacityPoint left = point_at(Side::left);
    const OpacityPoint right = point_at(Side::right);
    points.push_back(left);
    if (left.opacity != right.opacity || (left.color != right.color).any()) points.push_back(right);
  }
  return from_opacity(points, unit_length);
}

}  // namespace raytruth
