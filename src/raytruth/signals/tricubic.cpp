#include "raytruth/signals/tricubic.hpp"

#include "raytruth/core/dispatch.hpp"
#include "raytruth/signals/cell_walk.hpp"
#include "raytruth/signals/tracing_error.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <vector>

namespace raytruth {

namespace {

template <class Real>
using Matrix = std::array<std::array<Real, 4>, 4>;
template <class Real>
using Tensor = std::array<Real, 64>;  ///< index 16 k + 4 j + i

constexpr std::array<double, 4> binomial_3{1, 3, 3, 1};
constexpr std::array<double, 10> binomial_9{1, 9, 36, 84, 126, 126, 84, 36, 9, 1};

/// The matrix from the Bernstein coefficients of a cubic on [0, 1] to those on its part [p, q], as [row][column]: row r
/// holds the weights of the polar form at 3 - r times p and r times q, all of them positive.
template <class Real>
Matrix<Real> restriction(const Real& p, const Real& q) {
  const auto polar = [](const Real& a, const Real& b, const Real& c) {
    const Real a1 = 1 - a;
    const Real b1 = 1 - b;
    const Real c1 = 1 - c;
    return std::array{a1 * b1 * c1, a * b1 * c1 + a1 * b * c1 + a1 * b1 * c, a * b * c1 + a * b1 * c + a1 * b * c,
                      a * b * c};
  };
  return {polar(p, p, p), polar(p, p, q), polar(p, q, q), polar(q, q, q)};
}

/// The matrix from the four voxels around a cell to the Bernstein coefficients on its part [begin, end]:
/// [coefficient][voxel].
template <class Real>
Matrix<Real> cell_matrix(const Matrix<Real>& kernel, const Real& begin, const Real& end) {
  const Matrix<Real> part = restriction(begin, end);
  Matrix<Real> matrix{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t voxel = 0; voxel < 4; ++voxel) matrix[i][voxel] += part[i][k] * kernel[k][voxel];
  return matrix;
}

/// Turns voxels into Bernstein coefficients along each axis in turn; the innermost loops run over what lies side by
/// side.
template <class Real>
Tensor<Real> contract(const Tensor<double>& voxels, const Matrix<Real>& x, const Matrix<Real>& y,
                      const Matrix<Real>& z) {
  Tensor<Real> by_z{};
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t voxel = 0; voxel < 4; ++voxel)
      for (std::size_t rest = 0; rest < 16; ++rest) by_z[16 * k + rest] += z[k][voxel] * voxels[16 * voxel + rest];
  Tensor<Real> by_y{};
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t voxel = 0; voxel < 4; ++voxel)
        for (std::size_t i = 0; i < 4; ++i) by_y[16 * k + 4 * j + i] += y[j][voxel] * by_z[16 * k + 4 * voxel + i];
  Matrix<Real> x_by_voxel{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t voxel = 0; voxel < 4; ++voxel) x_by_voxel[voxel][i] = x[i][voxel];
  Tensor<Real> result{};
  for (std::size_t row = 0; row < 16; ++row)
    for (std::size_t voxel = 0; voxel < 4; ++voxel)
      for (std::size_t i = 0; i < 4; ++i) result[4 * row + i] += x_by_voxel[voxel][i] * by_y[4 * row + voxel];
  return result;
}

/// The polynomial on the segment of a cell between two local points; see the header for the formula.
template <class Real>
Bernstein<9, Real> cell_polynomial(const Grid& grid, const Matrix<Real>& kernel, const CellSegment<Real>& segment) {
  std::array<std::array<std::int64_t, 4>, 3> offset{};
  std::int64_t stride = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::int64_t voxel = 0; voxel < 4; ++voxel)
      offset[axis][static_cast<std::size_t>(voxel)] =
          std::clamp(segment.cell[axis] - 1 + voxel, std::int64_t{0}, grid.size[axis] - 1) * stride;
    stride *= grid.size[axis];
  }
  Tensor<double> voxels{};
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t j = 0; j < 4; ++j) {
      const double* const row = grid.values.data() + offset[2][k] + offset[1][j];
      for (std::size_t i = 0; i < 4; ++i) voxels[16 * k + 4 * j + i] = row[offset[0][i]];
    }
  const auto matrix = [&](std::size_t axis) { return cell_matrix(kernel, segment.begin[axis], segment.end[axis]); };
  const Tensor<Real> tensor = contract(voxels, matrix(0), matrix(1), matrix(2));

  Bernstein<9, Real> polynomial;
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t i = 0; i < 4; ++i)
        polynomial.coefficients[i + j + k] +=
            binomial_3[i] * binomial_3[j] * binomial_3[k] * tensor[16 * k + 4 * j + i];
  for (std::size_t m = 0; m < 10; ++m) polynomial.coefficients[m] = polynomial.coefficients[m] / binomial_9[m];
  return polynomial;
}

template <class Real>
Matrix<Real> kernel_matrix(CubicKernel kernel) {
  Matrix<Real> matrix{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t voxel = 0; voxel < 4; ++voxel) matrix[i][voxel] = kernel_coefficient<Real>(kernel, i, voxel);
  return matrix;
}

