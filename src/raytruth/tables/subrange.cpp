#include "raytruth/tables/subrange.hpp"

namespace raytruth {

Table<double> inclusive_subrange_table(const DiscreteTransfer& transfer, const TableAxes& axes) {
  // n entries as intervals of a table with one entry more, whose width |j - i| + 1 stands for |j - i|.
  using Slab = Rules<double>::vec4;
  Table<double> table(axes);
  const auto stretch = [&](double length) {
    return [&transfer, length](const Optics& optics) {
      return homogeneous_stretch<double>(optics, transfer.emission, length);
    };
  };
  for_each_entry(
      axes.size + 1,
      [&](std::size_t width, bool backwards) {
        return elements_of(transfer.entries, backwards,
                           stretch(axes.length / static_cast<double>(std::max<std::size_t>(width - 1, 1))));
      },
      [](const Slab& front, const Slab& back) -> Slab { return Rules<double>{}.over(front, back); },
      [&table](std::size_t front, std::size_t back, const Slab& slab) {
        if (front < back)
          table.set(front, back - 1, slab);
        else
          table.set(front - 1, back, slab);
      });
  return table;
}

}  // namespace raytruth
