// Isosurfaces between two samples: whether a value is passed there and where, its normal, and its slab.
//
// Scalars have the class of a value v, whether s >= v; one is passed where the two samples' classes differ, and on the
// line between them
//
//     w = (v - s_f) / (s_b - s_f)   (Engel, Kraus and Ertl 2001),
//
// 0 at the front and 1 at the back. Exact for linear signals, error O(h^2) of a place. Nearer to it, step by step, come
// places of regula falsi on the signal itself (Knoll et al. 2009). With a vec4 `bracket` of two places and of the signals
// less v there, which are on either side of 0, one step is
//
//     place = isosurface_regula_falsi(bracket);
//     bracket = isosurface_bracket(bracket, place, signal(place) - v);
//
// Its product of a place and a scalar must be above 2^-126. A surface that is met goes over what lies behind it, with its
// opacity a and the colour c that it is lit with: C += T a c, T *= 1 - a, as `over` does with its slab (see over.glsl).

real isosurface_class(real s, real value) {
  return s < value ? 0.0 : 1.0;
}

// w, or -1 where the value is not passed.
real isosurface_crossing(real front, real back, real value) {
  return isosurface_class(front, value) == isosurface_class(back, value) ? -1.0 : (value - front) / (back - front);
}

real isosurface_regula_falsi(vec4 bracket) {
  return bracket[0] - bracket[2] * (bracket[1] - bracket[0]) / (bracket[3] - bracket[2]);
}

// The part of it in which the signal passes v: `here` is the signal less v at a place between.
vec4 isosurface_bracket(vec4 bracket, real place, real here) {
  bool is_low = isosurface_class(here, 0.0) == isosurface_class(bracket[2], 0.0);
  return is_low ? vec4(place, bracket[1], here, bracket[3]) : vec4(bracket[0], place, bracket[2], here);
}

// `surface` has colour and opacity, the colour not multiplied by it.
vec4 isosurface_slab(vec4 surface) {
  return vec4(surface[3] * surface[0], surface[3] * surface[1], surface[3] * surface[2], surface[3]);
}

// The line between the samples' normals, at w, normalised; 0 where it is. Their fourth numbers are 0.
vec4 isosurface_normal(vec4 front, vec4 back, real w) {
  vec4 normal = front + w * (back - front);
  real norm = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
  return normal / (norm > 0.0 ? norm : 1.0);
}
