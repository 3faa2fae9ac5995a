// Guetat's three cases: what becomes of a cubic that goes below 0 between front and back (Guetat 2010, sections 5.1
// and 5.2). Both ends lit: its integral; one end dark: a fade from the light of the other one; both dark: nothing.
//
// `moments` are those of lighting.glsl; `cubic` has the coefficients, `front` and `back` the values at the ends. For
// diffuse light the cubic is the arc that quadratic_arc gives along L, for highlights it is fades_cone along H. The
// functions `_printed` do as the paper says: the diffuse fades stand in the opposite order to their conditions;
// highlights have N.L for N.H, coloured moments in the fades, and 1 - n is not faded, so that they reach 1 - n.

// 1 + n (c - 1) for a cubic cosine c.
vec4 fades_cone(vec4 cosine, real exponent) {
  return vec4(1.0 + exponent * (cosine[0] - 1.0), exponent * cosine[1], exponent * cosine[2], exponent * cosine[3]);
}

real fades_integral(vec4 moments, vec4 cubic, real front, real back) {
  if (front >= 0.0 && back >= 0.0) return lighting_integral(moments, cubic);
  return max(0.0, front) * (moments[0] - moments[1]) + max(0.0, back) * moments[1];
}

real fades_diffuse_printed(vec4 moments, vec4 cubic, real front, real back) {
  if (front >= 0.0 && back >= 0.0) return lighting_integral(moments, cubic);
  if (front < 0.0 && back < 0.0) return 0.0;
  return front < 0.0 ? front * (moments[0] - moments[1]) : back * moments[1];
}

// The largest value between the ends, in [0, 1], where it is above both of them; else 0.
real fades_peak(vec4 cubic, real front, real back) {
  real discriminant = cubic[2] * cubic[2] - 3.0 * cubic[1] * cubic[3];
  if (discriminant < 0.0) return 0.0;
  real root = cubic[2] < 0.0 ? sqrt(discriminant) - cubic[2] : -(sqrt(discriminant) + cubic[2]);
  real first = cubic[3] != 0.0 ? root / (3.0 * cubic[3]) : -1.0;
  real second = root != 0.0 ? cubic[1] / root : -1.0;
  real ends = max(front, back);
  real at_first = cubic[0] + first * (cubic[1] + first * (cubic[2] + first * cubic[3]));
  real at_second = cubic[0] + second * (cubic[1] + second * (cubic[2] + second * cubic[3]));
  real peak = max(first >= 0.0 && first <= 1.0 ? at_first : ends, second >= 0.0 && second <= 1.0 ? at_second : ends);
  return peak > ends ? min(1.0, max(0.0, peak)) : 0.0;
}

// The larger one of the fade and of the tent up to the peak; `tent` is the moment I'' of the tent that is 1 half-way.
real fades_highlight(vec4 moments, real tent, vec4 cubic, real front, real back) {
  real light = fades_integral(moments, cubic, front, back);
  return front >= 0.0 && back >= 0.0 ? light : max(light, fades_peak(cubic, front, back) * tent);
}

// `moments` have no density, `colored` have the matter's colour; `light_front` and `light_back` are N_f.L and N_b.L.
real fades_highlight_printed(vec4 moments, vec4 colored, vec4 cubic, real front, real back, real exponent,
                             real light_front, real light_back) {
  if (front >= 0.0 && back >= 0.0) return lighting_integral(moments, cubic);
  if (front < 0.0 && back < 0.0) return 0.0;
  real faded = front < 0.0 ? light_back * colored[1] : light_front * (colored[0] - colored[1]);
  return (1.0 - exponent) * colored[0] + exponent * faded;
}
