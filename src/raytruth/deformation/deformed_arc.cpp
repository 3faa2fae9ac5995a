#include "raytruth/deformation/deformed_arc.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace raytruth {

namespace {

using Series = std::array<double, arc_degree + 1>;

/// Coefficient k of a product.
double product(const Series& a, const Series& b, std::size_t k) {
  double sum = 0;
  for (std::size_t i = 0; i <= k; ++i) sum += a[i] * b[k - i];
  return sum;
}

/// A function of xi in [-1, 1]: a series, and how far it may be from the function.
struct Model {
  Series series{};
  double rest = 0;

  /// Sum of magnitudes, the rest with it.
  [[nodiscard]] double magnitude(std::size_t first = 0) const {
    double sum = rest;
    for (std::size_t k = first; k <= arc_degree; ++k) sum += std::abs(series[k]);
    return sum;
  }
};

/// What the product of two models leaves out, and their rests' part in it.
double rest_of_product(const Model& a, const Model& b) {
  std::array<double, arc_degree + 2> tail{};  // of b, from k on
  for (std::size_t k = arc_degree + 1; k-- > 0;) tail[k] = tail[k + 1] + std::abs(b.series[k]);
  double sum = 0;
  for (std::size_t i = 1; i <= arc_degree; ++i) sum += std::abs(a.series[i]) * tail[arc_degree + 1 - i];
  return sum + a.magnitude() * b.rest + a.rest * tail[0];
}

/// f, its derivatives, and what they are made of, in a cell: by x, then by y, then by z.
struct FunctionModel {
  std::array<Model, 9> line;  ///< powers b, c of y and z: 3 c + b
  std::array<Model, 9> line_dx;
  std::array<Model, 3> plane;  ///< powers of z
  std::array<Model, 3> plane_dx;
  std::array<Model, 3> plane_dy;
  Model value;
  std::array<Model, 3> gradient;
};

/// All that is a function of the curve.
struct CurveModel {
  std::array<Model, 3> local;
  std::array<Model, 3> square;
  std::array<FunctionModel, 2> functions;
  std::array<Model, 3> direction;
};

/// Coefficient k of everything but the local coordinates, which are known up to k.
void extend(const std::array<CellFunction, 2>& functions, std::size_t k, CurveModel& curve) {
  auto& [x, y, z] = curve.local;
  auto& [xx, yy, zz] = curve.square;
  for (std::size_t axis = 0; axis < 3; ++axis)
    curve.square[axis].series[k] = product(curve.local[axis].series, curve.local[axis].series, k);
  for (std::size_t i = 0; i < 2; ++i) {
    FunctionModel& f = curve.functions[i];
    for (std::size_t line = 0; line < 9; ++line) {
      const double* const c = &functions[i][3 * line];
      f.line[line].series[k] = (k == 0 ? c[0] : 0) + c[1] * x.series[k] + c[2] * xx.series[k];
      f.line_dx[line].series[k] = (k == 0 ? c[1] : 0) + 2 * c[2] * x.series[k];
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const Model* const line = &f.line[3 * c];
      const Model* const line_dx = &f.line_dx[3 * c];
      const double y_of_2 = product(y.series, line[2].series, k);
      f.plane[c].series[k] =
          line[0].series[k] + product(y.series, line[1].series, k) + product(yy.series, line[2].series, k);
      f.plane_dx[c].series[k] =
          line_dx[0].series[k] + product(y.series, line_dx[1].series, k) + product(yy.series, line_dx[2].series, k);
      f.plane_dy[c].series[k] = line[1].series[k] + 2 * y_of_2;
    }
    const auto along_z = [&](const std::array<Model, 3>& plane) {
      return plane[0].series[k] + product(z.series, plane[1].series, k) + product(zz.series, plane[2].series, k);
    };
    f.value.series[k] = along_z(f.plane);
    f.gradient[0].series[k] = along_z(f.plane_dx);
    f.gradient[1].series[k] = along_z(f.plane_dy);
    f.gradient[2].series[k] = f.plane[1].series[k] + 2 * product(z.series, f.plane[2].series, k);
  }
  const auto& g = curve.functions[0].gradient;
  const auto& h = curve.functions[1].gradient;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t a = (axis + 1) % 3;
    const std::size_t b = (axis + 2) % 3;
    curve.direction[axis].series[k] = product(g[a].series, h[b].series, k) - product(g[b].series, h[a].series, k);
  }
}

