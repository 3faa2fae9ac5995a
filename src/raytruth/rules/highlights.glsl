// Highlights: how the specular light falls off with the cosine between the normal and the half vector.
//
//     lobe:    max(0, cosine)^shininess                                          (Blinn 1977)
//     family:  max(0, 1 + (exponent / degree) (cosine - 1))^degree, degree 1, 2, 3
//
// The family of degree 1 and exponent = shininess is the cone of Guetat 2010, section 5.2, which is 0 for cosines below
// 1 - 1/shininess; with growing degree it tends to the lobe. Powers of a cubic in s, its integrals over a slab need
// 3 degree + 1 tables. Other exponents (for the lobe's energy, or nearest to the lobe): shading/highlight.hpp.

real highlight_lobe(real cosine, real shininess) {
  return cosine > 0.0 ? power(cosine, shininess) : 0.0;
}

real highlight_family(real cosine, real exponent, real degree) {
  real fall = min(1.0 - cosine, 2.0);  // never above 2; what passes a min, compilers do not multiply out
  real base = max(0.0, 1.0 - exponent / degree * fall);
  return base * (degree > 1.0 ? base : 1.0) * (degree > 2.0 ? base : 1.0);
}
