#pragma once

#include "raytruth/rules/rules.hpp"
#include "raytruth/schemes/quadratic_gray.hpp"
#include "raytruth/schemes/radius_axis.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace raytruth {

/// What becomes of the part of the signal between its minimum M and the next whole gray value.
enum class AroundMinimum {
  ten_steps,  ///< algorithm 9: the trapezoid rule of ten steps, but for the first one, where the integrand is infinite
  dropped,    ///< the text: sums begin at ceil(M) (eq. 5.3.7)
  exact,
};

/// Where the dissertation's quadratic model, as printed, departs from the integral (section 5.3, algorithms 9 to 11;
/// errata of the dissertation, 5 to 11). Every slip is a switch, so that it can be shown alone, or repaired alone; the
/// readings are of what the print leaves open. Default: as printed.
struct QuadraticGrayPrint {
  // Slips.
  bool simpson = true;  ///< Simpson's rule on tau / (2 sqrt(s - M)) between gray values; else exactly in sqrt(s - M)
  AroundMinimum minimum = AroundMinimum::ten_steps;
  bool smoothed = true;             ///< algorithm 11: a quadratic B-spline of the items; else linear between them
  bool drops_negative = true;       ///< the signal below gray value 0 counts for nothing (eq. 5.3.8)
  bool upward_only = true;          ///< a < 0 gets the linear table (`a < eps`); else its own
  bool entry_transmittance = true;  ///< eq. 5.3.23: that of another entry, whose M is another; else of this parabola
  bool radius_steps = true;         ///< R = 2^-3 to 2^3 and what `look_up` makes between; else R as it is
  // Readings.
  RadiusLookUp look_up = RadiusLookUp::linear_in_radius;
  bool inclusive_loops = false;  ///< `for i = f to b` with b
  bool nested_end_if = false;    ///< the last `end if` of algorithm 9 where it is printed: two sums count again

  /// No slip at all.
  static QuadraticGrayPrint repaired() {
    return {.simpson = false,
            .minimum = AroundMinimum::exact,
            .smoothed = false,
            .drops_negative = false,
            .upward_only = false,
            .entry_transmittance = false,
            .radius_steps = false};
  }
};

/// Radii 2^-3 to 2^3, one-sided (dissertation, section 5.6.1.4).
RadiusAxis printed_radius_axis(RadiusLookUp look_up = RadiusLookUp::linear_in_radius);

/// Slabs of one length of the quadratic gray-value model as the dissertation prints it, between whole gray values: sums
/// over gray values i of integrals over [i, i + 1]. In binary64; the transfer function is 256 items, extinction and
/// colour at gray values 0 to 255. Opacities are algorithm 9's; colours sum eqs. 5.3.13 to 5.3.15 the same way. Entries
/// between which nothing was computed yet are computed when asked for and kept: one object per thread.
class QuadraticGrayPrinted {
 public:
  using vec4 = Rules<double>::vec4;

  /// Gray values 0 to 255 are the scalars `low` to `high`. Throws InputError unless low < high, both finite, length >
  /// 0, and for transfer functions that are linear in opacity.
  QuadraticGrayPrinted(const PiecewiseLinear& transfer, double low, double high, double length, Emission emission,
                       const QuadraticGrayPrint& print = {});

  /// The slab between these scalars, a parabola of this second divided difference in scalars per squared length, as it
  /// is rendered (section 5.5.2): bilinear between whole gray values, R and the threshold of a as printed. Slabs that
  /// are taken as linear are exact.
  vec4 operator()(double front, double back, double curvature);

  [[nodiscard]] double length() const { return length_; }

  /// A table's entry: gray values, curvature in gray values per squared length.
  vec4 entry(std::size_t front, std::size_t back, double curvature);

  /// Its omega, D' = length sqrt|curvature|; symmetric in its ends, as algorithm 9 has it.
  double omega(std::size_t front, std::size_t back, double curvature);

  /// Evaluations of the transfer function so far (algorithm 11).
  [[nodiscard]] std::int64_t evaluations() const { return evaluations_; }

 private:
  static constexpr std::size_t item_count = 256;
  using Items = std::array<double, item_count>;
  enum class PieceRule { simpson, ten_steps, exact };
  /// The scalars from `low` to `high`, counted `times`.
  struct SumPiece {
    double low = 0;
    double high = 0;
    PieceRule rule = PieceRule::simpson;
    bool falls = false;
    double times = 1;
  };
  /// What a curvature's entries share.
  struct Curve {
    double curvature = 0;
    double radius = 1;
    double scaled_length = 1;
    std::vector<double> opacities = {};  ///< [front][back]; -1: not known yet
  };

  [[nodiscard]] double item(const Items& items, double s) const;
  /// Extinction, or what it sends out of a colour channel.
  [[nodiscard]] double density(std::size_t channel, double s) const;
  double integral(std::size_t channel, double minimum, const SumPiece& piece);
  double simpson(std::size_t channel, double minimum, double low, double high);
  double exact(std::size_t channel, double minimum, double low, double high);
  /// The pieces of a slab, front to back; opacity has its own readings.
  void cut(double front, double back, const Curve& curve, bool is_of_opacity);
  static double slope_of(const Curve& curve, double front, double back);
  static double minimum_of(const Curve& curve, double front, double back);
  void add_levels(double low, double high, bool falls, double times);
  void add_minimum(double minimum, double end, bool falls, double times);
  double omega(Curve& curve, std::size_t front, std::size_t back);
  double opacity(Curve& curve, std::size_t front, std::size_t back);
  vec4 upward_entry(Curve& curve, std::size_t front, std::size_t back);
  vec4 light_of(const Curve& curve, double minimum, const SumPiece& piece, double in_front);
  Curve& curve_of(double size);

  double low_;
  double high_;
  double length_;
  Emission emission_;
  QuadraticGrayPrint print_;
  std::array<std::array<Items, 4>, 2> items_{};  ///< colour and extinction; the second ones upside down
  std::size_t side_ = 0;                         ///< which of both is looked at
  std::array<std::vector<Curve>, 2> curves_;
  std::vector<SumPiece> pieces_;
  RadiusAxis axis_;
  RadiusNodes nodes_;
  QuadraticGraySlabs linear_;
  std::int64_t evaluations_ = 0;
};

}  // namespace raytruth
