#pragma once

#include "raytruth/core/named.hpp"
#include "raytruth/signals/fields/ct_phantom.hpp"
#include "raytruth/signals/fields/hydrogen_orbital.hpp"
#include "raytruth/signals/fields/molecule.hpp"
#include "raytruth/signals/marschner_lobb.hpp"
#include "raytruth/signals/random_field.hpp"
#include "raytruth/volume/grid.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <variant>

namespace raytruth {

/// Fields that need no file. Each is a type of its options with a static `kind`, its name in documents, `options()`,
/// and functions `check` and `make_grid`; one that is random has a `seed`. A new one is a file with these, and an item
/// here: documents read it, lists name it. Its values lie in [0, 1].
using GeneratedField = std::variant<RandomField, SampledMarschnerLobb, HydrogenOrbital, Molecule, CtPhantom>;

/// Their names and what they are.
inline constexpr auto generated_field_kinds = []<std::size_t... index>(std::index_sequence<index...>) {
  return std::array{std::variant_alternative_t<index, GeneratedField>::kind...};
}
(std::make_index_sequence<std::variant_size_v<GeneratedField>>());

inline Grid make_grid(const GeneratedField& field) {
  return std::visit([](const auto& generated) { return make_grid(generated); }, field);
}

namespace catalogue {

/// Where voxels come from: a generator, or a file.
inline constexpr auto fields = [] {
  std::array<Named, generated_field_kinds.size() + 1> kinds{};
  std::copy(generated_field_kinds.begin(), generated_field_kinds.end(), kinds.begin());
  kinds.back() = {"volume", "a file, NRRD or NIfTI, found by name"};
  return kinds;
}();

}  // namespace catalogue

}  // namespace raytruth
