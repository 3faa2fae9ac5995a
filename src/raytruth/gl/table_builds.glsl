// A slab of a pre-integration table for each invocation, from the rules. What is built says SECOND_ORDER, which must stand
// in front: 0 for slabs whose scalar is linear, each entry by itself (tables/brute_force.hpp); 1 for slabs of second order
// by iterations (tables/second_order.hpp).
//
// `optics` holds vec4s of emission density and extinction, or of colour and extinction for second order.

layout(local_size_x = 64) in;
uniform uint invocations;

uniform int size;           // n, entries along each axis
uniform float slab_length;  // of every slab
uniform int iterations;     // of a slab of second order
uniform float first_place;  // of the first of them in units of a step, 1/2 or 0
uniform int is_associated;

layout(std430, binding = 0) readonly buffer Optics { vec4 optics[]; };
layout(std430, binding = 1) writeonly buffer Slabs { vec4 slabs[]; };

#if SECOND_ORDER == 0

// First come the n entries, then the n - 1 intervals.
vec4 slab(int entry) {
  int front = entry % size;
  int back = entry / size;
  if (front == back) return homogeneous_slab(optics[front], slab_length, false);
  int width = abs(back - front);
  vec4 ray = vec4(0.0);
  for (int k = 0; k < width; ++k) {
    int interval = size + (front < back ? front + k : front - 1 - k);
    ray = over(ray, homogeneous_slab(optics[interval], slab_length / float(width), false));
  }
  return ray;
}

#else

vec4 optics_between_entries(float place) {
  float first = min(floor(place), float(size - 2));
  vec4 found = filter_linear(optics[int(first)], optics[int(first) + 1], place - first);
  return is_associated != 0 ? vec4(found.rgb * found.a, found.a) : found;
}

vec4 slab(int entry) {
  float front = float(entry % size);
  float middle = float(entry / size % size);
  float back = float(entry / (size * size));
  float a = 2.0 * front - 4.0 * middle + 2.0 * back;
  float b = -3.0 * front + 4.0 * middle - back;
  vec4 ray = vec4(0.0);
  for (int k = 0; k < iterations; ++k) {
    float t = (float(k) + first_place) / float(iterations);
    float place = clamp((a * t + b) * t + front, 0.0, float(size - 1));
    ray = over(ray, homogeneous_slab(optics_between_entries(place), slab_length / float(iterations), false));
  }
  return ray;
}

#endif

void main() {
  uint invocation = gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x + gl_GlobalInvocationID.x;
  if (invocation < invocations) slabs[invocation] = slab(int(invocation));
}
