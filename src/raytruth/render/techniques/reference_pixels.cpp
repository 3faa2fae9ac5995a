#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/render/renderer.hpp"
#include "raytruth/render/technique.hpp"
#include "raytruth/signals/cell_walk.hpp"
#include "raytruth/skipping/block_refinement.hpp"
#include "raytruth/skipping/parts_of_ray.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace raytruth {

namespace {

/// The certified integral. Whatever is clear by more than all rounding of rays and chains neither absorbs nor shines:
/// rays that meet no occupied block are done, and clear pieces are taken out before the others are certified.
template <class Field>
class ReferencePixels {
 public:
  ReferencePixels(const Field& field, const PreparedScene& prepared, std::shared_ptr<const OccupiedBlocks> blocks)
      : field_(field),
        placing_error_(prepared.placing_error),
        tolerance_(prepared.scene.covers_camera ? tolerance_with_camera : tolerance_of_rays),
        blocks_(std::move(blocks)),
        parts_of_(field.grid().size, blocks_.get()),
        clear_(prepared.scene.transfer, prepared.scene.emission),
        margin_(margin_of(field.grid(), prepared.placing_error)),
        integrate_(prepared.scene.transfer, prepared.scene.emission) {}

  PixelLight operator()(const PixelRay& pixel) {
    const bool may_skip = is_near(pixel.displacement);
    if (may_skip && parts_of_(pixel.ray)->empty() && (pixel.displacement.of_length == 0 || enters(pixel.ray)))
      return {};
    field_.trace(pixel.ray, chain_);
    is_clear_.clear();
    for (const auto& piece : chain_.pieces) {
      const auto& b = piece.polynomial.coefficients;
      const auto [low, high] = std::minmax_element(b.begin(), b.end());
      is_clear_.push_back(may_skip && clear_.contain(*low - margin_, *high + margin_));
    }
    SignalError error = field_.error(pixel.ray, chain_, is_clear_, pixel.displacement);
    if (pixel.displacement.may_differ_in_all) error.of_length = std::numeric_limits<double>::infinity();
    error.of_length *= pixel.length_unit;
    error.unclaimed *= pixel.length_unit;
    take_out_clear_pieces(error);
    scale_lengths(chain_, pixel.length_unit);
    Certified truth = integrate_(chain_, error, tolerance_);
    if (truth.status == Status::not_converged) look_closer(pixel, error, truth);
    return {truth.rgba(), truth.radius, truth.status};
  }

 private:
  /// Whether the ray that is meant is so near that what is clear along the ray at hand is clear along it.
  [[nodiscard]] bool is_near(const RayDisplacement& displacement) const {
    const auto& [x, y, z] = field_.grid().size;
    const double longest = std::hypot(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
    return !displacement.may_differ_in_all && displacement.of_length <= placing_error_ &&
           displacement.largest(longest) <= placing_error_;
  }
  [[nodiscard]] bool enters(const Ray& ray) const {
    const Span inside = clip(field_.grid().size, ray.origin, ray.direction);
    return inside.begin < inside.end;
  }
  /// Takes the ray in 106 bits, if much of what is unknown of it is rounding.
  void look_closer(const PixelRay& pixel, const SignalError& error, Certified& truth) {
    PreciseChain<Field::degree> signal = field_.trace_precisely(pixel.ray, pixel.displacement);
    const double at_hand =
        error.of_pieces.empty() ? 0 : *std::max_element(error.of_pieces.begin(), error.of_pieces.end());
    if (!(signal.largest_error() < at_hand / 4)) return;
    for (auto& piece : signal.pieces) piece.length *= pixel.length_unit;
    signal.length = signal.length * pixel.length_unit;
    signal.of_length *= pixel.length_unit;
    signal.unclaimed *= pixel.length_unit;
    if (pixel.displacement.may_differ_in_all) signal.of_length = std::numeric_limits<double>::infinity();
    const Certified closer = integrate_(signal, tolerance_);
    if (closer.radius < truth.radius) truth = closer;
  }
  void take_out_clear_pieces(SignalError& error) {
    std::size_t kept = 0;
    DoubleDouble end = 0.0;
    for (std::size_t i = 0; i < chain_.pieces.size(); ++i) {
      if (is_clear_[i]) continue;
      chain_.pieces[kept] = chain_.pieces[i];
      error.of_pieces[kept] = error.of_pieces[i];
      chain_.pieces[kept].start = end;
      end = end + DoubleDouble(chain_.pieces[kept].length);
      ++kept;
    }
    chain_.pieces.resize(kept);
    error.of_pieces.resize(kept);
    chain_.end = end;
  }

  const Field& field_;
  double placing_error_;
  double tolerance_;
  std::shared_ptr<const OccupiedBlocks> blocks_;
  PartsOfRay parts_of_;
  ClearScalars clear_;
  double margin_;
  RayIntegral integrate_;
  Chain<Field::degree> chain_;
  std::vector<bool> is_clear_;
};

PixelRendererFactory prepare(const PreparedScene& prepared) {
  const Scene& scene = prepared.scene;
  return std::visit(
      [&prepared, &scene](const auto& field) -> PixelRendererFactory {
        const auto blocks = std::make_shared<const OccupiedBlocks>(
            certain_blocks(field, ClearScalars(scene.transfer, scene.emission), prepared.placing_error));
        return [&field, &prepared, blocks] { return ReferencePixels(field, prepared, blocks); };
      },
      prepared.field);
}

}  // namespace

extern const Technique reference_pixels;
const Technique reference_pixels{
    .name = "reference",
    .summary = "the certified integral",
    .applies = [](const Scene& scene) { return scene.scheme == "reference" && !scene.shading; },
    .refuse = [](const PreparedScene& /*prepared*/) {},
    .prepare = prepare};

}  // namespace raytruth
