#pragma once

#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace raytruth {

/// What a piecewise linear transfer function says along a slab whose scalar is linear from front to back: stretches of
/// x = t / length, 0 at the front and 1 at the back, on which extinction and colour are linear.
class SlabOptics {
 public:
  struct Stretch {
    double begin = 0;  ///< x
    double end = 0;
    Optics front;
    Optics back;
    double depth = 0;             ///< optical depth in front of it
    double extinction_slope = 0;  ///< d tau / ds
  };

  SlabOptics(const PiecewiseLinear& transfer, double front, double back, double length);

  [[nodiscard]] const std::vector<Stretch>& stretches() const { return stretches_; }
  [[nodiscard]] double length() const { return length_; }
  [[nodiscard]] double depth() const { return depth_; }
  [[nodiscard]] double opacity() const { return -std::expm1(-depth_); }
  [[nodiscard]] double largest_color() const { return largest_color_; }

 private:
  std::vector<Stretch> stretches_;
  double length_;
  double depth_ = 0;
  double largest_color_ = 0;
};

/// integral_0^length f_k w T dt of functions f_k of x, w a density: the emission density q; that of white matter, tau
/// (associated) or 1 (plain); and 1.
template <std::size_t Count>
struct SlabSums {
  std::array<Vector3<double>, Count> colored;
  std::array<double, Count> white{};
  std::array<double, Count> bare{};
};

/// The rule of Gauss and Legendre that `slab_integral` applies, on [0, 1].
struct SlabRule {
  std::span<const double> nodes;
  std::span<const double> weights;
};
SlabRule slab_rule();

namespace slab_quadrature {

// Nothing shows behind this depth: exp(-100) < 4e-44.
constexpr double deepest = 100;
// The rule sees what happens within a panel of this depth.
constexpr double largest_panel_depth = 4;
constexpr int most_halvings = 60;
constexpr double relative_precision = 1e-14;

/// Adds up panels of one stretch.
template <std::size_t Count, class Functions>
class StretchSum {
 public:
  using Sums = Eigen::Array<double, 5 * static_cast<int>(Count), 1>;

  StretchSum(const SlabOptics::Stretch& stretch, double length, Emission emission, const Functions& functions,
             const Sums& tolerance, Sums& sums)
      : stretch_(stretch),
        rule_(slab_rule()),
        length_(length),
        is_associated_(emission == Emission::associated),
        functions_(functions),
        tolerance_(tolerance),
        sums_(sums) {}

  /// Adds what lies from x = begin to end.
  void add(double begin, double end) {
    const auto local = [this](double x) { return std::clamp((x - stretch_.begin) / width(), 0.0, 1.0); };
    add_shallow(local(begin), local(end));
  }

 private:
  // y runs from 0 to 1 along the stretch, so that nothing is lost where all light comes from its very front.

  [[nodiscard]] double extinction_at(double y) const {
    return std::lerp(stretch_.front.extinction, stretch_.back.extinction, y);
  }
  [[nodiscard]] double depth_at(double y) const {
    return stretch_.depth + width() * length_ * y * 0.5 * (stretch_.front.extinction + extinction_at(y));
  }
  [[nodiscard]] double width() const { return stretch_.end - stretch_.begin; }

  [[nodiscard]] Sums by_rule(double begin, double end) const {
    Sums sums = Sums::Zero();
    for (std::size_t i = 0; i < rule_.nodes.size(); ++i) {
      const double y = begin + (end - begin) * rule_.nodes[i];
      const double visible = rule_.weights[i] * (end - begin) * width() * length_ * std::exp(-depth_at(y));
      const Vector3<double> color = stretch_.front.color + y * (stretch_.back.color - stretch_.front.color);
      const double white = is_associated_ ? extinction_at(y) : 1;
      const auto values = functions_(stretch_.begin + width() * y, stretch_.extinction_slope);
      for (std::size_t k = 0; k < Count; ++k) {
        auto part = sums.template segment<5>(5 * static_cast<Eigen::Index>(k));
        const double share = visible * values[k];
        part.template head<3>() += share * white * color;
        part[3] += share * white;
        part[4] += share;
      }
    }
    return sums;
  }

