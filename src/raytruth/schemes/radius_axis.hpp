#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

namespace raytruth {

/// Gray values of the dissertation: 0 to 255 over the range of the data.
inline constexpr double largest_gray = 255;

/// Where the radii R = 1 / sqrt|a| of a quadratic table stand.
enum class RadiusSteps {
  signed_curvature,  ///< equal ratios, both signs of a around the linear table in the middle: ours
  powers_of_two,     ///< 2^k (dissertation, section 5.6.1.4)
  equal_steps,       ///< equal differences, both ends nodes (the same, table 5.3)
};

inline constexpr std::array<std::string_view, 3> radius_steps_names{"signed", "powers_of_two", "equal_steps"};

/// How a radius between two nodes is looked up.
enum class RadiusLookUp {
  linear_in_curvature,  ///< in a, through the linear table
  linear_in_radius,     ///< in R; flatter than the largest radius: the linear table (section 5.5.2, `a < eps`)
  nearest,              ///< the nearer radius, no weights
  natural_logarithm,    ///< procedure 6 with ln 2 for its constant, where 1 / ln 2 is meant: a wrong pair of radii
};

/// The third axis of a table of the quadratic gray-value model: a, the parabola's second divided difference, in gray
/// values per squared length. Nodes run from the most negative a over the linear table, a = 0, to the largest one; a
/// one-sided axis, as printed, begins with the linear table, which all a < 0 get. Curvatures beyond the smallest radius
/// are clamped to it.
struct RadiusAxis {
  RadiusSteps steps = RadiusSteps::signed_curvature;
  double low = 0.125;
  double high = 8;
  std::size_t count = 7;  ///< radii of either sign
  RadiusLookUp look_up = RadiusLookUp::linear_in_curvature;
  bool is_one_sided = false;

  [[nodiscard]] std::size_t linear_node() const { return is_one_sided ? 0 : count; }
  [[nodiscard]] std::size_t node_count() const { return linear_node() + 1 + count; }
  /// Radius i of `count`, from the smallest one up.
  [[nodiscard]] double radius(std::size_t i) const;
  /// a of a node.
  [[nodiscard]] double curvature(std::size_t node) const;
};

/// Throws InputError unless 0 < low < high (or one radius, low == high), all finite, at most `most_radii` of them, and,
/// for powers of two, `count` such radii from low to high.
void check(const RadiusAxis& axis);

/// Look-ups along the axis, its curvatures kept. rules/quadratic_gray.glsl has the same for shaders, where radii stand
/// in equal ratios.
class RadiusNodes {
 public:
  /// Two nodes, and the weight of the second one.
  struct Place {
    std::size_t first = 0;
    std::size_t second = 0;
    double weight = 0;
  };

  explicit RadiusNodes(const RadiusAxis& axis);

  [[nodiscard]] Place place(double curvature) const;
  /// Whether a is larger than that of the smallest radius, so that a look-up clamps it.
  [[nodiscard]] bool clamps(double curvature) const;

 private:
  [[nodiscard]] Place place_of_size(double size) const;
  [[nodiscard]] Place place_of_radius(double radius) const;

  RadiusAxis axis_;
  // By distance from the linear table, which has distance 0:
  std::vector<double> sizes_;  ///< |a|
  std::vector<double> radii_;  ///< infinite for the linear table
};

inline constexpr std::size_t most_radii = 1024;

}  // namespace raytruth
