#pragma once

#include <array>
#include <cstddef>

namespace raytruth {

/// The most nodes of a rule; a piece that needs more is halved.
inline constexpr std::size_t most_nodes = 40;

/// A number for each node, and 0 behind the last one.
using NodeRow = std::array<double, most_nodes>;

/// The Gauss-Legendre rule of `count` nodes on [0, 1], with what polynomials in Bernstein form need at its nodes. Every
/// number is the binary64 number nearest to the exact one.
template <int Degree>
struct NodeTable {
  std::size_t count = 0;
  alignas(64) NodeRow nodes{};
  NodeRow weights{};
  // Bernstein polynomials 0, 1, ... at the nodes:
  std::array<NodeRow, Degree> weighted_rate_basis{};  ///< of degree Degree - 1, times the nodes' weights
  std::array<NodeRow, Degree + 1> signal_basis{};     ///< of degree Degree
  std::array<NodeRow, Degree + 2> depth_basis{};      ///< of degree Degree + 1
};

/// The rule of `count` nodes, 1 to most_nodes; made at its first use.
template <int Degree>
const NodeTable<Degree>& node_table(std::size_t count);

}  // namespace raytruth
