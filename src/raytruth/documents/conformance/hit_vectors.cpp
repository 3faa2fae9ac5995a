#include "raytruth/documents/conformance/hit_vectors.hpp"

#include "raytruth/documents/conformance/draws.hpp"
#include "raytruth/signals/piecewise_polynomial.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

constexpr int rays_per_level = 40;
constexpr std::uint64_t first_vector = 1'000'000;  // others are those of colours

/// Adds a piece of length 1.
void append(HitVector& vector, std::vector<double> powers) {
  if (vector.breaks.empty()) vector.breaks.push_back(0);
  vector.breaks.push_back(vector.breaks.back() + 1);
  vector.coefficients.push_back(std::move(powers));
}

/// The piece's Bernstein coefficients: its powers are binomial(n, k) times the k-th forward difference of these.
void append_bernstein(HitVector& vector, std::vector<double> bernstein) {
  const std::size_t degree = bernstein.size() - 1;
  std::vector<double> powers;
  double binomial = 1;
  for (std::size_t k = 0; k <= degree; ++k) {
    powers.push_back(binomial * bernstein[0]);
    for (std::size_t i = 0; i + k < degree; ++i) bernstein[i] = bernstein[i + 1] - bernstein[i];
    binomial = binomial * static_cast<double>(degree - k) / static_cast<double>(k + 1);
  }
  append(vector, std::move(powers));
}

/// Continuous pieces with whole Bernstein coefficients from 0 to 64, and surfaces half-way between whole numbers.
void make_generic(Draws& draws, int /*index*/, HitVector& vector) {
  const int pieces = draws.whole(1, 5);
  double value = draws.whole(0, 64);
  for (int piece = 0; piece < pieces; ++piece) {
    const int degree = draws.whole(1, 9);
    std::vector<double> bernstein{value};
    for (int i = 0; i < degree; ++i) bernstein.push_back(draws.whole(0, 64));
    value = bernstein.back();
    append_bernstein(vector, std::move(bernstein));
  }
  for (int s = draws.whole(4, 30); s < 64 && vector.scalars.size() < 4; s += draws.whole(4, 20))
    vector.scalars.push_back(s + 0.5);
}

/// Pieces that begin and end on surfaces or between them, level stretches among them.
void make_voxel_values(Draws& draws, int index, HitVector& vector) {
  const int pieces = draws.whole(3, 7);
  double value = 8.0 * draws.whole(0, 8);
  for (int piece = 0; piece < pieces; ++piece) {
    const double next = draws.whole(0, 2) == 0 ? value : 8.0 * draws.whole(0, 8);
    const int degree = index % 2 == 0 ? 1 : 3;
    std::vector<double> bernstein{value};
    const bool is_level = next == value && draws.whole(0, 1) == 0;
    for (int i = 1; i < degree; ++i) bernstein.push_back(is_level ? value : 4.0 * draws.whole(0, 16));
    bernstein.push_back(next);
    append_bernstein(vector, std::move(bernstein));
    value = next;
  }
  vector.scalars = {16, 32, 48};
}

/// A piece c (u - a)^m (u - b) + v, which touches v or crosses it threefold, and a line on.
void append_contact(Draws& draws, int power, double height, HitVector& vector) {
  const double a = draws.whole(1, 15) / 16.0;
  const double b = draws.whole(0, 3) == 0 ? draws.whole(1, 15) / 16.0 : -1;
  const double factor = draws.whole(0, 1) == 0 ? 1 : -1;
  const double surface = vector.scalars[static_cast<std::size_t>(draws.whole(0, 1))];
  std::vector<double> powers{factor};
  const auto multiply = [&powers](double root) {
    powers.push_back(0);
    for (std::size_t k = powers.size(); k-- > 0;) powers[k] = (k > 0 ? powers[k - 1] : 0) - root * powers[k];
  };
  for (int i = 0; i < power; ++i) multiply(a);
  powers[0] += factor * height;
  if (height == 0) multiply(b);
  powers[0] += surface;
  double end = 0;
  for (const double coefficient : powers) end += coefficient;
  append(vector, std::move(powers));
  append(vector, {end, 0.25 * draws.whole(-8, 8)});
}

void make_contact(Draws& draws, int index, HitVector& vector) {
  vector.scalars = {1, 2};
  append_contact(draws, 2 + index % 3, 0, vector);
}

/// As contacts of the second order, but higher or lower by 2^-10 to 2^-30.
void make_near_contact(Draws& draws, int index, HitVector& vector) {
  vector.scalars = {1, 2};
  const double height = std::ldexp(1.0, -10 - 20 * index / (rays_per_level - 1));
  append_contact(draws, 2, index % 2 == 0 ? height : -height, vector);
}

