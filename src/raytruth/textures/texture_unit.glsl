// A texture unit in a shader, for weights of any precision: what TextureUnit (texture_unit.hpp) does on a CPU, from
// single texels and the arithmetic of rules/texture_filter.glsl, which must stand in front. `coordinate` is normalised,
// clamped to the edge; `levels` is 2^bits of the weights, or 0 for weights as exact as a float.

vec4 edge_texel(sampler1D unit, float index) {
  return texelFetch(unit, int(texel_clamped_to_edge(index, float(textureSize(unit, 0)))), 0);
}

vec4 edge_texel(sampler2D unit, vec2 index) {
  vec2 size = vec2(textureSize(unit, 0));
  return texelFetch(unit, ivec2(texel_clamped_to_edge(index.x, size.x), texel_clamped_to_edge(index.y, size.y)), 0);
}

vec4 edge_texel(sampler3D unit, vec3 index) {
  vec3 size = vec3(textureSize(unit, 0));
  return texelFetch(unit, ivec3(texel_clamped_to_edge(index.x, size.x), texel_clamped_to_edge(index.y, size.y),
                                texel_clamped_to_edge(index.z, size.z)), 0);
}

vec4 filtered_texture(sampler1D unit, float coordinate, float levels) {
  float position = texel_position(coordinate, float(textureSize(unit, 0)));
  float first = floor(position);
  return filter_linear(edge_texel(unit, first), edge_texel(unit, first + 1.0), filter_weight(position, levels));
}

vec4 filtered_texture(sampler2D unit, vec2 coordinate, float levels) {
  vec2 size = vec2(textureSize(unit, 0));
  vec2 position = vec2(texel_position(coordinate.x, size.x), texel_position(coordinate.y, size.y));
  vec2 first = floor(position);
  float weight = filter_weight(position.x, levels);
  vec4 rows[2];
  for (int j = 0; j < 2; ++j)
    rows[j] = filter_linear(edge_texel(unit, first + vec2(0, j)), edge_texel(unit, first + vec2(1, j)), weight);
  return filter_linear(rows[0], rows[1], filter_weight(position.y, levels));
}

vec4 filtered_texture(sampler3D unit, vec3 coordinate, float levels) {
  vec3 size = vec3(textureSize(unit, 0));
  vec3 position = vec3(texel_position(coordinate.x, size.x), texel_position(coordinate.y, size.y),
                       texel_position(coordinate.z, size.z));
  vec3 first = floor(position);
  vec2 weight = vec2(filter_weight(position.x, levels), filter_weight(position.y, levels));
  vec4 slices[2];
  for (int k = 0; k < 2; ++k) {
    vec4 rows[2];
    for (int j = 0; j < 2; ++j)
      rows[j] =
          filter_linear(edge_texel(unit, first + vec3(0, j, k)), edge_texel(unit, first + vec3(1, j, k)), weight.x);
    slices[k] = filter_linear(rows[0], rows[1], weight.y);
  }
  return filter_linear(slices[0], slices[1], filter_weight(position.z, levels));
}
