#include "raytruth/schemes/quadratic_gray_printed.hpp"

#include "raytruth/core/error.hpp"

#include <fmt/format.h>
#include <boost/math/quadrature/gauss.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace raytruth {

namespace {

constexpr int whole_steps = 10;          // INT_STEP
constexpr double least_fraction = 1e-3;  // EPS
constexpr double zero = 1e-9;            // what `IsZero`, which is not printed, takes for 0
constexpr double deepest_part = 2;       // of an exact piece's colour
constexpr double most_parts = 1e6;
constexpr std::size_t curves_kept = 7;
constexpr std::size_t extinction = 3;  // the channel behind the colour's

/// The integral of f over [low, high] by Gauss's rule.
template <unsigned Nodes, class Function>
double gauss(const Function& f, double low, double high) {
  return boost::math::quadrature::gauss<double, Nodes>::integrate(f, low, high);
}

}  // namespace

RadiusAxis printed_radius_axis(RadiusLookUp look_up) {
  return {.steps = RadiusSteps::powers_of_two,
          .low = 0.125,
          .high = 8,
          .count = 7,
          .look_up = look_up,
          .is_one_sided = true};
}

QuadraticGrayPrinted::QuadraticGrayPrinted(const PiecewiseLinear& transfer, double low, double high, double length,
                                           Emission emission, const QuadraticGrayPrint& print)
    : low_(low),
      high_(high),
      length_(length),
      emission_(emission),
      print_(print),
      axis_([&] {
        RadiusAxis axis = printed_radius_axis(print.look_up);
        axis.is_one_sided = print.upward_only;
        return axis;
      }()),
      nodes_(axis_),
      linear_(transfer, emission) {
  if (!(low < high) || !std::isfinite(high - low) || !(length > 0) || !std::isfinite(length))
    throw InputError(fmt::format(
        "found gray values for scalars from {} to {} and slabs of length {}; an ascending range and a length > 0 are "
        "allowed",
        low, high, length));
  for (std::size_t i = 0; i < item_count; ++i) {
    const Optics optics = transfer.at(low + (high - low) * (static_cast<double>(i) / largest_gray));
    for (std::size_t side = 0; side < 2; ++side) {
      const std::size_t at = side == 0 ? i : item_count - 1 - i;
      for (std::size_t c = 0; c < 3; ++c) items_[side][c][at] = optics.color[static_cast<Eigen::Index>(c)];
      items_[side][3][at] = optics.extinction;
    }
  }
}

double QuadraticGrayPrinted::item(const Items& items, double s) const {
  const double at = std::clamp(s, 0.0, largest_gray);
  constexpr std::size_t last = item_count - 1;
  if (!print_.smoothed) {
    const auto i = std::min(static_cast<std::size_t>(at), last - 1);
    return items[i] + (at - static_cast<double>(i)) * (items[i + 1] - items[i]);
  }
  // NOLINTNEXTLINE(bugprone-incorrect-roundings): as printed, and nothing is negative
  const auto i = std::min(static_cast<std::size_t>(at + 0.5), last);
  const double middle = items[i];
  const double before = items[i > 0 ? i - 1 : 1];
  const double after = items[i < last ? i + 1 : last - 1];
  const double t = at + 0.5 - static_cast<double>(i);
  return (0.5 * (after + before) - middle) * t * t + t * (middle - before) + 0.5 * (middle + before);
}

double QuadraticGrayPrinted::density(std::size_t channel, double s) const {
  const auto& items = items_[side_];
  if (channel == extinction || emission_ == Emission::plain) return item(items[channel], s);
  return item(items[channel], s) * item(items[extinction], s);
}

double QuadraticGrayPrinted::simpson(std::size_t channel, double minimum, double low, double high) {
  evaluations_ += 3;
  const auto value = [&](double s) { return density(channel, s) / (2 * std::sqrt(s - minimum)); };
  return (high - low) / 6 * (value(low) + 4 * value(0.5 * (low + high)) + value(high));
}

double QuadraticGrayPrinted::exact(std::size_t channel, double minimum, double low, double high) {
  // Between neighbours of these the density is one polynomial: in y = sqrt(s - M) of degree 8 at most.
  const double offset = print_.smoothed ? 0.5 : 0.0;
  double sum = 0;
  for (double from = low; from < high;) {
    const double next = from < 0 ? 0.0 : std::min(std::floor(from - offset) + offset + 1, largest_gray);
    const double to = next > from ? std::min(next, high) : high;
    const double first = std::sqrt(from - minimum);
    const double width = (to - from) / (std::sqrt(to - minimum) + first);
    evaluations_ += 7;
    sum += gauss<7>([&](double y) { return density(channel, from + y * (2 * first + y)); }, 0, width);
    from = to;
  }
  return sum;
}

