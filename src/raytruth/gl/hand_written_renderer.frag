#version 430 core

// A volume renderer as the author of one writes it, with nothing in it that the rest of raytruth uses: rays from a look-at
// camera, a volume and a transfer function in textures, post-classification, compositing from front to back. Lengths are
// in units of the smallest spacing, the camera's in world units.

uniform sampler3D volume;           // the scalar, 0 to 1
uniform sampler1D transfer;         // at the centres of its texels scalars 0 to 1: colour, extinction
uniform vec3 spacing;               // of voxels, world
uniform vec3 eye;
uniform vec3 look_at;
uniform vec3 up;
uniform int is_perspective;
uniform float height;               // of an orthographic image, world
uniform float angle_of_view;        // of a perspective one, from top to bottom, radians
uniform vec2 image_size;            // pixels
uniform float step_size;

layout(location = 0) out vec4 fragment;

vec4 classify(float scalar) {
  float texels = float(textureSize(transfer, 0));
  return texture(transfer, (scalar * (texels - 1.0) + 0.5) / texels);
}

void main() {
  // The pixel on the image plane, from -1 to 1.
  vec2 pixel = 2.0 * gl_FragCoord.xy / image_size - 1.0;
  pixel.x *= image_size.x / image_size.y;

  vec3 forward = normalize(look_at - eye);
  vec3 right = normalize(cross(forward, up));
  vec3 true_up = cross(right, forward);

  vec3 origin = eye;
  vec3 direction = forward;
  if (is_perspective != 0)
    direction = normalize(forward + tan(0.5 * angle_of_view) * (pixel.x * right + pixel.y * true_up));
  else
    origin += 0.5 * height * (pixel.x * right + pixel.y * true_up);

  // The volume ends half a voxel beyond the centres of its outermost voxels.
  vec3 voxels = vec3(textureSize(volume, 0));
  vec3 box_min = -0.5 * spacing;
  vec3 box_max = (voxels - 0.5) * spacing;
  vec3 t0 = (box_min - origin) / direction;
  vec3 t1 = (box_max - origin) / direction;
  vec3 entries = min(t0, t1);
  vec3 exits = max(t0, t1);
  float t_near = max(max(entries.x, entries.y), max(entries.z, 0.0));
  float t_far = min(exits.x, min(exits.y, exits.z));

  float unit = min(spacing.x, min(spacing.y, spacing.z));
  vec4 sum = vec4(0.0);
  if (t_near < t_far) {
    float path = (t_far - t_near) / unit;
    int steps = int(ceil(path / step_size));
    for (int i = 0; i < steps; ++i) {
      float begin = float(i) * step_size;
      float thickness = min(step_size, path - begin);
      vec3 position = origin + (t_near + (begin + 0.5 * thickness) * unit) * direction;
      float scalar = texture(volume, (position / spacing + 0.5) / voxels).r;
      vec4 optics = classify(scalar);
      float alpha = 1.0 - exp(-optics.a * thickness);
      sum += (1.0 - sum.a) * alpha * vec4(optics.rgb, 1.0);
    }
  }
  fragment = sum;
}
