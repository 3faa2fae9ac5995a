// Order 1: linear between two samples, the signal of classical pre-integration (El Hajjar 2008, section 3.2.2).
//
//     s(u) = front + u (back - front), as Bernstein coefficients of a cubic (see order0.glsl).
//
// Exact for linear signals. Error O(h^2).

vec4 order1(real front, real back) {
  real third = (back - front) / 3.0;
  return vec4(front, front + third, back - third, back);
}
