#pragma once

#include "schemes/integral_scheme.hpp"
#include "schemes/order0.hpp"
#include "schemes/order1.hpp"
#include "schemes/order2.hpp"
#include "schemes/order3.hpp"
#include "schemes/virtual_catmull_rom.hpp"
#include "schemes/virtual_samples.hpp"
#include "tables/table_builder.hpp"
#include "transfer/study_transfers.hpp"

#include <array>
#include <cstddef>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

/// The table of contents: every ingredient, in the order in which tables and plots show them. To add one, write its
/// file and give it a line here; names, help, tests and plots follow from the line.
namespace raytruth::catalogue {

using Schemes =
    std::tuple<Order0Left, Order0Right, Order0Mid, Order1, Order2, Order3, VirtualCatmullRom, VirtualCatmullRom1,
               VirtualCatmullRom3, VirtualCatmullRom7, VirtualLinear1, VirtualLinear3, VirtualLinear7>;

/// From samples and a transfer function to colour and opacity (catalogue.cpp). A name that stands among the `Schemes`
/// too is that of the ideal pre-integration of their signal.
const std::vector<IntegralScheme>& integral_schemes();

/// The one of this name; null if there is none.
const IntegralScheme* find_integral_scheme(std::string_view name);

/// From transfer functions to tables of pre-integrated slabs (tables/table_builders.cpp).
const std::vector<TableBuilder>& table_builders();

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

/// A transfer function of the studies.
struct TransferEntry {
  std::string_view name;
  std::string_view summary;
  PiecewiseLinear (*make)(double extinction, std::uint64_t seed);  ///< null: a file states its points
};

inline constexpr std::array transfers{
    TransferEntry{"points", "piecewise linear between points (s, extinction, color); two points at one s make a jump",
                  nullptr},
    TransferEntry{"ramp", "extinction from 0 at s = 0 to its largest at 1; color (s, 1/2, 1 - s)",
                  [](double extinction, std::uint64_t) { return ramp_transfer(extinction); }},
    TransferEntry{"tent", "a tent of extinction over 0.5 +- 0.1; color (s, 1/2, 1 - s)",
                  [](double extinction, std::uint64_t) { return tent_transfer(extinction); }},
    TransferEntry{"isoslab", "a box of extinction over 0.5 +- 1/512; color (s, 1/2, 1 - s)",
                  [](double extinction, std::uint64_t) { return isoslab_transfer(extinction); }},
    TransferEntry{"step", "no extinction below 0.5, a constant one from there on; color (s, 1/2, 1 - s)",
                  [](double extinction, std::uint64_t) { return step_transfer(extinction); }},
    TransferEntry{"gaussian", "extinction a Gaussian of mean 0.5, deviation 0.05, 1025 points; color (s, 1/2, 1 - s)",
                  [](double extinction, std::uint64_t) { return gaussian_transfer(extinction); }},
    TransferEntry{"random", "extinction and color random at 256 points, from the seed", random_transfer},
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
