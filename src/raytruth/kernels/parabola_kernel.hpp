#pragma once

#include "raytruth/kernels/band.hpp"
#include "raytruth/kernels/float_lanes.hpp"
#include "raytruth/kernels/gauss_legendre.hpp"
#include "raytruth/kernels/slab_kernels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace raytruth::inline RAYTRUTH_LEVEL {

/// An interval between two entries of the transfer function, crossed with x(u) = u (1 + g (u - 1)), u and x from 0 at
/// its lower end to 1: rate and colour are linear in x, x is a parabola in time.
struct ParabolaInterval {
  FloatLanes time;             ///< that the crossing takes, in what the rates are multiplied by
  FloatLanes bend;             ///< g, -1 to 1
  FloatLanes rate;             ///< at the lower end
  FloatLanes rate_difference;  ///< of the upper end from it
};

/// What an interval does to the light from behind it. Colour is c_0 - c_1 T + (c_1 - c_0) M, M the mean over x of the
/// transmittance from x to the viewer: the integral by parts (Abel summation over the intervals of a slab).
struct ParabolaCrossing {
  FloatLanes opacity;
  FloatLanes mean_from_below;
  FloatLanes mean_from_above;
};

/// Crosses by a Gauss-Legendre rule in u, in which all is smooth, even where the parabola turns.
inline ParabolaCrossing cross_by_nodes(const ParabolaInterval& interval, const FloatLanes& depth,
                                       const NodeTable<3>& rule) {
  constexpr float log2_e = 0x1.715476p0F;
  const auto transmittance = [](const FloatLanes& d) { return FloatLanes(1.0F) - opacity_of<false>(d * log2_e); };
  const FloatLanes& g = interval.bend;
  const FloatLanes at_lower_end = interval.time * interval.rate;
  const FloatLanes difference = interval.time * interval.rate_difference;
  ParabolaCrossing crossing{.opacity = opacity_of<false>(depth * log2_e), .mean_from_below = {}, .mean_from_above = {}};
  for (std::size_t i = 0; i < rule.count; ++i) {
    const auto u = static_cast<float>(rule.nodes[i]);
    // dx / du, and the depth below: u times rate + rate difference times the integral of x over u.
    const FloatLanes weight =
        multiply_add(g, FloatLanes(2 * u - 1), FloatLanes(1.0F)) * static_cast<float>(rule.weights[i]);
    const FloatLanes mean_x = multiply_add(g, FloatLanes(u * (u / 3 - 0.5F)), FloatLanes(0.5F * u));
    const FloatLanes below = multiply_add(difference, mean_x, at_lower_end) * u;
    crossing.mean_from_below = multiply_add(weight, transmittance(below), crossing.mean_from_below);
    crossing.mean_from_above = multiply_add(weight, transmittance(depth - below), crossing.mean_from_above);
  }
  return crossing;
}

/// Crosses by the moments of the depth d(x) seen on the way: the first one is exact, and gives the skew kappa; the
/// higher ones are those of the parabola d x + e x (1 - x) of this skew. The error is at most 6e-4 d^4 + 5e-3 d^2 |g|
/// for |g| <= 1/4.
inline ParabolaCrossing cross_by_moments(const FloatLanes& depth, const FloatLanes& skew) {
  // (1 - exp(-d)) / d
  FloatLanes even = multiply_add(depth, FloatLanes(1.0F / 120), FloatLanes(-1.0F / 24));
  even = multiply_add(depth, even, FloatLanes(1.0F / 6));
  even = multiply_add(depth, even, FloatLanes(-0.5F));
  even = multiply_add(depth, even, FloatLanes(1.0F));
  const FloatLanes opacity = depth * even;
  const FloatLanes square = skew * skew;
  even = multiply_add(square, multiply_add(depth, FloatLanes(-3.0F / 40), FloatLanes(3.0F / 20)), even);
  FloatLanes odd = multiply_add(depth, FloatLanes(3.0F / 40), FloatLanes(-0.25F));
  odd = multiply_add(square, FloatLanes(9.0F / 280), multiply_add(depth, odd, FloatLanes(0.5F)));
  return {opacity, multiply_add(skew, odd, even), multiply_add(FloatLanes(0.0F) - skew, odd, even)};
}

