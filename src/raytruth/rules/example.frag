// A renderer that uses the rules: one ray through the unit cube for each pixel, along z, in slabs of equal width, each
// homogeneous with the optics of its middle. This text goes behind prelude.glsl and the rules, as README.md tells.

uniform sampler3D volume;
uniform sampler1D transfer;  // colour and extinction per unit length
uniform vec2 image_size;
uniform int steps;

layout(location = 0) out vec4 color_and_opacity;

vec4 optics(float s) {
  vec4 found = texture(transfer, s);
  return vec4(found.rgb * found.a, found.a);  // a medium that glows as much as it absorbs
}

void main() {
  float width = 1.0 / float(steps);
  vec4 ray = vec4(0.0);
  for (int k = 0; k < steps; ++k) {
    float s = texture(volume, vec3(gl_FragCoord.xy / image_size, (float(k) + 0.5) * width)).r;
    ray = over(ray, homogeneous_slab(optics(s), width, false));
  }
  color_and_opacity = ray;
}
