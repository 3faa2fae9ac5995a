#include "raytruth/shading/slab_shading.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/transfer/emission.hpp"

#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/toms748_solve.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace raytruth {

namespace {

using Coefficients = std::array<double, 4>;

/// F w(1-x) + B w(x).
double blend(const NormalCurve& curve, double front, double back, double cosine, double x) {
  return front * curve.weight(1 - x, cosine) + back * curve.weight(x, cosine);
}

// --- Where a function of x on [0, 1] is 0 ---

constexpr int scan_cells = 32;

/// Adds the roots of f, each between two points of a scan that includes the extremes of f.
template <class Function>
void add_roots(const Function& f, std::vector<double>& roots) {
  std::vector<double> xs(scan_cells + 1);
  std::vector<double> values(xs.size());
  for (std::size_t i = 0; i < xs.size(); ++i) {
    xs[i] = static_cast<double>(i) / scan_cells;
    values[i] = f(xs[i]);
  }
  // A pair of roots between two points hides next to an extreme: three points of the scan show it, or, in an end cell,
  // the slope at the end.
  std::vector<double> points = xs;
  const auto add_extreme = [&](double sign, double low, double high) {
    constexpr int bits = std::numeric_limits<double>::digits / 2;
    points.push_back(
        boost::math::tools::brent_find_minima([&](double x) { return sign * f(x); }, low, high, bits).first);
  };
  for (std::size_t i = 1; i + 1 < xs.size(); ++i) {
    const double before = values[i] - values[i - 1];
    const double behind = values[i + 1] - values[i];
    if (before * behind < 0) add_extreme(before > 0 ? -1 : 1, xs[i - 1], xs[i + 1]);
  }
  constexpr double little = 0x1p-20;
  const double at_front = f(little) - values.front();
  const double at_back = values.back() - f(1 - little);
  if (at_front * (values[1] - values[0]) < 0) add_extreme(at_front > 0 ? -1 : 1, xs[0], xs[1]);
  if (at_back * (values[scan_cells] - values[scan_cells - 1]) < 0)
    add_extreme(at_back > 0 ? 1 : -1, xs[scan_cells - 1], xs[scan_cells]);
  std::sort(points.begin(), points.end());
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double low = f(points[i - 1]);
    const double high = f(points[i]);
    if (!(low * high < 0)) {
      if (low == 0 && points[i - 1] > 0) roots.push_back(points[i - 1]);
      continue;
    }
    std::uintmax_t iterations = 100;
    const auto [a, b] = boost::math::tools::toms748_solve(f, points[i - 1], points[i], low, high,
                                                          boost::math::tools::eps_tolerance<double>(), iterations);
    roots.push_back(a + (b - a) / 2);
  }
}

// --- Curves ---

SlabShader shader_of(const NormalCurve& curve, const SlabCosines& cosines, const Lighting& lighting) {
  const auto light = [&curve, cosines](double x) {
    return blend(curve, cosines.light_front, cosines.light_back, cosines.normals, x);
  };
  const auto half = [&curve, cosines](double x) {
    return blend(curve, cosines.half_front, cosines.half_back, cosines.normals, x);
  };
  const Illumination illumination(lighting);
  SlabShader shader{.at = [light, half, illumination](double x, double /*slope*/) {
    const double specular = illumination.specular(half(x));
    return LitPoint{illumination.diffuse(light(x)), specular, specular};
  }};
  shader.breaks = [light, half, illumination, negative = lighting.negative] {
    std::vector<double> breaks;
    if (negative != Negative::none) {
      add_roots(light, breaks);
      add_roots(half, breaks);
    }
    if (!illumination.is_plain_power()) {
      const double threshold = illumination.threshold();
      add_roots([&](double x) { return half(x) - threshold; }, breaks);
      if (negative == Negative::mirror) add_roots([&](double x) { return half(x) + threshold; }, breaks);
    }
    return breaks;
  };
  return shader;
}

/// Lum 2004, section 3: the light of both ends, interpolated.
SlabShader interpolated_light(const SlabCosines& cosines, const Lighting& lighting) {
  const Illumination illumination(lighting);
  const LitPoint front{illumination.diffuse(cosines.light_front), illumination.specular(cosines.half_front)};
  const LitPoint back{illumination.diffuse(cosines.light_back), illumination.specular(cosines.half_back)};
  return {.at = [front, back](double x, double /*slope*/) {
    const double specular = std::lerp(front.specular, back.specular, x);
    return LitPoint{std::lerp(front.diffuse, back.diffuse, x), specular, specular};
  }};
}

