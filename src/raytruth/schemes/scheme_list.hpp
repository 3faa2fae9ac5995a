#pragma once

#include "raytruth/schemes/cubic_split.hpp"
#include "raytruth/schemes/order0.hpp"
#include "raytruth/schemes/order1.hpp"
#include "raytruth/schemes/order2.hpp"
#include "raytruth/schemes/order3.hpp"
#include "raytruth/schemes/virtual_catmull_rom.hpp"
#include "raytruth/schemes/virtual_samples.hpp"

#include <cstddef>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace raytruth::catalogue {

/// From samples to an approximate signal, in the order in which tables and plots show them.
using Schemes =
    std::tuple<Order0Left, Order0Right, Order0Mid, Order1, Order2, Order3, VirtualCatmullRom, VirtualCatmullRom1,
               VirtualCatmullRom3, VirtualCatmullRom7, VirtualLinear1, VirtualLinear3, VirtualLinear7, CubicSplitNone,
               CubicSplitInflection, CubicSplitExtrema, CubicSplitMiddle, CubicSplitFewest>;

/// Calls visit<S>() for every scheme, in order.
template <class Visit>
void for_each_scheme(Visit&& visit) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (visit.template operator()<std::tuple_element_t<I, Schemes>>(), ...);
  }
  (std::make_index_sequence<std::tuple_size_v<Schemes>>{});
}

/// Calls visit<S>() for the scheme of this name; false if there is none.
template <class Visit>
bool visit_scheme(std::string_view name, Visit&& visit) {
  bool found = false;
  for_each_scheme([&]<class S>() {
    if (S::info.name != name) return;
    found = true;
    visit.template operator()<S>();
  });
  return found;
}

/// Their names, in order.
inline std::vector<std::string_view> scheme_names() {
  std::vector<std::string_view> names;
  for_each_scheme([&names]<class S>() { names.push_back(S::info.name); });
  return names;
}

}  // namespace raytruth::catalogue
