#include "raytruth/tables/no_attenuation.hpp"

#include "raytruth/rules/rules.hpp"
#include "raytruth/schemes/slab_integrals.hpp"

#include <tbb/parallel_for.h>

#include <array>
#include <vector>

namespace raytruth {

Table<double> no_attenuation_table(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission) {
  Table<double> table(axes);
  using Vec4 = Rules<double>::vec4;
  const auto mean_optics = [&](double front, double back) -> Vec4 {
    const std::array slab{Piece<3>{0.0, 1, Bernstein<1>{{front, back}}.elevated<3>()}};
    return optics_integral(slab, transfer, emission);
  };
  std::vector<Vec4> integrals{Vec4::Constant(0)};  // of q and tau, in units of an interval's width
  for (std::size_t k = 0; k + 1 < axes.size; ++k)
    integrals.emplace_back(integrals.back() + mean_optics(axes.scalar(k), axes.scalar(k + 1)));
  tbb::parallel_for(std::size_t{0}, axes.size, [&](std::size_t j) {
    for (std::size_t i = 0; i <= j; ++i) {
      Vec4 slab = axes.length * (i == j ? mean_optics(axes.scalar(i), axes.scalar(i))
                                        : (integrals[j] - integrals[i]) / static_cast<double>(j - i));
      slab[3] = Rules<double>{}.absorption(slab[3], false);
      table.set(i, j, slab);
      table.set(j, i, slab);
    }
  });
  return table;
}

}  // namespace raytruth
