#include "raytruth/tables/quadratic_gray_table.hpp"

#include "raytruth/kernels/slab_kernels.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/schemes/quadratic_gray.hpp"
#include "raytruth/tables/fast_quadratic_gray.hpp"
#include "raytruth/tables/fast_second_order.hpp"
#include "raytruth/tables/second_order.hpp"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace raytruth {

namespace {

constexpr std::size_t printed_entries = 256;

/// Calls set(node, front, back) for every entry, a row at a time on each thread, with what `make` makes for it.
template <class Make, class Set>
void for_each_entry(std::size_t nodes, std::size_t size, const Make& make, const Set& set) {
  tbb::enumerable_thread_specific<decltype(make())> makers(make);
  tbb::parallel_for(std::size_t{0}, nodes * size, [&](std::size_t row) {
    auto& maker = makers.local();
    for (std::size_t front = 0; front < size; ++front) set(maker, row / size, front, row % size);
  });
}

/// Certified slabs into a table; the largest radius.
template <class Real>
double fill_certified(QuadraticGrayTable<Real>& table, const PiecewiseLinear& transfer, Emission emission) {
  const TableAxes& axes = table.axes;
  std::vector<double> radii(table.radius.node_count() * axes.size, 0);
  for_each_entry(
      table.radius.node_count(), axes.size, [&] { return SecondOrderSlabs(transfer, axes, emission); },
      [&](SecondOrderSlabs& slabs, std::size_t node, std::size_t front, std::size_t back) {
        const std::array ends{axes.scalar(front), axes.scalar(back)};
        const double middle =
            Rules<double>{}.quadratic_gray_middle(ends[0], ends[1], table.curvature(node), axes.length);
        const Certified slab = slabs.certified({ends[0], middle, ends[1]});
        table.set(node, front, back, slab.rgba().template cast<Real>());
        double& radius = radii[node * axes.size + back];
        radius = std::max(radius, slab.radius);
      });
  return *std::max_element(radii.begin(), radii.end());
}

}  // namespace

template <class Real>
QuadraticGrayTable<Real>::QuadraticGrayTable(const TableAxes& its_axes, const RadiusAxis& its_radius)
    : axes(its_axes), radius(its_radius), gray((its_axes.high - its_axes.low) / largest_gray) {
  check(axes);
  check(radius);
  const std::size_t entries = radius.node_count() * axes.size * axes.size;
  if (entries > most_quadratic_entries)
    throw InputError(
        fmt::format("found a table of {} radii, {} with both signs, and {} x {} entries each; at most {} "
                    "entries in all are allowed",
                    radius.count, radius.node_count(), axes.size, axes.size, most_quadratic_entries));
  values.resize(4 * entries);
}

template struct QuadraticGrayTable<float>;
template struct QuadraticGrayTable<double>;

CertifiedQuadraticGray certified_quadratic_gray_table(const PiecewiseLinear& transfer, const TableAxes& axes,
                                                      const RadiusAxis& radius, Emission emission) {
  CertifiedQuadraticGray result{.table = {axes, radius}};
  result.radius = fill_certified(result.table, transfer, emission);
  return result;
}

QuadraticGrayTable<float> quadratic_gray_table(const PiecewiseLinear& transfer, const TableAxes& axes,
                                               const RadiusAxis& radius, Emission emission) {
  QuadraticGrayTable<float> table(axes, radius);
  if (is_linear_between_entries(transfer, axes))
    fill_quadratic_gray_table(table, transfer, emission, *slab_kernel_versions().front());
  else
    fill_certified(table, transfer, emission);
  return table;
}

QuadraticGrayTable<float> quadratic_gray_printed_table(const PiecewiseLinear& transfer, const TableAxes& axes,
                                                       const RadiusAxis& radius, Emission emission,
                                                       const QuadraticGrayPrint& print) {
  if (axes.size < 2 || printed_entries % axes.size != 0)
    throw InputError(fmt::format(
        "found a printed quadratic table of {} entries; 2, 4, 8, ... 256 are allowed, every (256 / n)-th gray value",
        axes.size));
  QuadraticGrayTable<float> table(axes, radius);
  const std::size_t step = printed_entries / axes.size;
  table.axes.high = axes.low + table.gray * static_cast<double>(printed_entries - step);
  for_each_entry(
      radius.node_count(), axes.size,
      [&] { return QuadraticGrayPrinted(transfer, axes.low, axes.high, axes.length, emission, print); },
      [&](QuadraticGrayPrinted& printed, std::size_t node, std::size_t front, std::size_t back) {
        table.set(node, front, back,
                  printed.entry(front * step, back * step, radius.curvature(node)).template cast<float>());
      });
  return table;
}

QuadraticGrayTable<double> gradient_lit_table(const PiecewiseLinear& transfer, const TableAxes& axes,
                                              const RadiusAxis& radius, GradientTable which, double exponent, double v,
                                              bool is_corrected) {
  QuadraticGrayTable<double> table(axes, radius);
  for_each_entry(
      radius.node_count(), axes.size, [&] { return QuadraticGraySlabs(transfer, Emission::plain); },
      [&](QuadraticGraySlabs& slabs, std::size_t node, std::size_t front, std::size_t back) {
        const QuadraticGray slab =
            QuadraticGray::of_curvature(axes.scalar(front), axes.scalar(back), table.curvature(node), axes.length);
        GradientLight light{.is_corrected = is_corrected};
        if (which == GradientTable::diffuse_z) {
          light.front = 0;
          light.back = slab.scaled_length;
        } else if (which != GradientTable::diffuse) {
          light.slope_power = light.weight_power = exponent;
          if (which == GradientTable::specular) light.back = 1 + v * slab.scaled_length;
          if (which == GradientTable::specular_from_front) light.back = v;
          if (which == GradientTable::specular_from_back) light.front = v;
        }
        if (is_corrected) light.back = std::max(light.back, 0.0);
        table.set(node, front, back, slabs(slab, light));
      });
  return table;
}

QuadraticGrayTable<double> in_binary64(const QuadraticGrayTable<float>& table) {
  QuadraticGrayTable<double> result(table.axes, table.radius);
  result.gray = table.gray;
  std::copy(table.values.begin(), table.values.end(), result.values.begin());
  return result;
}

namespace catalogue {

const std::array<QuadraticGrayBuilder, 2>& quadratic_gray_builders() {
  static const std::array list{
      QuadraticGrayBuilder{"quadratic_gray", "slabs of parabolas, over front and back scalar and curvature, exactly",
                           "the dissertation, section 5.3, corrected", RadiusAxis{}, quadratic_gray_table},
      QuadraticGrayBuilder{
          "quadratic_gray_printed", "the same by sums over gray values, with all slips of the print",
          "the dissertation, section 5.3 and algorithms 9 to 11", printed_radius_axis(),
          [](const PiecewiseLinear& transfer, const TableAxes& axes, const RadiusAxis& radius, Emission emission) {
            return quadratic_gray_printed_table(transfer, axes, radius, emission);
          }}};
  return list;
}

}  // namespace catalogue

}  // namespace raytruth
