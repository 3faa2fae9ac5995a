#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace raytruth {

/// How specular light falls off with the cosine between normal and half vector. With n the shininess
///
///     lobe     max(0, cosine)^n
///     others   max(0, 1 + (m/q) (cosine - 1))^q,   q = degree, m = exponent(n)
///
/// (src/raytruth/rules/highlights.glsl). The cone, q = 1 and m = n, is 0 below 1 - 1/n; it never exceeds the lobe
/// (Bernoulli), its largest deviation is (1 - 1/n)^n at cosine = 1 - 1/n, and over the hemisphere it reflects
/// (n+1)/(2n) of the lobe's light; m = (n+1)/2 makes up for that (cone_energy).
///
/// The minimax members are those exponents of a degree whose largest deviation from the lobe over cosines 0 to 1 is
/// least. The deviation at any cosine only falls as m grows. So where its maximum (in the flank) and the magnitude of
/// its minimum (at the foot) are equal, a larger m deepens the one and a smaller m raises the other: `minimax_exponent`
/// solves for that m. With fall = n (1 - cosine) and ratio = m/n, extremes are ends of the range or zeros of
///     g(fall) = log(ratio) + (q-1) log(1 - ratio fall / q) - (n-1) log(1 - fall/n),
/// the logarithm of the two slopes' ratio, which turns once, at fall = (q (n-1) - m (q-1)) / (ratio (n-q)), and so has
/// one zero at most on either side of it. In these terms all tends to a limit as n grows: cosine^n to exp(-fall).
///
/// `closed_form` is m exactly, where there is one; `exponent` is the same to rounding. The minimax members have none:
/// of them `exponent`, a binary64 number, is what is meant.
struct Highlight {
  /// (n + addend) / divisor
  struct ClosedForm {
    double addend = 0;
    double divisor = 1;
  };

  std::string_view name;
  std::string_view summary;
  std::string_view source;
  int degree;                                  ///< q; 0: the lobe, no polynomial
  double (*ratio)(double shininess);           ///< m/n; shininess may be infinite
  std::optional<ClosedForm> closed_form = {};  ///< of m; none: `exponent` is what is meant

  /// m.
  [[nodiscard]] double exponent(double shininess) const { return shininess * ratio(shininess); }

  /// The highlight, between 0 and 1 for cosines from -1 to 1. Shininess is at least 1.
  [[nodiscard]] double value(double cosine, double shininess) const;

  /// The value for m already known: for many cosines at one shininess.
  [[nodiscard]] double value_at_exponent(double cosine, double exponent) const;

  /// The highlight is 0 at cosines up to this one.
  [[nodiscard]] double threshold(double shininess) const;
};

/// m/n of the member of this degree nearest to the lobe of shininess n >= 1, which may be infinite; to rounding.
double minimax_ratio(double shininess, int degree);

/// Where a highlight is farthest from the lobe, over cosines 0 to 1.
struct LargestDeviation {
  double deviation = 0;  ///< highlight - lobe
  double fall = 0;       ///< n (1 - cosine)
};

/// The largest deviation of a member of a family (degree 1 to 3), that in the flank where the one at the foot is as
/// large; shininess may be infinite.
LargestDeviation largest_deviation(const Highlight& highlight, double shininess);

namespace catalogue {

/// All of them, in the order of tables and plots.
const std::vector<Highlight>& highlights();

}  // namespace catalogue

}  // namespace raytruth