/// Slabs that lie between the parabola's turning point, or its upper end, and a lower scalar, on both sides.
struct ParabolaSlabs {
  FloatLanes transmittance{1.0F};
  std::array<FloatLanes, 3> rising{};   ///< sum of M times the differences of colour, from the lower scalar up
  std::array<FloatLanes, 3> falling{};  ///< the same on the other side, from above down

  /// Goes on to a lower scalar: in front of what rises, behind what falls. `difference` is that of the colours.
  void go_on(const ParabolaCrossing& crossing, const std::array<FloatLanes, 3>& difference) {
    const FloatLanes through = FloatLanes(1.0F) - crossing.opacity;
    const FloatLanes seen = transmittance * crossing.mean_from_above;
    for (std::size_t c = 0; c < 3; ++c) {
      rising[c] = multiply_add(through, rising[c], crossing.mean_from_below * difference[c]);
      falling[c] = multiply_add(FloatLanes(0.0F) - seen, difference[c], falling[c]);
    }
    transmittance = transmittance * through;
  }
};

/// A row's slabs, from the turning point or the upper end downwards. The squared speed P'^2 is linear in the scalar,
/// B^2 + 8 D (s - lower), and whole at all entries; an interval between two of them is crossed in the time 2 / (sum of
/// both speeds), without a difference that loses digits. What lies above both ends is crossed twice, in two mirrored
/// ways; and a slab and its reverse share everything but the sums.
class ParabolaLanes {
 public:
  ParabolaLanes(const TransferEntries& transfer, const ParabolaRow& row)
      : transfer_(transfer), upper_(static_cast<std::int32_t>(row.upper)) {
    lower_ = multiply_add(FloatLanes(static_cast<float>(row.direction)),
                          FloatLanes::of(__builtin_convertvector(lane_places(), FloatLanes::Vector)),
                          FloatLanes(static_cast<float>(row.lower)));
    const FloatLanes height = FloatLanes(static_cast<float>(row.upper)) - lower_;
    const FloatLanes bow = FloatLanes(2.0F * static_cast<float>(row.middle - row.upper)) + height;  // -D
    is_asked_ = (bow.vector >= 0) & (lower_.vector >= 0) & (height.vector >= 0);
    eight_bows_ = bow * 8.0F;
    first_speed_squared_ = (height + bow * 2.0F) * (height + bow * 2.0F);  // B^2

    const auto last = static_cast<float>(transfer.count - 1);
    turns_ = is_asked_ & ((height - bow * 2.0F).vector < 0);  // P'(1) < 0
    const FloatLanes top = first_speed_squared_ / larger(eight_bows_, FloatLanes(1.0F));
    const FloatLanes::Bits entry = __builtin_convertvector((lower_ + top).vector, FloatLanes::Bits);
    const FloatLanes below_top = FloatLanes::of(__builtin_convertvector(entry, FloatLanes::Vector));
    start_ = select(turns_, smaller(below_top, FloatLanes(last)), lower_ + height);

    // Moments will do where the depth is at most 0.2, and depth^2 |g| at most 10^-4.
    const float most = transfer.most_rate;
    const FloatLanes speed_squared =
        larger(FloatLanes(6.25F * most * most), square_root(larger(bow, FloatLanes(1e-3F)) * 5000.0F) * most);
    const FloatLanes is_fast_at =
        lower_ + (first_speed_squared_ - speed_squared) / larger(eight_bows_, FloatLanes(1e-3F));
    fast_below_ = least(select(is_asked_, larger(is_fast_at, FloatLanes(0.0F)), FloatLanes(last)));
  }

  std::uint32_t run(float* rising, float* falling) {
    const std::uint32_t asked = lane_mask(is_asked_);
    if (asked == 0) return 0;
    is_constant_ = is_asked_ & (eight_bows_.vector == 0) & (lower_.vector == start_.vector);
    turn();
    const auto highest =
        static_cast<std::int32_t>(-least(select(is_asked_, FloatLanes(0.0F) - start_, FloatLanes(0.0F))));
    const auto lowest = static_cast<std::int32_t>(least(select(is_asked_, lower_, start_)));
    go_down(highest, upper_);
    const ParabolaSlabs above = slabs_;
    go_down(upper_, lowest);
    write(above, rising, falling);
    const std::uint32_t too_deep = lane_mask(is_too_deep_ & is_asked_);
    std::uint32_t by_place = 0;
    for (std::size_t lane = 0; lane < float_lane_count; ++lane) by_place |= (too_deep >> lane & 1U) << place_of(lane);
    return by_place;
  }

