#include "raytruth/deformation/deformed_ray.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace raytruth {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// The last terms of an arc's series, relative to the first: shorter arcs cost time, longer ones radius.
constexpr double last_terms = 0x1p-34;
// The longest arc in the size of a lattice's cell, and the shortest one, from which on the curve is given up.
constexpr double longest_arc = 0.5;
constexpr double shortest_arc = 0x1p-20;
constexpr std::size_t most_arcs = 1U << 20U;
constexpr double spare = 0.9;  // of what an arc could have been, for the next one
// How near, in the size of a cell, the place of an arc's end must be to an exit to be that exit.
constexpr double at_exit = 1e-5;
constexpr double rounding_of_sums = 0x1p-47;  // of the magnitudes of what is added and multiplied

using ArcSeries = std::array<double, arc_degree + 1>;
using PieceSeries = std::array<double, largest_degree + 1>;

/// The series about `middle`, in units of `half`.
ArcSeries shifted(ArcSeries series, double middle, double half) {
  for (std::size_t last = 0; last < arc_degree; ++last)
    for (std::size_t k = arc_degree; k-- > last;) series[k] += middle * series[k + 1];
  double power = 1;
  for (double& coefficient : series) {
    coefficient *= power;
    power *= half;
  }
  return series;
}

/// Powers on [-1, 1] as Bernstein coefficients on [0, 1].
template <int Degree, class Series>
Bernstein<Degree> bernstein_of(const Series& powers) {
  // First powers of u with xi = 2 u - 1, from the highest down, then the Bernstein coefficients of these.
  std::array<double, Degree + 1> c{};
  for (std::size_t k = 0; k <= Degree; ++k) c[k] = powers[k];
  for (std::size_t last = 0; last < Degree; ++last)
    for (std::size_t k = Degree; k-- > last;) c[k] -= c[k + 1];
  double power = 1;
  for (double& x : c) {
    x *= power;
    power *= 2;
  }
  Bernstein<Degree> result;
  for (std::size_t i = 0; i <= Degree; ++i) {
    double sum = 0;
    double ratio = 1;  // binomial(i, k) / binomial(n, k)
    for (std::size_t k = 0; k <= i; ++k) {
      sum += ratio * c[k];
      ratio *= static_cast<double>(i - k) / static_cast<double>(Degree - k == 0 ? 1 : Degree - k);
    }
    result.coefficients[i] = sum;
  }
  return result;
}

/// A part of an arc's function in [-1, 1] of its own, of degree 9, and what that leaves out.
struct PieceModel {
  PieceSeries series{};
  double rest = 0;
  double magnitude = 0;
};

PieceModel piece_model(const ArcSeries& series) {
  PieceModel model;
  for (std::size_t k = 0; k <= arc_degree; ++k) {
    if (k <= largest_degree)
      model.series[k] = series[k];
    else
      model.rest += std::abs(series[k]);
    model.magnitude += std::abs(series[k]);
  }
  return model;
}

PieceModel operator*(const PieceModel& a, const PieceModel& b) {
  PieceModel result;
  std::array<double, largest_degree + 2> tail{};
  for (std::size_t k = largest_degree + 1; k-- > 0;) tail[k] = tail[k + 1] + std::abs(b.series[k]);
  for (std::size_t k = 0; k <= largest_degree; ++k)
    for (std::size_t i = 0; i <= k; ++i) result.series[k] += a.series[i] * b.series[k - i];
  for (std::size_t i = 1; i <= largest_degree; ++i) result.rest += std::abs(a.series[i]) * tail[largest_degree + 1 - i];
  result.rest += a.magnitude * b.rest + a.rest * b.magnitude;
  result.magnitude = a.magnitude * b.magnitude;
  return result;
}

void add(PieceModel& sum, double factor, const PieceModel& model) {
  for (std::size_t k = 0; k <= largest_degree; ++k) sum.series[k] += factor * model.series[k];
  sum.rest += std::abs(factor) * model.rest;
  sum.magnitude += std::abs(factor) * model.magnitude;
}

}  // namespace

/// Follows one ray.
class DeformedVolume::Tracer {
 public:
  Tracer(const DeformedVolume& volume, const Ray& ray, DeformedSignal& signal)
      : volume_(volume),
        lattice_(*volume.lattice_),
        equations_(Eigen::Vector3d(ray.origin.data()), direction_of(ray), volume.object_volume_by_local_ < 0),
        signal_(signal),
        sigma_by_r_(equations_.scale() * std::abs(volume.object_volume_by_local_)) {}

