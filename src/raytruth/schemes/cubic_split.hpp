#pragma once

#include "raytruth/schemes/order3.hpp"

#include <cstddef>
#include <string_view>
#include <vector>

namespace raytruth {

/// Where a polynomial is cut into parts, each replaced by the parabola through its ends and its middle.
enum class CubicSplit {
  none,        ///< nowhere: one parabola
  inflection,  ///< at every point of inflection inside (the dissertation, section 5.4)
  extrema,     ///< at every extremum inside (its last paragraph)
  middle,      ///< in the middle: parts keep one length, so that one table of slabs holds them
  fewest,      ///< into the fewest equal parts whose mean error keeps a tolerance
};

/// `CubicSplit::fewest` makes no more parts than this.
inline constexpr int most_cubic_parts = 1024;

/// The mean of abs(p - parabola) over p cut into `parts` equal parts, in scalars: of a cubic in closed form.
template <int Degree, class Real>
Real mean_split_error(const Bernstein<Degree, Real>& p, int parts) {
  if constexpr (Degree == 3) {
    const auto& b = p.coefficients;
    return Rules<Real>{}.cubic_split_mean_error({b[0], b[1], b[2], b[3]}) / (Real(parts) * Real(parts) * Real(parts));
  } else {
    Rules<Real> rules;
    Real sum(0);
    for (int part = 0; part < parts; ++part) {
      const auto own = p.restricted(Real(part) / Real(parts), Real(part + 1) / Real(parts));
      const auto parabola = Rules<Real>::cubic(
          rules.cubic_split_parabola(own.coefficients.front(), own.value(Real(0.5)), own.coefficients.back()));
      sum = sum + (own - parabola.template elevated<Degree>()).integral_of_magnitude();
    }
    return sum / Real(parts);
  }
}

/// The borders of the parts, 0 first, 1 last, ascending, in `borders`, which is overwritten and keeps its memory; a cut
/// outside of (0, 1) is none. `tolerance` is that of `fewest`, in scalars: a mean of abs(p - parabola), that of the
/// field where all parts keep it. Equal parts are the best ones for a cubic; for higher degrees unequal ones may be
/// fewer.
template <int Degree, class Real>
void split_borders(const Bernstein<Degree, Real>& p, CubicSplit split, const Real& tolerance,
                   std::vector<Real>& borders) {
  borders.assign(1, Real(0));
  const auto cut = [&borders](const Real& u) {
    if (borders.back() < u && u < Real(1)) borders.push_back(u);
  };
  if (split == CubicSplit::middle) cut(Real(0.5));
  if constexpr (Degree == 3) {
    const auto& b = p.coefficients;
    const typename Rules<Real>::vec4 cubic(b[0], b[1], b[2], b[3]);
    Rules<Real> rules;
    if (split == CubicSplit::inflection) cut(rules.cubic_split_inflection(cubic));
    if (split == CubicSplit::extrema) {
      const typename Rules<Real>::vec4 extrema = rules.cubic_split_extrema(cubic);
      cut(extrema[1]);
      cut(extrema[2]);
    }
  } else {
    if (split == CubicSplit::inflection)
      for (const Real& u : p.derivative().derivative().sign_changes()) cut(u);
    if (split == CubicSplit::extrema)
      for (const Real& u : p.derivative().sign_changes()) cut(u);
  }
  if (split == CubicSplit::fewest) {
    int parts = 1;
    while (parts < most_cubic_parts && mean_split_error(p, parts) > tolerance) ++parts;
    for (int part = 1; part < parts; ++part) cut(Real(part) / Real(parts));
  }
  borders.push_back(Real(1));
}

/// Appends the parabolas of the parts of a piece between these borders.
template <int Degree, class Real>
void append_parts(const Piece<Degree, Real>& piece, const std::vector<Real>& borders, Chain<3, Real>& approximation) {
  Rules<Real> rules;
  for (std::size_t i = 0; i + 1 < borders.size(); ++i) {
    const Real& begin = borders[i];
    const Real& end = borders[i + 1];
    const auto parabola = [&] {
      const auto& b = piece.polynomial.coefficients;
      if constexpr (Degree == 3)
        return rules.cubic_split_part({b[0], b[1], b[2], b[3]}, begin, end);
      else
        return rules.cubic_split_parabola(piece.polynomial.value(begin),
                                          piece.polynomial.value((begin + end) * Real(0.5)),
                                          piece.polynomial.value(end));
    }();
    approximation.pieces.push_back({piece.start + Abscissa<Real>(begin * piece.length),
                                    Real((end - begin) * piece.length), Rules<Real>::cubic(parabola)});
  }
}

/// The largest mean error of `cubic_split_fewest` in a slab, in scalars: 1/256 of the range of the cubic's values at 0,
/// 1/3, 2/3 and 1, the slab's four samples. It takes six parts at most.
template <class Real>
Real fewest_tolerance(const Bernstein<3, Real>& cubic) {
  const auto& b = cubic.coefficients;
  const auto [low, high] = std::minmax({b[0], cubic.value(Real(1) / Real(3)), cubic.value(Real(2) / Real(3)), b[3]});
  return Real((high - low) / Real(256));
}

/// The slab of Order3 that begins at sample k: one cubic, a line where Order3 is linear.
template <int Degree, class Real>
Piece<3, Real> order3_slab(const Chain<Degree, Real>& signal, const Samples<Real>& samples, std::size_t k) {
  const std::size_t next = k + Order3::slab_intervals(samples, k);
  Piece<3, Real> slab{samples.positions[k], static_cast<Real>(samples.positions[next] - samples.positions[k]), {}};
  const auto* const value = samples.values.data() + k;
  slab.polynomial = next == k + 3
                        ? Rules<Real>::cubic(Rules<Real>{}.cubic_split_cubic(value[0], value[1], value[2], value[3]))
                        : Order3::interval(signal, samples, k);
  return slab;
}

/// Order3's slabs, their cubics replaced by parabolas; each part is a look-up. What Order3 leaves linear stays linear,
/// and an interval that is left over is a slab of its own.
template <CubicSplit Split>
struct CubicSplitScheme {
  template <class Real>
  static std::string_view refusal(const Samples<Real>& samples) {
    return Order3::refusal(samples);
  }

