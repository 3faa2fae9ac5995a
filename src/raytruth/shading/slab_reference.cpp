#include "raytruth/shading/slab_reference.hpp"

#include "raytruth/reference/arb/arb_complex.hpp"
#include "raytruth/reference/arb/arb_stretches.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/transfer/emission.hpp"

#include <acb_calc.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace raytruth {

namespace {

using arb::Ball;
using arb::BallPiece;
using arb::BallStretch;
using arb::Box;
using arb::Color;
using arb::evaluate;
using arb::PointsCut;
using arb::Polynomial;

// As in arb_integral.cpp: some decimal digits more than binary64 holds.
constexpr slong quadrature_precision = 96;
constexpr slong quadrature_goal = 60;

/// N.V = numerator / sqrt(norm_square), polynomials in x on [0, 1]; the norm is above 0.
struct Cosine {
  Polynomial numerator;
  Polynomial norm_square;

  [[nodiscard]] Ball operator()(const Ball& x) const { return numerator(x) / sqrt(norm_square(x)); }
  [[nodiscard]] Cosine restricted(const Ball& begin, const Ball& end) const {
    return {numerator.restricted(begin, end), norm_square.restricted(begin, end)};
  }
};

/// What lighting makes of a cosine c where neither the cosine's sign nor the highlight's base does: (a + b c)^power.
struct Shade {
  Ball a;
  Ball b;
  double power = 1;
};

Ball power_of(const Ball& base, double power) {
  Ball result;
  Ball exponent = power;
  // A base that touches 0 may have all powers from 0 on.
  const Ball largest = max(base.magnitude(), 0.0);
  const bool is_whole = std::floor(power) == power;
  if (base.sign() > 0 || is_whole)
    arb_pow(result.get(), base.get(), exponent.get(), arb::precision);
  else {
    arb_pow(result.get(), largest.get(), exponent.get(), arb::precision);
    result = hull(0.0, result);
  }
  return result;
}

int sign_factor(Negative negative, int sign) {
  if (negative == Negative::none) return 1;
  return negative == Negative::mirror ? sign : std::max(sign, 0);
}

/// The shade of the diffuse term, for a cosine of this sign.
Shade diffuse_shade(Negative negative, int sign) { return {0.0, static_cast<double>(sign_factor(negative, sign))}; }

/// A highlight is (1 + slope (cosine - 1))^power, clamped at 0 unless it is a lobe whose negative cosines stay.
struct Highlighting {
  Ball slope;
  double power;
  bool is_clamped;
};

Highlighting highlighting_of(const Lighting& lighting) {
  if (lighting.is_lobe()) return {1.0, lighting.shininess, lighting.negative != Negative::none};
  const Highlight& highlight = *lighting.highlight;
  const double degree = highlight.degree;
  const auto& exact = highlight.closed_form;
  const Ball exponent = exact ? (Ball(lighting.shininess) + exact->addend) / exact->divisor
                              : Ball(highlight.exponent(lighting.shininess));
  return {exponent / degree, degree, true};
}

/// The shade of the highlight, before it is clamped at 0.
Shade highlight_shade(const Highlighting& highlighting, Negative negative, int sign) {
  const Ball& slope = highlighting.slope;
  return {Ball(1.0) - slope, slope * static_cast<double>(sign_factor(negative, sign)), highlighting.power};
}

// --- Cuts ---

struct Gap {
  Ball begin;
  Ball end;
};

/// p over a box: the centred form, much narrower than Horner's where the box is small.
Ball over_box(const Polynomial& p, const Ball& begin, const Ball& end) {
  const Ball middle = ((begin + end) * 0.5).middle();
  Polynomial shifted;
  arb_poly_taylor_shift_horner(shifted.get(), p.get(), middle.get(), arb::precision);
  return shifted(hull(begin, end) - middle);
}

/// Isolates the roots of p in [begin, end] by halving: outside the gaps p has no root. Halving ends where rounding
/// hides the sign, or at a width whose square is below all that counts: next to a root that small nothing is larger.
void isolate(const Polynomial& p, const Ball& begin, const Ball& end, std::vector<Gap>& gaps) {
  const Ball box = over_box(p, begin, end);
  if (box.sign() != 0) return;
  const bool is_narrow = !(Ball(0x1p-48) < end - begin);
  if (is_narrow || box.magnitude() <= Ball(0x1p-90)) {
    const bool continues = !gaps.empty() && !(gaps.back().end < begin);
    if (continues)
      gaps.back().end = end;
    else
      gaps.push_back({begin, end});
    return;
  }
  const Ball middle = ((begin + end) * 0.5).middle();
  isolate(p, begin, middle, gaps);
  isolate(p, middle, end, gaps);
}

/// The gaps made disjoint, in order.
std::vector<Gap> merged(std::vector<Gap> gaps) {
  std::sort(gaps.begin(), gaps.end(), [](const Gap& a, const Gap& b) { return a.begin < b.begin; });
  std::vector<Gap> result;
  for (const Gap& gap : gaps) {
    if (!result.empty() && !(result.back().end < gap.begin))
      result.back().end = max(result.back().end, gap.end);
    else
      result.push_back(gap);
  }
  return result;
}

bool is_zero(const Ball& x) { return arb_is_zero(x.get()) != 0; }

/// Whether the polynomial is 0 everywhere, as the numerator is of a vector perpendicular to both normals.
bool is_zero(const Polynomial& p) { return p.size() == 0; }

/// Where the shade of either cosine is not analytic: at its roots, and where the highlight's base is 0. Each has gaps
/// of its own, for a cosine that is 0 all along the slab says nothing of the other one.
struct Gaps {
  std::vector<Gap> light;
  std::vector<Gap> half;
};

Gaps find_gaps(const Cosine& light, const Cosine& half, const Highlighting& highlighting, Negative negative) {
  Gaps gaps;
  const auto add_roots = [](const Polynomial& p, std::vector<Gap>& to) {
    // What is 0 everywhere is analytic, and has no sign to change.
    if (is_zero(p)) return;
    std::vector<Gap> own;
    isolate(p, 0.0, 1.0, own);
    to.insert(to.end(), own.begin(), own.end());
  };
  if (negative != Negative::none) {
    add_roots(light.numerator, gaps.light);
    add_roots(half.numerator, gaps.half);
  }
  if (highlighting.is_clamped) {
    // c = +-(1 - 1/slope); squared, for the norm is a root. What else the square is 0 at does no harm.
    const Ball threshold = Ball(1.0) - Ball(1.0) / highlighting.slope;
    add_roots(half.numerator * half.numerator - threshold * threshold * half.norm_square, gaps.half);
  }
  return {merged(std::move(gaps.light)), merged(std::move(gaps.half))};
}

/// Whether a part that no gap ends inside of lies in one of them.
bool are_over(const std::vector<Gap>& gaps, const Ball& begin, const Ball& end) {
  return std::any_of(gaps.begin(), gaps.end(), [&](const Gap& gap) { return gap.begin <= begin && end <= gap.end; });
}

/// All values of a cosine between two places. The ball of the norm over a wide box may reach below 0, where the norm
/// does not: then the box is halved.
Ball cosine_between(const Cosine& cosine, const Ball& begin, const Ball& end) {
  const Ball value = cosine(hull(begin, end));
  const Ball narrowest = 0x1p-12;
  if (arb_is_finite(value.get()) != 0 || !(narrowest < end - begin)) return value;
  const Ball middle = ((begin + end) * 0.5).middle();
  return hull(cosine_between(cosine, begin, middle), cosine_between(cosine, middle, end));
}

// --- Quadrature ---

/// factor exp(-depth), times a shade of a cosine if there is one.
struct Integrand {
  const Polynomial& factor;
  const Polynomial& depth;
  const Cosine* cosine;
  const Shade* shade;
};

/// base^power; indeterminate where it is asked to be analytic and is not.
void raise(acb_ptr result, acb_ptr base, double power, int analytic, slong bits) {
  constexpr double largest_product = 1 << 24;
  if (std::floor(power) == power && power <= largest_product) {
    acb_pow_ui(result, base, static_cast<ulong>(power), bits);
    return;
  }
  Box exponent;
  acb_set_d(exponent.get(), power);
  if (analytic != 0 || !acb_contains_zero(base)) {
    acb_pow_analytic(result, base, exponent.get(), analytic, bits);
    return;
  }
  // On a box about 0 the power may be all that is no larger.
  Ball largest;
  acb_get_abs_ubound_arf(arb_midref(largest.get()), base, bits);
  arb_pow(largest.get(), largest.get(), acb_realref(exponent.get()), bits);
  acb_zero(result);
  acb_add_error_arb(result, largest.upper().get());
}

int integrand(acb_ptr result, const acb_t z, void* parameter, slong order, slong bits) {
  const auto& [factor, depth, cosine, shade] = *static_cast<const Integrand*>(parameter);
  const int analytic = order != 0 ? 1 : 0;
  Box value;
  evaluate(value.get(), depth, z, bits);
  acb_neg(value.get(), value.get());
  acb_exp(value.get(), value.get(), bits);
  Box sum;
  evaluate(sum.get(), factor, z, bits);
  acb_mul(value.get(), value.get(), sum.get(), bits);
  if (cosine != nullptr) {
    evaluate(sum.get(), cosine->norm_square, z, bits);
    acb_rsqrt_analytic(sum.get(), sum.get(), analytic, bits);
    Box numerator;
    evaluate(numerator.get(), cosine->numerator, z, bits);
    acb_mul(sum.get(), sum.get(), numerator.get(), bits);
    acb_mul_arb(sum.get(), sum.get(), shade->b.get(), bits);
    acb_add_arb(sum.get(), sum.get(), shade->a.get(), bits);
    raise(sum.get(), sum.get(), shade->power, analytic, bits);
    acb_mul(value.get(), value.get(), sum.get(), bits);
  }
  acb_set(result, value.get());
  return 0;
}

/// The integral over [0, 1], to about 2^-quadrature_goal of `scale`.
Ball integral(const Integrand& what, const Ball& scale) {
  if (what.factor.size() == 0) return {};
  Box begin;
  Box end;
  Box sum;
  acb_one(end.get());
  mag_t tolerance;
  mag_init(tolerance);
  arb_get_mag(tolerance, scale.get());
  mag_mul_2exp_si(tolerance, tolerance, -quadrature_goal);
  acb_calc_integrate(sum.get(), integrand, const_cast<Integrand*>(&what), begin.get(), end.get(), quadrature_goal,
                     tolerance, nullptr, quadrature_precision);
  mag_clear(tolerance);
  Ball result;
  arb_set(result.get(), acb_realref(sum.get()));
  return result;
}

// --- The slab ---

/// Both shades of a part of the slab: analytic ones, or, where a cut hides, the values that they may have.
struct PartShades {
  bool is_diffuse_analytic = false;
  bool is_specular_analytic = false;
  Shade diffuse;
  Shade specular;
  bool is_dark = false;        ///< an analytic part that is sends no diffuse light
  bool has_highlight = false;  ///< an analytic part without one sends no specular light
  Ball diffuse_value;
  Ball specular_value;
};

struct Sums {
  Color ambient;
  Color diffuse;
  Ball specular;
  Ball depth;
};

/// b_i = sum over k <= i of binomial(i, k) / binomial(n, k) a_k.
std::vector<Ball> bernstein_coefficients(const Polynomial& p) {
  const slong n = std::max<slong>(p.size() - 1, 0);
  std::vector<Ball> result;
  for (slong i = 0; i <= n; ++i) {
    Ball sum;
    Ball share = 1.0;  // binomial(i, k) / binomial(n, k)
    for (slong k = 0; k <= i && k < p.size(); ++k) {
      sum += share * p.coefficient(k);
      if (k < i) share = share * Ball(static_cast<double>(i - k)) / Ball(static_cast<double>(n - k));
    }
    result.push_back(sum);
  }
  return result;
}

class SlabSum {
 public:
  SlabSum(Polynomial signal, double length, const PiecewiseLinear& transfer, Emission emission,
          const Lighting& lighting, Cosine light, Cosine half)
      : signal_(std::move(signal)),
        length_(length),
        cut_(transfer),
        is_associated_(emission == Emission::associated),
        lighting_(lighting),
        highlighting_(highlighting_of(lighting)),
        light_(std::move(light)),
        half_(std::move(half)) {}

