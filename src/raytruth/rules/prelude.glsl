// What the rules need of a shader language: this text stands in front of theirs. In C++ Rules<Real> (rules.hpp) says it.
//
// The functions of shader languages may be off by many units in the last place, the more so where 1 is subtracted or
// added; these are not. Where values are below 2^-126 they may be taken for 0.

#define real float
#if defined(GL_ES) && __VERSION__ < 320 || !defined(GL_ES) && __VERSION__ < 400
#define as_written
#else
#define as_written precise
#endif

// exp(x) - 1 = 2^k (exp(r) - 1) + 2^k - 1, x = k log(2) + r, |r| <= log(2) / 2, by Taylor's polynomial of degree 7.
float expm1(float x) {
  float k = floor(max(x, -80.0) * 1.44269504 + 0.5);
  float r = (max(x, -80.0) - k * 0.693359375) + k * 2.12194440e-4;
  float p = 1.0 / 120.0 + r * (1.0 / 720.0 + r * (1.0 / 5040.0));
  p = r + r * r * (0.5 + r * (1.0 / 6.0 + r * (1.0 / 24.0 + r * p)));
  if (k == 0.0) return p;
  float half_power = uintBitsToFloat(uint(int(min(k, 128.0)) + 126) << 23);  // half of 2^k, which may be beyond floats
  return 2.0 * (half_power * p + (half_power - 0.5));
}

// log(1 + x) = k log(2) + log(1 + f), 1 + f in [sqrt(1/2), sqrt(2)), and with s = f / (2 + f)
//     log(1 + f) = 2 (s + s^3 / 3 + s^5 / 5 + ...) = f - f^2 / 2 + s (f^2 / 2 + 2 s^2 / 3 + 2 s^4 / 5 + ...).
float log1p(float x) {
  if (x <= -1.0) return -3.0e38;  // for -infinity, which shaders need not have
  float sum = 1.0 + x;
  as_written float lost = x < 1.0 ? x - (sum - 1.0) : 1.0 - (sum - x);  // of 1 + x
  uint bits = floatBitsToUint(sum);
  int k = int((bits + (0x3f800000u - 0x3f3504f3u)) >> 23) - 127;
  float f = k == 0 ? x : uintBitsToFloat(bits - (uint(k) << 23)) - 1.0;
  float low = k == 0 ? 0.0 : lost / sum - float(k) * 2.12194440e-4;
  float s = f / (2.0 + f);
  float z = s * s;
  float series = z * (2.0 / 3.0 + z * (2.0 / 5.0 + z * (2.0 / 7.0 + z * (2.0 / 9.0))));
  float square = 0.5 * f * f;
  return s * (square + series) + low - square + f + float(k) * 0.693359375;
}

// x^y for 0 <= x and 1 <= y, to some units in the last place of 1 or of the value, whichever is larger.
float power(float x, float y) {
  return x > 0.0 ? 1.0 + expm1(y * log1p(max(x, 5.9604645e-8) - 1.0)) : 0.0;
}

// The sine of 0 <= x <= pi: with k quarters of the circle off, minimax polynomials on [-pi/4, pi/4] (Moshier, Cephes).
float sine(float x) {
  float k = floor(x * 0.636619772 + 0.5);
  float r = ((x - k * 1.5703125) - k * 4.83751297e-4) - k * 7.54978942e-8;
  float z = r * r;
  if (k == 1.0) return 1.0 - 0.5 * z + z * z * (4.16666457e-2 + z * (-1.38873162e-3 + z * 2.44331571e-5));
  float value = r + r * z * (-1.66666546e-1 + z * (8.33216087e-3 + z * -1.95152959e-4));
  return k == 0.0 ? value : -value;
}

// The arc cosine of -1 <= x <= 1 by the arc sine of at most 1/2, a minimax polynomial (Moshier, Cephes).
float arc_cosine(float x) {
  bool is_middle = abs(x) <= 0.5;
  float z = is_middle ? x * x : 0.5 - 0.5 * abs(x);
  float y = is_middle ? x : sqrt(z);
  float p = 1.66667522e-1 + z * (7.49530027e-2 + z * (4.54700260e-2 + z * (2.41813112e-2 + z * 4.21631990e-2)));
  float angle = y + y * z * p;
  if (is_middle) return 1.57079633 - angle;
  return x > 0.0 ? 2.0 * angle : 3.14159265 - 2.0 * angle;
}
