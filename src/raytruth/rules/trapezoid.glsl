// Trapezoid slab: the trapezoid rule for the optical depth, and once more for the emission that it attenuates (K.
// Novins and J. Arvo, Controlled precision volume integration, 1992).
//
//     D = width (tau_f + tau_b) / 2,  C = width (q_f + (1 - A(D)) q_b) / 2,  A as in absorption.glsl.
//
// A is exact for linear extinction. Error O(width^3); a sum over a ray loses one order. A thick slab of the associated
// convention may send out more than its colour.

vec4 trapezoid_slab(vec4 front, vec4 back, real width, bool is_linear) {
  real opacity = absorption(0.5 * width * (front[3] + back[3]), is_linear);
  vec4 slab = (0.5 * width) * (front + (1.0 - opacity) * back);
  slab[3] = opacity;
  return slab;
}