  CertifiedRadiance operator()(double tolerance) {
    const Ball brightest = cut_.largest_color(0.0);
    const Ball light = is_associated_ ? max(1.0, brightest) : max(1.0, brightest) * Ball(length_);
    const Ball cosines = max(1.0, max(largest(light_), largest(half_)));
    const Ball coefficients = max(1.0, Ball(lighting_.ambient) + Ball(lighting_.diffuse) + Ball(lighting_.specular));
    largest_light_ =
        max(1.0, light) * coefficients *
        power_of(max(1.0, Ball(1.0) + highlighting_.slope * (cosines - 1.0)) * cosines, highlighting_.power + 1);
    if (length_ > 0) sum_up();
    return rounded(tolerance, max(1.0, is_associated_ ? brightest : brightest * Ball(length_)).upper_double());
  }

 private:
  /// A bound on |cosine|: cubics have no norm, and cosines of unit vectors are hardly larger than 1.
  [[nodiscard]] static Ball largest(const Cosine& cosine) {
    return cosine.norm_square.size() <= 1 ? cosine.numerator.magnitude() : Ball(1.0 + 4 * largest_norm_error);
  }

  /// All light and opacity that may come from behind what is summed up.
  [[nodiscard]] Ball hidden() const { return (exp(-sums_.depth) * largest_light_).upper(); }

