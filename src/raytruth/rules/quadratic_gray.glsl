// Quadratic gray-value model: the parabola g(t) = a t^2 + b t + S_f through the scalars of a slab's front, middle and
// back (dissertation, section 5.3 and eq. 5.5.1), in the coordinate z = t / R, R = 1 / sqrt|a|, in which it is
//
//     h(z) = orientation z^2 + slope z + S_f,   0 <= z <= D' = D / R,   orientation = sign of a,
//     slope = b R = (S_b - S_f - orientation D'^2) / D',
//     extremum M = S_f - orientation slope^2 / 4, inside where 0 < -orientation slope < 2 D'.
//
// A table of its slabs needs S_f, S_b and a: with the orientation the optical depth is R omega(S_f, S_b, D'). The print
// has errors in M (eq. 5.3.11), and takes a < 0 for nothing; these are the formulas without them.

// a, per squared length: the second divided difference.
real quadratic_gray_curvature(real front, real middle, real back, real length) {
  return 2.0 * ((back - middle) - (middle - front)) / (length * length);
}

// The scalar half-way along a slab of this curvature.
real quadratic_gray_middle(real front, real back, real curvature, real length) {
  return 0.5 * (front + back) - 0.25 * curvature * length * length;
}

real quadratic_gray_slope(real front, real back, real orientation, real scaled_length) {
  return (back - front) / scaled_length - orientation * scaled_length;
}

real quadratic_gray_value(real front, real slope, real orientation, real z) {
  return front + z * (slope + orientation * z);
}

real quadratic_gray_extremum(real front, real slope, real orientation) {
  return front - 0.25 * orientation * slope * slope;
}

// The place z where h is `rise` above the front's scalar, on the branch on which h grows (branch = 1) or falls (-1):
// 2 rise / (slope + branch sqrt(slope^2 + 4 orientation rise)), or the other form of the root, whichever does not
// cancel. A root that does not exist is taken as that of the extremum.
real quadratic_gray_place(real rise, real slope, real orientation, real branch) {
  real speed = sqrt(max(slope * slope + 4.0 * orientation * rise, 0.0));
  real sum = slope + branch * speed;
  if (branch * slope > 0.0) return 2.0 * rise / sum;
  return 0.5 * orientation * (branch * speed - slope);
}

// The node of a table's curvature axis, and the weight of the next one as what is behind the integer. On each side of
// the linear table, node `count`, stand `count` radii in equal ratios, the outermost 1 / sqrt(largest), the innermost
// 1 / sqrt(smallest); between them the weight is linear in a. Beyond the outermost the last node is meant.
real quadratic_gray_node(real curvature, real smallest, real largest, real count) {
  real size = min(max(curvature, -curvature), largest);
  real distance = size / smallest;
  if (distance > 1.0 && count > 1.0) {
    real rate = log1p(largest / smallest - 1.0) / (count - 1.0);
    real whole = min(floor(log1p(distance - 1.0) / rate), count - 2.0);
    real below = expm1(whole * rate) + 1.0;
    distance = 1.0 + whole + min(max((distance - below) / (expm1(rate) * below), 0.0), 1.0);
  }
  if (count == 1.0) distance = min(distance, 1.0);
  return curvature < 0.0 ? count - distance : count + distance;
}
