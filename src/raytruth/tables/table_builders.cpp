#include "raytruth/tables/table_builders.hpp"

#include "raytruth/tables/brute_force.hpp"
#include "raytruth/tables/dissertation_linear.hpp"
#include "raytruth/tables/exact.hpp"
#include "raytruth/tables/moments.hpp"
#include "raytruth/tables/no_attenuation.hpp"
#include "raytruth/tables/subrange.hpp"
#include "raytruth/tables/weighted.hpp"
#include "raytruth/transfer/emission.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <utility>

namespace raytruth::catalogue {

namespace {

using Transfer = const PiecewiseLinear&;
using Axes = const TableAxes&;

/// One of two weighted tables: Make(transfer, axes) gives both.
template <WeightedTables<double> (*Make)(const DiscreteTransfer&, const TableAxes&), bool IsWhite,
          Table<double> WeightedTables<double>::*Which>
TableBuilder weighted(const char* name, std::string_view summary) {
  return {.name = name,
          .summary = summary,
          .source = "Lum 2004, section 4.3",
          .make =
              [](Transfer transfer, Axes axes, Emission emission) {
                const DiscreteTransfer means = interval_means(transfer, axes, emission);
                return Make(IsWhite ? whitened(means) : means, axes).*Which;
              },
          .content = {.weight = Which == &WeightedTables<double>::front ? LightWeight::to_front : LightWeight::x,
                      .is_white = IsWhite}};
}

template <std::size_t K>
TableBuilder moment() {
  constexpr std::array powers{LightWeight::one, LightWeight::x, LightWeight::x_squared, LightWeight::x_cubed};
  return {.name = fmt::format("moment_{}", K),
          .summary = "light times the k-th power of s in RGB, the same of white light as the fourth channel",
          .source = "Guetat 2010, eqs. 8 and 10",
          .make =
              [](Transfer transfer, Axes axes, Emission emission) {
                return moment_tables(interval_means(transfer, axes, emission), axes).moments[K];
              },
          .content = {.weight = powers[K], .has_white_as_alpha = true}};
}

template <DissertationAlgorithm Algorithm, DistanceInterpolation Interpolation>
TableBuilder dissertation(const char* name, std::string_view summary) {
  return {.name = name,
          .summary = summary,
          .source = "the dissertation, section 5.2.6",
          .make =
              [](Transfer transfer, Axes axes, Emission emission) {
                return dissertation_linear_table(transfer, axes, emission, Algorithm, Interpolation);
              },
          .cost = dissertation_linear_cost};
}

std::vector<TableBuilder> make_table_builders() {
  std::vector<TableBuilder> list;
  list.push_back(
      {.name = "brute_force",
       .summary = "entries composited one by one, each interval as its lower entry",
       .source = "Lum 2004, section 4.1",
       .make = [](Transfer transfer, Axes axes,
                  Emission emission) { return brute_force_table<double>(sampled(transfer, axes, emission), axes); },
       .cost = brute_force_cost});
  list.push_back(
      {.name = "subrange",
       .summary = "the same numbers by incremental subranges",
       .source = "Lum 2004, section 4.2",
       .make = [](Transfer transfer, Axes axes,
                  Emission emission) { return subrange_table<double>(sampled(transfer, axes, emission), axes); },
       .cost = subrange_cost});
  list.push_back({.name = "subrange_inclusive",
                  .summary = "subranges with both end entries, slabs too long by one entry",
                  .source = "Lum 2004, section 4.3, as printed",
                  .make = [](Transfer transfer, Axes axes, Emission emission) {
                    return inclusive_subrange_table(sampled(transfer, axes, emission), axes);
                  }});
  list.push_back(
      {.name = "subrange_means",
       .summary = "subranges of homogeneous intervals with the transfer function's means",
       .source = "Lum 2004, section 4.2, for piecewise linear transfer functions",
       .make = [](Transfer transfer, Axes axes,
                  Emission emission) { return subrange_table<double>(interval_means(transfer, axes, emission), axes); },
       .cost = subrange_cost});
  list.push_back({.name = "exact",
                  .summary = "subranges of exact intervals: the continuous integral",
                  .source = "this project",
                  .make = exact_table});
  list.push_back({.name = "no_attenuation",
                  .summary = "nothing absorbed on its way out of a slab; two integrals and their differences",
                  .source = "Engel, Kraus and Ertl 2001, in Lum 2004, section 4.2",
                  .make = no_attenuation_table,
                  .cost = no_attenuation_cost});
  constexpr auto to_front = &WeightedTables<double>::front;
  constexpr auto to_back = &WeightedTables<double>::back;
  constexpr std::string_view light = "light weighted towards one end of the slab, made of sums";
  list.push_back(weighted<weighted_tables<double>, false, to_front>("front_weighted", light));
  list.push_back(weighted<weighted_tables<double>, false, to_back>("back_weighted", light));
  constexpr std::string_view white = "white light weighted towards one end of the slab, made of sums";
  list.push_back(weighted<weighted_tables<double>, true, to_front>("front_weighted_specular", white));
  list.push_back(weighted<weighted_tables<double>, true, to_back>("back_weighted_specular", white));
  constexpr std::string_view difference = "light weighted towards one end, as the difference that is printed";
  list.push_back(
      weighted<weighted_tables_by_difference<double>, false, to_front>("front_weighted_difference", difference));
  list.push_back(
      weighted<weighted_tables_by_difference<double>, false, to_back>("back_weighted_difference", difference));
  list.push_back(moment<0>());
  list.push_back(moment<1>());
  list.push_back(moment<2>());
  list.push_back(moment<3>());
  list.push_back(
      {.name = "moment_tent",
       .summary = "white light weighted by a tent over the slab, and the opacity",
       .source = "Guetat 2010, section 5.2",
       .make = [](Transfer transfer, Axes axes,
                  Emission emission) { return moment_tables(interval_means(transfer, axes, emission), axes).tent; },
       .content = {.weight = LightWeight::tent, .is_white = true}});
  list.push_back(dissertation<DissertationAlgorithm::text, DistanceInterpolation::opacity>(
      "dissertation_text", "incremental over distances 2^j by the recurrence as printed"));
  list.push_back(dissertation<DissertationAlgorithm::pseudo_code, DistanceInterpolation::opacity>(
      "dissertation_pseudo_code", "incremental over distances 2^j by the pseudo-code as printed"));
  list.push_back(dissertation<DissertationAlgorithm::corrected, DistanceInterpolation::opacity>(
      "dissertation_linear", "incremental front to back at distances 2^j per interval, opacity linear in between"));
  list.push_back(dissertation<DissertationAlgorithm::corrected, DistanceInterpolation::logarithm>(
      "dissertation_logarithmic", "the same, the logarithm of the transmittance linear in between"));
  return list;
}

}  // namespace

const std::vector<TableBuilder>& table_builders() {
  static const std::vector<TableBuilder> list = make_table_builders();
  return list;
}

}  // namespace raytruth::catalogue