// --- Guetat's three cases ---

double value_at(const Coefficients& a, double s) { return a[0] + s * (a[1] + s * (a[2] + s * a[3])); }

double tent(double s) { return s < 0.5 ? 2 * s : 2 - 2 * s; }

/// The largest value that the cubic takes where its derivative is 0 in [0, 1], if it is there above both ends.
std::optional<double> inner_maximum(const Coefficients& a) {
  // a1 + 2 a2 s + 3 a3 s^2, by the formula without cancellation.
  const double discriminant = a[2] * a[2] - 3 * a[1] * a[3];
  if (!(discriminant >= 0)) return {};
  const double q = -(a[2] + std::copysign(std::sqrt(discriminant), a[2]));
  std::optional<double> largest;
  for (const double s : {q / (3 * a[3]), a[1] / q})
    if (s >= 0 && s <= 1)
      largest = std::max(largest.value_or(-std::numeric_limits<double>::infinity()), value_at(a, s));
  const double ends = std::max(value_at(a, 0), value_at(a, 1));
  return largest && *largest > ends ? largest : std::nullopt;
}

enum class Fades {
  plain,         ///< corrected, without I''
  with_maximum,  ///< corrected, with I''
  printed,
};

std::string_view refusal_of_fades(const Lighting& lighting) {
  if (lighting.negative != Negative::clamp) return "its fades replace the treatment of negative cosines called clamp";
  if (lighting.highlight->degree != 1)
    return "its fades are made for highlights that are linear in the cosine, as cone";
  return {};
}

std::function<double(double)> diffuse_with_fades(Fades fades, const SlabCosines& cosines, const Coefficients& curve) {
  const double front = cosines.light_front;
  const double back = cosines.light_back;
  if (front < 0 && back < 0) return [](double) { return 0.0; };
  if (front >= 0 && back >= 0) return [curve](double s) { return value_at(curve, s); };
  // As printed the two results stand in the opposite order to their conditions (errata, Guetat 5).
  const bool keeps_back = (front < 0) != (fades == Fades::printed);
  if (keeps_back) return [back](double s) { return back * s; };
  return [front](double s) { return front * (1 - s); };
}

SlabShader shader_with_fades(Fades fades, const SlabCosines& cosines, const Lighting& lighting) {
  const NormalCurve& arc = *find_named(catalogue::normal_curves(), "quadratic_arc");
  const auto light = arc.coefficients(cosines.light_front, cosines.light_back, cosines.normals);
  const auto half = arc.coefficients(cosines.half_front, cosines.half_back, cosines.normals);
  const double n = lighting.highlight->exponent(lighting.shininess);
  const auto cone = [n](double cosine) { return 1 + n * (cosine - 1); };
  const double front = cone(cosines.half_front);
  const double back = cone(cosines.half_back);
  const bool is_printed = fades == Fades::printed;

  SlabShader shader;
  std::function<double(double)> specular;
  std::function<double(double)> other;
  if (front >= 0 && back >= 0) {
    specular = [cone, half](double s) { return cone(value_at(half, s)); };
    if (is_printed) shader.specular_density = SpecularDensity::none;
  } else if (is_printed && (front >= 0 || back >= 0)) {
    // L stands for H, the tables are the coloured ones, and 1 - n is not faded.
    shader.specular_density = SpecularDensity::colored;
    if (front < 0)
      specular = [n, back_light = cosines.light_back](double s) { return 1 - n + n * back_light * s; };
    else
      specular = [n, front_light = cosines.light_front](double s) { return 1 - n + n * front_light * (1 - s); };
  } else {
    specular = [front, back](double s) { return std::max(front, 0.0) * (1 - s) + std::max(back, 0.0) * s; };
    if (is_printed) shader.specular_density = SpecularDensity::none;
    if (fades == Fades::with_maximum) {
      if (const auto largest = inner_maximum(half)) {
        other = [peak = std::max(0.0, cone(std::min(*largest, 1.0)))](double s) { return peak * tent(s); };
        shader.breaks = [] { return std::vector{0.5}; };
        shader.has_two_highlights = true;
      }
    }
  }
  shader.at = [diffuse = diffuse_with_fades(fades, cosines, light), specular, other = other ? other : specular](
                  double s, double /*slope*/) {
    return LitPoint{diffuse(s), specular(s), other(s)};
  };
  return shader;
}

