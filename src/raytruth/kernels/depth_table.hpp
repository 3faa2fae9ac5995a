#pragma once

#include "raytruth/kernels/gauss_legendre.hpp"

#include <array>
#include <cstddef>

namespace raytruth {

/// The numbers of samples, and of nodes, that there are tables for.
inline constexpr std::array<std::size_t, 9> depth_sample_counts{8, 12, 16, 20, 24, 28, 32, 40, 48};
inline constexpr std::array<std::size_t, 10> depth_node_counts{4, 6, 8, 10, 12, 14, 16, 20, 28, 40};

/// What integrates a function f over [0, u] for the u of a Gauss-Legendre rule, and for u = 1: f is sampled at
/// Chebyshev's points, and its interpolating polynomial is integrated exactly. All numbers are the binary64 numbers
/// nearest to the exact ones.
template <int Degree>
struct DepthTable {
  static constexpr std::size_t most_samples = depth_sample_counts.back();
  using Row = std::array<double, most_samples>;

  std::size_t sample_count = 0;
  std::size_t node_count = 0;
  const NodeTable<Degree>* nodes = nullptr;     ///< the rule of node_count nodes
  double largest_negative = 0;                  ///< largest sum of the negative numbers of such a row, as a magnitude
  double largest_row = 0;                       ///< largest sum of |a row of `integrals`|
  std::array<Row, Degree + 1> signal_basis{};   ///< Bernstein polynomials of degree Degree at Chebyshev's points
  std::array<Row, most_nodes + 1> integrals{};  ///< row i: up to node i; the row behind the last node: up to 1
};

/// The most samples and nodes together; a piece that needs more is halved.
inline constexpr std::size_t most_points = depth_sample_counts.back() + depth_node_counts.back();

/// The table of these indices into the two lists above; made at its first use.
template <int Degree>
const DepthTable<Degree>& depth_table(std::size_t sample_index, std::size_t node_index);

}  // namespace raytruth