  void sum_up() {
    const Gaps gaps = find_gaps(light_, half_, highlighting_, lighting_.negative);
    std::vector<Ball> borders{1.0};
    for (const std::vector<Gap>* own : {&gaps.light, &gaps.half})
      for (const Gap& gap : *own) borders.insert(borders.end(), {gap.begin, gap.end});
    std::sort(borders.begin(), borders.end());
    Ball reached = 0.0;
    for (const Ball& border : borders) {
      add_part(reached, border, gaps);
      reached = border;
    }
  }

  [[nodiscard]] PartShades shades_of(const Ball& begin, const Ball& end, const Gaps& gaps) const {
    const Negative negative = lighting_.negative;
    PartShades result;
    const Ball middle = ((begin + end) * 0.5).middle();
    const int light_sign = light_.numerator(middle).sign();
    const int half_sign = half_.numerator(middle).sign();
    result.diffuse = diffuse_shade(negative, light_sign);
    result.specular = highlight_shade(highlighting_, negative, half_sign);
    const Ball base = result.specular.a + result.specular.b * half_(middle);
    result.is_dark = is_zero(result.diffuse.b) || is_zero(light_.numerator);
    result.has_highlight = !highlighting_.is_clamped || base.sign() > 0;
    const auto is_known = [negative](int sign, const Cosine& cosine) {
      return negative == Negative::none || sign != 0 || is_zero(cosine.numerator);
    };
    const bool is_clear = !highlighting_.is_clamped || base.sign() != 0 || is_zero(base);
    result.is_diffuse_analytic = is_known(light_sign, light_) && !are_over(gaps.light, begin, end);
    result.is_specular_analytic = is_known(half_sign, half_) && is_clear && !are_over(gaps.half, begin, end);
    enclose_shades(begin, end, result);
    return result;
  }