// --- The dissertation's opacity gradient ---

/// The normal of the slab as a whole: the normalised mean.
struct MeanCosines {
  double light;
  double half;
};

MeanCosines mean_cosines(const SlabCosines& cosines) {
  const NormalCurve& mean = *find_named(catalogue::normal_curves(), "mean_gradient");
  return {blend(mean, cosines.light_front, cosines.light_back, cosines.normals, 0.5),
          blend(mean, cosines.half_front, cosines.half_back, cosines.normals, 0.5)};
}

/// grad tau = d tau / ds N, neither normalised nor clamped (5.2.9, 5.2.13).
SlabShader shader_of_opacity_gradient(const SlabCosines& cosines, const Lighting& lighting) {
  const auto [light, half] = mean_cosines(cosines);
  return {.at =
              [light = light, half = half, n = lighting.shininess](double /*x*/, double slope) {
                const double specular = std::pow(half, n) * std::pow(slope, n);
                return LitPoint{slope * light, specular, specular};
              },
          .specular_density = SpecularDensity::colored};
}

/// The direction of the gradient of the extinction, which falls where the normal points the other way.
SlabShader shader_of_opacity_normal(const SlabCosines& cosines, const Lighting& lighting) {
  const auto [light, half] = mean_cosines(cosines);
  return {.at = [light = light, half = half, illumination = Illumination(lighting)](double /*x*/, double slope) {
    if (slope == 0) return LitPoint{};
    const double sign = slope < 0 ? -1 : 1;
    const double specular = illumination.specular(sign * half);
    return LitPoint{illumination.diffuse(sign * light), specular, specular};
  }};
}

/// grad tau = d tau / ds (A z + B): the normal is linear along the slab (5.3.16 to 5.3.20), neither normalised nor
/// clamped.
SlabShader shader_of_linear_gradient(const SlabCosines& cosines, const Lighting& lighting) {
  return {.at =
              [cosines, n = lighting.shininess](double x, double slope) {
                const double light = cosines.light_front + x * (cosines.light_back - cosines.light_front);
                const double half = cosines.half_front + x * (cosines.half_back - cosines.half_front);
                const double specular = std::pow(half, n) * std::pow(slope, n);
                return LitPoint{slope * light, specular, specular};
              },
          .specular_density = SpecularDensity::colored};
}

/// The direction of that gradient, the normal linear along the slab: it is turned round where the extinction falls.
SlabShader shader_of_linear_normal(const SlabCosines& cosines, const Lighting& lighting) {
  return {.at = [cosines, illumination = Illumination(lighting)](double x, double slope) {
    if (slope == 0) return LitPoint{};
    const double sign = slope < 0 ? -1 : 1;
    const double light = cosines.light_front + x * (cosines.light_back - cosines.light_front);
    const double half = cosines.half_front + x * (cosines.half_back - cosines.half_front);
    const double specular = illumination.specular(sign * half);
    return LitPoint{illumination.diffuse(sign * light), specular, specular};
  }};
}

// --- The catalogue ---

std::string_view takes_all(const Lighting& /*lighting*/) { return {}; }

