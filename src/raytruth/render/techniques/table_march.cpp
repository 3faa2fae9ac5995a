#include "raytruth/render/techniques/table_march.hpp"

#include "raytruth/core/dispatch.hpp"
#include "raytruth/rules/rules.hpp"
#include "raytruth/signals/cell_walk.hpp"

#include <algorithm>
#include <cmath>

namespace raytruth {

namespace {

/// Where a scalar, in entries of the table, lies on its axis.
struct Place {
  int entry;
  float weight;  ///< of the next entry
};

}  // namespace

/// The loop over slabs k = first ... last - 1 of a ray; what it needs at hand.
struct TableMarch::March {
  const PaddedVoxels<float>& voxels;
  const float* texels;
  int entries;
  bool is_linear;
  float opaque;
  Double4 origin;     ///< in padded voxels, at k = 0
  Double4 direction;  ///< from one sample to the next
  Double4 end;        ///< the end of the ray, its last sample

  [[nodiscard]] float sample(std::int64_t k, std::int64_t count) const {
    const Double4 position = k < count ? origin + static_cast<double>(k) * direction : end;
    const Int4 cell = __builtin_convertvector(position, Int4);
    const Float4 weight = __builtin_convertvector(position - __builtin_convertvector(cell, Double4), Float4);
    const auto [y, z] = voxels.stride();
    const float* const corner = voxels.at(cell[0], cell[1], cell[2]);
    const Float4 low = load2(corner, corner + y);
    const Float4 high = load2(corner + z, corner + y + z);
    const Float4 plane = low + weight[2] * (high - low);
    const float near = plane[0] + weight[1] * (plane[2] - plane[0]);
    const float far = plane[1] + weight[1] * (plane[3] - plane[1]);
    return near + weight[0] * (far - near);
  }

  [[nodiscard]] Place place(float scalar) const {
    const float inside = std::min(std::max(scalar, 0.0F), static_cast<float>(entries - 1));
    // Halves go up, as a nearest filter has it, and nothing is negative.
    if (!is_linear) return {static_cast<int>(inside + 0.5F), 0};  // NOLINT(bugprone-incorrect-roundings)
    const int entry = std::min(static_cast<int>(inside), entries - 2);
    return {entry, inside - static_cast<float>(entry)};
  }

  [[nodiscard]] Float4 slab(const Place& front, const Place& back) const {
    const float* const both = texels + 4 * (static_cast<std::ptrdiff_t>(back.entry) * entries + front.entry);
    if (!is_linear) return load4(both);
    const float* const next = both + 4 * static_cast<std::ptrdiff_t>(entries);
    const Float4 first = load4(both) + front.weight * (load4(both + 4) - load4(both));
    const Float4 second = load4(next) + front.weight * (load4(next + 4) - load4(next));
    return first + back.weight * (second - first);
  }

  /// Composites the slabs from `first` to `last` of the ray's `count`; false once it is opaque. `rest`: share of a step
  /// that the last slab of all is long.
  bool composite(std::int64_t first, std::int64_t last, std::int64_t count, float rest, Float4& sum) const {
    Place front = place(sample(first, count));
    for (std::int64_t k = first; k < last; ++k) {
      const Place back = place(sample(k + 1, count));
      Float4 here = slab(front, back);
      if (k + 1 == count && rest < 1) here = shortened(here, rest);
      sum += (1 - sum[3]) * here;
      front = back;
      if (sum[3] >= opaque) return false;
    }
    return true;
  }

  static Float4 shortened(const Float4& slab, float share) {
    Rules<double> rules;
    const Rules<double>::vec4 whole(slab[0], slab[1], slab[2], slab[3]);
    const auto part = rules.opacity_corrected_slab(whole, rules.opacity_correction(whole[3], share), share);
    return Float4{static_cast<float>(part[0]), static_cast<float>(part[1]), static_cast<float>(part[2]),
                  static_cast<float>(part[3])};
  }
};

TableMarch::TableMarch(const Grid& grid, Border border, const Table<double>& table, TableFilter filter, double step,
                       double opaque)
    : size_(grid.size),
      border_(border),
      voxels_(grid, table.axes.low, static_cast<double>(table.axes.size - 1) / (table.axes.high - table.axes.low)),
      texels_(table.values.begin(), table.values.end()),
      entries_(static_cast<int>(table.axes.size)),
      filter_(filter),
      step_(step),
      opaque_(opaque) {}

RAYTRUTH_DISPATCH
Eigen::Array4d TableMarch::operator()(const PixelRay& pixel,
                                      const std::optional<std::span<const RayPart>>& parts) const {
  const Ray& ray = pixel.ray;
  const double length_unit = pixel.length_unit;
  const Span inside = clip(size_, border_, ray.origin, ray.direction);
  if (!(inside.begin < inside.end)) return Eigen::Array4d::Zero();
  const auto begin = static_cast<double>(inside.begin);
  const auto length = static_cast<double>(inside.end - inside.begin);
  const double step = step_ / length_unit;
  const auto count = static_cast<std::int64_t>(std::ceil(length * (1 - 1e-9) / step));
  const auto rest = static_cast<float>(std::min(1.0, length / step - static_cast<double>(count - 1)));

  const Double4 origin{ray.origin[0], ray.origin[1], ray.origin[2], 0};
  const Double4 direction{ray.direction[0], ray.direction[1], ray.direction[2], 0};
  const March march{.voxels = voxels_,
                    .texels = texels_.data(),
                    .entries = entries_,
                    .is_linear = filter_ == TableFilter::linear,
                    .opaque = static_cast<float>(std::min(opaque_, 1.0)),
                    .origin = origin + begin * direction + 1.0,
                    .direction = step * direction,
                    .end = origin + (begin + length) * direction + 1.0};
  Float4 sum{};
  std::int64_t done = 0;
  const RayPart everything{0, length};
  for (const RayPart& part : parts.value_or(std::span(&everything, 1))) {
    const std::int64_t first = std::max(done, static_cast<std::int64_t>(part.begin / step));
    const std::int64_t last = std::min(count, static_cast<std::int64_t>(std::ceil(part.end / step)));
    if (first < last && !march.composite(first, last, count, rest, sum)) break;
    done = std::max(done, last);
  }
  return {sum[0], sum[1], sum[2], sum[3]};
}

}  // namespace raytruth