double QuadraticGrayPrinted::integral(std::size_t channel, double minimum, const SumPiece& piece) {
  if (piece.rule == PieceRule::exact) return exact(channel, minimum, piece.low, piece.high);
  if (piece.rule == PieceRule::simpson) return simpson(channel, minimum, piece.low, piece.high);
  const auto value = [&](double s) { return density(channel, s) / (2 * std::sqrt(s - minimum)); };
  const double step = (piece.high - piece.low) / whole_steps;
  const double first = piece.low + step;
  double sum = 0.5 * (value(first) + value(piece.high));
  const int end = print_.inclusive_loops ? whole_steps : whole_steps - 1;
  for (int k = 1; k <= end; ++k) sum += value(first + k * step);
  evaluations_ += 2 + end;
  return sum * step;
}

void QuadraticGrayPrinted::add_levels(double low, double high, bool falls, double times) {
  const PieceRule rule = print_.simpson ? PieceRule::simpson : PieceRule::exact;
  const auto count = static_cast<int>(high - low);
  for (int k = 0; k < count; ++k) {
    const double level = falls ? high - 1 - k : low + k;
    pieces_.push_back({.low = level, .high = level + 1, .rule = rule, .falls = falls, .times = times});
  }
}

void QuadraticGrayPrinted::add_minimum(double minimum, double end, bool falls, double times) {
  if (print_.minimum == AroundMinimum::dropped) return;
  const bool is_exact = print_.minimum == AroundMinimum::exact;
  if (!is_exact && end - minimum < least_fraction) return;
  pieces_.push_back({.low = minimum,
                     .high = end,
                     .rule = is_exact ? PieceRule::exact : PieceRule::ten_steps,
                     .falls = falls,
                     .times = times});
}

void QuadraticGrayPrinted::cut(double front, double back, const Curve& curve, bool is_of_opacity) {
  pieces_.clear();
  const double more = is_of_opacity && print_.inclusive_loops ? 1 : 0;
  const double slope = slope_of(curve, front, back);
  const double minimum = minimum_of(curve, front, back);
  const bool turns = slope < 0 && slope > -2 * curve.scaled_length && minimum < std::min(front, back) - zero;
  if (!turns) {
    const bool falls = back < front;
    const double low = std::min(front, back);
    const double high = std::max(front, back);
    const bool begins_at_minimum = low - minimum < zero;
    if (begins_at_minimum && !falls) add_minimum(low, low + 1, false, 1);
    add_levels(low + (begins_at_minimum ? 1 : 0), high + more, falls, 1);
    if (begins_at_minimum && falls) add_minimum(low, low + 1, true, 1);
    return;
  }
  // Down to the minimum and up again.
  double first_level = 0;
  const bool is_negative = minimum < 0;
  const bool is_whole = !is_negative && std::ceil(minimum) - minimum < zero;
  if (!is_negative) first_level = std::ceil(minimum) + (is_whole ? 1 : 0);
  const auto add_bottom = [&](bool falls, double times) {
    if (!is_negative) {
      // Where M is a gray value algorithm 9 leaves out the interval behind it.
      if (!is_whole || print_.minimum == AroundMinimum::exact) add_minimum(minimum, first_level, falls, times);
    } else if (!print_.drops_negative) {
      pieces_.push_back({.low = minimum, .high = 0, .rule = PieceRule::exact, .falls = falls, .times = times});
    }
  };
  const bool is_nested = is_of_opacity && print_.nested_end_if && !is_negative && !is_whole;
  const double times = is_nested ? 2 : 1;
  add_levels(first_level, front + more, true, times);
  add_bottom(true, times);
  add_bottom(false, times);
  if (!is_of_opacity || is_negative) {
    add_levels(first_level, back + more, false, 1);
    return;
  }
  // Algorithm 9 doubles the sum up to S_f, the lower end, and adds that from there to S_b.
  add_levels(first_level, front + more, false, times);
  add_levels(front, back + more, false, is_nested ? 3 : 1);
  if (is_nested) add_levels(first_level + 1, front + more, false, 2);
}

