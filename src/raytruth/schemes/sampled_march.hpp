#pragma once

#include "raytruth/schemes/integral_scheme.hpp"
#include "raytruth/schemes/omissions.hpp"
#include "raytruth/schemes/optics_lookup.hpp"
#include "raytruth/schemes/outcome.hpp"
#include "raytruth/schemes/virtual_catmull_rom.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace raytruth {

/// What a sampled scheme reads of a ray, rounded to Real.
template <class Real>
struct SampledRay {
  std::vector<Real> values;   ///< at the samples
  std::vector<Real> middles;  ///< halfway from each sample to the next
  std::vector<Real> widths;   ///< distance of each sample from the next
  std::vector<double> positions;
  std::size_t full = 0;  ///< the first so many widths count as equal, those of virtual samples

  template <int Degree>
  SampledRay(const Chain<Degree>& signal, const Samples<double>& samples) : full(full_intervals(samples)) {
    for (const double value : samples.values) values.emplace_back(value);
    for (const DoubleDouble& position : samples.positions) positions.push_back(static_cast<double>(position));
    for (std::size_t k = 0; k < samples.interval_count(); ++k) {
      const double width = samples.length_of(k);
      widths.emplace_back(width);
      middles.emplace_back(signal.value(samples.positions[k] + DoubleDouble(width / 2)));
    }
  }
};

/// Post-classification: front to back over the ray, every slab's colour and opacity from the optics of its samples.
/// What a slab contributes stands in rules/{homogeneous,trapezoid,simpson,opacity_correction}.glsl; all of it, the
/// look-ups too, is computed in Real. `look_up(value, t)` gives emission density and extinction of a scalar at the
/// place t of the ray.
template <class Real, class LookUp>
class SampledMarch {
 public:
  using vec4 = typename Rules<Real>::vec4;

  SampledMarch(const Sampled& method, const LookUp& look_up, const SampledRay<Real>& ray, const Omissions& omissions)
      : method_(method),
        look_up_(look_up),
        ray_(ray),
        omissions_(omissions),
        is_linear_(method.absorption == Absorption::linear) {}

  Outcome<Real> operator()() {
    for (std::size_t k = 0; k < ray_.widths.size() && ray_slab_[3] < Real(omissions_.opaque);)
      k += is_omitted(k) ? 1 : composite_from(k);
    outcome_.fetches = static_cast<std::int64_t>(holds_one_sample() ? ray_.widths.size() : ray_.values.size());
    outcome_.voxels = voxels_per_fetch * outcome_.fetches;
    outcome_.color = ray_slab_.template head<3>();
    outcome_.opacity = ray_slab_[3];
    return outcome_;
  }

 private:
  /// Whether all of the slab that begins at sample k is left out.
  [[nodiscard]] bool is_omitted(std::size_t k) const {
    const std::size_t end = std::min(k + (method_.rule == SampledRule::simpson ? 2 : 1), ray_.widths.size());
    return omissions_.omit(ray_.positions[k], ray_.positions[end]);
  }

  /// Composites the slab that begins at sample k; the number of its intervals.
  std::size_t composite_from(std::size_t k) {
    switch (method_.rule) {
      case SampledRule::riemann_left:
        composite_held(ray_.values[k], k, 0);
        return 1;
      case SampledRule::riemann_right:
        composite_held(ray_.values[k + 1], k, 1);
        return 1;
      case SampledRule::riemann_mid:
        composite_held(ray_.middles[k], k, 0.5);
        return 1;
      case SampledRule::trapezoid:
        composite_trapezoid(k);
        return 1;
      case SampledRule::simpson:
        return composite_simpson(k);
      case SampledRule::virtual_catmull_rom:
        composite_virtual_samples(k);
        return 1;
    }
    return 1;
  }

  /// The optics are those of this share of the interval.
  void composite_held(const Real& value, std::size_t k, double share) {
    composite(rules_.homogeneous_slab(optics(value, place(k, share)), ray_.widths[k], is_linear_));
  }

  void composite_trapezoid(std::size_t k) {
    const vec4 front = optics_of_front(k);
    look_up_last(k + 1);
    composite(rules_.trapezoid_slab(front, last_, ray_.widths[k], is_linear_));
  }

