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

/// From the four voxels around a cell to the Bernstein coefficients on its part [begin, end]: [coefficient][voxel].
Matrix cell_matrix(CubicKernel kernel, double begin, double end) {
  Matrix matrix{};
  for (std::size_t voxel = 0; voxel < 4; ++voxel) {
    Bernstein<3> cubic;
    for (std::size_t i = 0; i < 4; ++i) cubic.coefficients[i] = kernel_coefficient<double>(kernel, i, voxel);
    const auto part = cubic.restricted(begin, end);
    for (std::size_t i = 0; i < 4; ++i) matrix[i][voxel] = part.coefficients[i];
  }
  return matrix;
}

/// The matrix applied along the axis of the lowest index, which becomes the highest: three turns visit all axes and
/// restore the order.
Tensor turn(const Tensor& tensor, const Matrix& matrix) {
  Tensor result{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t rest = 0; rest < 16; ++rest) {
      double sum = 0;
      for (std::size_t voxel = 0; voxel < 4; ++voxel) sum += matrix[i][voxel] * tensor[4 * rest + voxel];
      result[16 * i + rest] = sum;
    }
  return result;
}

/// The polynomial on the segment through the current cell; see the header for the formula.
Bernstein<9> cell_polynomial(const Grid& grid, CubicKernel kernel, const CellWalk& walk) {
  std::array<std::array<std::int64_t, 4>, 3> offset{};
  std::int64_t stride = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::int64_t voxel = 0; voxel < 4; ++voxel)
      offset[axis][static_cast<std::size_t>(voxel)] =
          std::clamp(walk.cell(axis) - 1 + voxel, std::int64_t{0}, grid.size[axis] - 1) * stride;
    stride *= grid.size[axis];
  }
  Tensor tensor{};
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t j = 0; j < 4; ++j) {
      const double* const row = grid.values.data() + offset[2][k] + offset[1][j];
      for (std::size_t i = 0; i < 4; ++i) tensor[16 * k + 4 * j + i] = row[offset[0][i]];
    }
  for (std::size_t axis = 0; axis < 3; ++axis)
    tensor = turn(tensor, cell_matrix(kernel, walk.begin(axis), walk.end(axis)));

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
  trace_cells(grid.size, ray, chain,
              [&grid, kernel](const CellWalk& walk) { return cell_polynomial(grid, kernel, walk); });
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
