// Lighting: cosines below 0, and the light of a slab from the moments of its scalars.
//
// Moments are what tables hold of a slab with s = 0 at its front and 1 at its back, I_k = integral of s^k times the
// emission density that is seen, k = 0 to 3: I_k with the matter's colour for diffuse light, I'_k white for highlights
// (Guetat 2010, eqs. 8 and 10). A cosine that is a cubic in s, with `coefficients` of 1, s, s^2, s^3, integrates to
//     a_0 I_0 + a_1 I_1 + a_2 I_2 + a_3 I_3.

real lighting_clamped(real cosine) {
  return max(0.0, cosine);
}

real lighting_mirrored(real cosine) {
  return max(cosine, -cosine);
}

real lighting_integral(vec4 moments, vec4 coefficients) {
  return coefficients[0] * moments[0] + coefficients[1] * moments[1] + coefficients[2] * moments[2] +
         coefficients[3] * moments[3];
}

// The light of a slab whose lighting runs linearly from front to back (Lum 2004, section 3).
real lighting_interpolated(vec4 moments, real front, real back) {
  return front * (moments[0] - moments[1]) + back * moments[1];
}
