#pragma once

#include "raytruth/core/bernstein.hpp"

#include <array>
#include <cstddef>

namespace raytruth {

/// The product, c_k = sum over i + j = k of binomial(m, i) binomial(n, j) / binomial(m + n, k) a_i b_j.
template <int DegreeA, int DegreeB, class Real>
Bernstein<DegreeA + DegreeB, Real> operator*(const Bernstein<DegreeA, Real>& a, const Bernstein<DegreeB, Real>& b) {
  const auto binomials = [](std::size_t n, auto& row) {
    row[0] = Real(1);
    for (std::size_t k = 0; k < n; ++k) row[k + 1] = row[k] * Real(n - k) / Real(k + 1);
  };
  std::array<Real, DegreeA + 1> of_a{};
  std::array<Real, DegreeB + 1> of_b{};
  std::array<Real, DegreeA + DegreeB + 1> of_product{};
  binomials(DegreeA, of_a);
  binomials(DegreeB, of_b);
  binomials(DegreeA + DegreeB, of_product);
  Bernstein<DegreeA + DegreeB, Real> product;
  for (std::size_t i = 0; i <= DegreeA; ++i)
    for (std::size_t j = 0; j <= DegreeB; ++j)
      product.coefficients[i + j] =
          product.coefficients[i + j] + of_a[i] * of_b[j] / of_product[i + j] * a.coefficients[i] * b.coefficients[j];
  return product;
}

}  // namespace raytruth
