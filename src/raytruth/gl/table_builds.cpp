#include "raytruth/gl/table_builds.hpp"

#include "raytruth/gl/rule_shader.hpp"
#include "raytruth/gl/texts.hpp"
#include "raytruth/transfer/emission.hpp"

#include <fmt/format.h>

#include <vector>

namespace raytruth {

namespace {

void add(std::vector<float>& numbers, const Vector3<double>& color, double extinction) {
  for (const double channel : color) numbers.push_back(static_cast<float>(channel));
  numbers.push_back(static_cast<float>(extinction));
}

std::vector<float> build(GlDevice& device, bool is_second_order, const std::vector<float>& optics, GlInputs reads,
                         const TableAxes& axes, std::size_t entries) {
  reads.uniforms["size"] = static_cast<int>(axes.size);
  reads.uniforms["slab_length"] = static_cast<float>(axes.length);
  return device.compute(
      {.shader = rule_shader(fmt::format("#define SECOND_ORDER {}\n{}", is_second_order ? 1 : 0, table_builds)),
       .reads = std::move(reads),
       .inputs = {optics},
       .invocations = entries,
       .output_size = 4 * entries});
}

}  // namespace

Table<float> brute_force_table_in_shader(GlDevice& device, const DiscreteTransfer& transfer, const TableAxes& axes) {
  Table<float> table(axes);
  std::vector<float> optics;
  for (const auto* const list : {&transfer.entries, &transfer.intervals})
    for (const Optics& each : *list) {
      const bool is_associated = transfer.emission == Emission::associated;
      add(optics, is_associated ? Vector3<double>(each.extinction * each.color) : each.color, each.extinction);
    }
  table.values = build(device, false, optics, {}, axes, axes.size * axes.size);
  return table;
}

Table3<float> second_order_table_in_shader(GlDevice& device, const PiecewiseLinear& transfer, const TableAxes& axes,
                                           Emission emission, const Iterations& iterations) {
  Table3<float> table(axes);
  std::vector<float> optics;
  for (std::size_t i = 0; i < axes.size; ++i) {
    const Optics entry = transfer.at(axes.scalar(i));
    add(optics, entry.color, entry.extinction);
  }
  table.values = build(device, true, optics,
                       {.uniforms = {{"iterations", iterations.count},
                                     {"first_place", iterations.is_left ? 0.0F : 0.5F},
                                     {"is_associated", emission == Emission::associated ? 1 : 0}}},
                       axes, axes.size * axes.size * axes.size);
  return table;
}

}  // namespace raytruth
