#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace raytruth {

/// The most nodes of a rule; a piece that needs more is halved.
inline constexpr std::size_t most_nodes = 40;

/// The Gauss-Legendre rule of `count` nodes on [0, 1], with what polynomials in Bernstein form need at its nodes. Every
/// number is the binary64 number nearest to the exact one. Rows are padded to full lanes with nodes of weight 0.
template <int Degree>
struct NodeTable {
  std::size_t count = 0;
  std::size_t stride = 0;  ///< nodes per row, padding included
  std::vector<double> nodes;
  std::vector<double> weights;
  std::array<std::vector<double>, Degree + 1>
      signal_basis;  ///< [j][i]: Bernstein polynomial j of degree Degree at node i
  std::array<std::vector<double>, Degree + 2> depth_basis;  ///< the same of degree Degree + 1
};

/// The rule of `count` nodes, 1 to most_nodes; made at its first use.
template <int Degree>
const NodeTable<Degree>& node_table(std::size_t count);

}  // namespace raytruth