double QuadraticGrayPrinted::slope_of(const Curve& curve, double front, double back) {
  return Rules<double>{}.quadratic_gray_slope(front, back, 1, curve.scaled_length);
}

double QuadraticGrayPrinted::minimum_of(const Curve& curve, double front, double back) {
  return Rules<double>{}.quadratic_gray_extremum(front, slope_of(curve, front, back), 1);
}

QuadraticGrayPrinted::Curve& QuadraticGrayPrinted::curve_of(double size) {
  auto& curves = curves_[side_];
  const auto found =
      std::find_if(curves.begin(), curves.end(), [&](const Curve& curve) { return curve.curvature == size; });
  if (found != curves.end()) return *found;
  if (curves.size() == curves_kept) curves.erase(curves.begin());
  const double radius = 1 / std::sqrt(size);
  curves.push_back({.curvature = size, .radius = radius, .scaled_length = length_ / radius});
  return curves.back();
}

double QuadraticGrayPrinted::omega(Curve& curve, std::size_t front, std::size_t back) {
  const auto low = static_cast<double>(std::min(front, back));
  const auto high = static_cast<double>(std::max(front, back));
  const double minimum = minimum_of(curve, low, high);
  cut(low, high, curve, true);
  double sum = 0;
  for (const SumPiece& piece : pieces_) sum += piece.times * integral(extinction, minimum, piece);
  return sum;
}

double QuadraticGrayPrinted::opacity(Curve& curve, std::size_t front, std::size_t back) {
  if (curve.opacities.empty()) curve.opacities.assign(item_count * item_count, -1);
  double& known = curve.opacities[std::min(front, back) * item_count + std::max(front, back)];
  if (known < 0) known = -std::expm1(-curve.radius * omega(curve, front, back));
  return known;
}

QuadraticGrayPrinted::vec4 QuadraticGrayPrinted::light_of(const Curve& curve, double minimum, const SumPiece& piece,
                                                          double in_front) {
  vec4 light = vec4::Zero();
  if (piece.rule != PieceRule::exact) {
    const double depth = curve.radius * integral(extinction, minimum, piece);
    const double seen = std::exp(-in_front) * (depth > 0 ? -std::expm1(-depth) / depth : 1.0);
    for (std::size_t c = 0; c < 3; ++c)
      light[static_cast<Eigen::Index>(c)] = seen * curve.radius * integral(c, minimum, piece);
    light[3] = depth;
    return light;
  }
  // In y = sqrt(s - M), in parts on which the items are one polynomial and that are not deep.
  const double offset = print_.smoothed ? 0.5 : 0.0;
  std::vector<double> ends{piece.low};
  const double next = std::floor(std::max(piece.low, 0.0) - offset);
  for (auto i = static_cast<std::int64_t>(next); i <= static_cast<std::int64_t>(largest_gray); ++i) {
    const double border = static_cast<double>(i) + offset;
    if (border >= offset && border > piece.low && border < piece.high && border <= largest_gray) ends.push_back(border);
  }
  if (piece.low < 0 && piece.high > 0 && offset > 0) ends.insert(ends.begin() + 1, 0.0);
  ends.push_back(piece.high);
  if (piece.falls) std::reverse(ends.begin(), ends.end());
  double before = 0;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const double low = std::min(ends[i], ends[i + 1]);
    const double high = std::max(ends[i], ends[i + 1]);
    const double first = std::sqrt(low - minimum);
    const double width = (high - low) / (std::sqrt(high - minimum) + first);
    // y from the lower end; `way` from the end that is nearer to the viewer.
    const auto scalar = [&](double way) {
      const double y = piece.falls ? width - way : way;
      return low + y * (2 * first + y);
    };
    const auto depth = [&](double from, double to) {
      return curve.radius * gauss<3>([&](double way) { return density(extinction, scalar(way)); }, from, to);
    };
    const double whole = depth(0, width);
    const double parts = std::ceil(std::clamp(whole / deepest_part, 1.0, most_parts));
    double passed = 0;
    for (std::int64_t part = 0; part < static_cast<std::int64_t>(parts); ++part) {
      const double from = width * (static_cast<double>(part) / parts);
      const double to = width * (static_cast<double>(part + 1) / parts);
      for (std::size_t c = 0; c < 3; ++c)
        light[static_cast<Eigen::Index>(c)] +=
            curve.radius * gauss<15>(
                               [&](double way) {
                                 return density(c, scalar(way)) *
                                        std::exp(-(in_front + before + passed + depth(from, way)));
                               },
                               from, to);
      passed += depth(from, to);
    }
    before += whole;
  }
  light[3] = before;
  return light;
}

