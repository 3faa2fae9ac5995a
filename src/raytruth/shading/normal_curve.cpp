#include "raytruth/shading/normal_curve.hpp"

#include "raytruth/core/real50.hpp"
#include "raytruth/rules/rules.hpp"
#include "raytruth/shading/normal_curve50.hpp"

#include <algorithm>
#include <cmath>

namespace raytruth {

namespace {

/// Rounded unit vectors may have a product beyond 1.
template <class Real>
Real clamped(const Real& cosine) {
  return std::clamp(cosine, Real(-1), Real(1));
}

/// `rule` calls a function of Rules<Real> that gives coefficients, or a weight.
template <class Real, class Rule>
Real weight_by(const Rule& rule, const Real& s, const Real& cosine) {
  Rules<Real> rules;
  if constexpr (requires { rule(rules, s, cosine); })
    return rule(rules, s, clamped(cosine));
  else
    return rules.normal_curve_value(rule(rules, Real(0), Real(1), clamped(cosine)), s);
}

template <class Rule>
const NormalCurve50 in_50_digits{[](const Real50& s, const Real50& cosine) { return weight_by(Rule{}, s, cosine); }};

template <class Rule>
NormalCurve curve(std::string_view name, std::string_view summary, std::string_view source, std::string_view color,
                  std::string_view marker, Rule /*rule*/) {
  NormalCurve result{.name = name,
                     .summary = summary,
                     .source = source,
                     .weight = [](double s, double cosine) { return weight_by(Rule{}, s, cosine); },
                     .in_50_digits = &in_50_digits<Rule>,
                     .coefficients = nullptr,
                     .color = color,
                     .marker = marker};
  if constexpr (requires { Rule{}(Rules<double>{}, 0.0, 0.0, 0.0); })
    result.coefficients = [](double front, double back, double cosine) {
      const Rules<double>::vec4 a = Rule{}(Rules<double>{}, front, back, clamped(cosine));
      return std::array{a[0], a[1], a[2], a[3]};
    };
  return result;
}

std::vector<NormalCurve> make_normal_curves() {
  return {
      curve("normalized_linear", "linear, normalised at every point: the reference", "van Overveld and Wyvill 1997",
            "#000000", "o", [](auto rules, auto s, auto cosine) { return rules.normalized_linear(s, cosine); }),
      curve("slerp", "along the circle at constant angular speed", "Shoemake 1985", "#999999", "s",
            [](auto rules, auto s, auto cosine) { return rules.slerp(s, cosine); }),
      curve("mean_gradient", "the normalised mean all along", "Engel, Kraus and Ertl 2001, in Guetat 2010, section 2.1",
            "#E69F00", "v",
            [](auto rules, auto front, auto back, auto cosine) { return rules.mean_gradient(front, back, cosine); }),
      curve("linear_gradient", "linear, not normalised", "Guetat 2010, section 4", "#56B4E9", "^",
            [](auto rules, auto front, auto back, auto /*cosine*/) { return rules.linear_gradient(front, back); }),
      curve("quadratic_arc", "linear, over a quadratic approximation of its length", "Guetat 2010, eqs. 5 and 8",
            "#009E73", "D",
            [](auto rules, auto front, auto back, auto cosine) { return rules.quadratic_arc(front, back, cosine); }),
      curve("quadratic_arc_printed", "quadratic_arc with its ends exchanged", "Guetat 2010, eq. 6 as printed",
            "#CC79A7", "x",
            [](auto rules, auto front, auto back, auto cosine) {
              return rules.quadratic_arc_printed(front, back, cosine);
            }),
      curve("circle_arc", "cubic, in the middle the circle and its speed", "this project", "#0072B2", "P",
            [](auto rules, auto front, auto back, auto cosine) { return rules.circle_arc(front, back, cosine); }),
      curve("circle_arc_tuned", "circle_arc with the least deviation of its length from 1", "this project", "#D55E00",
            "X",
            [](auto rules, auto front, auto back, auto cosine) { return rules.circle_arc_tuned(front, back, cosine); }),
      curve("minimax_arc", "cubic with the least distance from normalized_linear", "this project", "#882255", "*",
            [](auto rules, auto front, auto back, auto cosine) { return rules.minimax_arc(front, back, cosine); }),
      curve(
          "minimax_circle_arc", "cubic with the least distance from slerp", "this project", "#332288", "h",
          [](auto rules, auto front, auto back, auto cosine) { return rules.minimax_circle_arc(front, back, cosine); }),
  };
}

}  // namespace

namespace catalogue {

const std::vector<NormalCurve>& normal_curves() {
  static const std::vector<NormalCurve> list = make_normal_curves();
  return list;
}

}  // namespace catalogue

}  // namespace raytruth
