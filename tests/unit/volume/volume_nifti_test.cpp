#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <map>

#include "unit/volume/volume_files.hpp"

namespace raytruth::test {
namespace {

/// The fields of a header, written at their places in the format's definition (nifti1.h); the tests change one or two.
struct NiftiFields {
  std::endian endian = std::endian::little;
  std::int32_t sizeof_hdr = 348;
  std::array<std::int16_t, 8> dim{3, 3, 2, 2, 1, 1, 1, 1};
  std::int16_t datatype = 2;
  std::int16_t bitpix = 8;
  std::array<float, 8> pixdim{1, 1, 1, 1, 0, 0, 0, 0};
  float vox_offset = 352;
  float scl_slope = 0;
  float scl_inter = 0;
  std::string magic{"n+1\0", 4};

  [[nodiscard]] std::string header() const {
    std::string bytes(348, '\0');
    const auto put = [&](std::size_t place, auto values) {
      using Number = typename decltype(values)::value_type;
      const auto text = stored<Number>(std::span<const Number>(values), endian);
      bytes.replace(place, text.size(), text);
    };
    put(0, std::array{sizeof_hdr});
    put(40, dim);
    put(70, std::array{datatype, bitpix});
    put(76, pixdim);
    put(108, std::array{vox_offset, scl_slope, scl_inter});
    bytes.replace(344, 4, magic);
    return bytes;
  }