  template <class Real>
  static std::size_t slab_intervals(const Samples<Real>& samples, std::size_t k) {
    return Order3::slab_intervals(samples, k);
  }

  /// Appends the slab that begins at sample k.
  template <int Degree, class Real>
  static void append_slab(const Chain<Degree, Real>& signal, const Samples<Real>& samples, std::size_t k,
                          Chain<3, Real>& approximation) {
    const Piece<3, Real> slab = order3_slab(signal, samples, k);
    std::vector<Real> borders{Real(0), Real(1)};
    const std::size_t full = full_intervals(samples);
    if (k < full && full >= 3) split_borders(slab.polynomial, Split, fewest_tolerance(slab.polynomial), borders);
    append_parts(slab, borders, approximation);
  }

 protected:
  /// The row of the catalogue. Only `middle` cuts every slab of a smooth signal, in whatever step.
  static constexpr SchemeInfo info_of(std::string_view name, std::string_view summary, std::string_view source,
                                      std::string_view color, std::string_view marker) {
    return {.name = name,
            .summary = summary,
            .source = source,
            .exact_degree = 2,
            .order = 3,
            .error_constant = Split == CubicSplit::middle ? 9.0 / 512 : 9.0 / 64,
            .integral_order = 4,
            .extra_fetches_per_interval = 0,
            .color = color,
            .marker = marker};
  }
};

struct CubicSplitNone : CubicSplitScheme<CubicSplit::none> {
  static constexpr SchemeInfo info =
      info_of("cubic_split_none", "one parabola through ends and middle of the cubic of four samples",
              "this project; what the dissertation, section 5.4, improves on", "#999999", "s");
};

struct CubicSplitInflection : CubicSplitScheme<CubicSplit::inflection> {
  static constexpr SchemeInfo info =
      info_of("cubic_split_inflection", "parabolas on both sides of the cubic's inflection",
              "the dissertation, section 5.4", "#D55E00", "<");
};

struct CubicSplitExtrema : CubicSplitScheme<CubicSplit::extrema> {
  static constexpr SchemeInfo info = info_of("cubic_split_extrema", "parabolas between the cubic's extrema",
                                             "the dissertation, section 5.4, last paragraph", "#009E73", ">");
};

struct CubicSplitMiddle : CubicSplitScheme<CubicSplit::middle> {
  static constexpr SchemeInfo info =
      info_of("cubic_split_middle", "parabolas on both halves of the cubic", "this project", "#0072B2", "8");
};

struct CubicSplitFewest : CubicSplitScheme<CubicSplit::fewest> {
  static constexpr SchemeInfo info =
      info_of("cubic_split_fewest", "fewest equal parts with a mean error of 1/256 of the slab's range", "this project",
              "#332288", "*");
};

}  // namespace raytruth
