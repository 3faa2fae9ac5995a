// A look-up of a texture for each invocation, by the device's sampler or by textures/texture_unit.glsl, which must stand
// in front, as must DIMENSIONS.

layout(local_size_x = 64) in;
uniform uint invocations;

uniform int is_emulated;
uniform float levels;  // of the emulation's weights

layout(std430, binding = 0) readonly buffer Coordinates { float coordinates[]; };
layout(std430, binding = 1) writeonly buffer Values { float values[]; };

#if DIMENSIONS == 1
uniform sampler1D looked_up;
float coordinate(uint i) { return coordinates[i]; }
#elif DIMENSIONS == 2
uniform sampler2D looked_up;
vec2 coordinate(uint i) { return vec2(coordinates[2u * i], coordinates[2u * i + 1u]); }
#else
uniform sampler3D looked_up;
vec3 coordinate(uint i) { return vec3(coordinates[3u * i], coordinates[3u * i + 1u], coordinates[3u * i + 2u]); }
#endif

void main() {
  uint invocation = gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x + gl_GlobalInvocationID.x;
  if (invocation >= invocations) return;
  vec4 value = is_emulated != 0 ? filtered_texture(looked_up, coordinate(invocation), levels)
                                : textureLod(looked_up, coordinate(invocation), 0.0);
  for (uint channel = 0u; channel < 4u; ++channel) values[4u * invocation + channel] = value[channel];
}
