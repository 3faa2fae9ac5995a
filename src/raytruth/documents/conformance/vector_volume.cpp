#include "raytruth/documents/conformance/vector_volume.hpp"

#include "raytruth/documents/read_transfer_function.hpp"
#include "raytruth/signals/border.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <bit>
#include <cstddef>
#include <utility>
#include <vector>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "the file states how numbers lie in memory");

constexpr std::int64_t side = 3;  // of the columns: the middle one and its neighbours, so that any filter sees a ray

std::string nrrd_of(const std::vector<double>& samples) {
  std::string file = fmt::format(
      "NRRD0004\ntype: float\ndimension: 3\nsizes: {0} {0} {1}\nspacings: 1 1 1\ncenters: node node node\nendian: "
      "little\nencoding: raw\n\n",
      side, samples.size());
  for (auto sample = samples.rbegin(); sample != samples.rend(); ++sample)
    for (std::int64_t i = 0; i < side * side; ++i) {
      const auto number = static_cast<float>(*sample);
      file.append(reinterpret_cast<const char*>(&number), sizeof number);
    }
  return file;
}

/// A transfer function of the same matter where lengths are in units of `unit`.
PiecewiseLinear in_units(const PiecewiseLinear& transfer, Emission emission, double unit) {
  const double of_color = emission == Emission::plain ? unit : 1;
  if (transfer.is_linear_in_opacity()) {
    std::vector<OpacityPoint> points;
    for (std::size_t i = 0; i < transfer.points().size(); ++i)
      points.push_back({transfer.points()[i].s, transfer.opacities()[i], transfer.points()[i].optics.color * of_color});
    return from_opacity(points, transfer.unit_length() / unit);
  }
  std::vector<TransferPoint> points = transfer.points();
  for (auto& [s, optics] : points) {
    optics.extinction *= unit;
    optics.color *= of_color;
  }
  return PiecewiseLinear(std::move(points));
}

SeparateLists in_units(SeparateLists lists, Emission emission, double unit) {
  if (emission == Emission::plain)
    for (auto& [s, color] : lists.colors) color *= unit;
  if (lists.unit_length != 0)
    lists.unit_length /= unit;
  else
    for (auto& [s, value] : lists.densities) value *= unit;
  return lists;
}

}  // namespace

VectorVolume vector_volume(const ConformanceVector& vector, std::int64_t intervals) {
  std::vector<double> samples = samples_of(vector, intervals);
  for (double& sample : samples) sample = static_cast<double>(static_cast<float>(sample));
  const auto count = static_cast<double>(samples.size() - 1);
  const double voxel = vector.breaks.back() / count;

  ConformanceVector asked = vector;
  asked.breaks = {0, count};  // its length in voxels
  asked = sampled(asked, samples);
  asked.transfer = in_units(vector.transfer, vector.emission, voxel);
  if (vector.lists) asked.lists = in_units(*vector.lists, vector.emission, voxel);

  constexpr double middle = (side - 1) / 2.0;
  constexpr int pixels = 5;
  const Json camera{{"eye", {middle, middle, 2 * count + 4}},
                    {"target", {middle, middle, count / 2}},
                    {"up", {0, 1, 0}},
                    {"height", 0.5},
                    {"size", {pixels, pixels}}};
  Json scene{{"raytruth", "scene/1"},
             {"volume", vector.id + ".nrrd"},
             {"border", name_of(Border::voxel_centres)},
             {"transfer_function", transfer_function_json(asked.transfer)},
             {"emission", vector.emission == Emission::plain ? "plain" : "associated"},
             {"camera", camera},
             {"scheme", "reference"}};
  return {.nrrd = nrrd_of(samples), .scene = std::move(scene), .asked = std::move(asked)};
}

}  // namespace raytruth