  void run() {
    const FaceCrossings crossings = volume_.faces_(equations_);
    for (std::size_t i = 0; i + 1 < crossings.found.size() && signal_.is_certified; i += 2) {
      if (!(crossings.found[i + 1].t > 0)) continue;  // behind the ray's origin
      is_before_origin_ = crossings.found[i].t < 0;
      follow(crossings.found[i], crossings.found[i + 1]);
    }
    if (crossings.in_doubt > 0) doubt(crossings.in_doubt);
    signal_.chain.end = end_;
    if (!signal_.is_certified) signal_.error.unclaimed = infinity;
  }

 private:
  static Eigen::Vector3d direction_of(const Ray& ray) {
    const auto unit = unit_direction(ray.direction);
    return Eigen::Vector3d(unit.data());
  }

  /// A length of the world that may belong to the object, at the smallest volume that its parts are pressed to.
  void doubt(double length) { signal_.error.unclaimed += length / volume_.least_determinant_; }

  void follow(const FaceCrossing& entry, const FaceCrossing& exit) {
    place_ = entry.place;
    across_ = Eigen::Vector3d::Unit(static_cast<Eigen::Index>(entry.axis)) *
              (place_.local[static_cast<Eigen::Index>(entry.axis)] > 0.5 ? -1 : 1);
    double guess = longest_arc;
    int standstill = 0;
    while (true) {
      if (++signal_.arcs > most_arcs) return give_up();
      const CellCurve curve(equations_, lattice_.cell(place_.cell));
      const std::optional<DeformedArc> arc = make_arc(curve, guess);
      if (!arc) return give_up();
      const double begin = begin_of(*arc);
      if (!std::isfinite(begin)) return give_up();
      Leaving leaving = leaving_of(*arc, begin, exit);
      emit(*arc, begin, leaving);
      if (leaving.is_exit) return;
      // Cells that are left where they were entered, again and again, are touched: the curve then goes on in one of
      // them for a little, which costs the square of how far that is beyond.
      standstill = leaving.xi - begin < 1e-9 ? standstill + 1 : 0;
      if (standstill > 8) return give_up();
      place_.local = arc->value(leaving.xi);
      across_ = arc->along;
      if (leaving.axis) {
        const std::size_t axis = *leaving.axis;
        place_.cell[axis] += leaving.is_upwards ? 1 : -1;
        place_.local[static_cast<Eigen::Index>(axis)] -= leaving.is_upwards ? 1 : -1;
      }
      guess = next_half_length_;
    }
  }

  void give_up() { signal_.is_certified = false; }

  /// An arc that begins at the place and is as long as its series allow, `guess` at first, in sizes of a cell.
  std::optional<DeformedArc> make_arc(const CellCurve& curve, double guess) {
    for (int i = 0; i < 24; ++i) {
      const double speed = curve.direction(place_.local).norm();
      if (!(speed > 0)) return std::nullopt;
      const double r = guess / speed;
      const Eigen::Vector3d middle = curve.step(place_.local, r);
      if (!middle.allFinite() || middle.cwiseAbs().maxCoeff() > 1.25) {
        guess /= 2;
        continue;
      }
      const DeformedArc arc = curve.arc(middle, r * slightly_longer);
      signal_.evaluations += arc_degree + 1;
      const double reach = curve.reach(arc, last_terms);
      if (arc.is_certified && reach >= r * slightly_longer) {
        // The next one will be as long as this one could have been, with something to spare.
        next_half_length_ = std::min(longest_arc, spare * guess * reach / (r * slightly_longer));
        return arc;
      }
      const double shorter = arc.is_certified ? std::min(0.9, reach / (r * slightly_longer)) : 0.5;
      guess *= std::max(0.1, shorter);
      if (guess < shortest_arc) return std::nullopt;
    }
    return std::nullopt;
  }

  /// Where the arc passes the plane through the place across which the one before ended.
  [[nodiscard]] double begin_of(const DeformedArc& arc) const {
    double xi = -1 / slightly_longer;
    for (int i = 0; i < 20; ++i) {
      const double late = across_.dot(arc.value(xi) - place_.local);
      const double rate = across_.dot(arc.derivative(xi));
      if (rate == 0) return infinity;
      const double step = std::clamp(late / rate, -0.5, 0.5);
      xi -= step;
      if (std::abs(step) < 0x1p-50) break;
    }
    return std::abs(xi) <= 1.0 ? xi : infinity;
  }

  struct Leaving {
    double xi = 1;
    std::optional<std::size_t> axis = {};  ///< of the border of the lattice's cell; none: the arc's own end
    bool is_upwards = false;
    bool is_exit = false;
  };