/// Solves the system of `bspline_coefficients` in place on one line: elimination without pivoting, the matrix being
/// diagonally dominant.
void prefilter_line(double* values, std::int64_t count, std::int64_t stride, std::vector<double>& upper) {
  if (count == 1) return;  // (1 + 4 + 1)/6 c_0 = v_0
  upper.resize(static_cast<std::size_t>(count));
  const auto at = [values, stride](std::int64_t i) -> double& { return values[i * stride]; };
  for (std::int64_t i = 0; i < count; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const double diagonal = i == 0 || i == count - 1 ? 5 : 4;
    const double pivot = i == 0 ? diagonal : diagonal - upper[index - 1];
    upper[index] = 1 / pivot;
    at(i) = (6 * at(i) - (i == 0 ? 0 : at(i - 1))) / pivot;
  }
  for (std::int64_t i = count - 2; i >= 0; --i) at(i) -= upper[static_cast<std::size_t>(i)] * at(i + 1);
}

/// The derivative of a B-spline is a mean of differences. Bernstein coefficients of a Catmull-Rom cubic are sums of
/// voxels with weights of magnitude 4/3 in all, those of its derivative sums of differences with 3: (4/3)^2 3.
Reconstruction tricubic(CubicKernel kernel) {
  return {.margin = 1, .slope = kernel == CubicKernel::bspline ? 1 : 16.0 / 3};
}

}  // namespace

RAYTRUTH_DISPATCH
void trace_tricubic(const Grid& grid, CubicKernel kernel, const Ray& ray, Chain<9>& chain, Border border) {
  const auto matrix = kernel_matrix<double>(kernel);
  trace_cells(grid.size, border, ray, chain,
              [&](const CellWalk& walk) { return cell_polynomial(grid, matrix, walk.segment()); });
}

RAYTRUTH_DISPATCH
SignalError tricubic_error(const Grid& grid, CubicKernel kernel, const Ray& ray, const Chain<9>& chain,
                           double coefficient_error, const std::vector<bool>& is_needless,
                           const RayDisplacement& displacement, Border border) {
  const auto matrix = kernel_matrix<DoubleDouble>(kernel);
  SignalError error =
      tracing_error(grid, border, ray, chain, tricubic(kernel), is_needless, displacement,
                    [&](const CellSegment<DoubleDouble>& segment) { return cell_polynomial(grid, matrix, segment); });
  for (double& of_piece : error.of_pieces) of_piece += coefficient_error;
  return error;
}

PreciseChain<9> trace_tricubic_precisely(const Grid& grid, CubicKernel kernel, const Ray& ray, double coefficient_error,
                                         const RayDisplacement& displacement, Border border) {
  const auto matrix = kernel_matrix<DoubleDouble>(kernel);
  auto chain = trace_precisely<9>(
      grid, border, ray, tricubic(kernel), displacement,
      [&](const CellSegment<DoubleDouble>& segment) { return cell_polynomial(grid, matrix, segment); });
  for (auto& piece : chain.pieces) piece.error += coefficient_error;
  return chain;
}

Grid bspline_coefficients(const Grid& grid) {
  Grid result = grid;
  const std::array<std::int64_t, 3> stride{1, grid.size[0], grid.size[0] * grid.size[1]};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t a = (axis + 1) % 3;
    const std::size_t b = (axis + 2) % 3;
    tbb::parallel_for(std::int64_t{0}, grid.size[b], [&](std::int64_t slice) {
      std::vector<double> upper;
      for (std::int64_t line = 0; line < grid.size[a]; ++line)
        prefilter_line(result.values.data() + slice * stride[b] + line * stride[a], grid.size[axis], stride[axis],
                       upper);
    });
  }
  return result;
}

double prefilter_error(const Grid& voxels, const Grid& coefficients) {
  // Residuals are counted in 216ths, so that all weights are powers of 2; the rounding of their sums is known by
  // compensated summation (T. Ogita, S. M. Rump, S. Oishi, Accurate sum and dot product, 2005, proposition 4.5).
  constexpr std::array<double, 3> weight{1, 4, 1};
  std::vector<double> of_slice(static_cast<std::size_t>(voxels.size[2]));
  tbb::parallel_for(std::int64_t{0}, voxels.size[2], [&](std::int64_t k) {
    double& worst = of_slice[static_cast<std::size_t>(k)];
    const auto neighbour = [&](std::int64_t i, std::size_t step, std::size_t axis) {
      return std::clamp(i + static_cast<std::int64_t>(step) - 1, std::int64_t{0}, voxels.size[axis] - 1);
    };
    for (std::int64_t j = 0; j < voxels.size[1]; ++j)
      for (std::int64_t i = 0; i < voxels.size[0]; ++i) {
        const DoubleDouble target = two_product(-216.0, voxels.at(i, j, k));
        DoubleDouble sum = target;
        double magnitude = std::abs(target.high);
        for (std::size_t z = 0; z < 3; ++z)
          for (std::size_t y = 0; y < 3; ++y)
            for (std::size_t x = 0; x < 3; ++x) {
              const double term = weight[x] * weight[y] * weight[z] *
                                  coefficients.at(neighbour(i, x, 0), neighbour(j, y, 1), neighbour(k, z, 2));
              const DoubleDouble next = two_sum(sum.high, term);
              sum = {next.high, sum.low + next.low};
              magnitude += std::abs(term);
            }
        worst = std::max(worst, std::abs(sum.high + sum.low) + 0x1p-94 * magnitude);
      }
  });
  return 27.0 / 216 * (1 + 0x1p-50) * *std::max_element(of_slice.begin(), of_slice.end());
}

}  // namespace raytruth