/// r becomes xi = r / scale.
void rescale(Model& model, double scale) {
  double power = 1;
  for (double& coefficient : model.series) {
    coefficient *= power;
    power *= scale;
  }
}

void rescale(CurveModel& curve, double scale) {
  for (auto* const models : {&curve.local, &curve.square, &curve.direction})
    for (Model& model : *models) rescale(model, scale);
  for (FunctionModel& f : curve.functions) {
    for (auto* const lines : {&f.line, &f.line_dx})
      for (Model& model : *lines) rescale(model, scale);
    for (auto* const planes : {&f.plane, &f.plane_dx, &f.plane_dy, &f.gradient})
      for (Model& model : *planes) rescale(model, scale);
    rescale(f.value, scale);
  }
}

/// What the series leave out, for local coordinates that are polynomials exactly.
void find_rests(const std::array<CellFunction, 2>& functions, CurveModel& curve) {
  auto& [x, y, z] = curve.local;
  auto& [xx, yy, zz] = curve.square;
  for (std::size_t axis = 0; axis < 3; ++axis)
    curve.square[axis].rest = rest_of_product(curve.local[axis], curve.local[axis]);
  for (std::size_t i = 0; i < 2; ++i) {
    FunctionModel& f = curve.functions[i];
    for (std::size_t line = 0; line < 9; ++line) f.line[line].rest = std::abs(functions[i][3 * line + 2]) * xx.rest;
    for (std::size_t c = 0; c < 3; ++c) {
      const Model* const line = &f.line[3 * c];
      const Model* const line_dx = &f.line_dx[3 * c];
      f.plane[c].rest = line[0].rest + rest_of_product(y, line[1]) + rest_of_product(yy, line[2]);
      f.plane_dx[c].rest = rest_of_product(y, line_dx[1]) + rest_of_product(yy, line_dx[2]);
      f.plane_dy[c].rest = line[1].rest + 2 * rest_of_product(y, line[2]);
    }
    const auto along_z = [&](const std::array<Model, 3>& plane) {
      return plane[0].rest + rest_of_product(z, plane[1]) + rest_of_product(zz, plane[2]);
    };
    f.value.rest = along_z(f.plane);
    f.gradient[0].rest = along_z(f.plane_dx);
    f.gradient[1].rest = along_z(f.plane_dy);
    f.gradient[2].rest = f.plane[1].rest + 2 * rest_of_product(z, f.plane[2]);
  }
  const auto& g = curve.functions[0].gradient;
  const auto& h = curve.functions[1].gradient;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t a = (axis + 1) % 3;
    const std::size_t b = (axis + 2) % 3;
    curve.direction[axis].rest = rest_of_product(g[a], h[b]) + rest_of_product(g[b], h[a]);
  }
}

/// The sum of the squares of the second derivatives' bounds on the cell: second differences of Bernstein coefficients.
double sum_of_squared_bends(const CellFunction& powers) {
  CellFunction b = powers;
  for (const std::size_t stride : {std::size_t{1}, std::size_t{3}, std::size_t{9}})
    for (std::size_t k = 0; k < b.size(); ++k) {
      if (k / stride % 3 != 0) continue;
      const double middle = b[k] + b[k + stride] / 2;
      b[k + 2 * stride] += b[k] + b[k + stride];
      b[k + stride] = middle;
    }
  constexpr std::array<std::size_t, 3> strides{1, 3, 9};
  double sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t stride = strides[axis];
    const std::size_t next = strides[(axis + 1) % 3];
    double along = 0;
    double mixed = 0;
    for (std::size_t k = 0; k < b.size(); ++k) {
      if (k / stride % 3 == 0) along = std::max(along, std::abs(2 * (b[k] - 2 * b[k + stride] + b[k + 2 * stride])));
      if (k / stride % 3 < 2 && k / next % 3 < 2)
        mixed = std::max(mixed, std::abs(4 * (b[k] - b[k + stride] - b[k + next] + b[k + stride + next])));
    }
    sum += along * along + 2 * mixed * mixed;
  }
  return sum;
}

