// SampledMarch of schemes/sampled_march.hpp, statement by statement: a ray for each invocation, by a sampled scheme.

layout(local_size_x = 64) in;
uniform uint invocations;

// The members of `Sampled` and of OpticsLookup, with the numbers of their enums.
uniform int rule;
uniform int is_linear;
uniform int virtual_samples;
uniform int is_recursion;
uniform int is_plain;
uniform int point_count;

const int riemann_left = 0;
const int riemann_right = 1;
const int riemann_mid = 2;
const int trapezoid = 3;
const int simpson = 4;
const int virtual_samples_between = 5;

layout(std430, binding = 0) readonly buffer Transfer { float points[]; };  // s, red, green, blue, extinction
layout(std430, binding = 1) readonly buffer Rays { float rays[]; };        // first sample, intervals, equal intervals
layout(std430, binding = 2) readonly buffer Values { float values[]; };
layout(std430, binding = 3) readonly buffer Middles { float middles[]; };
layout(std430, binding = 4) readonly buffer Widths { float widths[]; };
layout(std430, binding = 5) writeonly buffer Slabs { float slabs[]; };

vec4 point(int i) { return vec4(points[5 * i + 1], points[5 * i + 2], points[5 * i + 3], points[5 * i + 4]); }

vec4 color_and_extinction(real s) {
  // The first point behind s. A loop of constant length is unrolled, and so takes none of the 65535 rounds after which
  // llvmpipe silently leaves the loops of a shader.
  int after = 0;
  for (int bit = 15; bit >= 0; --bit) {
    int next = after + (1 << bit);
    if (next <= point_count && !(s < points[5 * (next - 1)])) after = next;
  }
  if (after == 0) return point(0);
  if (after == point_count) return point(point_count - 1);
  real weight = (s - points[5 * (after - 1)]) / (points[5 * after] - points[5 * (after - 1)]);
  return point(after - 1) + weight * (point(after) - point(after - 1));
}

vec4 optics(real s) {
  vec4 found = color_and_extinction(s);
  if (is_plain != 0) return found;
  real extinction = found[3];
  found = extinction * found;
  found[3] = extinction;
  return found;
}

vec4 held_slab(real value, int k) { return homogeneous_slab(optics(value), widths[k], is_linear != 0); }

vec4 trapezoid_between(int k) {
  return trapezoid_slab(optics(values[k]), optics(values[k + 1]), widths[k], is_linear != 0);
}

bool are_equal(real a, real b) {
  real slack = 1e-6 * a;
  return a - b <= slack && b - a <= slack;
}

// VirtualCatmullRom::curve.
vec4 curve(int first, int full, int k) {
  if (k - first >= full || full < 2) return order1(values[k], values[k + 1]);
  real before = k > first ? values[k - 1]
                          : virtual_catmull_rom_ghost(values[first], values[first + 1], values[first + 2]);
  int last = first + full;
  real after = k + 2 <= last ? values[k + 2]
                             : virtual_catmull_rom_ghost(values[last], values[last - 1], values[last - 2]);
  return virtual_catmull_rom(before, values[k], values[k + 1], after);
}

real corrected(real opacity, int parts) {
  if (is_recursion == 0) return opacity_correction(opacity, 1.0 / float(parts));
  for (; parts > 1; parts /= 2) opacity = opacity_correction_half(opacity);
  return opacity;
}

vec4 over_virtual_samples(vec4 ray, vec4 coefficients, int k) {
  int parts = virtual_samples + 1;
  for (int part = 0; part < parts; ++part) {
    vec4 slab = held_slab(virtual_sample(coefficients, float(part) / float(parts)), k);
    ray = over(ray, opacity_corrected_slab(slab, corrected(slab[3], parts), 1.0 / float(parts)));
  }
  return ray;
}

void main() {
  uint invocation = gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x + gl_GlobalInvocationID.x;
  if (invocation >= invocations) return;
  int first = int(rays[3u * invocation]);
  int end = first + int(rays[3u * invocation + 1u]);
  int full = int(rays[3u * invocation + 2u]);
  vec4 ray = vec4(0.0);
  for (int k = first; k < end; ++k) {
    if (rule == riemann_left) ray = over(ray, held_slab(values[k], k));
    if (rule == riemann_right) ray = over(ray, held_slab(values[k + 1], k));
    if (rule == riemann_mid) ray = over(ray, held_slab(middles[k], k));
    if (rule == virtual_samples_between) ray = over_virtual_samples(ray, curve(first, full, k), k);
    bool is_pair = rule == simpson && k + 2 <= end && are_equal(widths[k], widths[k + 1]);
    if (rule == trapezoid || (rule == simpson && !is_pair)) ray = over(ray, trapezoid_between(k));
    if (is_pair) {
      ray = over(ray, simpson_slab(optics(values[k]), optics(values[k + 1]), optics(values[k + 2]),
                                   widths[k] + widths[k + 1], is_linear != 0));
      ++k;
    }
  }
  for (int channel = 0; channel < 4; ++channel) slabs[4u * invocation + uint(channel)] = ray[channel];
}
