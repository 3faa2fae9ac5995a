// Simpson slab: the parabola through three equally spaced values for the extinction, and once more for the emission
// that it attenuates (K. Novins and J. Arvo, Controlled precision volume integration, 1992).
//
//     D(1/2) = width (5 tau_f + 8 tau_m - tau_b) / 24,  D(1) = width (tau_f + 4 tau_m + tau_b) / 6,
//     C = width (q_f + 4 (1 - A(D(1/2))) q_m + (1 - A(D(1))) q_b) / 6,  A as in absorption.glsl.
//
// A is exact for cubic extinction. Error O(width^5), for D(1/2) is off by O(width^4) and its term has another width;
// a sum over a ray loses one order. Where the parabola dips below zero D(1/2) stays in [0, D(1)].

vec4 simpson_slab(vec4 front, vec4 middle, vec4 back, real width, bool is_linear) {
  real depth = width * (front[3] + 4.0 * middle[3] + back[3]) / 6.0;
  real half_depth = width * (5.0 * front[3] + 8.0 * middle[3] - back[3]) / 24.0;
  real opacity = absorption(depth, is_linear);
  real half_opacity = absorption(min(max(half_depth, 0.0), depth), is_linear);
  vec4 slab = (width / 6.0) * (front + (4.0 * (1.0 - half_opacity)) * middle + (1.0 - opacity) * back);
  slab[3] = opacity;
  return slab;
}