 private:
  // Time times the larger rate up to which rules of so many nodes err by less than 4e-7, 10^-6 and 10^-9.
  static constexpr float most_of_4_nodes = 0.5F;
  static constexpr float most_of_6_nodes = 3;
  static constexpr float most_of_16_nodes = 24;

  [[nodiscard]] FloatLanes speed_squared(std::int32_t entry) const {
    // It must not be 0, which has no inverse square root.
    return larger(multiply_add(eight_bows_, lower_ - FloatLanes(static_cast<float>(entry)), first_speed_squared_),
                  FloatLanes(1e-30F));
  }

  [[nodiscard]] FloatLanes gather(const float* values, const FloatLanes& at) const {
    FloatLanes result;
    for (std::size_t lane = 0; lane < float_lane_count; ++lane) {
      const auto index = static_cast<std::ptrdiff_t>(at.vector[lane]);
      result.vector[lane] =
          values[std::clamp<std::ptrdiff_t>(index, 0, static_cast<std::ptrdiff_t>(transfer_.count) - 1)];
    }
    return result;
  }

  ParabolaCrossing cross(const ParabolaInterval& interval, const FloatLanes& depth, const FloatLanes::Bits& is_inside) {
    const FloatLanes steepest = interval.time * larger(interval.rate, interval.rate + interval.rate_difference);
    const auto exceeds = [&](float most) { return (steepest.vector > most) & is_inside; };
    is_too_deep_ |= exceeds(most_of_16_nodes);
    std::size_t nodes = 4;
    if (lane_mask(exceeds(most_of_4_nodes)) != 0) nodes = lane_mask(exceeds(most_of_6_nodes)) != 0 ? 16 : 6;
    return cross_by_nodes(interval, depth, node_table<3>(nodes));
  }

  /// Crosses from the last entry below the turning point up to that point: half of it, since slabs_ holds either side.
  /// Beyond the last entry of all the optics are constant, and so they are in all of a constant slab.
  void turn() {
    if (lane_mask(turns_ | is_constant_) == 0) return;
    const FloatLanes squared = multiply_add(eight_bows_, lower_ - start_, first_speed_squared_);
    const FloatLanes speed = square_root(larger(squared, FloatLanes(1e-30F)));
    const FloatLanes inverse = FloatLanes(1.0F) / larger(eight_bows_, FloatLanes(1.0F));
    const FloatLanes zero(0.0F);
    const FloatLanes::Bits ends_inside = turns_ & (start_.vector < static_cast<float>(transfer_.count - 1));
    const FloatLanes height = select(ends_inside, larger(squared, zero) * inverse, zero);
    const ParabolaInterval interval{
        .time = select(is_constant_, FloatLanes(0.25F), select(turns_, speed * inverse, zero)),
        .bend = FloatLanes(-1.0F),
        .rate = gather(transfer_.rate, start_),
        .rate_difference = height * gather(transfer_.rate_difference, start_)};
    constexpr float mean_x = 2.0F / 3;  // of u (2 - u)
    const FloatLanes depth = interval.time * multiply_add(interval.rate_difference, FloatLanes(mean_x), interval.rate);
    const ParabolaCrossing crossing = cross(interval, depth, ends_inside);
    std::array<FloatLanes, 3> difference;
    for (std::size_t c = 0; c < 3; ++c) difference[c] = height * gather(transfer_.color_difference[c], start_);
    slabs_.go_on(crossing, difference);
  }

