#include "raytruth/deformation/displacement.hpp"

#include "raytruth/core/random.hpp"

#include <cmath>
#include <numbers>

namespace raytruth {

namespace {

constexpr double radians = std::numbers::pi / 180;

/// Moves one point after the other.
class Mover {
 public:
  Mover(const LatticeBox& box, const std::array<std::int64_t, 3>& cells)
      : centre_(box.origin + box.edges * Eigen::Vector3d::Constant(0.5)) {
    for (int axis = 0; axis < 3; ++axis) {
      // The extent of the box, which for one along the axes is its edge.
      length_[axis] = box.edges.row(axis).cwiseAbs().sum();
      cell_size_[axis] = box.edges.col(axis).norm() / static_cast<double>(cells[static_cast<std::size_t>(axis)]);
    }
  }

  void operator()(const Twist& twist, std::size_t /*index*/, Eigen::Vector3d& point) const {
    const double angle = twist.degrees * radians * (position(twist.axis, point) - 0.5);
    const auto [a, b] = across(twist.axis);
    const Eigen::Vector3d from = point - centre_;
    point[a] = centre_[a] + std::cos(angle) * from[a] - std::sin(angle) * from[b];
    point[b] = centre_[b] + std::sin(angle) * from[a] + std::cos(angle) * from[b];
  }

  void operator()(const Bend& bend, std::size_t /*index*/, Eigen::Vector3d& point) const {
    if (bend.degrees == 0) return;
    const double curvature = bend.degrees * radians / length_[2];
    const Eigen::Vector3d from = point - centre_;
    const double angle = curvature * from[2];
    const double half = std::sin(angle / 2);
    point[0] = centre_[0] + 2 * half * half / curvature + from[0] * std::cos(angle);
    point[2] = centre_[2] + std::sin(angle) / curvature - from[0] * std::sin(angle);
  }

  void operator()(const Taper& taper, std::size_t /*index*/, Eigen::Vector3d& point) const {
    scale_across(taper.axis, taper.scale[0] + (taper.scale[1] - taper.scale[0]) * position(taper.axis, point), point);
  }

  void operator()(const Bulge& bulge, std::size_t /*index*/, Eigen::Vector3d& point) const {
    const double from_middle = 2 * position(bulge.axis, point) - 1;
    scale_across(bulge.axis, 1 + bulge.amount * (1 - from_middle * from_middle), point);
  }

  void operator()(const Affine& affine, std::size_t /*index*/, Eigen::Vector3d& point) const {
    point = centre_ + affine.matrix * (point - centre_) + affine.offset;
  }

  void operator()(const RandomDisplacement& random, std::size_t index, Eigen::Vector3d& point) const {
    for (int axis = 0; axis < 3; ++axis) {
      const auto chance =
          random_numbers(random.seed, RandomStream::lattice, 3 * index + static_cast<std::size_t>(axis));
      point[axis] += random.amplitude * cell_size_[axis] * (2 * chance[0] - 1);
    }
  }

 private:
  static std::array<Eigen::Index, 2> across(std::size_t axis) {
    return {static_cast<Eigen::Index>((axis + 1) % 3), static_cast<Eigen::Index>((axis + 2) % 3)};
  }
  [[nodiscard]] double position(std::size_t axis, const Eigen::Vector3d& point) const {
    const auto index = static_cast<Eigen::Index>(axis);
    return (point[index] - centre_[index]) / length_[index] + 0.5;
  }
  void scale_across(std::size_t axis, double factor, Eigen::Vector3d& point) const {
    for (const Eigen::Index index : across(axis))
      point[index] = centre_[index] + factor * (point[index] - centre_[index]);
  }

  Eigen::Vector3d centre_;
  Eigen::Vector3d length_;
  Eigen::Vector3d cell_size_;
};

}  // namespace

void displace(const LatticeBox& box, const std::array<std::int64_t, 3>& cells,
              const std::vector<Displacement>& displacements, std::vector<Eigen::Vector3d>& points) {
  const Mover move(box, cells);
  for (const Displacement& displacement : displacements)
    for (std::size_t i = 0; i < points.size(); ++i)
      std::visit([&](const auto& kind) { move(kind, i, points[i]); }, displacement);
}

}  // namespace raytruth
