#include "raytruth/kernels/gauss_legendre.hpp"

#include "raytruth/core/real50.hpp"
#include "raytruth/kernels/level.hpp"
#include "raytruth/signals/piecewise_polynomial.hpp"

#include <boost/math/special_functions/legendre.hpp>

#include <atomic>
#include <mutex>
#include <vector>

namespace raytruth {

namespace {

struct Rule {
  std::vector<Real50> nodes;  ///< on [0, 1], ascending
  std::vector<Real50> weights;
};

Rule gauss_legendre(std::size_t count) {
  const int n = static_cast<int>(count);
  std::vector<Real50> roots = boost::math::legendre_p_zeros<Real50>(n);  // those that are not negative, ascending
  Rule rule;
  const auto add = [&](const Real50& z) {
    const Real50 slope = boost::math::legendre_p_prime(n, z);
    rule.nodes.push_back((1 + z) / 2);
    rule.weights.push_back(1 / ((1 - z * z) * slope * slope));
  };
  for (std::size_t i = roots.size(); i-- > 0;)
    if (roots[i] != 0) add(-roots[i]);
  for (const Real50& root : roots) add(root);
  return rule;
}

/// Bernstein polynomials 0 ... degree at every node times a factor, rounded to binary64, in rows.
template <std::size_t Count>
std::array<NodeRow, Count> bernstein_rows(const Rule& rule, const std::vector<Real50>& factors) {
  constexpr int degree = static_cast<int>(Count) - 1;
  std::array<NodeRow, Count> rows{};
  Real50 binomial = 1;
  for (int j = 0; j <= degree; ++j) {
    NodeRow& row = rows[static_cast<std::size_t>(j)];
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
      const Real50& u = rule.nodes[i];
      row[i] = to_double(factors[i] * binomial * pow(u, j) * pow(Real50(1 - u), degree - j));
    }
    binomial = binomial * (degree - j) / (j + 1);
  }
  return rows;
}

template <int Degree>
NodeTable<Degree> make_table(std::size_t count) {
  const Rule rule = gauss_legendre(count);
  NodeTable<Degree> table;
  table.count = count;
  for (std::size_t i = 0; i < count; ++i) {
    table.nodes[i] = to_double(rule.nodes[i]);
    table.weights[i] = to_double(rule.weights[i]);
  }
  const std::vector<Real50> ones(count, 1);
  table.weighted_rate_basis = bernstein_rows<Degree>(rule, rule.weights);
  table.signal_basis = bernstein_rows<Degree + 1>(rule, ones);
  table.depth_basis = bernstein_rows<Degree + 2>(rule, ones);
  return table;
}

}  // namespace

template <int Degree>
const NodeTable<Degree>& node_table(std::size_t count) {
  // Not std::call_once: whoever integrates one piece would wait for it as long as for two nodes.
  static std::array<std::atomic<const NodeTable<Degree>*>, most_nodes + 1> made{};
  if (const auto* table = made[count].load(std::memory_order_acquire)) return *table;
  static std::mutex mutex;
  static std::array<NodeTable<Degree>, most_nodes + 1> tables;
  const std::lock_guard lock(mutex);
  if (tables[count].count == 0) {
    tables[count] = make_table<Degree>(count);
    made[count].store(&tables[count], std::memory_order_release);
  }
  return tables[count];
}

template const NodeTable<3>& node_table<3>(std::size_t);
template const NodeTable<largest_degree>& node_table<largest_degree>(std::size_t);

}  // namespace raytruth
