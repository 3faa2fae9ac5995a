#pragma once

#include "raytruth/reference/arb/arb_numbers.hpp"

#include <acb_poly.h>

namespace raytruth::arb {

/// A box of complex numbers, which frees itself: for what Arb's certified integration calls.
class Box {
 public:
  Box() { acb_init(z_); }
  Box(const Box&) = delete;
  Box& operator=(const Box&) = delete;
  ~Box() { acb_clear(z_); }
  [[nodiscard]] acb_ptr get() { return z_; }

 private:
  acb_t z_{};
};

/// p(z) for a box z: Taylor's form about its centre is much narrower than Horner's on wide boxes.
inline void evaluate(acb_t result, const Polynomial& p, const acb_t z, slong bits) {
  if (acb_rel_accuracy_bits(z) > bits / 4) {
    arb_poly_evaluate_acb_horner(result, p.get(), z, bits);
    return;
  }
  acb_poly_t shifted;
  acb_t middle;
  acb_poly_init(shifted);
  acb_init(middle);
  acb_get_mid(middle, z);
  acb_poly_set_arb_poly(shifted, p.get());
  acb_poly_taylor_shift_horner(shifted, shifted, middle, bits);
  acb_sub(middle, z, middle, bits);
  acb_poly_evaluate_horner(result, shifted, middle, bits);
  acb_clear(middle);
  acb_poly_clear(shifted);
}

}  // namespace raytruth::arb