  /// The first place behind `begin` where the arc leaves the cell.
  [[nodiscard]] Leaving leaving_of(const DeformedArc& arc, double begin, const FaceCrossing& exit) const {
    Leaving result;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double least = arc.local[axis][0];
      double most = least;
      for (std::size_t k = 1; k <= arc_degree; ++k) {
        least -= std::abs(arc.local[axis][k]);
        most += std::abs(arc.local[axis][k]);
      }
      for (const bool is_upwards : {false, true}) {
        if (is_upwards ? most < 1 : least > 0) continue;
        ArcSeries beyond = arc.local[axis];
        beyond[0] -= is_upwards ? 1 : 0;
        const auto polynomial =
            bernstein_of<static_cast<int>(arc_degree)>(shifted(beyond, (begin + 1) / 2, (1 - begin) / 2));
        for (const double u : polynomial.sign_changes()) {
          const double xi = begin + u * (1 - begin);
          if (xi >= result.xi) break;
          const double rate = arc.derivative(xi)[static_cast<Eigen::Index>(axis)];
          if (is_upwards ? rate <= 0 : rate >= 0) continue;
          const bool is_face = place_.cell[axis] == (is_upwards ? lattice_.cells()[axis] - 1 : 0);
          if (is_face && !is_at(arc.value(xi), exit)) continue;
          result = {.xi = xi, .axis = axis, .is_upwards = is_upwards, .is_exit = is_face};
          break;
        }
      }
    }
    return result;
  }

  [[nodiscard]] bool is_at(const Eigen::Vector3d& local, const FaceCrossing& exit) const {
    Eigen::Vector3d difference = local - exit.place.local;
    for (std::size_t axis = 0; axis < 3; ++axis)
      difference[static_cast<Eigen::Index>(axis)] += static_cast<double>(place_.cell[axis] - exit.place.cell[axis]);
    return difference.cwiseAbs().maxCoeff() <= at_exit;
  }

  /// Appends the pieces of an arc between two places: one for every cell of the volume.
  /// One that ends where its series does stops at the last border of voxels before, which is an end of pieces anyway.
  void emit(const DeformedArc& arc, double begin, Leaving& leaving) {
    double end = leaving.xi;
    if (!(end > begin) || (is_before_origin_ && !reach_origin(arc, end, begin))) return;
    std::array<ArcSeries, 3> voxel{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto row = volume_.voxel_by_local_.row(static_cast<Eigen::Index>(axis));
      for (std::size_t from = 0; from < 3; ++from)
        for (std::size_t k = 0; k <= arc_degree; ++k)
          voxel[axis][k] += row[static_cast<Eigen::Index>(from)] * arc.local[from][k];
    }
    const Eigen::Vector3d corner =
        volume_.voxel_by_object_ * lattice_.object_of({place_.cell, Eigen::Vector3d::Zero()});
    for (std::size_t axis = 0; axis < 3; ++axis) voxel[axis][0] += corner[static_cast<Eigen::Index>(axis)];
    find_breaks(voxel, begin, end);
    if (!leaving.axis && breaks_.size() > 2 && breaks_[breaks_.size() - 2] > begin + (end - begin) / 4) {
      breaks_.pop_back();
      end = leaving.xi = breaks_.back();
    }
    const double off = arc.off * volume_.voxel_by_local_.cwiseAbs().rowwise().sum().maxCoeff();
    // The ends of an arc are in planes across their own curves, whose true points may lie beside each other.
    const double sliver = 4 * arc.off / std::max(arc.derivative(begin).norm(), 1e-300) / slope_of_entry(arc, begin);
    signal_.error.unclaimed += sliver * arc.scale * sigma_by_r_;
    signal_.rate_error = std::max(signal_.rate_error, arc.rate_error);
    const double out_of_cell = beyond_cell(arc, begin, end);
    const double of_lattice = volume_.curvature_ * out_of_cell * out_of_cell;
    for (std::size_t i = 0; i + 1 < breaks_.size(); ++i)
      if (breaks_[i + 1] > breaks_[i]) emit_piece(arc, voxel, breaks_[i], breaks_[i + 1], off + of_lattice);
  }

  /// Whether a ray that begins inside of the object does so on this arc; then at `begin`.
  bool reach_origin(const DeformedArc& arc, double end, double& begin) {
    const LatticeCell& cell = lattice_.cell(place_.cell);
    const auto t = [&](double xi) { return equations_.t_of(cell.value(arc.value(xi))); };
    if (t(end) <= 0) return false;
    double low = begin;
    double high = end;
    for (int i = 0; i < 60; ++i) {
      const double middle = (low + high) / 2;
      (t(middle) > 0 ? high : low) = middle;
    }
    begin = high;
    is_before_origin_ = false;
    // t itself is rounded, as large as the numbers are that it is the difference of.
    doubt(0x1p-46 * (cell.centre.norm() + lattice_.box().edges.norm()));
    return true;
  }

  /// How steeply the curve passes the plane in which it begins: right across it but for a face of the box.
  [[nodiscard]] double slope_of_entry(const DeformedArc& arc, double begin) const {
    const Eigen::Vector3d derivative = arc.derivative(begin);
    return std::max(std::abs(across_.dot(derivative)) / derivative.norm(), 0x1p-30);
  }

  /// How far the part leaves its cell of the lattice, at most.
  [[nodiscard]] static double beyond_cell(const DeformedArc& arc, double begin, double end) {
    double result = 0;
    for (const ArcSeries& series : arc.local) {
      const auto polynomial =
          bernstein_of<static_cast<int>(arc_degree)>(shifted(series, (begin + end) / 2, (end - begin) / 2));
      const auto [least, most] = std::minmax_element(polynomial.coefficients.begin(), polynomial.coefficients.end());
      if (*least >= 0 && *most <= 1) continue;
      const auto [low, high] = polynomial.range();
      result = std::max({result, -low, high - 1});
    }
    return result;
  }

  /// Where the arc passes planes of voxels, and the ends of the volume.
  void find_breaks(const std::array<ArcSeries, 3>& voxel, double begin, double end) {
    breaks_.assign({begin, end});
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const ArcSeries series = shifted(voxel[axis], (begin + end) / 2, (end - begin) / 2);
      double reach = 0;
      for (std::size_t k = 1; k <= arc_degree; ++k) reach += std::abs(series[k]);
      const auto size = static_cast<double>(volume_.voxels_->size[axis]);
      const double margin = margin_of(volume_.border_);
      const auto add_plane = [&](double plane) {
        if (std::abs(plane - series[0]) > reach) return;
        ArcSeries beyond = series;
        beyond[0] -= plane;
        const auto polynomial = bernstein_of<static_cast<int>(arc_degree)>(beyond);
        for (const double u : polynomial.sign_changes()) breaks_.push_back(begin + u * (end - begin));
      };
      if (margin > 0) {
        add_plane(-margin);
        add_plane(size - 1 + margin);
      }
      const double first = std::max(0.0, std::ceil(series[0] - reach));
      const double last = std::min(size - 1, std::floor(series[0] + reach));
      for (double plane = first; plane <= last; ++plane) add_plane(plane);
    }
    std::sort(breaks_.begin(), breaks_.end());
  }

  void emit_piece(const DeformedArc& arc, const std::array<ArcSeries, 3>& voxel, double begin, double end, double off) {
    const Grid& grid = *volume_.voxels_;
    const double middle = (begin + end) / 2;
    const double half = (end - begin) / 2;
    const double margin = margin_of(volume_.border_);
    std::array<PieceModel, 3> local;
    std::array<std::array<std::int64_t, 2>, 3> index{};
    double overshoot = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ArcSeries series = shifted(voxel[axis], middle, half);
      const auto size = static_cast<double>(grid.size[axis]);
      if (series[0] < -margin || series[0] > size - 1 + margin) return;  // outside of the volume
      const double cell = std::clamp(std::floor(series[0]), -1.0, size - 1);
      series[0] -= cell;
      index[axis] = {std::clamp<std::int64_t>(static_cast<std::int64_t>(cell), 0, grid.size[axis] - 1),
                     std::clamp<std::int64_t>(static_cast<std::int64_t>(cell) + 1, 0, grid.size[axis] - 1)};
      const auto polynomial = bernstein_of<static_cast<int>(arc_degree)>(series);
      const auto [least, most] = std::minmax_element(polynomial.coefficients.begin(), polynomial.coefficients.end());
      if (*least < 0 || *most > 1) {
        const auto [low, high] = polynomial.range();
        overshoot = std::max({overshoot, -low, high - 1});
      }
      local[axis] = piece_model(series);
    }
    std::array<double, 8> corner{};
    for (std::size_t k = 0; k < 8; ++k)
      corner[k] = grid.at(index[0][k & 1U], index[1][k >> 1U & 1U], index[2][k >> 2U]);
    const auto [low, high] = std::minmax_element(corner.begin(), corner.end());

    // The trilinear function in powers of its three coordinates.
    std::array<double, 8> c = corner;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t k = 0; k < 8; ++k)
        if ((k >> axis & 1U) != 0) c[k] -= c[k ^ (1U << axis)];
    const auto& [x, y, z] = local;
    const PieceModel xy = x * y;
    PieceModel without_z;
    without_z.series[0] = c[0];
    add(without_z, c[1], x);
    add(without_z, c[2], y);
    add(without_z, c[3], xy);
    PieceModel with_z;
    with_z.series[0] = c[4];
    add(with_z, c[5], x);
    add(with_z, c[6], y);
    add(with_z, c[7], xy);
    with_z.magnitude += std::abs(c[4]);
    PieceModel sum = with_z * z;
    add(sum, 1, without_z);

    Piece<largest_degree> piece;
    piece.start = end_;
    piece.length = (end - begin) * arc.scale * sigma_by_r_;
    piece.polynomial = bernstein_of<largest_degree>(sum.series);
    const double magnitude = sum.magnitude + std::max(std::abs(*low), std::abs(*high));
    // A trilinear function changes by no more than its voxels differ, on each axis, and beside a border the neighbour's
    // function differs by no more than the slopes of both.
    const double slope = 3 * range_about(index);
    const double error = sum.rest + slope * (3 * off + 2 * overshoot) + rounding_of_sums * magnitude;
    signal_.error.of_pieces.push_back(error);
    signal_.chain.pieces.push_back(piece);
    end_ = end_ + DoubleDouble(piece.length);
    ++signal_.cells;
  }

  /// The range of the voxels of a cell and of all cells that touch it.
  [[nodiscard]] double range_about(const std::array<std::array<std::int64_t, 2>, 3>& index) const {
    const Grid& grid = *volume_.voxels_;
    std::array<std::int64_t, 3> first{};
    std::array<std::int64_t, 3> last{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      first[axis] = std::max<std::int64_t>(0, index[axis][0] - 1);
      last[axis] = std::min(grid.size[axis] - 1, index[axis][1] + 1);
    }
    double low = infinity;
    double high = -infinity;
    for (std::int64_t k = first[2]; k <= last[2]; ++k)
      for (std::int64_t j = first[1]; j <= last[1]; ++j)
        for (std::int64_t i = first[0]; i <= last[0]; ++i) {
          const double value = grid.at(i, j, k);
          low = std::min(low, value);
          high = std::max(high, value);
        }
    return high - low;
  }

  static constexpr double slightly_longer = 1.0625;

  const DeformedVolume& volume_;
  const Lattice& lattice_;
  RayEquations equations_;
  DeformedSignal& signal_;
  double sigma_by_r_;
  LatticePlace place_;
  Eigen::Vector3d across_ = Eigen::Vector3d::Zero();
  double next_half_length_ = longest_arc;
  bool is_before_origin_ = false;
  DoubleDouble end_;
  std::vector<double> breaks_;
};

