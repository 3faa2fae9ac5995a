// What the rules need of GLSL 4.30: put this text in front of theirs. In C++ Rules<Real> (rules.hpp) says the same.
//
// exp and log of GLSL may be off by many units in the last place, the more so where 1 is subtracted or added; these two
// are not. Where values are below 2^-126 they may be taken for 0.

#define real float

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
  if (x <= -1.0) return uintBitsToFloat(0xff800000u);  // -infinity
  float sum = 1.0 + x;
  precise float lost = x < 1.0 ? x - (sum - 1.0) : 1.0 - (sum - x);  // of 1 + x
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