QuadraticGrayPrinted::vec4 QuadraticGrayPrinted::upward_entry(Curve& curve, std::size_t front, std::size_t back) {
  const auto first = static_cast<double>(front);
  const auto last = static_cast<double>(back);
  const double minimum = minimum_of(curve, first, last);
  vec4 light = vec4::Zero();
  double depth = 0;
  cut(first, last, curve, false);
  const std::vector<SumPiece> pieces = pieces_;  // opacities cut in the same place
  const bool turns = !pieces.empty() && pieces.front().falls && !pieces.back().falls;
  const auto lowest = static_cast<std::size_t>(std::max(0.0, std::ceil(minimum)));
  for (const SumPiece& piece : pieces) {
    if (!print_.entry_transmittance) {
      const vec4 part = light_of(curve, minimum, piece, depth);
      light.head<3>() += part.head<3>();
      depth += part[3];
      continue;
    }
    const auto index = static_cast<std::size_t>(std::clamp(std::ceil(piece.low), 0.0, largest_gray));
    double seen = 1;
    if (piece.falls)
      seen = 1 - opacity(curve, index, front);
    else if (turns)
      seen = (1 - opacity(curve, lowest, front)) * (1 - opacity(curve, lowest, index));
    else
      seen = 1 - opacity(curve, front, index);
    for (std::size_t c = 0; c < 3; ++c)
      light[static_cast<Eigen::Index>(c)] += seen * curve.radius * integral(c, minimum, piece);
  }
  light[3] = opacity(curve, front, back);
  return light;
}

QuadraticGrayPrinted::vec4 QuadraticGrayPrinted::entry(std::size_t front, std::size_t back, double curvature) {
  const auto scalar = [this](std::size_t gray) {
    return low_ + (high_ - low_) * (static_cast<double>(gray) / largest_gray);
  };
  if (curvature == 0 || (curvature < 0 && print_.upward_only))
    return linear_(QuadraticGray::of_curvature(scalar(front), scalar(back), 0, length_));
  side_ = curvature < 0 ? 1 : 0;
  if (side_ == 0) return upward_entry(curve_of(curvature), front, back);
  return upward_entry(curve_of(-curvature), item_count - 1 - front, item_count - 1 - back);
}

double QuadraticGrayPrinted::omega(std::size_t front, std::size_t back, double curvature) {
  side_ = curvature < 0 ? 1 : 0;
  Curve& curve = curve_of(std::abs(curvature));
  if (side_ == 0) return omega(curve, front, back);
  return omega(curve, item_count - 1 - front, item_count - 1 - back);
}

QuadraticGrayPrinted::vec4 QuadraticGrayPrinted::operator()(double front, double back, double curvature_of_scalars) {
  const auto gray_of = [this](double s) { return (s - low_) / (high_ - low_) * largest_gray; };
  const double curvature = curvature_of_scalars / (high_ - low_) * largest_gray;
  const bool is_flat = std::abs(curvature) * length_ * length_ < 1e-9;
  const auto at = [&](double of_node) -> vec4 {
    if (of_node == 0) return linear_(QuadraticGray::of_curvature(front, back, 0, length_));
    const auto corner = [&](double s) {
      const double gray = std::clamp(gray_of(s), 0.0, largest_gray);
      const double whole = std::min(std::floor(gray), largest_gray - 1);
      return std::pair(static_cast<std::size_t>(whole), gray - whole);
    };
    const auto [f, front_weight] = corner(front);
    const auto [b, back_weight] = corner(back);
    vec4 sum = vec4::Zero();
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t j = 0; j < 2; ++j) {
        const double weight = (i == 0 ? 1 - front_weight : front_weight) * (j == 0 ? 1 - back_weight : back_weight);
        if (weight != 0) sum += weight * entry(f + i, b + j, of_node);
      }
    return sum;
  };
  if (is_flat || (curvature < 0 && print_.upward_only)) return at(0);
  if (!print_.radius_steps) return at(curvature);
  const RadiusNodes::Place place = nodes_.place(curvature);
  vec4 first = at(axis_.curvature(place.first));
  if (place.weight == 0) return first;
  return first + place.weight * (at(axis_.curvature(place.second)) - first);
}

}  // namespace raytruth
