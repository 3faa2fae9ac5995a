// Gooch's tones in one channel (Guetat 2010, eq. 11): cool where the normal faces the light, warm where it is averted.
//
//     1/2 (cool e + cool_share q) (1 + N.L) + 1/2 (warm e + warm_share q) (1 - N.L)
//
// e is the emission density of white matter, q that of the matter, whose moments are `white` and `colored` (see
// lighting.glsl); `curve` are the coefficients of N.L; the shares are a K_d and b K_d. Of the two tables per channel the
// paper prints the linear one only; without the constant one a slab seen from the side is black.

real gooch_constant(vec4 colored, vec4 white, real cool, real warm, real cool_share, real warm_share) {
  return 0.5 * ((cool + warm) * white[0] + (cool_share + warm_share) * colored[0]);
}

real gooch_linear(vec4 colored, vec4 white, vec4 curve, real cool, real warm, real cool_share, real warm_share) {
  return 0.5 * ((cool - warm) * lighting_integral(white, curve) +
                (cool_share - warm_share) * lighting_integral(colored, curve));
}
