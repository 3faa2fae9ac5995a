#include "raytruth/kernels/depth_table.hpp"

#include "raytruth/core/real50.hpp"
#include "raytruth/signals/piecewise_polynomial.hpp"

#include <boost/math/constants/constants.hpp>

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

namespace raytruth {

namespace {

/// T_0 ... T_(count - 1) at z.
std::vector<Real50> chebyshev_polynomials(const Real50& z, std::size_t count) {
  std::vector<Real50> values{1, z};
  while (values.size() < count) values.push_back(2 * z * values.back() - values[values.size() - 2]);
  return values;
}

/// The integrals of T_0 ... T_(count - 1) from -1 to z: of T_k, k > 1, it is (T_(k+1) / (k + 1) - T_(k-1) / (k - 1)) /
/// 2, less the value at -1.
std::vector<Real50> chebyshev_integrals(const Real50& z, std::size_t count) {
  const std::vector<Real50> at_z = chebyshev_polynomials(z, count + 1);
  std::vector<Real50> integrals{z + 1, (z * z - 1) / 2};
  for (std::size_t k = 2; k < count; ++k) {
    const Real50 above = Real50(1) / static_cast<int>(k + 1);
    const Real50 below = Real50(1) / static_cast<int>(k - 1);
    const int sign_at_begin = k % 2 == 0 ? -1 : 1;
    integrals.push_back((at_z[k + 1] * above - at_z[k - 1] * below - sign_at_begin * (above - below)) / 2);
  }
  return integrals;
}

template <int Degree>
std::unique_ptr<const DepthTable<Degree>> make_table(std::size_t samples, std::size_t nodes) {
  auto table = std::make_unique<DepthTable<Degree>>();
  table->sample_count = samples;
  table->node_count = nodes;
  table->nodes = &node_table<Degree>(nodes);

  std::vector<std::vector<Real50>> polynomials;
  for (std::size_t j = 0; j < samples; ++j) {
    const Real50 angle =
        boost::math::constants::pi<Real50>() * static_cast<int>(2 * j + 1) / static_cast<int>(2 * samples);
    const Real50 z = -cos(angle);
    polynomials.push_back(chebyshev_polynomials(z, samples));
    const Real50 u = (1 + z) / 2;
    Real50 binomial = 1;
    for (int k = 0; k <= Degree; ++k) {
      table->signal_basis[static_cast<std::size_t>(k)][j] =
          to_double(Real50(binomial * pow(u, k) * pow(Real50(1 - u), Degree - k)));
      binomial = binomial * (Degree - k) / (k + 1);
    }
  }
  for (std::size_t i = 0; i <= nodes; ++i) {
    const Real50 u = i < nodes ? table->nodes->nodes[i] : 1.0;
    const std::vector<Real50> integrals = chebyshev_integrals(2 * u - 1, samples);
    double row = 0;
    double negative = 0;
    for (std::size_t j = 0; j < samples; ++j) {
      // The interpolating polynomial of the function that is 1 at point j and 0 at the others.
      Real50 sum = integrals[0] / 2;
      for (std::size_t k = 1; k < samples; ++k) sum += polynomials[j][k] * integrals[k];
      table->integrals[i][j] = to_double(Real50(sum / static_cast<int>(samples)));
      row += std::abs(table->integrals[i][j]);
      negative += std::max(0.0, -table->integrals[i][j]);
    }
    table->largest_row = std::max(table->largest_row, row);
    table->largest_negative = std::max(table->largest_negative, negative);
  }
  return table;
}

}  // namespace

template <int Degree>
const DepthTable<Degree>& depth_table(std::size_t sample_index, std::size_t node_index) {
  using Table = DepthTable<Degree>;
  constexpr std::size_t count = depth_sample_counts.size() * depth_node_counts.size();
  static std::array<std::atomic<const Table*>, count> made{};
  const std::size_t index = sample_index * depth_node_counts.size() + node_index;
  if (const Table* table = made[index].load(std::memory_order_acquire)) return *table;
  static std::mutex mutex;
  static std::array<std::unique_ptr<const Table>, count> tables;
  const std::lock_guard lock(mutex);
  if (!tables[index]) {
    tables[index] = make_table<Degree>(depth_sample_counts[sample_index], depth_node_counts[node_index]);
    made[index].store(tables[index].get(), std::memory_order_release);
  }
  return *tables[index];
}

template const DepthTable<3>& depth_table<3>(std::size_t, std::size_t);
template const DepthTable<largest_degree>& depth_table<largest_degree>(std::size_t, std::size_t);

}  // namespace raytruth
