#pragma once

#include "raytruth/core/named.hpp"
#include "raytruth/rules/rules.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <cstddef>
#include <vector>

namespace raytruth {

// Partial pre-integration (K. Moreland and E. Angel, A fast high accuracy volume renderer for unstructured data, 2004):
// a slab on which extinction and colour themselves are linear from front to back. With the optical depths D_f and D_b
// that it had if either end's extinction held throughout, and u from 0 at the front to 1 at the back,
//
//     zeta = exp(-(D_f + D_b) / 2),  psi = integral_0^1 exp(-(D_f u + (D_b - D_f) u^2 / 2)) du,
//     C = c_f (1 - psi) + c_b (psi - zeta),  opacity = 1 - zeta,
//
// for associated emission, by parts. psi depends on two numbers and on no transfer function: one table serves them all.
// Exact where the transfer function is linear between the two scalars; what it does in between is not seen.

/// psi for 0 <= D_f, D_b, infinity too. Error below 1e-14.
double partial_pre_integration_psi(double front_depth, double back_depth);

/// How the table of psi is read.
enum class PsiLookUp { nearest, bilinear };

/// The table of psi over gamma = D / (D + 1), which maps all depths to [0, 1]: entry i stands for i / (n - 1).
class PsiTable {
 public:
  /// Throws InputError unless 2 <= size <= largest_table_size.
  explicit PsiTable(std::size_t size);
  /// Such numbers as a format of a file changed them: size^2 of them.
  PsiTable(std::size_t size, std::vector<double> values);

  [[nodiscard]] double operator()(double front_depth, double back_depth, PsiLookUp look_up) const;

  [[nodiscard]] std::size_t size() const { return size_; }
  /// Shape (back, front).
  [[nodiscard]] const std::vector<double>& values() const { return values_; }

 private:
  std::size_t size_;
  std::vector<double> values_;
};

/// The slab between two optics from its psi; colour and opacity.
Rules<double>::vec4 partially_pre_integrated_slab(const Optics& front, const Optics& back, double length, double psi);

namespace catalogue {

/// The table of psi, over two optical depths.
inline constexpr Named psi_builder{"partial_pre_integration",
                                   "psi of Moreland and Angel 2004, over the optical depths of both ends"};

}  // namespace catalogue

}  // namespace raytruth