  /// All values that shades may have which are not analytic.
  void enclose_shades(const Ball& begin, const Ball& end, PartShades& shades) const {
    const auto treated = [this](const Ball& cosine) {
      if (lighting_.negative == Negative::clamp) return max(cosine, 0.0);
      return lighting_.negative == Negative::mirror ? max(cosine, -cosine) : cosine;
    };
    if (!shades.is_diffuse_analytic) shades.diffuse_value = treated(cosine_between(light_, begin, end));
    if (shades.is_specular_analytic) return;
    const Ball cosine = treated(cosine_between(half_, begin, end));
    Ball base = Ball(1.0) - highlighting_.slope + highlighting_.slope * cosine;
    if (highlighting_.is_clamped) base = max(base, 0.0);
    shades.specular_value = power_of(base, highlighting_.power);
  }

  void add_part(const Ball& begin, const Ball& end, const Gaps& gaps) {
    if (!(begin < end)) return;
    // Nothing behind shows any more, but for what `rounded` adds.
    is_cut_short_ = is_cut_short_ || hidden() < Ball(0x1p-80);
    if (is_cut_short_) return;
    const PartShades shades = shades_of(begin, end, gaps);
    BallPiece piece{
        .signal = signal_.size() <= 1 ? signal_ : signal_.restricted(begin, end), .control = {}, .length = end - begin};
    piece.control = bernstein_coefficients(piece.signal);
    Ball reached = begin;
    cut_(piece, [&](const BallStretch& stretch) {
      add_stretch(stretch, reached, shades);
      reached += stretch.length;
    });
  }