constexpr double rounding_of_sums = 0x1p-47;  // of the magnitudes of what is added and multiplied

}  // namespace

Eigen::Vector3d DeformedArc::value(double xi) const {
  Eigen::Vector3d result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double sum = 0;
    for (std::size_t k = arc_degree + 1; k-- > 0;) sum = local[axis][k] + xi * sum;
    result[static_cast<Eigen::Index>(axis)] = sum;
  }
  return result;
}

Eigen::Vector3d DeformedArc::derivative(double xi) const {
  Eigen::Vector3d result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double sum = 0;
    for (std::size_t k = arc_degree; k > 0; --k) sum = static_cast<double>(k) * local[axis][k] + xi * sum;
    result[static_cast<Eigen::Index>(axis)] = sum;
  }
  return result;
}

CellCurve::CellCurve(const RayEquations& equations, const LatticeCell& cell) {
  double squares = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    functions_[i] = equations.in_cell(i, cell);
    for (const double power : functions_[i]) size_[i] += std::abs(power);
    squares += sum_of_squared_bends(functions_[i]);
  }
  bends_ = std::sqrt(squares);
}

CellCurve::Jet CellCurve::jet(const Eigen::Vector3d& local) const {
  Jet result{};
  const double x = local[0];
  for (std::size_t i = 0; i < 2; ++i) {
    double value = 0;
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    for (std::size_t c = 3; c-- > 0;) {
      double plane = 0;
      double plane_dx = 0;
      double plane_dy = 0;
      for (std::size_t b = 3; b-- > 0;) {
        const double* const p = &functions_[i][LatticeCell::index(0, b, c)];
        plane_dy = plane + local[1] * plane_dy;
        plane = p[0] + x * (p[1] + x * p[2]) + local[1] * plane;
        plane_dx = p[1] + 2 * x * p[2] + local[1] * plane_dx;
      }
      gradient[2] = value + local[2] * gradient[2];
      value = plane + local[2] * value;
      gradient[0] = plane_dx + local[2] * gradient[0];
      gradient[1] = plane_dy + local[2] * gradient[1];
    }
    result.value[i] = value;
    result.gradient[i] = gradient;
  }
  return result;
}

Eigen::Vector3d CellCurve::direction(const Eigen::Vector3d& local) const {
  const Jet here = jet(local);
  return here.gradient[0].cross(here.gradient[1]);
}

Eigen::Vector3d CellCurve::onto_curve(Eigen::Vector3d local) const {
  for (int i = 0; i < 3; ++i) {
    const Jet here = jet(local);
    const Eigen::Vector3d& g = here.gradient[0];
    const Eigen::Vector3d& h = here.gradient[1];
    // The shortest step to where both are 0, in the plane of the gradients.
    const double gg = g.squaredNorm();
    const double gh = g.dot(h);
    const double hh = h.squaredNorm();
    const double determinant = gg * hh - gh * gh;
    if (!(determinant > 0)) break;
    const double along_g = (hh * here.value[0] - gh * here.value[1]) / determinant;
    const double along_h = (gg * here.value[1] - gh * here.value[0]) / determinant;
    local -= along_g * g + along_h * h;
  }
  return local;
}

Eigen::Vector3d CellCurve::step(const Eigen::Vector3d& from, double r) const {
  const Eigen::Vector3d one = direction(from);
  const Eigen::Vector3d two = direction(from + r / 2 * one);
  const Eigen::Vector3d three = direction(from + r / 2 * two);
  const Eigen::Vector3d four = direction(from + r * three);
  return onto_curve(from + r / 6 * (one + 2 * two + 2 * three + four));
}

