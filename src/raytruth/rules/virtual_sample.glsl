// Virtual samples: values of an interval's own curve between its two true samples, at u = 1/(n+1) ... n/(n+1), without a
// look at the volume (Lee 2010, section 3.1).
//
// The value at u of a cubic in Bernstein form (see order0.glsl), in powers of u, whose coefficients a loop over u computes
// once; on the cubic of virtual_catmull_rom.glsl it is Lee's eq. 2. Exact for constants, bit by bit.

real virtual_sample(vec4 curve, real u) {
  real linear = 3.0 * (curve[1] - curve[0]);
  real quadratic = 3.0 * (curve[2] - curve[1]) - linear;
  real cubic = (curve[3] - curve[0]) - linear - quadratic;
  return curve[0] + u * (linear + u * (quadratic + u * cubic));
}

// Four channels at once, the intensity and the gradient of samples as texels hold them: the cubic of
// virtual_catmull_rom.glsl through the middle two of four equally spaced samples, channel by channel, at u (Lee 2010,
// eq. 2). A normal is the gradient over its length. Exact for constants, bit by bit, and at u = 0.
vec4 virtual_texel(vec4 before, vec4 front, vec4 back, vec4 after, real u) {
  real middle = 0.5;
  vec4 rise = back - front;
  vec4 at_front = middle * (back - before);
  vec4 cubic = (at_front - rise) + (middle * (after - front) - rise);
  vec4 quadratic = (rise - at_front) - cubic;
  return front + u * (at_front + u * (quadratic + u * cubic));
}