  /// `stretch` has its length in units of the slab's, and begins at x = `begin`.
  void add_stretch(const BallStretch& stretch, const Ball& begin, const PartShades& shades) {
    const Ball length = stretch.length * Ball(length_);
    const Polynomial depth = length * stretch.extinction.antiderivative();
    const Ball total = depth(1.0);
    const Ball front = exp(-sums_.depth);
    const Ball end = begin + stretch.length;
    const Cosine light = light_.restricted(begin, end);
    const Cosine half = half_.restricted(begin, end);
    const Polynomial density = is_associated_ ? length * stretch.extinction : Polynomial(length);
    const Ball opacity = -expm1(-total);
    const Ball scale = is_associated_ ? opacity : Ball(1.0) < total ? length / total : length;

    const auto& change = stretch.color_change;
    const bool has_weight = !std::all_of(change.begin(), change.end(), [](const Ball& x) { return is_zero(x); });
    const Polynomial weighted = has_weight ? stretch.weight * density : Polynomial();
    const auto plain = [&](const Polynomial& factor) { return integral({factor, depth, nullptr, nullptr}, scale); };
    const auto shaded = [&](const Polynomial& factor, const Cosine& cosine, const Shade& shade) {
      return integral({factor, depth, &cosine, &shade}, scale);
    };
    const Ball of_one = is_associated_ ? opacity : plain(density);
    const Ball of_weight = plain(weighted);
    Ball diffuse_of_one = shades.diffuse_value * of_one;
    Ball diffuse_of_weight = shades.diffuse_value * of_weight;
    Ball specular = shades.specular_value * of_one;
    if (shades.is_diffuse_analytic) {
      diffuse_of_one = shades.is_dark ? Ball() : shaded(density, light, shades.diffuse);
      diffuse_of_weight = shades.is_dark ? Ball() : shaded(weighted, light, shades.diffuse);
    }
    if (shades.is_specular_analytic) specular = shades.has_highlight ? shaded(density, half, shades.specular) : Ball();
    for (std::size_t i = 0; i < 3; ++i) {
      sums_.ambient[i] += front * (stretch.color[i] * of_one + change[i] * of_weight);
      sums_.diffuse[i] += front * (stretch.color[i] * diffuse_of_one + change[i] * diffuse_of_weight);
    }
    sums_.specular += front * specular;
    sums_.depth += total;
  }

  CertifiedRadiance rounded(double tolerance, double largest_color) {
    CertifiedRadiance result;
    const auto round = [&](const Ball& ball) {
      if (arb_is_finite(ball.get()) == 0) {
        result.radius = std::numeric_limits<double>::infinity();
        return 0.0;
      }
      const double nearest = ball.nearest();
      result.radius = std::max(result.radius, (ball - Ball(nearest)).magnitude().upper_double());
      return nearest;
    };
    const auto color = [&](double coefficient, const Ball& sum) {
      const Ball light = Ball(coefficient) * sum;
      return round(is_cut_short_ ? widened(light, hidden()) : light);
    };
    for (std::size_t i = 0; i < 3; ++i) {
      const auto channel = static_cast<Eigen::Index>(i);
      result.ambient[channel] = color(lighting_.ambient, sums_.ambient[i]);
      result.diffuse[channel] = color(lighting_.diffuse, sums_.diffuse[i]);
    }
    result.specular.setConstant(color(lighting_.specular, sums_.specular));
    const Ball opacity = -expm1(-sums_.depth);
    result.opacity = round(is_cut_short_ ? hull(opacity, 1.0) : opacity);
    if (!(result.radius <= tolerance * largest_color)) result.status = Status::not_converged;
    return result;
  }