  /// Crosses the intervals from one entry down to another, in lanes that have begun and not reached their lower end.
  void go_down(std::int32_t from, std::int32_t to) {
    const auto fast_from = static_cast<std::int32_t>(fast_below_);
    FloatLanes upper_speed = square_root(speed_squared(from));
    const auto crossed = [&](std::int32_t entry, const auto& crossing_of) {
      const FloatLanes speed = square_root(speed_squared(entry));
      const auto at = static_cast<float>(entry);
      const FloatLanes::Bits is_inside = (lower_.vector <= at) & (start_.vector > at);
      const FloatLanes time = select(is_inside, reciprocal(speed + upper_speed), FloatLanes(0.0F));
      upper_speed = speed;
      const auto index = static_cast<std::size_t>(entry);
      const ParabolaInterval interval{.time = time,
                                      .bend = FloatLanes(0.0F) - eight_bows_ * (time * time),
                                      .rate = FloatLanes(transfer_.rate[index]),
                                      .rate_difference = FloatLanes(transfer_.rate_difference[index])};
      const FloatLanes bend = interval.bend * (1.0F / 6);
      const FloatLanes depth = time * multiply_add(interval.rate_difference, FloatLanes(0.5F) - bend, interval.rate);
      std::array<FloatLanes, 3> difference;
      for (std::size_t c = 0; c < 3; ++c) difference[c] = FloatLanes(transfer_.color_difference[c][index]);
      ParabolaCrossing crossing = crossing_of(interval, bend, depth, is_inside);
      crossing.mean_from_below = select(is_inside, crossing.mean_from_below, FloatLanes(0.0F));
      crossing.mean_from_above = select(is_inside, crossing.mean_from_above, FloatLanes(0.0F));
      slabs_.go_on(crossing, difference);
    };
    std::int32_t entry = from - 1;
    for (; entry >= std::max(to, fast_from); --entry)
      crossed(entry, [this](const ParabolaInterval& interval, const FloatLanes& /*bend*/, const FloatLanes& depth,
                            const FloatLanes::Bits& is_inside) { return cross(interval, depth, is_inside); });
    for (; entry >= to; --entry)
      crossed(entry, [](const ParabolaInterval& interval, const FloatLanes& bend, const FloatLanes& depth,
                        const FloatLanes::Bits& /*is_inside*/) {
        const FloatLanes of_difference =
            multiply_add(bend, multiply_add(FloatLanes(2.4F), bend, FloatLanes(-1.0F)), FloatLanes(1.0F / 6));
        return cross_by_moments(
            depth, interval.time * (interval.rate_difference * of_difference - (bend + bend) * interval.rate));
      });
  }

  /// `above`: between the turning point and the upper end.
  void write(const ParabolaSlabs& above, float* rising, float* falling) const {
    const FloatLanes through = above.transmittance * slabs_.transmittance;
    LaneSlab up;
    LaneSlab down;
    for (std::size_t c = 0; c < 3; ++c) {
      const FloatLanes at_lower = gather(transfer_.color[c], lower_);
      const FloatLanes at_upper(transfer_.color[c][upper_]);
      up[c] = multiply_add(slabs_.transmittance, above.falling[c], slabs_.rising[c]) + (at_lower - through * at_upper);
      down[c] = multiply_add(above.transmittance, slabs_.falling[c], above.rising[c]) + (at_upper - through * at_lower);
    }
    up[3] = down[3] = FloatLanes(1.0F) - through;
    store_texels(up, rising);
    store_texels(down, falling);
  }

  FloatLanes lower_;
  FloatLanes start_;  ///< the last entry below the turning point; the upper end where the slab is monotone
  FloatLanes eight_bows_;
  FloatLanes first_speed_squared_;
  FloatLanes::Bits is_asked_{};
  FloatLanes::Bits turns_{};
  FloatLanes::Bits is_constant_{};
  FloatLanes::Bits is_too_deep_{};
  ParabolaSlabs slabs_;
  TransferEntries transfer_;
  std::int32_t upper_;
  float fast_below_ = 0;  ///< intervals whose upper end is not above it are crossed fast in all lanes
};

/// SlabKernels::parabolas.
inline std::uint32_t parabolas(const TransferEntries& transfer, const ParabolaRow& row, float* rising, float* falling) {
  return ParabolaLanes(transfer, row).run(rising, falling);
}

}  // namespace raytruth::inline RAYTRUTH_LEVEL
