// Absorption: what a homogeneous stretch of optical depth D = extinction times length takes from light that passes it.
//
//     exponential: A = 1 - exp(-D)      (Beer and Lambert)
//     linear:      A = min(1, D)        (its first order, clamped)
//
// Light sent out evenly along the stretch leaves it attenuated by A / D on the mean: C = q length A / D solves
// C = integral_0^length q exp(-extinction t) dt for the exponential; the linear form keeps its limits.

real absorption(real depth, bool is_linear) {
  return is_linear ? min(1.0, depth) : -expm1(-depth);
}

real absorption_mean_transmittance(real depth, bool is_linear) {
  return depth > 0.0 ? absorption(depth, is_linear) / depth : 1.0;
}
