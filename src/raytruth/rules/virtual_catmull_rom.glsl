// Virtual Catmull-Rom: the cubic through two samples whose slopes are the central differences of their neighbours, for
// equal steps (Lee 2010, section 3.2; R. G. Keys, Cubic convolution interpolation, 1981).
//
//     b.y = front + (back - before) / 6,  b.z = back - (after - front) / 6 (Bernstein coefficients, see order0.glsl).
//
// Exact for quadratics. Error O(h^3).

vec4 virtual_catmull_rom(real before, real front, real back, real after) {
  return vec4(front, front + (back - before) / 6.0, back - (after - front) / 6.0, back);
}

// The sample that is missing beyond an end, from the three nearest: the quadratic through them, continued.
real virtual_catmull_rom_ghost(real first, real second, real third) {
  return 3.0 * first - 3.0 * second + third;
}
