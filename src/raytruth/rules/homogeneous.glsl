// Homogeneous slab: the optics held at one value over its width (Riemann sums of post-classification; the steps of El
// Hajjar 2008, section 7). Optics are a vec4: the emission density q, and the extinction tau.
//
//     C = q width A / D,  A as in absorption.glsl, D = tau width.
//
// The exponential form is exact for constant optics. Error O(width^2) for the front or back value, O(width^3) for the
// middle one; a sum over a ray loses one order.

vec4 homogeneous_slab(vec4 optics, real width, bool is_linear) {
  real depth = optics[3] * width;
  vec4 slab = (width * absorption_mean_transmittance(depth, is_linear)) * optics;
  slab[3] = absorption(depth, is_linear);  // without the rounding of a detour over A / D
  return slab;
}
