#pragma once

#include "raytruth/core/bernstein.hpp"
#include "raytruth/reference/knot_cut.hpp"
#include "raytruth/reference/linear_interval.hpp"
#include "raytruth/shading/point_light.hpp"
#include "raytruth/transfer/emission.hpp"

#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace raytruth {

/// Light and optical depth of the part of a ray that has been summed up.
struct LitSum {
  Vector3<double> color = Vector3<double>::Constant(0);
  double depth = 0;
  double difference = 0;    ///< of the two rules, summed up over all panels; largest channel
  bool is_resolved = true;  ///< no panel was accepted though its rules differ by more than they should

  [[nodiscard]] double transmittance() const { return std::exp(-depth); }
  [[nodiscard]] double opacity() const { return -std::expm1(-depth); }
};

/// The light of lit matter along polynomial pieces of a ray, front to back,
///
///     C = integral (matter q + white e + bare) T dt,   T(t) = exp(-integral_0^t tau),
///
/// where a function gives the `PointLight` of every point. A piece is cut where the scalar crosses the transfer
/// function's points and where the light is not smooth; tau is a polynomial in between and the optical depth exact but
/// for rounding. Every panel is integrated by the rules of Gauss and Kronrod of 7 and 15 nodes and halved until they
/// differ by no more than `tolerance` times max(1, its light). The sum of these differences is an estimate that is far
/// too large where the light is smooth: it is measured, not proven.
///
/// A transfer function that is linear in opacity is taken as `linear_in_extinction` makes it.
///
/// Holds buffers: one object per thread.
template <int Degree>
class LitIntegral {
 public:
  /// Throws InputError as LinearIntervals does.
  LitIntegral(const PiecewiseLinear& transfer, Emission emission, double tolerance = 1e-10)
      : intervals_(linear_in_extinction(transfer)),
        is_associated_(emission == Emission::associated),
        tolerance_(tolerance) {}

  /// Adds a piece of this length behind the sum. `light(u, extinction_slope)` gives the PointLight at the piece's unit
  /// coordinate u, where d tau / ds is that slope; it is not smooth at `breaks`, ascending, in (0, 1).
  template <class Light>
  void add(const Bernstein<Degree>& scalar, double length, std::span<const double> breaks, const Light& light,
           LitSum& sum) {
    stretches_.clear();
    cut_(intervals_, scalar, 0, stretches_);
    for (const KnotStretch& stretch : stretches_) add_stretch(scalar, length, stretch, breaks, light, sum);
  }

 private:
  // Nothing shows behind this depth: exp(-100) < 4e-44.
  static constexpr double deepest = 100;
  static constexpr int most_halvings = 40;

  /// Everything along a stretch is a polynomial of its unit coordinate y, or the light.
  struct Matter {
    const LinearInterval& interval;
    Bernstein<Degree> x;
    Bernstein<Degree + 1> depth;  ///< behind its front
    double length;
    double begin;  ///< in the piece
    double width;
    double extinction_slope;
  };

  template <class Light>
  void add_stretch(const Bernstein<Degree>& scalar, double length, const KnotStretch& stretch,
                   std::span<const double> breaks, const Light& light, LitSum& sum) {
    if (sum.depth > deepest) return;
    const LinearInterval& interval = intervals_[stretch.interval];
    const double width = stretch.end - stretch.begin;
    Matter matter{.interval = interval,
                  .x = {},
                  .depth = {},
                  .length = length * width,
                  .begin = stretch.begin,
                  .width = width,
                  .extinction_slope = (interval.at_1.extinction - interval.at_0.extinction) * interval.scale};
    if (is_dark(interval.at_0) && is_dark(interval.at_1)) return;
    if (interval.is_linear) {
      matter.x = scalar.restricted(stretch.begin, stretch.end);
      for (double& x : matter.x.coefficients) x = interval.offset + interval.scale * (x - interval.origin);
    } else {
      matter.extinction_slope = 0;
    }
    Bernstein<Degree> extinction;
    for (std::size_t i = 0; i <= Degree; ++i)
      extinction.coefficients[i] =
          matter.length * std::lerp(interval.at_0.extinction, interval.at_1.extinction, matter.x.coefficients[i]);
    matter.depth = extinction.antiderivative();
    double begin = 0;
    const auto to = [&](double end) {
      if (end <= begin) return;
      add_panel(matter, begin, end, light, most_halvings, sum);
      begin = end;
    };
    for (const double u : breaks)
      if (u < stretch.end) to((u - stretch.begin) / width);
    to(1);
    sum.depth += matter.depth.coefficients.back();
  }

  [[nodiscard]] bool is_dark(const Optics& optics) const {
    return optics.extinction == 0 && (is_associated_ || (optics.color == 0).all());
  }

  template <class Light>
  [[nodiscard]] Vector3<double> radiance(const Matter& matter, double y, const Light& light, double depth) const {
    const double x = matter.interval.is_linear ? matter.x.value(y) : 0;
    const auto& [at_0, at_1] = std::tie(matter.interval.at_0, matter.interval.at_1);
    const PointLight point = light(matter.begin + matter.width * y, matter.extinction_slope);
    const double white = is_associated_ ? std::lerp(at_0.extinction, at_1.extinction, x) : 1;
    const double transmittance = matter.length * std::exp(-depth - matter.depth.value(y));
    const Vector3<double> color = at_0.color + x * (at_1.color - at_0.color);
    return transmittance * (white * (point.matter * color + point.white) + point.bare);
  }

  template <class Light>
  void add_panel(const Matter& matter, double begin, double end, const Light& light, int halvings, LitSum& sum) const {
    using Kronrod = boost::math::quadrature::gauss_kronrod<double, 15>;
    using Gauss = boost::math::quadrature::gauss<double, 7>;
    const auto& nodes = Kronrod::abscissa();
    const auto& weights = Kronrod::weights();
    const auto& gauss_weights = Gauss::weights();
    const double middle = begin + (end - begin) / 2;
    const double half = (end - begin) / 2;
    Vector3<double> all = Vector3<double>::Constant(0);
    Vector3<double> few = Vector3<double>::Constant(0);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      Vector3<double> pair = radiance(matter, middle + half * nodes[i], light, sum.depth);
      if (i > 0) pair += radiance(matter, middle - half * nodes[i], light, sum.depth);
      all += weights[i] * pair;
      if (i % 2 == 0) few += gauss_weights[i / 2] * pair;
    }
    const double difference = half * (all - few).abs().maxCoeff();
    // Curves between nearly opposite normals are long, and their light may be 10^9, or overflow.
    const double allowed = tolerance_ * std::max(1.0, half * all.abs().maxCoeff());
    if (difference > allowed && halvings > 0) {
      add_panel(matter, begin, middle, light, halvings - 1, sum);
      add_panel(matter, middle, end, light, halvings - 1, sum);
      return;
    }
    sum.color += half * all;
    sum.difference += difference;
    sum.is_resolved = sum.is_resolved && difference <= allowed;
  }

  LinearIntervals intervals_;
  bool is_associated_;
  double tolerance_;
  KnotCut cut_;
  std::vector<KnotStretch> stretches_;
};

}  // namespace raytruth