double CellCurve::reach(const DeformedArc& arc, double relative) const {
  const Eigen::Vector3d first = arc.derivative(0);
  double result = std::numeric_limits<double>::infinity();
  // Both of the last terms, as one alone may happen to be small.
  for (const std::size_t k : {arc_degree - 1, arc_degree}) {
    double size = 0;
    for (const auto& series : arc.local) size += std::abs(series[k]) * static_cast<double>(k);
    if (!(size > 0)) continue;
    const double ratio = std::pow(relative * first.norm() / size, 1 / static_cast<double>(k - 1));
    result = std::min(result, std::abs(arc.scale) * ratio);
  }
  return result;
}

DeformedArc CellCurve::arc(Eigen::Vector3d middle, double r) const {
  middle = onto_curve(middle);
  CurveModel curve;
  for (std::size_t axis = 0; axis < 3; ++axis) curve.local[axis].series[0] = middle[static_cast<Eigen::Index>(axis)];
  for (std::size_t k = 0; k <= arc_degree; ++k) {
    extend(functions_, k, curve);
    if (k == arc_degree) break;
    for (std::size_t axis = 0; axis < 3; ++axis)
      curve.local[axis].series[k + 1] = curve.direction[axis].series[k] / static_cast<double>(k + 1);
  }
  rescale(curve, r);
  find_rests(functions_, curve);

  DeformedArc arc;
  arc.scale = r;
  for (std::size_t axis = 0; axis < 3; ++axis) arc.local[axis] = curve.local[axis].series;
  Eigen::Vector3d at_middle;
  for (std::size_t axis = 0; axis < 3; ++axis)
    at_middle[static_cast<Eigen::Index>(axis)] = curve.direction[axis].series[0];
  const double speed = at_middle.norm();
  if (!(speed > 0)) return arc;
  arc.along = at_middle / speed;

  // c . h, which is `speed` in the middle.
  double variation = 0;
  for (std::size_t k = 1; k <= arc_degree; ++k) {
    double sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      sum += arc.along[static_cast<Eigen::Index>(axis)] * curve.direction[axis].series[k];
    variation += std::abs(sum);
  }
  double rest = 0;
  for (const Model& component : curve.direction) rest += component.rest;
  double least = speed - variation - rest;

  // Beyond the cell by e, Bernstein coefficients bound a polynomial of degree 2 up to the factor (1 + 2 e)^2, and
  // powers grow by less.
  double beyond = 0;
  for (const Model& component : curve.local) {
    const double reach = component.magnitude(1);
    beyond = std::max({beyond, component.series[0] + reach - 1, reach - component.series[0]});
  }
  const double growth = std::pow(1 + 2 * beyond, 6);
  double residual = 0;
  for (std::size_t i = 0; i < 2; ++i)
    residual += curve.functions[i].value.magnitude() + rounding_of_sums * growth * size_[i];
  double slopes = 0;  // |A|, all entries
  for (const FunctionModel& f : curve.functions)
    for (const Model& component : f.gradient) slopes += component.magnitude() * component.magnitude();
  slopes = std::sqrt(slopes);
  arc.off = 2 * residual * slopes / least;
  const double bends = growth * bends_;
  const double change_of_direction = (slopes + bends * arc.off) * bends * arc.off;
  least -= change_of_direction;
  arc.is_certified =
      beyond + arc.off <= 0.25 && least > speed / 2 && 4 * residual * slopes * slopes * bends <= least * least;

  // c . (x' - h): the series agree up to the last but one, short of rounding.
  double defect = rest + change_of_direction;
  for (std::size_t k = 0; k <= arc_degree; ++k) {
    double sum = 0;
    double magnitude = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double of_arc = k < arc_degree ? static_cast<double>(k + 1) * curve.local[axis].series[k + 1] / r : 0;
      const double of_direction = curve.direction[axis].series[k];
      sum += arc.along[static_cast<Eigen::Index>(axis)] * (of_arc - of_direction);
      magnitude += std::abs(of_direction);
    }
    defect += std::abs(sum) + rounding_of_sums * magnitude;
  }
  arc.rate_error = defect / least + 0x1p-50;
  return arc;
}

}  // namespace raytruth
