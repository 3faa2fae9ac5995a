#pragma once

#include "raytruth/schemes/omissions.hpp"
#include "raytruth/signals/border.hpp"
#include "raytruth/signals/cell_walk.hpp"
#include "raytruth/signals/ray.hpp"
#include "raytruth/skipping/occupied_blocks.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace raytruth {

/// The parts of a ray that are looked at: those in occupied blocks. Holds a buffer: one object per thread.
class PartsOfRay {
 public:
  /// `blocks` null: all of every ray is looked at.
  PartsOfRay(const std::array<std::int64_t, 3>& size, Border border, const OccupiedBlocks* blocks)
      : size_(size), border_(border), blocks_(blocks) {}

  /// The parts, in `unit`s of a voxel behind the ray's entry; none: all of it. They are valid until the next call.
  std::optional<std::span<const RayPart>> operator()(const Ray& ray, double unit = 1) {
    if (blocks_ == nullptr) return std::nullopt;
    parts_.clear();
    const Span inside = clip(size_, border_, ray.origin, ray.direction);
    if (inside.begin < inside.end) {
      const auto begin = static_cast<double>(inside.begin);
      std::array<double, 3> entry{};
      for (std::size_t axis = 0; axis < 3; ++axis) entry[axis] = ray.origin[axis] + begin * ray.direction[axis];
      blocks_->parts(entry, ray.direction, static_cast<double>(inside.end - inside.begin), parts_);
    }
    for (RayPart& part : parts_) part = {part.begin * unit, part.end * unit};
    return parts_;
  }

 private:
  std::array<std::int64_t, 3> size_;
  Border border_;
  const OccupiedBlocks* blocks_;
  std::vector<RayPart> parts_;
};

}  // namespace raytruth