std::vector<Shading> make_shadings() {
  std::vector<Shading> list;
  for (const NormalCurve& curve : catalogue::normal_curves())
    list.push_back({.name = std::string(curve.name),
                    .summary = std::string(curve.summary),
                    .source = std::string(curve.source),
                    .refusal = takes_all,
                    .shader = [&curve](const SlabCosines& cosines,
                                       const Lighting& lighting) { return shader_of(curve, cosines, lighting); },
                    .color = curve.color,
                    .marker = curve.marker});
  list.push_back({.name = "linear_intensity",
                  .summary = "the light of both ends, interpolated",
                  .source = "Lum 2004, section 3",
                  .refusal = takes_all,
                  .shader = interpolated_light,
                  .color = "#882255",
                  .marker = "d"});
  const auto add_fades = [&list](std::string name, std::string summary, std::string source, Fades fades,
                                 std::string_view marker) {
    list.push_back({.name = std::move(name),
                    .summary = std::move(summary),
                    .source = std::move(source),
                    .refusal = refusal_of_fades,
                    .shader = [fades](const SlabCosines& cosines,
                                      const Lighting& lighting) { return shader_with_fades(fades, cosines, lighting); },
                    .color = "#999933",
                    .marker = marker});
  };
  add_fades("quadratic_arc_fades", "the quadratic arc, faded where an end is dark, as corrected",
            "Guetat 2010, section 5; errata", Fades::plain, "1");
  add_fades("quadratic_arc_fades_maximum", "the same, and a tent where the highlight lies between the ends",
            "Guetat 2010, section 5.2, I''; errata", Fades::with_maximum, "2");
  add_fades("quadratic_arc_fades_printed", "the quadratic arc, faded where an end is dark, as printed",
            "Guetat 2010, section 5", Fades::printed, "x");
  list.push_back({.name = "opacity_gradient",
                  .summary = "the gradient of the extinction for the normal: neither normalised nor clamped",
                  .source = "dissertation, eqs. 5.2.8 to 5.2.15",
                  .refusal = [](const Lighting& lighting) -> std::string_view {
                    return lighting.is_lobe() ? "" : "it is made for the highlight called lobe";
                  },
                  .shader = shader_of_opacity_gradient,
                  .color = "#AA4499",
                  .marker = "x",
                  .needs_extinction = true});
  list.push_back({.name = "opacity_gradient_normalized",
                  .summary = "the direction of the gradient of the extinction for the normal",
                  .source = "dissertation, eqs. 5.2.8 to 5.2.15; errata",
                  .refusal = takes_all,
                  .shader = shader_of_opacity_normal,
                  .color = "#AA4499",
                  .marker = "+",
                  .needs_extinction = true});
  list.push_back(
      {.name = "opacity_gradient_linear",
       .summary = "the gradient of the extinction, its normal linear along the slab: not normalised nor clamped",
       .source = "dissertation, eqs. 5.3.16 to 5.3.20",
       .refusal = [](const Lighting& lighting) -> std::string_view {
         return lighting.is_lobe() ? "" : "it is made for the highlight called lobe";
       },
       .shader = shader_of_linear_gradient,
       .color = "#332288",
       .marker = "x",
       .needs_extinction = true});
  list.push_back({.name = "opacity_gradient_linear_normalized",
                  .summary = "the direction of the gradient of the extinction, its normal linear along the slab",
                  .source = "dissertation, eqs. 5.3.16 to 5.3.20; errata",
                  .refusal = takes_all,
                  .shader = shader_of_linear_normal,
                  .color = "#332288",
                  .marker = "+",
                  .needs_extinction = true});
  return list;
}

}  // namespace

SlabCosines cosines_of(const ShadedSlab& slab, const Lighting& lighting) {
  const auto dot = [](const Vector3<double>& a, const Vector3<double>& b) { return (a * b).sum(); };
  return {dot(slab.front_normal, lighting.light), dot(slab.back_normal, lighting.light),
          dot(slab.front_normal, lighting.half), dot(slab.back_normal, lighting.half),
          // The vectors are unit vectors only nearly.
          std::clamp(slab.cosine(), -1.0, 1.0)};
}

ShadedRadiance shade(const Shading& shading, const SlabCosines& cosines, const SlabOptics& optics, Emission emission,
                     const Lighting& lighting) {
  const SlabShader shader = shading.shader(cosines, lighting);
  const auto sums = slab_integral<4>(optics, emission, shader.breaks(), [&shader](double x, double slope) {
    const LitPoint point = shader.at(x, slope);
    return std::array<double, 4>{1, point.diffuse, point.specular, point.other_specular};
  });
  const auto specular = [&](std::size_t k) -> Vector3<double> {
    if (shader.specular_density == SpecularDensity::colored) return sums.colored[k];
    return Vector3<double>::Constant(shader.specular_density == SpecularDensity::white ? sums.white[k] : sums.bare[k]);
  };
  const Vector3<double> one = specular(2);
  const Vector3<double> other = specular(3);
  return {.ambient = lighting.ambient * sums.colored[0],
          .diffuse = lighting.diffuse * sums.colored[1],
          .specular = lighting.specular * (one < other).select(other, one),
          .opacity = optics.opacity()};
}

namespace catalogue {

const std::vector<Shading>& shadings() {
  static const std::vector<Shading> list = make_shadings();
  return list;
}

}  // namespace catalogue

}  // namespace raytruth
