// Order 2: the parabola through three samples at 0, `split` and 1 of a slab, between the first two samples and between
// the last two (El Hajjar 2008, section 4 and eq. 2, where split = 1/2:
// P(t) = A t^2 + B t + C, A = 2 front - 4 middle + 2 back, B = -3 front + 4 middle - back, C = front).
//
// Over an interval of width w with end values a and b the parabola's middle Bernstein coefficient is
//     (a + b) / 2 - curvature w^2 / 2,
// curvature being the second divided difference, A of eq. 2. The result is raised to a cubic (see order0.glsl).
//
// Exact for quadratics. Error O(h^3). The parabola can leave the range of its three samples by 1/8 of it.

real order2_curvature(real front, real middle, real back, real split) {
  return (back - middle) / (1.0 - split) - (middle - front) / split;
}

vec4 order2_interval(real front, real back, real width, real curvature) {
  real third = (back - front) / 3.0;
  real bulge = curvature * width * width / 3.0;
  return vec4(front, front + third - bulge, back - third - bulge, back);
}

// Between the front and the middle sample.
vec4 order2_front(real front, real middle, real back, real split) {
  return order2_interval(front, middle, split, order2_curvature(front, middle, back, split));
}

// Between the middle and the back sample.
vec4 order2_back(real front, real middle, real back, real split) {
  return order2_interval(middle, back, 1.0 - split, order2_curvature(front, middle, back, split));
}
