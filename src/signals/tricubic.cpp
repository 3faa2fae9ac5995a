#include "signals/tricubic.hpp"

#include "core/dispatch.hpp"
#include "signals/cell_walk.hpp"

#include <tbb/parallel_for.h>

#include <vector>

namespace raytruth {

namespace {

using Matrix = std::array<std::array<double, 4>, 4>;
using Tensor = std::array<double, 64>;  ///< index 16 k + 4 j + i

constexpr std::array<double, 4> binomial_3{1, 3, 3, 1};
constexpr std::array<double, 10> binomial_9{1, 9, 36, 84, 126, 126, 84, 36, 9, 1};

/// From the Bernstein coefficients of a cubic on [0, 1] to those on its part [p, q], as [row][column]: row r holds the
/// weights of the polar form at 3 - r times p and r times q, all of them positive.
Matrix restriction(double p, double q) {
  const auto polar = [](double a, double b, double c) {
    const double a1 = 1 - a;
    const double b1 = 1 - b;
    const double c1 = 1 - c;
    return std::array{a1 * b1 * c1, a * b1 * c1 + a1 * b * c1 + a1 * b1 * c, a * b * c1 + a * b1 * c + a1 * b * c,
                      a * b * c};
  };
  return {polar(p, p, p), polar(p, p, q), polar(p, q, q), polar(q, q, q)};
}

/// From the four voxels around a cell to the Bernstein coefficients on its part [begin, end]: [coefficient][voxel].
Matrix cell_matrix(const Matrix& kernel, double begin, double end) {
  const Matrix part = restriction(begin, end);
  Matrix matrix{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t voxel = 0; voxel < 4; ++voxel) matrix[i][voxel] += part[i][k] * kernel[k][voxel];
  return matrix;
}

/// Voxels to Bernstein coefficients along each axis in turn; the innermost loops run over what lies side by side.
Tensor contract(const Tensor& voxels, const Matrix& x, const Matrix& y, const Matrix& z) {
  Tensor by_z{};
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t voxel = 0; voxel < 4; ++voxel)
      for (std::size_t rest = 0; rest < 16; ++rest) by_z[16 * k + rest] += z[k][voxel] * voxels[16 * voxel + rest];
  Tensor by_y{};
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t voxel = 0; voxel < 4; ++voxel)
        for (std::size_t i = 0; i < 4; ++i) by_y[16 * k + 4 * j + i] += y[j][voxel] * by_z[16 * k + 4 * voxel + i];
  Matrix x_by_voxel{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t voxel = 0; voxel < 4; ++voxel) x_by_voxel[voxel][i] = x[i][voxel];
  Tensor result{};
  for (std::size_t row = 0; row < 16; ++row)
    for (std::size_t voxel = 0; voxel < 4; ++voxel)
      for (std::size_t i = 0; i < 4; ++i) result[4 * row + i] += x_by_voxel[voxel][i] * by_y[4 * row + voxel];
  return result;
}

/// The polynomial on the segment through the current cell; see the header for the formula.
Bernstein<9> cell_polynomial(const Grid& grid, const Matrix& kernel, const CellWalk& walk) {
  std::array<std::array<std::int64_t, 4>, 3> offset{};
  std::int64_t stride = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::int64_t voxel = 0; voxel < 4; ++voxel)
      offset[axis][static_cast<std::size_t>(voxel)] =
          std::clamp(walk.cell(axis) - 1 + voxel, std::int64_t{0}, grid.size[axis] - 1) * stride;
    stride *= grid.size[axis];
  }
  Tensor voxels{};
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t j = 0; j < 4; ++j) {
      const double* const row = grid.values.data() + offset[2][k] + offset[1][j];
      for (std::size_t i = 0; i < 4; ++i) voxels[16 * k + 4 * j + i] = row[offset[0][i]];
    }
  const auto matrix = [&](std::size_t axis) { return cell_matrix(kernel, walk.begin(axis), walk.end(axis)); };
  const Tensor tensor = contract(voxels, matrix(0), matrix(1), matrix(2));

  Bernstein<9> polynomial;
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t i = 0; i < 4; ++i)
        polynomial.coefficients[i + j + k] +=
            binomial_3[i] * binomial_3[j] * binomial_3[k] * tensor[16 * k + 4 * j + i];
  for (std::size_t m = 0; m < 10; ++m) polynomial.coefficients[m] /= binomial_9[m];
  return polynomial;
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

}  // namespace

RAYTRUTH_DISPATCH
void trace_tricubic(const Grid& grid, CubicKernel kernel, const Ray& ray, Chain<9>& chain) {
  Matrix matrix{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t voxel = 0; voxel < 4; ++voxel) matrix[i][voxel] = kernel_coefficient<double>(kernel, i, voxel);
  trace_cells(grid.size, ray, chain, [&](const CellWalk& walk) { return cell_polynomial(grid, matrix, walk); });
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

}  // namespace raytruth
