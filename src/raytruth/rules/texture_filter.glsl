// Texture filtering: what a texture unit makes of a normalised coordinate and the texels around it (OpenGL 4.5 core,
// section 8.14). Texel i of n has its centre at coordinate (i + 1/2) / n; in units of texels, from the first one's centre,
// the coordinate lies at
//
//     position = coordinate n - 1/2,  index i = floor(position),  weight w = position - i of texel i + 1,
//
// and the filtered value is (1 - w) texel_i + w texel_(i+1), on every axis. Texels beyond an end are the last one at it
// (clamp to edge).
//
// Hardware keeps few bits of the weight: NVIDIA's units 8, with 1 representable (CUDA C++ Programming Guide, linear
// filtering). `levels` = 2^bits rounds it to the nearest multiple of 1 / levels; 0 leaves it as it is. On every axis a
// value is then off by at most half a level of the difference of two texels.

real texel_position(real coordinate, real size) {
  return coordinate * size - 0.5;
}

real filter_weight(real position, real levels) {
  real weight = position - floor(position);
  return levels > 0.0 ? floor(weight * levels + 0.5) / levels : weight;
}

real texel_clamped_to_edge(real index, real size) {
  return min(max(index, 0.0), size - 1.0);
}

vec4 filter_linear(vec4 first, vec4 second, real weight) {
  return (1.0 - weight) * first + weight * second;
}
