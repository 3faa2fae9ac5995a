#include "raytruth/metrics/slab_banding.hpp"

#include "raytruth/core/error.hpp"

#include <fmt/format.h>
#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace raytruth {

namespace {

constexpr int smooth_terms = 6;
constexpr int phase_terms = 5;

using SmoothRow = Eigen::Matrix<double, smooth_terms, 1>;
using PhaseRow = Eigen::Matrix<double, phase_terms, 1>;

/// All quadratics of a place in [-1, 1]^2.
SmoothRow smooth_at(double x, double y) {
  SmoothRow row;
  row << 1, x, y, x * x, x * y, y * y;
  return row;
}

/// The Legendre polynomials of degree 1 to 5 of 2 phase - 1, of mean square 1 over the phases.
PhaseRow phase_polynomials(double phase) {
  PhaseRow row;
  double before = 1;
  double here = 2 * phase - 1;
  const double x = here;
  for (int degree = 1; degree <= phase_terms; ++degree) {
    row[degree - 1] = std::sqrt(2.0 * degree + 1) * here;
    const double next = ((2 * degree + 1) * x * here - degree * before) / (degree + 1);
    before = here;
    here = next;
  }
  return row;
}

/// The depths of the pixels that count; not a number elsewhere.
std::vector<double> wide_depths(const std::vector<double>& depths, const std::array<std::int64_t, 2>& size) {
  constexpr std::array<std::array<std::int64_t, 2>, 4> neighbours{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  constexpr double widest = 0.5;
  const auto [width, height] = size;
  std::vector<double> result(depths.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::int64_t row = 0; row < height; ++row)
    for (std::int64_t column = 0; column < width; ++column) {
      const auto here = static_cast<std::size_t>(row * width + column);
      const bool counts = std::all_of(neighbours.begin(), neighbours.end(), [&](const auto& step) {
        const std::int64_t x = column + step[0];
        const std::int64_t y = row + step[1];
        if (x < 0 || x >= width || y < 0 || y >= height) return true;
        // A comparison with what is not a number is false.
        return std::abs(depths[static_cast<std::size_t>(y * width + x)] - depths[here]) < widest;
      });
      if (counts && std::isfinite(depths[here])) result[here] = depths[here];
    }
  return result;
}

/// The sums over windows.
struct Sums {
  double left_by_smooth = 0;
  double left_by_both = 0;
  double freedom_of_smooth = 0;
  double freedom_of_both = 0;
  double jumps = 0;  ///< squared
  std::int64_t windows = 0;
};

/// Adds a window, of which the values, smooth functions and phases' polynomials of its pixels are given, row by row.
void add_window(const Eigen::VectorXd& values, const Eigen::MatrixXd& smooth, const Eigen::MatrixXd& phases,
                Sums& sums) {
  constexpr double least_eigenvalue = 0.25;
  const auto count = static_cast<double>(values.size());
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver(smooth);
  const auto without_smooth = [&](const auto& columns) { return (columns - smooth * solver.solve(columns)).eval(); };
  const Eigen::VectorXd rest = without_smooth(values);
  const Eigen::MatrixXd own = without_smooth(phases);
  const Eigen::MatrixXd products = own.transpose() * own / count;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(products);
  if (!(eigen.eigenvalues()[0] > least_eigenvalue)) return;

  const Eigen::LDLT<Eigen::MatrixXd> inverse(products);
  const Eigen::VectorXd found = inverse.solve(own.transpose() * rest / count);
  const double left = (rest - own * found).squaredNorm();
  const double freedom = count - smooth_terms - phase_terms;
  const Eigen::VectorXd ends = phase_polynomials(0) - phase_polynomials(1);
  const double jump = ends.dot(found);
  const double variance = left / freedom / count * ends.dot(inverse.solve(ends));
  sums.left_by_smooth += rest.squaredNorm();
  sums.left_by_both += left;
  sums.freedom_of_smooth += count - smooth_terms;
  sums.freedom_of_both += freedom;
  sums.jumps += jump * jump - variance;
  ++sums.windows;
}

}  // namespace

std::optional<SlabBanding> slab_banding(const std::vector<double>& values, const std::vector<double>& depths,
                                        const std::array<std::int64_t, 2>& size, std::int64_t side) {
  constexpr std::int64_t least_side = 8;
  if (side < least_side || size[0] < side || size[1] < side)
    throw InputError(fmt::format("found windows of {} pixels in an image of {} x {}; {} up to the image are allowed",
                                 side, size[0], size[1], least_side));
  const std::vector<double> wide = wide_depths(depths, size);
  Sums sums;
  for (std::int64_t top = 0; top + side <= size[1]; top += side / 2)
    for (std::int64_t left = 0; left + side <= size[0]; left += side / 2) {
      std::vector<std::array<std::int64_t, 2>> pixels;
      for (std::int64_t row = top; row < top + side; ++row)
        for (std::int64_t column = left; column < left + side; ++column)
          if (std::isfinite(wide[static_cast<std::size_t>(row * size[0] + column)])) pixels.push_back({column, row});
      if (2 * static_cast<std::int64_t>(pixels.size()) < side * side) continue;
      const auto count = static_cast<Eigen::Index>(pixels.size());
      Eigen::VectorXd its_values(count);
      Eigen::MatrixXd smooth(count, smooth_terms);
      Eigen::MatrixXd phases(count, phase_terms);
      for (Eigen::Index i = 0; i < count; ++i) {
        const auto [column, row] = pixels[static_cast<std::size_t>(i)];
        const auto pixel = static_cast<std::size_t>(row * size[0] + column);
        const auto in_window = [side](std::int64_t from_edge) {
          return 2 * static_cast<double>(from_edge) / static_cast<double>(side - 1) - 1;
        };
        its_values[i] = values[pixel];
        smooth.row(i) = smooth_at(in_window(column - left), in_window(row - top)).transpose();
        phases.row(i) = phase_polynomials(wide[pixel] - std::floor(wide[pixel])).transpose();
      }
      add_window(its_values, smooth, phases, sums);
    }
  if (sums.windows == 0) return {};
  const double smooth_square = sums.left_by_smooth / sums.freedom_of_smooth;
  const double both_square = sums.left_by_both / sums.freedom_of_both;
  // Values that are smooth to rounding have nothing that could follow phases.
  const double largest = std::abs(
      *std::max_element(values.begin(), values.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
  constexpr double rounding = 1e-12;
  if (!(std::sqrt(smooth_square) > rounding * largest)) return SlabBanding{.windows = sums.windows};
  return SlabBanding{.share = 1 - both_square / smooth_square,
                     .amplitude = std::sqrt(std::max(0.0, smooth_square - both_square)),
                     .jump = std::sqrt(std::max(0.0, sums.jumps / static_cast<double>(sums.windows))),
                     .windows = sums.windows};
}

}  // namespace raytruth