DeformedVolume::DeformedVolume(const Grid& voxels, Border border, const std::array<double, 3>& spacing,
                               const Lattice& lattice, double least_determinant)
    : voxels_(&voxels), border_(border), lattice_(&lattice), faces_(lattice), least_determinant_(least_determinant) {
  voxel_by_object_ = Eigen::Vector3d(1 / spacing[0], 1 / spacing[1], 1 / spacing[2]).asDiagonal();
  voxel_by_local_ = voxel_by_object_ * lattice.cell_edges();
  object_volume_by_local_ = lattice.cell_edges().determinant();
  double bend = 0;
  const auto& cells = lattice.cells();
  for (std::int64_t k = 0; k < cells[2]; ++k)
    for (std::int64_t j = 0; j < cells[1]; ++j)
      for (std::int64_t i = 0; i < cells[0]; ++i) {
        const LatticeCell& cell = lattice.cell({i, j, k});
        double sum = 0;
        for (std::size_t power = 0; power < cell.powers.size(); ++power)
          if (power % 3 == 2 || power / 3 % 3 == 2 || power / 9 == 2) sum += cell.powers[power].norm();
        bend = std::max(bend, sum);
      }
  // Half of both cells' second derivatives of f_i, whose e_i are no longer than sqrt(2).
  curvature_ = 4 * bend;
}

void DeformedVolume::trace(const Ray& ray, DeformedSignal& signal) const {
  signal.chain.pieces.clear();
  signal.chain.end = 0.0;
  signal.error = {};
  signal.rate_error = 0;
  signal.cells = 0;
  signal.arcs = 0;
  signal.evaluations = 0;
  signal.is_certified = true;
  Tracer(*this, ray, signal).run();
}

}  // namespace raytruth
