// Look-ups of pre-integration tables. Entry i of n stands for the scalar low + (high - low) i / (n - 1); texel i has its
// centre at coordinate (i + 1/2) / n (texture_filter.glsl). So with the scalar's `share` (s - low) / (high - low),
//
//     coordinate = (share (n - 1) + 1/2) / n,  share = (coordinate n - 1/2) / (n - 1).
//
// A share taken for a coordinate, a frequent slip, is off by up to half a texel at the ends of the table.
//
// Between entries values are linear in each scalar: bilinear in the front and the back scalar of a slab; for slabs of
// second order filter_linear joins two of these. Weights belong to the second entry of a pair. Error O(1 / n^2) where
// the second derivatives of the table are bounded, O(1 / n) across its kinks.

real table_coordinate(real share, real size) {
  return (share * (size - 1.0) + 0.5) / size;
}

real table_share(real coordinate, real size) {
  return (coordinate * size - 0.5) / (size - 1.0);
}

vec4 table_bilinear(vec4 both, vec4 next_front, vec4 next_back, vec4 next_both, real front_weight, real back_weight) {
  return filter_linear(filter_linear(both, next_front, front_weight),
                       filter_linear(next_back, next_both, front_weight), back_weight);
}
