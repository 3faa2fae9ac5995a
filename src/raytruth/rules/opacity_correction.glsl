// Opacity correction: the opacity of a stretch that is `ratio` times as long as the one whose opacity is known.
//
//     1 - (1 - opacity)^ratio
//
// solves Lee 2010, eq. 9, for every ratio 1/n. Written with expm1 and log1p, small opacities keep their digits.

real opacity_correction(real opacity, real ratio) {
  return -expm1(ratio * log1p(-opacity));
}

// Opacity correction for ratio = 1/2 (Lee 2010, eqs. 10 and 11), applied again and again for 1/4, 1/8, ... Its absolute
// error is half an ulp of 1, so a small opacity loses a bit with every step.
real opacity_correction_half(real opacity) {
  return 1.0 - sqrt(1.0 - opacity);
}

// The first order in opacity, clamped: what renderers do if they take opacity for extinction.
real opacity_correction_linear(real opacity, real ratio) {
  return min(1.0, ratio * opacity);
}

// A slab whose opacity has been corrected; its colour, made of the same absorption, goes with it.
vec4 opacity_corrected_slab(vec4 slab, real opacity, real ratio) {
  vec4 corrected = (slab[3] > 0.0 ? opacity / slab[3] : ratio) * slab;
  corrected[3] = opacity;
  return corrected;
}