  /// Halves down to panels of a small depth, and leaves out what is hidden.
  void add_shallow(double begin, double end) {
    const double front = depth_at(begin);
    if (front > deepest) return;
    const double middle = begin + (end - begin) / 2;
    if (depth_at(end) - front > largest_panel_depth && begin < middle && middle < end) {
      add_shallow(begin, middle);
      add_shallow(middle, end);
    } else {
      add_resolved(begin, end, by_rule(begin, end), most_halvings);
    }
  }

  /// Halves until two halves say the same as the whole.
  void add_resolved(double begin, double end, const Sums& whole, int halvings) {
    const double middle = begin + (end - begin) / 2;
    const Sums front = by_rule(begin, middle);
    const Sums back = by_rule(middle, end);
    const Sums both = front + back;
    // They may also say as nearly the same as rounding lets large functions do. What is not a number stays so.
    const Sums rounding = relative_precision * (front.abs() + back.abs());
    if (halvings == 0 || !((both - whole).abs() > tolerance_.max(rounding)).any()) {
      sums_ += both;
      return;
    }
    add_resolved(begin, middle, front, halvings - 1);
    add_resolved(middle, end, back, halvings - 1);
  }

  const SlabOptics::Stretch& stretch_;
  SlabRule rule_;
  double length_;
  bool is_associated_;
  const Functions& functions_;
  const Sums& tolerance_;
  Sums& sums_;
};

}  // namespace slab_quadrature

/// The integrals of Count functions at once: functions(x, extinction_slope) gives an array of their values, smooth but
/// at `breaks`. A Gauss-Legendre rule of 16 nodes is applied to panels, which are halved until nothing changes by more
/// than 1e-15 of what light there is, or 1e-14 of what the panel adds; the error is about 1e-14, without a bound.
template <std::size_t Count, class Functions>
SlabSums<Count> slab_integral(const SlabOptics& optics, Emission emission, std::vector<double> breaks,
                              const Functions& functions) {
  using Sum = slab_quadrature::StretchSum<Count, Functions>;
  constexpr double precision = 1e-15;
  breaks.push_back(1);
  std::sort(breaks.begin(), breaks.end());

  // What a slab of white matter sends out, and what of a length of 1 is seen.
  const double seen = optics.depth() > 0 ? optics.length() * (optics.opacity() / optics.depth()) : optics.length();
  const double white = emission == Emission::associated ? optics.opacity() : seen;
  typename Sum::Sums tolerance;
  for (std::size_t k = 0; k < Count; ++k)
    tolerance.template segment<5>(5 * static_cast<Eigen::Index>(k))
        << precision * white * std::max(1.0, optics.largest_color()),
        precision * white * std::max(1.0, optics.largest_color()),
        precision * white * std::max(1.0, optics.largest_color()), precision * white, precision * seen;

  typename Sum::Sums sums = Sum::Sums::Zero();
  for (const SlabOptics::Stretch& stretch : optics.stretches()) {
    Sum sum(stretch, optics.length(), emission, functions, tolerance, sums);
    double begin = stretch.begin;
    for (const double x : breaks) {
      const double end = std::min(x, stretch.end);
      if (end > begin) {
        sum.add(begin, end);
        begin = end;
      }
    }
  }
  SlabSums<Count> result;
  for (std::size_t k = 0; k < Count; ++k) {
    const auto part = sums.template segment<5>(5 * static_cast<Eigen::Index>(k));
    result.colored[k] = part.template head<3>();
    result.white[k] = part[3];
    result.bare[k] = part[4];
  }
  return result;
}

/// The moments of a slab, which tables hold: of 1, s, s^2, s^3 and of the tent that is 1 half-way, 0 at both ends
/// (Guetat 2010, section 5). `colored` are the I_k (times the transfer function's colour), `white` the I'_k and I'',
/// with the emission density of white matter (as printed I'_k is `bare`: errata, Guetat 8).
using SlabMoments = SlabSums<5>;
SlabMoments slab_moments(const SlabOptics& optics, Emission emission);

/// J_k = integral_0^1 s^k exp(-depth s) ds, k = 0 to 3: the moments of a homogeneous slab, I_k = q D J_k(tau D), where
/// the form in terms of scalars is singular. For small depths by its series, J_k = sum_m (-depth)^m / (m! (k + m + 1)),
/// else J_k = (k J_(k-1) - exp(-depth)) / depth.
std::array<double, 4> homogeneous_moments(double depth);

}  // namespace raytruth
