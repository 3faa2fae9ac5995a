// Cubics by splitting: a slab's cubic is cut into parts, and each part is replaced by the parabola through its ends and its
// middle, three values of the cubic itself: no further fetches, one look-up for each part (the dissertation, section 5.4).
//
// On a part of length w that parabola is off by a_3 (t - t_0) (t - t_0 - w/2) (t - t_0 - w), an area abs(a_3) w^4 / 32,
// a_3 being the cubic's third coefficient in lengths. Exact for quadratics. Error O(h^3).
//
// Places are local coordinates u, 0 at the slab's front, 1 at its back. A place that is 0 or 1 cuts nothing off.

// The cubic through the four equally spaced samples of a slab (see order3.glsl).
vec4 cubic_split_cubic(real first, real second, real third, real fourth) {
  return vec4(first, first + order3_slope_first(first, second, third, fourth),
              fourth + order3_slope_first(fourth, third, second, first), fourth);
}

// Its value at u, in powers of the distance from the nearer end: exact at both ends.
real cubic_split_value(vec4 cubic, real u) {
  if (u < 0.5) return virtual_sample(cubic, u);
  return virtual_sample(vec4(cubic[3], cubic[2], cubic[1], cubic[0]), 1.0 - u);
}

// The parabola through the values at both ends and in the middle, raised to a cubic: order2.glsl with one interval.
vec4 cubic_split_parabola(real front, real middle, real back) {
  return order2_interval(front, back, 1.0, order2_curvature(front, middle, back, 0.5));
}

// The parabola of the part from `begin` to `end`.
vec4 cubic_split_part(vec4 cubic, real begin, real end) {
  return cubic_split_parabola(cubic_split_value(cubic, begin), cubic_split_value(cubic, 0.5 * (begin + end)),
                              cubic_split_value(cubic, end));
}

// Where the cubic has its point of inflection, between its second differences; the nearer end where that is outside, and 0
// where there is none.
real cubic_split_inflection(vec4 cubic) {
  real at_front = (cubic[2] - cubic[1]) - (cubic[1] - cubic[0]);
  real at_back = (cubic[3] - cubic[2]) - (cubic[2] - cubic[1]);
  real fall = at_front - at_back;
  if (fall == 0.0) return 0.0;
  return min(max(at_front / fall, 0.0), 1.0);
}

// The borders 0 <= low <= high <= 1 of the parts between extrema: the roots of front + 2 turn u + bend u^2, the slope's
// quadratic over its largest coefficient, without cancellation.
vec4 cubic_split_extrema(vec4 cubic) {
  real front = cubic[1] - cubic[0];
  real middle = cubic[2] - cubic[1];
  real back = cubic[3] - cubic[2];
  real largest = max(max(max(front, -front), max(middle, -middle)), max(back, -back));
  if (largest == 0.0) return vec4(0.0, 0.0, 0.0, 1.0);
  front = front / largest;
  middle = middle / largest;
  back = back / largest;
  real discriminant = middle * middle - front * back;
  if (discriminant <= 0.0) return vec4(0.0, 0.0, 0.0, 1.0);
  real turn = middle - front;
  real bend = (back - middle) - turn;
  real sum = turn < 0.0 ? turn - sqrt(discriminant) : turn + sqrt(discriminant);
  real one = min(max(-front / sum, 0.0), 1.0);
  real other = bend == 0.0 ? 1.0 : min(max(-sum / bend, 0.0), 1.0);
  return vec4(0.0, min(one, other), max(one, other), 1.0);
}

// The mean of abs(cubic - parabola) over a slab in one part; in n equal parts it is n^3 times smaller. Equal parts are the
// best ones: of all parts with one sum, equal ones have the smallest sum of fourth powers.
real cubic_split_mean_error(vec4 cubic) {
  real leading = (cubic[3] - cubic[0]) - 3.0 * (cubic[2] - cubic[1]);
  return max(leading, -leading) / 32.0;
}
