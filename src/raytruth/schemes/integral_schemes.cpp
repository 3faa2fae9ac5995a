#include "raytruth/schemes/integral_schemes.hpp"

#include "raytruth/schemes/scheme_list.hpp"

#include <fmt/format.h>

namespace raytruth::catalogue {

namespace {

constexpr int fewest_iterations = 8;
constexpr int most_iterations = 2048;

/// A rule with exponential and with linear absorption; the latter is of first order and exact on nothing.
void add_sampled(std::vector<IntegralScheme>& list, IntegralScheme scheme, SampledRule rule) {
  scheme.method = Sampled{.rule = rule};
  list.push_back(scheme);
  scheme.name += "_linear_opacity";
  scheme.summary += ", opacity min(1, tau h)";
  scheme.method = Sampled{.rule = rule, .absorption = Absorption::linear};
  scheme.order = {1, 1};
  scheme.is_exact_on_constants = false;
  scheme.marker = "x";
  list.push_back(scheme);
}

void add_virtual(std::vector<IntegralScheme>& list, int count, std::string_view marker) {
  IntegralScheme scheme{.name = fmt::format("sampled_virtual_catmull_rom_{}", count),
                        .summary = fmt::format("{} virtual samples between, opacity corrected in closed form", count),
                        .source = "Lee 2010, section 3.1 and eq. 9",
                        .method = Sampled{.rule = SampledRule::virtual_catmull_rom, .virtual_samples = count},
                        .signal = VirtualCatmullRom::info.name,
                        .order = {1, 1},
                        .color = VirtualCatmullRom::info.color,
                        .marker = marker};
  list.push_back(scheme);
  scheme.name += "_recursion";
  scheme.summary = fmt::format("{} virtual samples between, opacity corrected by square roots", count);
  scheme.source = "Lee 2010, eq. 11";
  std::get<Sampled>(scheme.method).correction = OpacityCorrection::recursion;
  scheme.color = "#44AA99";
  list.push_back(scheme);
}

void add_iterations(std::vector<IntegralScheme>& list, const SchemeInfo& signal) {
  for (const bool is_left : {false, true})
    for (int count = fewest_iterations; count <= most_iterations; count *= 2)
      list.push_back({.name = fmt::format("{}_iterations_{}{}", signal.name, count, is_left ? "_left" : ""),
                      .summary = fmt::format("{}, {} steps per slab{}", signal.name, count,
                                             is_left ? ", each with the optics of its front" : ""),
                      .source = "El Hajjar 2008, section 7",
                      .method = Iterations{.count = count, .is_left = is_left},
                      .signal = signal.name,
                      .order = is_left ? IntegralOrder{1, 1} : IntegralOrder{2, 2},
                      .color = signal.color,
                      .marker = is_left ? "4" : "3"});
}

void add_without_attenuation(std::vector<IntegralScheme>& list, const SchemeInfo& signal) {
  list.push_back({.name = fmt::format("{}_no_attenuation", signal.name),
                  .summary = fmt::format("{}, nothing absorbed on its way out of a slab", signal.name),
                  .source = "Engel, Kraus and Ertl 2001, in Lum 2004, section 4.2",
                  .method = WithoutAttenuation{},
                  .signal = signal.name,
                  .order = {1, signal.integral_order},
                  .is_exact_on_constants = false,
                  .color = signal.color,
                  .marker = "2"});
}

std::vector<IntegralScheme> make_integral_schemes() {
  std::vector<IntegralScheme> list;

  add_sampled(list,
              {.name = "riemann_left",
               .summary = "sampled: every slab has the optics of its front sample",
               .source = "Lum 2004, section 2; El Hajjar 2008, section 3.2.1",
               .signal = Order0Left::info.name,
               .order = {1, 1},
               .color = Order0Left::info.color,
               .marker = "p"},
              SampledRule::riemann_left);
  add_sampled(list,
              {.name = "riemann_right",
               .summary = "sampled: every slab has the optics of its back sample",
               .source = "El Hajjar 2008, section 3.2.1",
               .signal = Order0Right::info.name,
               .order = {1, 1},
               .color = Order0Right::info.color,
               .marker = "p"},
              SampledRule::riemann_right);
  add_sampled(list,
              {.name = "riemann_mid",
               .summary = "sampled: every slab has the optics of its midpoint",
               .source = "El Hajjar 2008, section 3.2.1",
               .signal = Order0Mid::info.name,
               .order = {2, 2},
               .color = Order0Mid::info.color,
               .marker = "p"},
              SampledRule::riemann_mid);
  add_sampled(list,
              {.name = "trapezoid",
               .summary = "sampled: trapezoid rule for optical depth and emission",
               .source = "Novins and Arvo 1992",
               .signal = Order1::info.name,
               .order = {2, 2},
               .is_exact_on_constants = false,
               .color = Order1::info.color,
               .marker = "p"},
              SampledRule::trapezoid);
  add_sampled(list,
              {.name = "simpson",
               .summary = "sampled: Simpson's rule over three samples for optical depth and emission",
               .source = "Novins and Arvo 1992",
               .signal = Order2::info.name,
               .order = {4, 4},
               .is_exact_on_constants = false,
               .color = Order2::info.color,
               .marker = "p"},
              SampledRule::simpson);
  add_virtual(list, 3, "H");
  add_virtual(list, 7, "8");

  for_each_scheme([&list]<class S>() {
    list.push_back({.name = std::string(S::info.name),
                    .summary = std::string(S::info.summary),
                    .source = S::info.source,
                    .method = Ideal{},
                    .signal = S::info.name,
                    .order = {S::info.integral_order, S::info.integral_order},
                    .color = S::info.color,
                    .marker = S::info.marker});
  });
  add_without_attenuation(list, Order1::info);
  add_without_attenuation(list, Order2::info);
  add_without_attenuation(list, Order3::info);
  add_without_attenuation(list, VirtualCatmullRom::info);
  add_iterations(list, Order1::info);
  add_iterations(list, Order2::info);

  list.push_back({.name = "quadratic_gray",
                  .summary = "the slabs of order2 in the quadratic gray-value model's own coordinates, exactly",
                  .source = "the dissertation, section 5.3, corrected",
                  .method = QuadraticGrayModel{},
                  .signal = Order2::info.name,
                  .order = {Order2::info.integral_order, Order2::info.integral_order},
                  .color = "#D55E00",
                  .marker = "P"});
  list.push_back({.name = "quadratic_gray_printed",
                  .summary = "the same by sums over gray values, 256 of them, with all slips of the print",
                  .source = "the dissertation, sections 5.3 and 5.5.2, algorithms 9 to 11",
                  .method = QuadraticGrayPrintedModel{},
                  .signal = Order2::info.name,
                  .color = "#D55E00",
                  .marker = "X"});

  list.push_back({.name = "cell_adaptive",
                  .summary = "samples at cell borders and inside the longest chords, as many as given",
                  .source = "this project",
                  .method = CellAdaptive{},
                  .color = "#882255",
                  .marker = "h"});
  list.push_back({.name = "cell_cubic",
                  .summary = "the exact cubic of every cell, from its eight voxels",
                  .source = "El Hajjar 2008, section 3.1",
                  .method = CellCubic{},
                  .color = "#000000",
                  .marker = "*"});
  return list;
}

}  // namespace

const std::vector<IntegralScheme>& integral_schemes() {
  static const std::vector<IntegralScheme> list = make_integral_schemes();
  return list;
}

}  // namespace raytruth::catalogue