  /// One file: header, no extension, data.
  [[nodiscard]] std::string with(std::string_view data) const {
    return header() + std::string(4, '\0') + std::string(data);
  }
};

constexpr std::string_view twelve_bytes = "abcdefghijkl";

NiftiFields two_files() { return {.vox_offset = 0, .magic = std::string("ni1\0", 4)}; }

class VolumeNifti : public VolumeFiles {
 protected:
  [[nodiscard]] Volume read(std::string_view content, const std::string& name = "v.nii") const {
    return read_volume(write(name, content));
  }
  void refused(const NiftiFields& fields, std::string_view phrase) const {
    expect_refused(write("bad.nii", fields.with(twelve_bytes)), phrase);
    expect_refused(write("bad.nii.gz", gzip(fields.with(twelve_bytes))), phrase);
  }
};

template <class T>
struct Code;
template <>
struct Code<std::uint8_t> {
  static constexpr std::int16_t number = 2;
};
template <>
struct Code<std::int16_t> {
  static constexpr std::int16_t number = 4;
};
template <>
struct Code<std::int32_t> {
  static constexpr std::int16_t number = 8;
};
template <>
struct Code<float> {
  static constexpr std::int16_t number = 16;
};
template <>
struct Code<double> {
  static constexpr std::int16_t number = 64;
};
template <>
struct Code<std::int8_t> {
  static constexpr std::int16_t number = 256;
};
template <>
struct Code<std::uint16_t> {
  static constexpr std::int16_t number = 512;
};
template <>
struct Code<std::uint32_t> {
  static constexpr std::int16_t number = 768;
};
template <>
struct Code<std::int64_t> {
  static constexpr std::int16_t number = 1024;
};
template <>
struct Code<std::uint64_t> {
  static constexpr std::int16_t number = 1280;
};

template <class T>
class VolumeNiftiTypes : public VolumeNifti {};

using VoxelTypes = testing::Types<std::int8_t, std::uint8_t, std::int16_t, std::uint16_t, std::int32_t, std::uint32_t,
                                  std::int64_t, std::uint64_t, float, double>;
TYPED_TEST_SUITE(VolumeNiftiTypes, VoxelTypes, );

TYPED_TEST(VolumeNiftiTypes, BothEndiansPlainAndGzipOneFileAndTwo) {
  const auto values = twelve_values<TypeParam>();
  for (const auto endian : {std::endian::little, std::endian::big}) {
    const auto data = stored<TypeParam>(values, endian);
    auto one = NiftiFields{.endian = endian, .datatype = Code<TypeParam>::number, .bitpix = 8 * sizeof(TypeParam)};
    auto two = two_files();
    two.endian = endian;
    two.datatype = one.datatype;
    two.bitpix = one.bitpix;
    (void)this->write("a.img", data);
    (void)this->write("b.img.gz", gzip(data));
    for (const auto& volume : {this->read(one.with(data)), this->read(gzip(one.with(data)), "v.nii.gz"),
                               this->read(two.header(), "a.hdr"), this->read(two.header(), "b.hdr")}) {
      SCOPED_TRACE(volume.file);
      EXPECT_EQ(volume.grid.values, as_double(values));
      EXPECT_EQ(volume.grid.size, (std::array<std::int64_t, 3>{3, 2, 2}));
      EXPECT_EQ(volume.grid.spacing, (std::array<double, 3>{1, 1, 1}));
      EXPECT_EQ(volume.format, "NIfTI-1");
      EXPECT_EQ(facts(volume.type).bytes, static_cast<int>(sizeof(TypeParam)));
      EXPECT_EQ(facts(volume.type).is_integer, std::is_integral_v<TypeParam>);
      EXPECT_EQ(facts(volume.type).is_signed, std::is_signed_v<TypeParam>);
      EXPECT_EQ(volume.endian, endian);
    }
  }
}

TEST_F(VolumeNifti, SlopeAndInterceptGivePhysicalUnits) {
  const auto scaled = read(NiftiFields{.scl_slope = 0.5F, .scl_inter = -3}.with(twelve_bytes));
  EXPECT_EQ(scaled.slope, 0.5);
  EXPECT_EQ(scaled.intercept, -3);
  EXPECT_EQ(scaled.grid.values.front(), 0.5 * 'a' - 3);
  EXPECT_EQ(scaled.grid.values.back(), 0.5 * 'l' - 3);
  const auto big_endian =
      read(NiftiFields{.endian = std::endian::big, .scl_slope = -2, .scl_inter = 7}.with(twelve_bytes));
  EXPECT_EQ(big_endian.grid.values.front(), -2.0 * 'a' + 7);
  const auto slope_0 = read(NiftiFields{.scl_inter = 7}.with(twelve_bytes));
  EXPECT_EQ(slope_0.grid.values.front(), 'a');
  EXPECT_EQ(slope_0.slope, 1);
  EXPECT_EQ(slope_0.intercept, 0);
}

TEST_F(VolumeNifti, SpacingAndExtraAxes) {
  const auto volume = read(
      NiftiFields{.dim = {5, 3, 1, 2, 1, 2, 0, -1}, .pixdim = {-1, 0.5F, 9, 2, 7, 1.25F, 0, 0}}.with(twelve_bytes));
  EXPECT_EQ(volume.grid.size, (std::array<std::int64_t, 3>{3, 2, 2}));
  EXPECT_EQ(volume.grid.spacing, (std::array{0.5, 2.0, 1.25}));
  const auto flat = read(NiftiFields{.dim = {4, 12, 1, 1, 1, 1, 1, 1}}.with(twelve_bytes));
  EXPECT_EQ(flat.grid.size, (std::array<std::int64_t, 3>{12, 1, 1}));
}

TEST_F(VolumeNifti, ExtensionsBeforeTheDataArePassedOver) {
  const NiftiFields fields{.vox_offset = 384};
  const auto content =
      fields.header() + std::string("\1\0\0\0", 4) + std::string(32, '\xff') + std::string(twelve_bytes);
  EXPECT_EQ(read(content).grid.values.front(), 'a');
  EXPECT_EQ(read(gzip(content), "v.nii.gz").grid.values.front(), 'a');
}

TEST_F(VolumeNifti, LastByteThatLooksLikeANewline) {
  EXPECT_TRUE(read(NiftiFields{.scl_slope = 2}.with("abcdefghijk\n")).lost_first_byte);
  EXPECT_FALSE(read(NiftiFields{}.with(twelve_bytes)).lost_first_byte);
}

TEST_F(VolumeNifti, RefusesFilesThatAreNone) {
  expect_refused(folder() / "missing.nii", "no such file");
  expect_refused(folder() / "missing.nii.gz", "no such file");
  std::filesystem::create_directory(folder() / "folder.nii");
  expect_refused(folder() / "folder.nii", "not a regular file");
  expect_refused(write("empty.nii", ""), "the file ends after 0 bytes; a NIfTI-1 header has 348");
  expect_refused(write("empty.nii.gz", ""), "");
  expect_refused(write("plain.nii.gz", NiftiFields{}.with(twelve_bytes)),
                 "the gzip data are damaged: incorrect header check");
  expect_refused(write("packed.nii", gzip(std::string(5000, 'x'))), "");
  expect_refused(write("text.nii", std::string(400, 'x')), "this is not NIfTI; NIfTI-1 is allowed");
  expect_refused(write("two.nii", NiftiFields{.sizeof_hdr = 540}.with(twelve_bytes)), "this is NIfTI-2");
  expect_refused(write("nrrd.nii", "NRRD0004\ntype: uint8\n"), "a NIfTI-1 header has 348");
}

TEST_F(VolumeNifti, RefusesEveryTruncation) {
  const auto whole = NiftiFields{}.with(twelve_bytes);
  for (std::size_t length = 0; length < whole.size(); ++length) {
    SCOPED_TRACE(length);
    expect_refused(write("v.nii", whole.substr(0, length)), "");
    expect_refused(write("v.nii.gz", gzip(whole.substr(0, length))), "");
  }
  expect_refused(write("v.nii", whole.substr(0, whole.size() - 1)),
                 "can hold no more than 11 bytes of data; the header announces 12");
  expect_refused(write("v.nii.gz", gzip(whole.substr(0, whole.size() - 1))),
                 "the data end after 11 bytes; the header announces 12");
  const auto packed = gzip(whole);
  for (std::size_t length = 0; length < packed.size(); ++length) {
    SCOPED_TRACE(length);
    expect_refused(write("v.nii.gz", packed.substr(0, length)), "");
  }
  expect_refused(write("v.nii", whole + "m"), "the data go on after 12 bytes");
  expect_refused(write("v.nii.gz", gzip(whole + "m")), "the data go on after 12 bytes");
}

TEST_F(VolumeNifti, RefusesDamagedGzipData) {
  auto packed = gzip(NiftiFields{}.with(twelve_bytes));
  packed[packed.size() - 8] = static_cast<char>(packed[packed.size() - 8] ^ 1);
  expect_refused(write("v.nii.gz", packed), "incorrect data check");
}

TEST_F(VolumeNifti, RefusesTypesThatAreNoNumbers) {
  const std::map<std::int16_t, std::int16_t> bits_of_type{{0, 0},      {1, 1},      {32, 64},   {128, 24}, {1536, 128},
                                                          {1792, 128}, {2048, 256}, {2304, 32}, {-2, 8},   {7, 8}};
  for (const auto& [datatype, bitpix] : bits_of_type) {
    refused(NiftiFields{.datatype = datatype, .bitpix = bitpix}, fmt::format("the datatype is {} (", datatype));
  }
  refused(NiftiFields{.datatype = 4, .bitpix = 8}, "bitpix is 8; 16 is allowed for int16");
}

TEST_F(VolumeNifti, RefusesImpossibleSizes) {
  const std::string three_axes = "three axes are allowed, and further ones of size 1";
  refused(NiftiFields{.dim = {2, 3, 4, 1, 1, 1, 1, 1}}, "the sizes are 3 x 4; " + three_axes);
  refused(NiftiFields{.dim = {4, 3, 2, 2, 2, 1, 1, 1}}, "the sizes are 3 x 2 x 2 x 2; " + three_axes);
  refused(NiftiFields{.dim = {0, 3, 2, 2, 1, 1, 1, 1}}, "dim[0], the number of axes, is 0");
  refused(NiftiFields{.dim = {8, 3, 2, 2, 1, 1, 1, 1}}, "dim[0], the number of axes, is 8");
  refused(NiftiFields{.dim = {-3, 3, 2, 2, 1, 1, 1, 1}}, "dim[0], the number of axes, is -3");
  refused(NiftiFields{.dim = {3, 0, 2, 2, 1, 1, 1, 1}}, "the size dim[1] is 0");
  refused(NiftiFields{.dim = {3, -3, -2, 2, 1, 1, 1, 1}}, "the size dim[1] is -3");
  refused(NiftiFields{.dim = {7, 3, 2, 2, 1, 1, 1, 0}}, "the size dim[7] is 0");
  refused(NiftiFields{.dim = {3, 32767, 32767, 32767, 1, 1, 1, 1}}, "at most 2^33 voxels are allowed");  // 2^45
  refused(NiftiFields{.dim = {7, 32767, 32767, 32767, 32767, 32767, 32767, 32767}},
          "at most 2^33 voxels are allowed");                                                                // 2^105
  refused(NiftiFields{.dim = {3, 2048, 2048, 1024, 1, 1, 1, 1}}, "the header announces 4294967296 voxels");  // 2^32
}

TEST_F(VolumeNifti, RefusesImpossibleNumbers) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (const float bad : {0.0F, -1.0F, nan, infinity}) {
    refused(NiftiFields{.pixdim = {1, 1, bad, 1, 0, 0, 0, 0}}, "the spacing of axis 1 is ");
  }
  for (const float bad : {nan, infinity}) {
    refused(NiftiFields{.scl_slope = bad}, "scl_slope is ");
    refused(NiftiFields{.scl_slope = 1, .scl_inter = bad}, "scl_inter is ");
  }
  for (const float bad : {0.0F, -352.0F, 348.0F, 352.5F, nan, infinity, 1e30F}) {
    refused(NiftiFields{.vox_offset = bad}, "vox_offset is ");
  }
  refused(NiftiFields{.vox_offset = 8e15F}, "");
  refused(NiftiFields{.vox_offset = 353}, "");
  refused(NiftiFields{.magic = std::string("n+2\0", 4)}, "the magic is \"n+2\"");
  refused(NiftiFields{.magic = std::string(4, '\0')}, "the magic is \"\"");
  refused(NiftiFields{.magic = std::string("ni1\0", 4)}, "the magic is \"ni1\"");
  refused(NiftiFields{.magic = "\n%s\xff"}, "the magic is \"\\n%s");
}

TEST_F(VolumeNifti, RefusesValuesThatAreNotFinite) {
  auto values = twelve_values<double>();
  values[1] = 0;
  values[0] = 0;
  const NiftiFields fields{.datatype = 64, .bitpix = 64};
  EXPECT_NO_THROW((void)read(fields.with(stored<double>(values, std::endian::little))));
  values[11] = std::numeric_limits<double>::quiet_NaN();
  expect_refused(write("v.nii", fields.with(stored<double>(values, std::endian::little))), "voxel (2, 1, 1) is nan");
  values[11] = 1e308;
  auto scaled = fields;
  scaled.scl_slope = 100;
  expect_refused(write("v.nii", scaled.with(stored<double>(values, std::endian::little))), "voxel (2, 1, 1) is inf");
}

TEST_F(VolumeNifti, RefusesBadDataBesideTheHeader) {
  expect_refused(write("alone.hdr", two_files().header()), "no such file", "alone.img");
  (void)write("short.img", twelve_bytes.substr(1));
  expect_refused(write("short.hdr", two_files().header()), "can hold no more than 11 bytes", "short.img");
  (void)write("long.img", std::string(twelve_bytes) + "\n");
  expect_refused(write("long.hdr", two_files().header()), "the data go on after 12 bytes", "long.img");
  (void)write("v.img", twelve_bytes);
  expect_refused(write("v.hdr", NiftiFields{}.header()), "the magic is \"n+1\"");
  expect_refused(folder() / "v.img", "name does not tell the format");
}

}  // namespace
}  // namespace raytruth::test