/// Rays through a trilinear field of whole voxels, along edges of its cells, along diagonals of their faces and through
/// their corners; surfaces at voxel values, or half-way between them.
void make_edges_and_corners(Draws& draws, int index, HitVector& vector) {
  constexpr std::int64_t side = 5;
  HitVolume volume{.size = {side, side, side}, .values = {}, .origin = {}, .direction = {}};
  for (std::int64_t i = 0; i < side * side * side; ++i) volume.values.push_back(draws.whole(0, 15));
  const int dimensions = 1 + index % 3;
  const int first_axis = draws.whole(0, 2);
  for (int axis = 0; axis < 3; ++axis) {
    const bool is_moving = (axis - first_axis + 3) % 3 < dimensions;
    const auto at = static_cast<std::size_t>(axis);
    volume.direction[at] = is_moving ? 1 : 0;
    volume.origin[at] = is_moving ? 0 : draws.whole(0, side - 1);
  }
  for (std::int64_t cell = 0; cell + 1 < side; ++cell) {
    // By how many of its axes a corner lies behind: with u along each of them the weights are Bernstein's.
    std::vector<double> sums(static_cast<std::size_t>(dimensions) + 1);
    for (int corner = 0; corner < 8; ++corner) {
      std::array<std::int64_t, 3> place{};
      std::size_t behind = 0;
      bool counts = true;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool is_set = ((corner >> axis) & 1) != 0;
        const bool is_moving = volume.direction[axis] != 0;
        counts = counts && (is_moving || !is_set);
        behind += is_moving && is_set ? 1 : 0;
        place[axis] = is_moving ? cell + (is_set ? 1 : 0) : static_cast<std::int64_t>(volume.origin[axis]);
      }
      if (counts)
        sums[behind] += volume.values[static_cast<std::size_t>((place[2] * side + place[1]) * side + place[0])];
    }
    // Powers of sum_k sums[k] u^k (1-u)^(n-k), which are whole: (1-u)^m has alternating binomials.
    std::vector<double> powers(sums.size());
    for (std::size_t k = 0; k < sums.size(); ++k) {
      double binomial = 1;
      const std::size_t m = sums.size() - 1 - k;
      for (std::size_t j = 0; j <= m; ++j) {
        powers[k + j] += sums[k] * (j % 2 == 0 ? binomial : -binomial);
        binomial = binomial * static_cast<double>(m - j) / static_cast<double>(j + 1);
      }
    }
    append(vector, std::move(powers));
  }
  const double shift = index % 2 == 0 ? 0 : 0.5;
  vector.scalars = {4 + shift, 7 + shift, 11 + shift};
  vector.volume = std::move(volume);
}

struct Recipe {
  VectorLevel level;
  void (*make)(Draws&, int index, HitVector&);
};

constexpr std::array recipes{
    Recipe{{"generic", "pieces of degree 1 to 9, several surfaces in some, none at a piece's end"}, make_generic},
    Recipe{{"voxel_values", "pieces begin and end on surfaces, and stay on them for a while"}, make_voxel_values},
    Recipe{{"edges_and_corners", "rays along edges and diagonals of cells, through their corners"},
           make_edges_and_corners},
    Recipe{{"contacts", "zeros of the second, third and fourth order: only odd ones are crossings"}, make_contact},
    Recipe{{"near_contacts", "two crossings or none, where the scalar turns 2^-10 to 2^-30 beside a surface"},
           make_near_contact}};

Json vector_json(const HitVector& vector) {
  Json json{
      {"id", vector.id},
      {"level", vector.level},
      {"signal", {{"kind", "piecewise_polynomial"}, {"breaks", vector.breaks}, {"coefficients", vector.coefficients}}}};
  if (vector.volume)
    json["ray"] = {{"volume", {{"size", vector.volume->size}, {"values", vector.volume->values}}},
                   {"origin", vector.volume->origin},
                   {"direction", vector.volume->direction}};
  json["isosurfaces"] = vector.scalars;
  Json hits = Json::array();
  for (const SurfaceHit& hit : truth_of(vector).hits) {
    const auto t = static_cast<double>(hit.t);
    const double radius = hit.error + std::abs(static_cast<double>(hit.t - DoubleDouble(t)));
    hits.push_back({{"t", t},
                    {"radius", radius == 0 ? 0 : std::nextafter(radius, std::numeric_limits<double>::infinity())},
                    {"surface", hit.surface},
                    {"rising", hit.is_rising}});
  }
  json["hits"] = std::move(hits);
  return json;
}

}  // namespace

std::vector<VectorLevel> hit_levels() {
  std::vector<VectorLevel> levels;
  for (const Recipe& recipe : recipes) levels.push_back(recipe.level);
  return levels;
}

std::vector<HitVector> hit_vectors(std::uint64_t seed) {
  std::vector<HitVector> vectors;
  for (const Recipe& recipe : recipes)
    for (int index = 0; index < rays_per_level; ++index) {
      Draws draws(seed, first_vector + vectors.size());
      HitVector vector{.id = fmt::format("{}_{:02}", recipe.level.name, index + 1),
                       .level = recipe.level.name,
                       .breaks = {},
                       .coefficients = {},
                       .scalars = {}};
      recipe.make(draws, index, vector);
      vectors.push_back(std::move(vector));
    }
  return vectors;
}

SurfaceHits truth_of(const HitVector& vector) {
  return surface_hits(precise_piecewise_polynomial(vector.breaks, vector.coefficients), vector.scalars);
}

Json hit_vectors_json(std::uint64_t seed) {
  Json levels = Json::array();
  for (const VectorLevel& level : hit_levels())
    levels.push_back({{"level", level.name}, {"difficulty", levels.size() + 1}, {"why", level.why}});
  Json vectors = Json::array();
  for (const HitVector& vector : hit_vectors(seed)) vectors.push_back(vector_json(vector));
  return {
      {"raytruth", hit_vector_form}, {"seed", seed}, {"levels", std::move(levels)}, {"vectors", std::move(vectors)}};
}

}  // namespace raytruth
