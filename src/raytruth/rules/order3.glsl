// Order 3: the cubic through four equally spaced samples of a slab, on each of its three intervals.
//
// With d_i the differences of neighbouring samples, the cubic's slopes at the first and at the second sample are
//     (11 d_0 - 7 d_1 + 2 d_2) / 6  and  (2 d_0 + 5 d_1 - d_2) / 6  per interval,
// and mirrored at the others; a slope's third is the distance of the inner Bernstein coefficient (see order0.glsl).
//
// Exact for cubics: of a trilinear signal wherever a slab does not cross the border of a cell. Error O(h^4).

real order3_slope_first(real first, real second, real third, real fourth) {
  return (11.0 * (second - first) - 7.0 * (third - second) + 2.0 * (fourth - third)) / 6.0;
}

real order3_slope_second(real first, real second, real third, real fourth) {
  return (2.0 * (second - first) + 5.0 * (third - second) - (fourth - third)) / 6.0;
}

vec4 order3_front(real first, real second, real third, real fourth) {
  return vec4(first, first + order3_slope_first(first, second, third, fourth) / 3.0,
              second - order3_slope_second(first, second, third, fourth) / 3.0, second);
}

vec4 order3_middle(real first, real second, real third, real fourth) {
  return vec4(second, second + order3_slope_second(first, second, third, fourth) / 3.0,
              third + order3_slope_second(fourth, third, second, first) / 3.0, third);
}

vec4 order3_back(real first, real second, real third, real fourth) {
  return vec4(third, third - order3_slope_second(fourth, third, second, first) / 3.0,
              fourth + order3_slope_first(fourth, third, second, first) / 3.0, fourth);
}
