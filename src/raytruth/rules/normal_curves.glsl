// Curves between the unit normals at the front and at the back of a slab, seen along a direction: N(s).V, 0 <= s <= 1.
//
// With F = N_f.V, B = N_b.V and 2a the angle between the normals, whose cosine is `cosine`, every curve here is
//     N(s).V = w(1-s) F + w(s) B
// for one weight w. Cubic ones that meet the normals at both ends are, for two numbers bulge and skew of c = cos a,
//     w(s) = s + 2 s (1-s) (bulge + (2s-1) skew):
// along the bisector of the normals u = c (1 + bulge (1-x^2)), along their chord v = x sin a (1 + skew (1-x^2)),
// x = 2s-1. They come as the coefficients of 1, s, s^2 and s^3 that tables of the moments of a slab are multiplied by:
//
//     mean_gradient         bisector                        Engel, Kraus and Ertl 2001
//     linear_gradient       0, 0                            Guetat 2010, section 4, eta = 1
//     quadratic_arc         1/c - 1, 1/c - 1                Guetat 2010, eqs. 5 and 8; norm never below 1
//     quadratic_arc_printed the same from back to front     Guetat 2010, eq. 6 as printed
//     circle_arc            1/c - 1, a/sin a - 1            in the middle the circle and its speed
//     circle_arc_tuned      1/c - 1, sqrt((6+2c)/(1+c)) - 2 largest deviation of the squared norm from 1 least
//     minimax_arc           fits                            largest distance from `normalized_linear` least
//     minimax_circle_arc    fits                            largest distance from `slerp` least
//
// The last three minimise for this bulge, or over all cubics (shading/normal_curve.hpp has the proofs). At opposite
// normals all but linear_gradient and the last two are singular.

// c
real normal_curve_cosine(real cosine) {
  return sqrt(0.5 + 0.5 * cosine);
}

// 1 - c, which keeps its digits where the normals are nearly equal.
real normal_curve_rise(real cosine) {
  return (0.5 - 0.5 * cosine) / (1.0 + normal_curve_cosine(cosine));
}

vec4 normal_curve(real front, real back, real bulge, real skew) {
  real even = 2.0 * bulge * (front + back);
  real odd = 2.0 * skew * (back - front);
  return vec4(front, (back - front) + even - odd, 3.0 * odd - even, -2.0 * odd);
}

real normal_curve_value(vec4 coefficients, real s) {
  return coefficients[0] + s * (coefficients[1] + s * (coefficients[2] + s * coefficients[3]));
}

vec4 mean_gradient(real front, real back, real cosine) {
  return vec4((front + back) / (2.0 * normal_curve_cosine(cosine)), 0.0, 0.0, 0.0);
}

vec4 linear_gradient(real front, real back) {
  return vec4(front, back - front, 0.0, 0.0);
}

vec4 quadratic_arc(real front, real back, real cosine) {
  real bulge = normal_curve_rise(cosine) / normal_curve_cosine(cosine);
  return normal_curve(front, back, bulge, bulge);
}

vec4 quadratic_arc_printed(real front, real back, real cosine) {
  return quadratic_arc(back, front, cosine);
}

vec4 circle_arc(real front, real back, real cosine) {
  real bulge = normal_curve_rise(cosine) / normal_curve_cosine(cosine);
  real skew = cosine < 1.0 ? 0.5 * arc_cosine(cosine) / sqrt(0.5 - 0.5 * cosine) - 1.0 : 0.0;
  return normal_curve(front, back, bulge, skew);
}

vec4 circle_arc_tuned(real front, real back, real cosine) {
  real c = normal_curve_cosine(cosine);
  real rise = normal_curve_rise(cosine);
  return normal_curve(front, back, rise / c, 2.0 * rise / ((1.0 + c) * (sqrt((6.0 + 2.0 * c) / (1.0 + c)) + 2.0)));
}

// For angles to 130 degrees the distance is within 2 % of the least one of all cubics.
vec4 minimax_arc(real front, real back, real cosine) {
  real rise = normal_curve_rise(cosine);
  real bulge = rise * (1.0 - rise * (66.0 - 14.0 * rise) / (256.0 - 143.0 * rise)) / normal_curve_cosine(cosine);
  real skew = rise * (512.0 - 380.0 * rise) / (512.0 - 475.0 * rise);
  return normal_curve(front, back, bulge, skew);
}

// For angles to 170 degrees the distance is within 2 % of the least one of all cubics.
vec4 minimax_circle_arc(real front, real back, real cosine) {
  real rise = normal_curve_rise(cosine);
  real bulge = rise * (1.0 - rise * (128.0 + 35.0 * rise) / 4480.0) / normal_curve_cosine(cosine);
  real skew = rise * (12.0 + rise * (3.0 + rise * 4.0)) / 36.0;
  return normal_curve(front, back, bulge, skew);
}

// The weight w(s) of the linear interpolation, normalised: s / sqrt(1 - 4 s (1-s) sin^2 a). The reference.
real normalized_linear(real s, real cosine) {
  real x = 2.0 * s - 1.0;
  return s / sqrt(0.5 + 0.5 * cosine + x * x * (0.5 - 0.5 * cosine));
}

// The weight w(s) of the circle at constant angular speed: sin(2as) / sin(2a) (Shoemake 1985).
real slerp(real s, real cosine) {
  return cosine < 1.0 ? sine(s * arc_cosine(cosine)) / sqrt((1.0 - cosine) * (1.0 + cosine)) : s;
}
