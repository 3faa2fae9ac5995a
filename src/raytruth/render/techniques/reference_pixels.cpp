#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/render/technique.hpp"
#include "raytruth/skipping/block_refinement.hpp"
#include "raytruth/skipping/parts_of_ray.hpp"

#include <algorithm>
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
  ReferencePixels(const Field& field, const Scene& scene, std::shared_ptr<const OccupiedBlocks> blocks)
      : field_(field),
        blocks_(std::move(blocks)),
        parts_of_(field.grid().size, blocks_.get()),
        clear_(scene.transfer, scene.emission),
        margin_(margin_of(field.grid())),
        integrate_(scene.transfer, scene.emission) {}

  PixelLight operator()(const PixelRay& pixel) {
    if (parts_of_(pixel.ray)->empty()) return {};
    field_.trace(pixel.ray, chain_);
    is_clear_.clear();
    for (const auto& piece : chain_.pieces) {
      const auto& b = piece.polynomial.coefficients;
      const auto [low, high] = std::minmax_element(b.begin(), b.end());
      is_clear_.push_back(clear_.contain(*low - margin_, *high + margin_));
    }
    SignalError error = field_.error(pixel.ray, chain_, is_clear_);
    error.of_length *= pixel.length_unit;
    error.unclaimed *= pixel.length_unit;
    take_out_clear_pieces(error);
    scale_lengths(chain_, pixel.length_unit);
    const Certified truth = integrate_(chain_, error);
    return {truth.rgba(), truth.radius, truth.status};
  }

 private:
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
      [&scene](const auto& field) -> PixelRendererFactory {
        const auto blocks =
            std::make_shared<const OccupiedBlocks>(certain_blocks(field, ClearScalars(scene.transfer, scene.emission)));
        return [&field, &scene, blocks] { return ReferencePixels(field, scene, blocks); };
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
