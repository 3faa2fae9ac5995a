#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <numbers>

#include "raytruth/volume/files/describe_volume.hpp"
#include "raytruth/volume/files/find_volume.hpp"
#include "raytruth/volume/files/read_volume.hpp"

// Real volumes, where they are at hand: those named here in the folders of RAYTRUTH_DATA, and Debian's mricron-data.

namespace raytruth::test {
namespace {

struct Known {
  std::string name;
  std::array<std::int64_t, 3> size;
  std::array<double, 3> spacing;
  VoxelType type;
  double minimum;
  double maximum;
  double percent_zeros;
  bool lost_first_byte;
};

constexpr auto u8 = VoxelType::uint8;
constexpr std::array<double, 3> unit{1, 1, 1};

const std::vector<Known>& known_volumes() {
  static const std::vector<Known> volumes{
      {"bucky_32", {32, 32, 32}, unit, u8, 0, 255, 0.4, false},
      {"marschner_lobb_41", {41, 41, 41}, unit, u8, 0, 255, 0.4, true},
      {"nucleon_41", {41, 41, 41}, unit, u8, 0, 249, 18.3, true},
      {"fuel_64", {64, 64, 64}, unit, u8, 0, 255, 94.8, false},
      {"neghip_64", {64, 64, 64}, unit, u8, 0, 255, 53.6, false},
      {"silicium_98x34x34", {98, 34, 34}, unit, u8, 0, 255, 41.6, true},
      {"hydrogen_atom_128", {128, 128, 128}, unit, u8, 0, 250, 67.3, true},
      {"engine_256x256x128", {256, 256, 128}, unit, u8, 0, 255, 38.0, true},
      {"bonsai_256", {256, 256, 256}, unit, u8, 0, 255, 79.7, false},
      {"aneurism_256", {256, 256, 256}, unit, u8, 0, 255, 99.0, false},
      {"boston_teapot_256x256x178", {256, 256, 178}, unit, u8, 0, 255, 57.7, false},
      {"cthead_256x256x99", {256, 256, 99}, {1, 1, 2}, u8, 0, 255, 1.9, false},
      {"headsq_quarter_64x64x93_u16", {64, 64, 93}, {3.2, 3.2, 1.5}, VoxelType::uint16, 0, 3926, 15.4, false},
      {"cranium_256x256x108_i16",
       {256, 256, 108},
       {0.957031, 0.957031, 1.5},
       VoxelType::int16,
       -1024,
       2986,
       0.1,
       false},
      {"water_molecule_40x60x20_f32", {40, 60, 20}, unit, VoxelType::float32, 0, 9.63576, 4.5, false},
      {"imide_potential_23x43x48_f32", {23, 43, 48}, {0.4, 0.4, 0.4}, VoxelType::float32, -0.08183, 52.1968, 0, false},
      {"ch2", {181, 217, 181}, unit, u8, 0, 254, 41.6, false},  // from mricron-data
  };
  return volumes;
}

/// The volume, or nothing and a message: these tests pass on a machine without it.
std::optional<Volume> volume_at_hand(const std::string& name) {
  try {
    return read_volume(find_volume(name, volume_folders()));
  } catch (const VolumeAbsent& absent) {
    std::cout << "not tested: " << absent.what() << '\n';
    return std::nullopt;
  }
}

TEST(VolumeReal, HasTheKnownFacts) {
  for (const auto& known : known_volumes()) {
    SCOPED_TRACE(known.name);
    const auto volume = volume_at_hand(known.name);
    if (!volume) continue;
    const auto description = describe_volume(*volume);
    EXPECT_EQ(description.size, known.size);
    for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(description.spacing[axis], known.spacing[axis], 5e-7);
    EXPECT_EQ(volume->type, known.type);
    EXPECT_NEAR(description.minimum, known.minimum, 5e-5);
    EXPECT_NEAR(description.maximum, known.maximum, 5e-5);
    EXPECT_NEAR(100 * description.share_of_zeros, known.percent_zeros, 0.0501);
    EXPECT_EQ(description.lost_first_byte, known.lost_first_byte);
  }
}

/// Mean absolute difference of a grid and its mirror image along `axis`.
double asymmetry(const Grid& grid, std::size_t axis) {
  double sum = 0;
  for (std::int64_t k = 0; k < grid.size[2]; ++k) {
    for (std::int64_t j = 0; j < grid.size[1]; ++j) {
      for (std::int64_t i = 0; i < grid.size[0]; ++i) {
        std::array<std::int64_t, 3> mirrored{i, j, k};
        mirrored[axis] = grid.size[axis] - 1 - mirrored[axis];
        sum += std::abs(grid.at(i, j, k) - grid.at(mirrored[0], mirrored[1], mirrored[2]));
      }
    }
  }
  return sum / static_cast<double>(grid.values.size());
}

TEST(VolumeReal, RepairedNucleonIsExactlySymmetric) {
  auto volume = volume_at_hand("nucleon_41");
  if (!volume) return;
  EXPECT_NEAR(asymmetry(volume->grid, 0), 8.58, 0.005);
  repair_first_byte(*volume);
  const auto& grid = volume->grid;
  EXPECT_EQ(asymmetry(grid, 0), 0);
  EXPECT_EQ(asymmetry(grid, 1), 0);
  for (std::int64_t k = 0; k < 41; ++k) {
    for (std::int64_t j = 0; j < 41; ++j) {
      for (std::int64_t i = 0; i < j; ++i) ASSERT_EQ(grid.at(i, j, k), grid.at(j, i, k)) << i << ' ' << j << ' ' << k;
    }
  }
}

TEST(VolumeReal, RepairedHydrogenIsMoreSymmetric) {
  auto volume = volume_at_hand("hydrogen_atom_128");
  if (!volume) return;
  EXPECT_NEAR(asymmetry(volume->grid, 0), 0.72, 0.005);
  repair_first_byte(*volume);
  EXPECT_NEAR(asymmetry(volume->grid, 0), 0.24, 0.005);
}

/// Marschner and Lobb's signal, alpha = 0.25, f_M = 6, on [-1, 1]^3 in 41 points per axis, as floor(255 rho).
TEST(VolumeReal, RepairedMarschnerLobbIsItsFormulaButForRounding) {
  auto volume = volume_at_hand("marschner_lobb_41");
  if (!volume) return;
  constexpr unsigned char first_byte = 212;
  repair_first_byte(*volume, first_byte);
  const auto& grid = volume->grid;
  constexpr double pi = std::numbers::pi;
  int differing = 0;
  for (std::int64_t k = 0; k < 41; ++k) {
    for (std::int64_t j = 0; j < 41; ++j) {
      for (std::int64_t i = 0; i < 41; ++i) {
        const auto at = [](std::int64_t index) { return static_cast<double>(index) / 20 - 1; };
        const double wave = std::cos(12 * pi * std::cos(pi * std::hypot(at(i), at(j)) / 2));
        const double rho = (1 - std::sin(pi * at(k) / 2) + 0.25 * (1 + wave)) / 2.5;
        const double difference = std::abs(grid.at(i, j, k) - std::floor(255 * rho));
        ASSERT_LE(difference, 1) << i << ' ' << j << ' ' << k;
        if (difference != 0) ++differing;
      }
    }
  }
  EXPECT_LT(differing, 1400);
}

}  // namespace
}  // namespace raytruth::test