  std::size_t composite_simpson(std::size_t k) {
    if (k + 2 > ray_.widths.size() || !are_equal(ray_.widths[k], ray_.widths[k + 1])) {
      composite_trapezoid(k);
      return 1;
    }
    const vec4 front = optics_of_front(k);
    const vec4 middle = optics(ray_.values[k + 1], ray_.positions[k + 1]);
    look_up_last(k + 2);
    composite(rules_.simpson_slab(front, middle, last_, ray_.widths[k] + ray_.widths[k + 1], is_linear_));
    return 2;
  }

  /// Lee 2010, section 3.1: the true sample, then the virtual ones behind it.
  void composite_virtual_samples(std::size_t k) {
    const vec4 curve = VirtualCatmullRom::curve(ray_.values, ray_.full, k);
    const int parts = method_.virtual_samples + 1;
    for (int part = 0; part < parts; ++part) {
      const Real value = rules_.virtual_sample(curve, Real(part) / Real(parts));
      const vec4 here = optics(value, place(k, static_cast<double>(part) / parts));
      const vec4 slab = rules_.homogeneous_slab(here, ray_.widths[k], is_linear_);
      composite(rules_.opacity_corrected_slab(slab, corrected(slab[3], parts), Real(1) / Real(parts)));
    }
  }

  [[nodiscard]] Real corrected(Real opacity, int parts) {
    if (method_.correction == OpacityCorrection::closed_form)
      return rules_.opacity_correction(opacity, Real(1) / Real(parts));
    for (; parts > 1; parts /= 2) opacity = rules_.opacity_correction_half(opacity);
    return opacity;
  }

  /// The place on the ray that lies a share of interval k behind its front.
  [[nodiscard]] double place(std::size_t k, double share) const {
    return std::lerp(ray_.positions[k], ray_.positions[k + 1], share);
  }

  vec4 optics(const Real& value, double t) {
    ++outcome_.lookups;
    return look_up_(value, t);
  }

  /// The optics at sample k, which the slab before has looked up unless it was left out.
  vec4 optics_of_front(std::size_t k) { return last_sample_ == k ? last_ : optics(ray_.values[k], ray_.positions[k]); }

  void look_up_last(std::size_t k) {
    last_ = optics(ray_.values[k], ray_.positions[k]);
    last_sample_ = k;
  }

  void composite(const vec4& slab) {
    ++outcome_.composites;
    ray_slab_ = rules_.over(ray_slab_, slab);
  }

  /// Whether a slab reads one place of its own, so that one of the ray's ends is never read.
  [[nodiscard]] bool holds_one_sample() const {
    return method_.rule == SampledRule::riemann_left || method_.rule == SampledRule::riemann_right ||
           method_.rule == SampledRule::riemann_mid;
  }

  /// Whether two widths are equal but for rounding, as those are into which its middle divides a cell.
  static bool are_equal(const Real& a, const Real& b) {
    const Real slack = Real(1e-6) * a;
    return a - b <= slack && b - a <= slack;
  }

  const Sampled& method_;
  const LookUp& look_up_;
  const SampledRay<Real>& ray_;
  const Omissions& omissions_;
  bool is_linear_;
  Rules<Real> rules_;
  vec4 last_ = vec4::Constant(Real(0));  ///< optics at the back of the slab before
  std::optional<std::size_t> last_sample_;
  vec4 ray_slab_ = vec4::Constant(Real(0));
  Outcome<Real> outcome_;
};

/// What a sampled scheme makes of the ray.
template <class Real, class LookUp>
Outcome<Real> march(const Sampled& method, const LookUp& look_up, const SampledRay<Real>& ray,
                    const Omissions& omissions = {}) {
  return SampledMarch<Real, LookUp>(method, look_up, ray, omissions)();
}
template <class Real>
Outcome<Real> march(const Sampled& method, const OpticsLookup<Real>& look_up, const SampledRay<Real>& ray,
                    const Omissions& omissions = {}) {
  const auto anywhere = [&look_up](const Real& value, double /*t*/) { return look_up(value); };
  return march(method, anywhere, ray, omissions);
}

}  // namespace raytruth