  Polynomial signal_;  ///< in x
  double length_;
  PointsCut cut_;
  bool is_associated_;
  const Lighting& lighting_;
  Highlighting highlighting_;
  Cosine light_;
  Cosine half_;
  Sums sums_;
  Ball largest_light_;
  bool is_cut_short_ = false;
};

Ball dot(const Vector3<double>& a, const Vector3<double>& b) {
  Ball sum;
  for (Eigen::Index i = 0; i < 3; ++i) sum += Ball(a[i]) * Ball(b[i]);
  return sum;
}

Polynomial polynomial(std::initializer_list<Ball> coefficients) {
  Polynomial result;
  slong k = 0;
  for (const Ball& coefficient : coefficients) result.set(k++, coefficient);
  return result;
}

/// The line from `front` at 0 to `back` at 1; equal ends make a constant.
Polynomial linear(double front, double back) {
  return front == back ? Polynomial(front) : polynomial({Ball(front), Ball(back) - Ball(front)});
}

/// The polynomial in powers of x, exactly.
Polynomial power_basis(const Bernstein<3>& p) {
  const auto& [a, b, c, d] = p.coefficients;
  const Ball first(a);
  const Ball second(b);
  const Ball third(c);
  return polynomial({first, Ball(3.0) * (second - first), Ball(3.0) * (first - Ball(2.0) * second + third),
                     Ball(d) - first + Ball(3.0) * (second - third)});
}

/// The numerator of N.V for the chord from one normal to the other.
Polynomial chord(const ShadedSlab& slab, const Vector3<double>& vector) {
  const Ball front = dot(slab.front_normal, vector);
  return polynomial({front, dot(slab.back_normal, vector) - front});
}

/// |(1 - x) N_f + x N_b|^2.
Polynomial chord_square(const ShadedSlab& slab) {
  const Ball front = dot(slab.front_normal, slab.front_normal);
  const Ball mixed = dot(slab.front_normal, slab.back_normal);
  const Ball back = dot(slab.back_normal, slab.back_normal);
  return polynomial({front, Ball(2.0) * (mixed - front), front - Ball(2.0) * mixed + back});
}

}  // namespace

CertifiedRadiance slab_reference(const ShadedSlab& slab, const PiecewiseLinear& transfer, Emission emission,
                                 const Lighting& lighting, double tolerance) {
  check(slab);
  check(lighting);
  const Polynomial norm_square = chord_square(slab);
  const PiecewiseLinear in_extinction = linear_in_extinction(transfer);
  return SlabSum(linear(slab.front, slab.back), slab.length, in_extinction, emission, lighting,
                 {chord(slab, lighting.light), norm_square}, {chord(slab, lighting.half), norm_square})(tolerance);
}

CertifiedRadiance cubic_reference(const ShadedSlab& slab, const PiecewiseLinear& transfer, Emission emission,
                                  const Lighting& lighting, const Cubic& light_cosine, const Cubic& half_cosine,
                                  double tolerance) {
  const auto cosine = [](const Cubic& a) {
    return Cosine{polynomial({Ball(a[0]), Ball(a[1]), Ball(a[2]), Ball(a[3])}), Polynomial(1.0)};
  };
  const PiecewiseLinear in_extinction = linear_in_extinction(transfer);
  return SlabSum(linear(slab.front, slab.back), slab.length, in_extinction, emission, lighting, cosine(light_cosine),
                 cosine(half_cosine))(tolerance);
}

CertifiedRadiance gradient_reference(const Bernstein<3>& scalar, double length,
                                     const std::array<Bernstein<3>, 3>& gradient, const PiecewiseLinear& transfer,
                                     Emission emission, const Lighting& lighting, double tolerance) {
  check(lighting);
  std::array<Polynomial, 3> vector;
  for (std::size_t axis = 0; axis < 3; ++axis) vector[axis] = power_basis(gradient[axis]);
  const Polynomial norm_square = vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2];
  const auto along = [&](const Vector3<double>& direction) {
    return Ball(direction[0]) * vector[0] + Ball(direction[1]) * vector[1] + Ball(direction[2]) * vector[2];
  };
  return SlabSum(power_basis(scalar), length, transfer, emission, lighting, {along(lighting.light), norm_square},
                 {along(lighting.half), norm_square})(tolerance);
}

}  // namespace raytruth
