#pragma once

#include "schemes/order0.hpp"
#include "schemes/order1.hpp"
#include "schemes/order2.hpp"
#include "schemes/virtual_catmull_rom.hpp"
#include "schemes/virtual_samples.hpp"

#include <array>
#include <cstddef>
#include <string_view>
#include <tuple>
#include <utility>

/// The table of contents: every ingredient, in the order in which tables and plots show them. To add one, write its
/// file and give it a line here; names, help, tests and plots follow from the line.
namespace raytruth::catalogue {

using Schemes = std::tuple<Order0Left, Order0Right, Order0Mid, Order1, Order2, VirtualCatmullRom, VirtualCatmullRom1,
                           VirtualCatmullRom3, VirtualCatmullRom7, VirtualLinear1, VirtualLinear3, VirtualLinear7>;

/// An ingredient without a type of its own.
struct Entry {
  std::string_view name;
  std::string_view summary;
};

inline constexpr std::array signals{
    Entry{"piecewise_polynomial", "given coefficients, degree up to 9"},
    Entry{"trilinear", "a ray through a voxel grid, trilinear reconstruction: an exact chain of cubics"},
    Entry{"tricubic", "a ray through a voxel grid, B-spline (prefiltered or not) or Catmull-Rom: exact, degree 9"},
    Entry{"marschner_lobb", "the Marschner-Lobb signal itself along a ray through [-1, 1]^3"},
    Entry{"analytic", "a test signal with a name: sines, Gaussians, a chirp, a step, a kink"},
};

inline constexpr std::array fields{
    Entry{"random_field", "white noise in [0, 1], or white noise smoothed by a Gaussian; 64^3, periodic, from a seed"},
    Entry{"marschner_lobb", "the Marschner-Lobb signal sampled at n^3 nodes"},
    Entry{"volume", "a file, NRRD or NIfTI, found by name"},
};

inline constexpr std::array transfers{
    Entry{"points", "piecewise linear between points (s, extinction, color); two points at one s make a jump"},
};

inline constexpr std::array samplings{
    Entry{"cells", "at every border of the signal's pieces and at the midpoint of each"},
    Entry{"constant", "at t = 0, h, 2h, ... and at the end"},
};

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

}  // namespace raytruth::catalogue
