#include <fmt/format.h>
#include <fmt/ranges.h>

#include <bit>
#include <cstdint>
#include <string>
#include <type_traits>

#include "unit/volume/volume_files.hpp"

namespace raytruth::test {
namespace {

/// A NumPy file of version 1, 2 or 3, padded as NumPy pads it.
std::string npy(const std::string& header, std::string_view data, int version = 1) {
  std::string text = header;
  const std::size_t preamble = version == 1 ? 10 : 12;
  text.append(63 - (preamble + text.size()) % 64, ' ');
  text += '\n';
  std::string file = "\x93NUMPY" + std::string{static_cast<char>(version), '\0'};
  for (std::size_t byte = 0; byte < preamble - 8; ++byte)
    file += static_cast<char>(byte < sizeof(std::size_t) ? text.size() >> (8 * byte) & 0xFFU : 0);
  return file + text + std::string(data);
}

std::string header_of(const std::string& type, bool fortran, const std::string& shape) {
  return fmt::format("{{'descr': '{}', 'fortran_order': {}, 'shape': {}, }}", type, fortran ? "True" : "False", shape);
}

constexpr std::string_view twelve_bytes = "abcdefghijkl";

class VolumeNpy : public VolumeFiles {
 protected:
  [[nodiscard]] Volume read(const std::string& content, const VolumeChoices& choices = {}) const {
    return read_volume(write("v.npy", content), choices);
  }
  void refused(const std::string& header, std::string_view phrase) const {
    expect_refused(write("bad.npy", npy(header, twelve_bytes)), phrase);
  }
};

template <class T>
class VolumeNpyTypes : public VolumeNpy {};

using VoxelTypes = testing::Types<std::int8_t, std::uint8_t, std::int16_t, std::uint16_t, std::int32_t, std::uint32_t,
                                  std::int64_t, std::uint64_t, float, double>;
TYPED_TEST_SUITE(VolumeNpyTypes, VoxelTypes, );

TYPED_TEST(VolumeNpyTypes, BothEndiansAndBothOrders) {
  const char kind = std::is_floating_point_v<TypeParam> ? 'f' : std::is_signed_v<TypeParam> ? 'i' : 'u';
  const auto values = twelve_values<TypeParam>();  // array[z, y, x] of the shape (2, 2, 3)
  std::vector<TypeParam> in_fortran_order;
  for (std::size_t x = 0; x < 3; ++x)
    for (std::size_t y = 0; y < 2; ++y)
      for (std::size_t z = 0; z < 2; ++z) in_fortran_order.push_back(values[x + 3 * (y + 2 * z)]);
  for (const auto endian : {std::endian::little, std::endian::big}) {
    const auto type = fmt::format("{}{}{}", endian == std::endian::little ? '<' : '>', kind, sizeof(TypeParam));
    for (const bool fortran : {false, true}) {
      const auto data = stored<TypeParam>(fortran ? in_fortran_order : values, endian);
      for (const int version : {1, 2, 3}) {
        const auto volume = this->read(npy(header_of(type, fortran, "(2, 2, 3)"), data, version));
        EXPECT_EQ(volume.grid.values, as_double(values));
        EXPECT_EQ(volume.grid.size, (std::array<std::int64_t, 3>{3, 2, 2}));
        EXPECT_EQ(volume.grid.spacing, (std::array{1.0, 1.0, 1.0}));
        EXPECT_FALSE(volume.has_spacing);
        EXPECT_EQ(volume.format, "NPY");
        EXPECT_EQ(facts(volume.type).bytes, static_cast<int>(sizeof(TypeParam)));
        EXPECT_EQ(facts(volume.type).is_integer, std::is_integral_v<TypeParam>);
        EXPECT_EQ(volume.warnings.size(), (facts(volume.type).bytes == 8 && facts(volume.type).is_integer) ? 1U : 0U);
      }
    }
  }
}

TEST_F(VolumeNpy, ShapesSpacingAndSmallHeaders) {
  const auto volume = read(npy(header_of("|u1", false, "(1, 2, 1, 6, 1)"), twelve_bytes), {.spacing = {{0.5, 2, 3}}});
  EXPECT_EQ(volume.grid.values.size(), 12U);
  EXPECT_EQ(volume.grid.spacing, (std::array{0.5, 2.0, 3.0}));
  EXPECT_TRUE(volume.has_spacing);
  EXPECT_EQ(volume.warnings, std::vector<std::string>{});
  EXPECT_EQ(read(npy("{\"descr\":\"|b1\",\"fortran_order\":False,\"shape\":(2,2,3)}", std::string(12, '\1')))
                .grid.values.back(),
            1);
  EXPECT_TRUE(read(npy(header_of("|u1", false, "(2, 2, 3)"), "abcdefghijk\n")).lost_first_byte);
  EXPECT_FALSE(read(npy(header_of("|u1", true, "(2, 2, 3)"), "abcdefghijk\n")).lost_first_byte);
}

TEST_F(VolumeNpy, RefusesWhatIsNoVolume) {
  expect_refused(write("empty.npy", ""), "this is not a NumPy file");
  expect_refused(write("text.npy", std::string(500, 'x')), "this is not a NumPy file");
  expect_refused(write("new.npy", npy("{}", "", 4)), "the version is 4");
  refused("{}", "the header has no \"descr\"");
  refused("{'descr': '<f4', 'fortran_order': False}", "the header has no \"shape\"");
  refused(header_of("|O", false, "(2, 2, 3)"), "the type is '|O'");
  refused(header_of("<f2", false, "(2, 2, 3)"), "the type is '<f2'; numbers of 8 to 64 bits");
  refused(header_of("<c8", false, "(2, 2, 3)"), "the type is '<c8'");
  refused(header_of("f4", false, "(2, 2, 3)"), "the type is 'f4'");
  refused("{'descr': [('a', '<f4')], 'fortran_order': False, 'shape': (2, 2, 3)}", "the type is [('a'");
  refused("{'descr': '|u1', 'fortran_order': 0, 'shape': (2, 2, 3)}", "\"fortran_order\" is 0");
  refused(header_of("|u1", false, "(12,)"), "the array has 1 axes; three, (z, y, x), are allowed");
  refused(header_of("|u1", false, "()"), "the array has 0 axes");
  refused(header_of("|u1", false, "(2, 2, x)"), "\"shape\" is (2, 2, x");
  refused(header_of("|u1", false, "(2, 2, -3)"), "\"shape\" is (2, 2, -3");
  refused(header_of("|u1", false, "(2, 0, 3)"), "sizes >= 1");
  refused(header_of("|u1", false, "(4294967296, 4294967296, 12)"), "at most 2^33 voxels");
  refused(header_of("|u1", false, "(2, 2, 3, 2)"), "three axes are allowed");
  refused(header_of("|u1", false, "(2, 2, 4)"),
          "can hold no more than 12 bytes of data; the header announces 16 voxels");
  const auto whole = npy(header_of("|u1", false, "(2, 2, 3)"), twelve_bytes);
  for (std::size_t length = 0; length < whole.size(); ++length) {
    SCOPED_TRACE(length);
    expect_refused(write("short.npy", whole.substr(0, length)), "");
  }
}

}  // namespace
}  // namespace raytruth::test
