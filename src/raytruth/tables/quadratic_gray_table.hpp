#pragma once

#include "raytruth/core/error.hpp"
#include "raytruth/rules/rules.hpp"
#include "raytruth/schemes/quadratic_gray_printed.hpp"
#include "raytruth/schemes/radius_axis.hpp"
#include "raytruth/tables/look_up.hpp"
#include "raytruth/tables/table.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

namespace raytruth {

/// A table of slabs of the quadratic gray-value model, of one length (dissertation, section 5.3): over a, the
/// parabola's second divided difference, in gray values (0 to 255 over the range of the data) per squared length, and
/// over the back and the front scalar. Shape (node, back, front, 4), C order; RGBA as in Table.
template <class Real>
struct QuadraticGrayTable {
  TableAxes axes;
  RadiusAxis radius;
  double gray = 1;  ///< scalars to a gray value
  std::vector<Real> values;

  QuadraticGrayTable() = default;
  /// Zeros. Throws InputError as `check` does, and for more than `most_quadratic_entries`.
  QuadraticGrayTable(const TableAxes& its_axes, const RadiusAxis& its_radius);

  [[nodiscard]] Real* texel(std::size_t node, std::size_t front, std::size_t back) {
    return values.data() + 4 * ((node * axes.size + back) * axes.size + front);
  }
  [[nodiscard]] const Real* texel(std::size_t node, std::size_t front, std::size_t back) const {
    return values.data() + 4 * ((node * axes.size + back) * axes.size + front);
  }
  void set(std::size_t node, std::size_t front, std::size_t back, const Eigen::Array<Real, 4, 1>& slab) {
    Eigen::Map<Eigen::Array<Real, 4, 1>>(texel(node, front, back)) = slab;
  }
  /// The curvature of a node, in scalars per squared length.
  [[nodiscard]] double curvature(std::size_t node) const { return radius.curvature(node) * gray; }
};

/// Entries along the axes of scalars.
inline constexpr std::size_t largest_quadratic_size = 1024;

/// The most entries of a table, 1 GiB in binary32.
inline constexpr std::size_t most_quadratic_entries = std::size_t{1} << 26U;

/// A table in binary64 whose entries are the certified slabs of the same parabolas, and the largest of their radii: a
/// proven error of every entry.
struct CertifiedQuadraticGray {
  QuadraticGrayTable<double> table;
  double radius = 0;
};
CertifiedQuadraticGray certified_quadratic_gray_table(const PiecewiseLinear& transfer, const TableAxes& axes,
                                                      const RadiusAxis& radius, Emission emission);

/// The table in binary32, for rendering. Where all points of the transfer function are at entries it goes by the
/// kernels of fast_quadratic_gray.hpp, at most 10^-5 off for colours up to 1.
QuadraticGrayTable<float> quadratic_gray_table(const PiecewiseLinear& transfer, const TableAxes& axes,
                                               const RadiusAxis& radius, Emission emission);

/// The table as the dissertation prints it, in which entry i of n is the gray value (256 / n) i, 0 to 255 being the
/// range of `axes`. Throws InputError unless n divides 256.
QuadraticGrayTable<float> quadratic_gray_printed_table(const PiecewiseLinear& transfer, const TableAxes& axes,
                                                       const RadiusAxis& radius, Emission emission,
                                                       const QuadraticGrayPrint& print = {});

/// Which light a table of the model holds that is lit by the gradient of the opacity (dissertation, section 5.3.4).
enum class GradientTable {
  diffuse,              ///< of c d tau/ds: what B.L is multiplied by (eq. 5.3.18)
  diffuse_z,            ///< of z c d tau/ds: what A.L is multiplied by
  specular,             ///< of (1 + v z)^n c (d tau/ds)^n, v = (A.H) / (B.H), to be multiplied by (B.H)^n (eq. 5.3.20)
  specular_from_front,  ///< the same over the ratio of N_b.H to N_f.H, 0 to 1, to be multiplied by (N_f.H)^n: ours
  specular_from_back,   ///< over the ratio of N_f.H to N_b.H, to be multiplied by (N_b.H)^n
};

inline constexpr std::array<std::string_view, 5> gradient_table_names{"diffuse", "diffuse_z", "specular",
                                                                      "specular_from_front", "specular_from_back"};

/// Such a table; `v` is v, or the ratio. As printed, or by normals of the length 1 whose weights are clamped at both
/// ends: `is_corrected`. Throws InputError as QuadraticGraySlabs does.
QuadraticGrayTable<double> gradient_lit_table(const PiecewiseLinear& transfer, const TableAxes& axes,
                                              const RadiusAxis& radius, GradientTable which, double exponent, double v,
                                              bool is_corrected);

QuadraticGrayTable<double> in_binary64(const QuadraticGrayTable<float>& table);

/// The look-up: bilinear in the scalars, along the axis as it says.
template <class Real>
class QuadraticGrayLookUp {
 public:
  using vec4 = Rules<double>::vec4;

  explicit QuadraticGrayLookUp(const QuadraticGrayTable<Real>& table) : table_(&table), nodes_(table.radius) {}

  /// The slab through front, middle and back scalar. `is_nearest`: the nearest entry of every axis.
  [[nodiscard]] vec4 operator()(const std::array<double, 3>& scalars, bool is_nearest = false) const {
    return of_curvature({scalars[0], scalars[2]}, curvature(scalars), is_nearest);
  }

  /// In gray values per squared length.
  [[nodiscard]] double curvature(const std::array<double, 3>& scalars) const {
    Rules<double> rules;
    return rules.quadratic_gray_curvature(scalars[0], scalars[1], scalars[2], table_->axes.length) / table_->gray;
  }

  [[nodiscard]] bool clamps(double curvature) const { return nodes_.clamps(curvature); }

  [[nodiscard]] vec4 of_curvature(const std::array<double, 2>& ends, double curvature, bool is_nearest = false) const {
    const RadiusNodes::Place place = nodes_.place(curvature);
    if (is_nearest) return nearest<double>(table_->axes, reader(place.weight < 0.5 ? place.first : place.second), ends);
    const vec4 first = bilinear<double>(table_->axes, reader(place.first), ends);
    if (place.weight == 0) return first;
    return Rules<double>{}.filter_linear(first, bilinear<double>(table_->axes, reader(place.second), ends),
                                         place.weight);
  }

 private:
  [[nodiscard]] auto reader(std::size_t node) const {
    return [this, node](std::size_t front, std::size_t back) -> vec4 {
      return Eigen::Map<const Eigen::Array<Real, 4, 1>>(table_->texel(node, front, back)).template cast<double>();
    };
  }

  const QuadraticGrayTable<Real>* table_;
  RadiusNodes nodes_;
};

/// A way to a table of the quadratic gray-value model: a row of the list below.
struct QuadraticGrayBuilder {
  std::string_view name;
  std::string_view summary;
  std::string_view source;
  /// What a table has that says nothing of its radii.
  RadiusAxis radius;
  QuadraticGrayTable<float> (*make)(const PiecewiseLinear&, const TableAxes&, const RadiusAxis&, Emission);
};

namespace catalogue {

/// In the order in which tables and plots show them.
const std::array<QuadraticGrayBuilder, 2>& quadratic_gray_builders();

}  // namespace catalogue

}  // namespace raytruth
