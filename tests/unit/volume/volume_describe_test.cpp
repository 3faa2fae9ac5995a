#include "raytruth/volume/files/describe_volume.hpp"

#include "unit/volume/volume_files.hpp"

namespace raytruth::test {
namespace {

Volume volume_of(std::array<std::int64_t, 3> size, std::vector<double> values, VoxelType type = VoxelType::uint8) {
  Volume volume;
  volume.file = "some.nrrd";
  volume.format = "NRRD";
  volume.type = type;
  volume.grid.size = size;
  volume.grid.values = std::move(values);
  return volume;
}

TEST(VolumeDescribe, FactsOfTheHeader) {
  auto volume = volume_of({1, 1, 2}, {-1, 1}, VoxelType::int16);
  volume.grid.spacing = {1, 2, 3};
  volume.encoding = Encoding::gzip;
  volume.endian = std::endian::big;
  const auto description = describe_volume(volume);
  EXPECT_EQ(description.file, "some.nrrd");
  EXPECT_EQ(description.format, "NRRD");
  EXPECT_EQ(description.type, "int16");
  EXPECT_EQ(description.bytes_per_voxel, 2);
  EXPECT_TRUE(description.is_integer);
  EXPECT_TRUE(description.is_signed);
  EXPECT_EQ(description.encoding, "gzip");
  EXPECT_EQ(description.endian, "big");
  EXPECT_EQ(description.size, (std::array<std::int64_t, 3>{1, 1, 2}));
  EXPECT_EQ(description.spacing, (std::array{1.0, 2.0, 3.0}));
  EXPECT_FALSE(description.lost_first_byte);
  volume.encoding = Encoding::ascii;
  EXPECT_EQ(describe_volume(volume).endian, "none");
  volume.encoding = Encoding::raw;
  volume.type = VoxelType::int8;
  EXPECT_EQ(describe_volume(volume).endian, "none");
}

TEST(VolumeDescribe, RangeSharesAndLevels) {
  const auto description = describe_volume(volume_of({4, 2, 1}, {3, 3, 9, 0, 9, 0, 5, 3}));
  EXPECT_EQ(description.minimum, 0);
  EXPECT_EQ(description.maximum, 9);
  EXPECT_EQ(description.levels, 4U);
  EXPECT_EQ(description.possible_levels, 10);
  EXPECT_EQ(description.share_at_minimum, 0.25);
  EXPECT_EQ(description.share_of_zeros, 0.25);
  const auto hounsfield = describe_volume(volume_of({4, 1, 1}, {-1024, -1024, 0, 4}, VoxelType::int32));
  EXPECT_EQ(hounsfield.levels, 3U);
  EXPECT_EQ(hounsfield.possible_levels, 1029);
  EXPECT_EQ(hounsfield.share_at_minimum, 0.5);
  EXPECT_EQ(hounsfield.share_of_zeros, 0.25);
  const auto real = describe_volume(volume_of({4, 1, 1}, {0.5, 0.25, 0.5, 1e300}, VoxelType::float64));
  EXPECT_EQ(real.levels, 3U);
  EXPECT_FALSE(real.possible_levels.has_value());
  auto scaled = volume_of({2, 1, 1}, {-0.5, 2}, VoxelType::int16);
  scaled.slope = -0.25;
  EXPECT_EQ(describe_volume(scaled).possible_levels, 11);
}

TEST(VolumeDescribe, ConstantLayersFromEachFace) {
  Grid grid;
  grid.size = {6, 5, 4};
  grid.values.assign(120, 7);
  grid.values[grid.index(2, 1, 2)] = 8;
  grid.values[grid.index(3, 1, 2)] = 6;
  const auto description = describe_volume(volume_of(grid.size, grid.values));
  EXPECT_EQ(description.constant_layers[0], (std::array<std::int64_t, 2>{2, 2}));
  EXPECT_EQ(description.constant_layers[1], (std::array<std::int64_t, 2>{1, 3}));
  EXPECT_EQ(description.constant_layers[2], (std::array<std::int64_t, 2>{2, 1}));
  // Layers each of a value of its own, from either face.
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::int64_t k = 0; k < 4; ++k)
      for (std::int64_t j = 0; j < 5; ++j)
        for (std::int64_t i = 0; i < 6; ++i) {
          const std::int64_t layer = std::array{i, j, k}[axis];
          const bool is_mixed = layer == 1 && (i + j + k) % 2 == 0;
          grid.values[grid.index(i, j, k)] = static_cast<double>(is_mixed ? 100 : layer);
        }
    const auto of_layers = describe_volume(volume_of(grid.size, grid.values)).constant_layers;
    EXPECT_EQ(of_layers[axis], (std::array<std::int64_t, 2>{1, grid.size[axis] - 2}));
    EXPECT_EQ(of_layers[(axis + 1) % 3], (std::array<std::int64_t, 2>{0, 0}));
  }
  const auto constant = describe_volume(volume_of({3, 2, 1}, std::vector<double>(6, 1)));
  EXPECT_EQ(constant.constant_layers[0], (std::array<std::int64_t, 2>{3, 3}));
  EXPECT_EQ(constant.constant_layers[2], (std::array<std::int64_t, 2>{1, 1}));
}

TEST(VolumeRepair, PutsTheLostByteInFront) {
  auto volume = volume_of({2, 2, 1}, {1, 2, 3, 10});
  volume.lost_first_byte = true;
  auto repaired = volume;
  repair_first_byte(repaired);
  EXPECT_EQ(repaired.grid.values, (std::vector<double>{0, 1, 2, 3}));
  EXPECT_FALSE(repaired.lost_first_byte);
  repaired = volume;
  repair_first_byte(repaired, 212);
  EXPECT_EQ(repaired.grid.values, (std::vector<double>{212, 1, 2, 3}));
  volume.type = VoxelType::int8;
  volume.slope = 0.5;
  volume.intercept = 1;
  repair_first_byte(volume, 0xFE);
  EXPECT_EQ(volume.grid.values, (std::vector<double>{0, 1, 2, 3}));
}

TEST(VolumeRepair, RefusesWhatDidNotLoseAByte) {
  const auto refusal = [](Volume volume) -> std::string {
    try {
      repair_first_byte(volume);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  auto volume = volume_of({2, 1, 1}, {1, 10}, VoxelType::int16);
  EXPECT_EQ(refusal(volume),
            "some.nrrd: the voxels have the type int16; \"repair\": \"first_byte\" is allowed for 8-bit voxels");
  volume.type = VoxelType::uint8;
  EXPECT_EQ(refusal(volume),
            "some.nrrd: the last stored byte is not 0x0A; \"repair\": \"first_byte\" is allowed for a file that bears "
            "this sign");
}

}  // namespace
}  // namespace raytruth::test
