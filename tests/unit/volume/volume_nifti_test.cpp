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
  char xyzt_units = 0;
  std::int16_t sform_code = 0;
  std::array<float, 12> sform{};
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
    bytes[123] = xyzt_units;
    put(254, std::array{sform_code});
    put(280, sform);
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
      NiftiFields{.dim = {5, 3, 2, 2, 1, 1, 0, -1}, .pixdim = {-1, 0.5F, 2, 1.25F, 7, 9, 0, 0}}.with(twelve_bytes));
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
  expect_refused(write("empty.nii", ""), "the file ends after 0 bytes; a NIfTI header has 348 or 540");
  expect_refused(write("empty.nii.gz", ""), "");
  expect_refused(write("packed.nii", gzip(std::string(5000, 'x'))), "");
  expect_refused(write("text.nii", std::string(400, 'x')), "this is not NIfTI; NIfTI is allowed");
  expect_refused(write("two.nii", NiftiFields{.sizeof_hdr = 540}.with(twelve_bytes)),
                 "the file ends after 364 bytes; a header of NIfTI-2 has 540");
  expect_refused(write("nrrd.nii", "NRRD0004\ntype: uint8\n"), "a NIfTI header has 348 or 540");
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
}

TEST_F(VolumeNifti, WarnsOfBytesBehindTheData) {
  const auto whole = NiftiFields{}.with(twelve_bytes);
  const std::string warning = "the header announces 12 bytes of data; the 3 bytes behind them are not read";
  for (const auto& volume : {read(whole + "mno"), read(gzip(whole + "mno"), "v.nii.gz")}) {
    EXPECT_EQ(volume.grid.values.back(), 'l');
    EXPECT_EQ(volume.warnings, std::vector{warning});
  }
  for (const std::string& padding : {std::string(1, '\0'), std::string(100000, '\0')})
    EXPECT_EQ(read(gzip(whole) + padding, "v.nii.gz").warnings, std::vector<std::string>{});
  for (const std::string& behind : {std::string("\0\0more", 6), std::string("\x1f"), std::string(70000, 'x')}) {
    const auto volume = read(gzip(whole) + behind, "v.nii.gz");
    EXPECT_EQ(volume.grid.values.back(), 'l');
    const auto ignored = behind.size() - (behind.front() == '\0' ? 2 : 0);
    EXPECT_EQ(volume.warnings, std::vector{fmt::format(
                                   "the {} bytes behind the gzip data are no such data, and are not read", ignored)});
  }
  const auto half = whole.size() / 2;
  EXPECT_EQ(
      read(gzip(whole.substr(0, half)) + std::string(512, '\0') + gzip(whole.substr(half)), "v.nii.gz").grid.values,
      read(whole).grid.values);
}

TEST_F(VolumeNifti, BytesTellWhetherTheyAreGzip) {
  const auto whole = NiftiFields{}.with(twelve_bytes);
  const auto plain = read(whole, "v.nii.gz");
  EXPECT_EQ(plain.grid.values, read(whole).grid.values);
  EXPECT_EQ(plain.encoding, Encoding::raw);
  EXPECT_EQ(plain.warnings,
            std::vector<std::string>{"the name says gzip, and the bytes are not; they are read as they are"});
  const auto packed = read(gzip(whole));
  EXPECT_EQ(packed.grid.values, plain.grid.values);
  EXPECT_EQ(packed.encoding, Encoding::gzip);
  EXPECT_EQ(packed.warnings,
            std::vector<std::string>{"the bytes are gzip, and the name does not say so; they are inflated"});
}

TEST_F(VolumeNifti, NamesInUpperCase) {
  const auto expected = read(NiftiFields{}.with(twelve_bytes)).grid.values;
  EXPECT_EQ(read(NiftiFields{}.with(twelve_bytes), "V.NII").grid.values, expected);
  EXPECT_EQ(read(gzip(NiftiFields{}.with(twelve_bytes)), "W.NII.GZ").grid.values, expected);
  (void)write("A.IMG", twelve_bytes);
  EXPECT_EQ(read(two_files().header(), "A.HDR").grid.values, expected);
  (void)write("b.img", twelve_bytes);
  EXPECT_EQ(read(two_files().header(), "b.HDR").grid.values, expected);
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
  const auto other_bits = read(NiftiFields{.bitpix = 16}.with(twelve_bytes));
  EXPECT_EQ(other_bits.grid.values.back(), 'l');
  EXPECT_EQ(other_bits.warnings,
            std::vector<std::string>{"bitpix is 16; the datatype uint8 says 8, as libnifti and nibabel have it"});
}

TEST_F(VolumeNifti, RefusesImpossibleSizes) {
  const std::string three_axes = "three axes are allowed, and further ones of size 1";
  refused(NiftiFields{.dim = {2, 3, 4, 1, 1, 1, 1, 1}}, "the sizes are 3 x 4; " + three_axes);
  refused(NiftiFields{.dim = {0, 3, 2, 2, 1, 1, 1, 1}}, "dim[0], the number of axes, is 0");
  refused(NiftiFields{.dim = {8, 3, 2, 2, 1, 1, 1, 1}}, "dim[0], the number of axes, is 8");
  refused(NiftiFields{.dim = {-3, 3, 2, 2, 1, 1, 1, 1}}, "dim[0], the number of axes, is -3");
  refused(NiftiFields{.dim = {3, 0, 2, 2, 1, 1, 1, 1}}, "the size dim[1] is 0");
  refused(NiftiFields{.dim = {3, -3, -2, 2, 1, 1, 1, 1}}, "the size dim[1] is -3");
  refused(NiftiFields{.dim = {7, 3, 2, 2, 1, 1, 1, -1}}, "the size dim[7] is -1");
  EXPECT_EQ(read(NiftiFields{.dim = {7, 3, 2, 2, 1, 1, 1, 0}}.with(twelve_bytes)).warnings,
            std::vector<std::string>{"the size dim[7] is 0; 1 is taken, as libnifti does"});
  refused(NiftiFields{.dim = {3, 32767, 32767, 32767, 1, 1, 1, 1}}, "at most 2^33 voxels are allowed");  // 2^45
  refused(NiftiFields{.dim = {7, 32767, 32767, 32767, 32767, 32767, 32767, 32767}},
          "at most 2^33 voxels are allowed");                                                                // 2^105
  refused(NiftiFields{.dim = {3, 2048, 2048, 1024, 1, 1, 1, 1}}, "the header announces 4294967296 voxels");  // 2^32
}

TEST_F(VolumeNifti, RefusesImpossibleNumbers) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  constexpr float infinity = std::numeric_limits<float>::infinity();
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

TEST_F(VolumeNifti, MendsNumbersAsLibniftiDoes) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const auto only_warning = [](const Volume& volume) {
    EXPECT_EQ(volume.warnings.size(), 1U);
    return volume.warnings.empty() ? "" : volume.warnings.front();
  };
  for (const float bad : {0.0F, nan, infinity}) {
    const auto volume = read(NiftiFields{.pixdim = {1, 2, bad, 3, 0, 0, 0, 0}}.with(twelve_bytes));
    EXPECT_EQ(volume.grid.spacing, (std::array{2.0, 1.0, 3.0}));
    EXPECT_EQ(only_warning(volume), fmt::format("pixdim[2] is {}; 1 is taken, as libnifti does", bad));
  }
  const auto backwards = read(NiftiFields{.pixdim = {1, 2, -0.5F, 3, 0, 0, 0, 0}}.with(twelve_bytes));
  EXPECT_EQ(backwards.grid.spacing, (std::array{2.0, 0.5, 3.0}));
  EXPECT_EQ(backwards.grid.values.front(), 'a');
  EXPECT_NE(only_warning(backwards).find("the spacing of axis 1 is -0.5"), std::string::npos);
  for (const float bad : {nan, infinity}) {
    const auto unscaled = read(NiftiFields{.scl_slope = bad, .scl_inter = 7}.with(twelve_bytes));
    EXPECT_EQ(unscaled.grid.values.front(), 'a');
    EXPECT_NE(only_warning(unscaled).find("the voxels are read unscaled"), std::string::npos);
    const auto without_intercept = read(NiftiFields{.scl_slope = 2, .scl_inter = bad}.with(twelve_bytes));
    EXPECT_EQ(without_intercept.grid.values.front(), 2 * 'a');
    EXPECT_NE(only_warning(without_intercept).find("0 is taken"), std::string::npos);
  }
}

TEST_F(VolumeNifti, TheFourthAxisIsTime) {
  const NiftiFields fields{
      .dim = {4, 3, 2, 1, 2, 1, 1, 1}, .pixdim = {1, 1, 2, 3, 2500, 0, 0, 0}, .xyzt_units = 2 + 16};
  const auto file = write("time.nii", fields.with(twelve_bytes));
  expect_refused(file, "axis 4 is time, 2 steps of 2500 ms; one volume is allowed: --time-step N, or \"time_step\": N");
  for (const std::int64_t step : {0, 1}) {
    const auto volume = read_volume(file, {.time_step = step});
    EXPECT_EQ(volume.grid.size, (std::array<std::int64_t, 3>{3, 2, 1}));
    EXPECT_EQ(volume.grid.spacing, (std::array{1.0, 2.0, 3.0}));
    EXPECT_EQ(volume.grid.values.front(), step == 0 ? 'a' : 'g');
    EXPECT_EQ(volume.grid.values.size(), 6U);
  }
  expect_refused(file, "the time step 2 is asked for; 0 to 1 are allowed", {}, {.time_step = 2});
  const auto alone = write("alone.nii", NiftiFields{.dim = {4, 3, 2, 2, 1, 1, 1, 1}}.with(twelve_bytes));
  EXPECT_EQ(read_volume(alone, {.time_step = 0}).grid.values.size(), 12U);
  expect_refused(alone, "the time step 1 is asked for; the file holds one volume: 0 is allowed", {}, {.time_step = 1});
  refused(NiftiFields{.dim = {5, 3, 2, 1, 1, 2, 1, 1}}, "axis 5 holds 2 numbers for each voxel");
  expect_refused(write("both.nii", NiftiFields{.dim = {5, 3, 1, 1, 2, 2, 1, 1}}.with(twelve_bytes)),
                 "axis 5 holds 2 numbers for each voxel", {}, {.time_step = 0});
}

TEST_F(VolumeNifti, SformThatDisagrees) {
  NiftiFields fields{.pixdim = {1, 1, 2, 3, 0, 0, 0, 0}, .sform_code = 1};
  fields.sform = {0, -2, 0, 9, 1, 0, 0, 9, 0, 0, 3, 9};  // a rotation
  EXPECT_EQ(read(fields.with(twelve_bytes)).warnings, std::vector<std::string>{});
  fields.sform = {1, 0, 0, 9, 0, 2, 0, 9, 0, 0, 1.5F, 9};
  const auto other = read(fields.with(twelve_bytes));
  EXPECT_EQ(other.grid.spacing, (std::array{1.0, 2.0, 3.0}));
  EXPECT_EQ(other.warnings,
            std::vector<std::string>{"pixdim states the spacing 1 2 3, and the sform 1 2 1.5; the first is taken"});
  fields.sform = {0, -1.2F, 0, 9, 1, 1.6F, 0, 9, 0, 0, 3, 9};
  EXPECT_EQ(
      read(fields.with(twelve_bytes)).warnings,
      std::vector<std::string>{
          "the axes of the sform are sheared, two of them meet at 36.9 degrees; a grid of right angles is taken"});
  fields.sform_code = 0;
  EXPECT_EQ(read(fields.with(twelve_bytes)).warnings, std::vector<std::string>{});
}

TEST_F(VolumeNifti, Version2InBothOrdersOfBytes) {
  for (const auto endian : {std::endian::little, std::endian::big}) {
    std::string bytes(544, '\0');
    const auto put = [&](std::size_t place, auto values) {
      using Number = typename decltype(values)::value_type;
      const auto text = stored<Number>(std::span<const Number>(values), endian);
      bytes.replace(place, text.size(), text);
    };
    // The places of nifti2.h.
    put(0, std::array<std::int32_t, 1>{540});
    bytes.replace(4, 8, std::string("n+2\0\r\n\x1a\n", 8));
    put(12, std::array<std::int16_t, 2>{512, 16});
    put(16, std::array<std::int64_t, 8>{3, 3, 2, 2, 1, 1, 1, 1});
    put(104, std::array<double, 8>{1, 0.1, 0.2, 0.3, 0, 0, 0, 0});
    put(168, std::array<std::int64_t, 1>{544});
    put(176, std::array<double, 2>{0.5, -3});
    const auto values = twelve_values<std::uint16_t>();
    const auto whole = bytes + stored<std::uint16_t>(values, endian);
    for (const auto& volume : {read(whole), read(gzip(whole), "v.nii.gz")}) {
      EXPECT_EQ(volume.format, "NIfTI-2");
      EXPECT_EQ(volume.endian, endian);
      EXPECT_EQ(volume.grid.spacing, (std::array{0.1, 0.2, 0.3}));
      EXPECT_EQ(volume.grid.size, (std::array<std::int64_t, 3>{3, 2, 2}));
      for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(volume.grid.values[i], 0.5 * values[i] - 3);
      EXPECT_EQ(volume.warnings, std::vector<std::string>{});
    }
  }
}

TEST_F(VolumeNifti, RefusesValuesThatAreNotFinite) {
  auto values = twelve_values<double>();
  values[1] = 0;
  values[0] = 0;
  const NiftiFields fields{.datatype = 64, .bitpix = 64};
  EXPECT_NO_THROW((void)read(fields.with(stored<double>(values, std::endian::little))));
  values[11] = std::numeric_limits<double>::quiet_NaN();
  expect_refused(write("v.nii", fields.with(stored<double>(values, std::endian::little))),
                 "1 of 12 voxels are NaN, the first is voxel (2, 1, 1); only finite");
  values[11] = 1e308;
  auto scaled = fields;
  scaled.scl_slope = 100;
  expect_refused(write("v.nii", scaled.with(stored<double>(values, std::endian::little))),
                 "1 of 12 voxels are infinite, the first is voxel (2, 1, 1)");
}

TEST_F(VolumeNifti, RefusesBadDataBesideTheHeader) {
  expect_refused(write("alone.hdr", two_files().header()), "no such file", "alone.img");
  (void)write("short.img", twelve_bytes.substr(1));
  expect_refused(write("short.hdr", two_files().header()), "can hold no more than 11 bytes", "short.img");
  (void)write("long.img", std::string(twelve_bytes) + "\n");
  EXPECT_EQ(read(two_files().header(), "long.hdr").warnings,
            std::vector<std::string>{"the header announces 12 bytes of data; the 1 bytes behind them are not read"});
  (void)write("v.img", twelve_bytes);
  expect_refused(write("v.hdr", NiftiFields{}.header()), "the magic is \"n+1\"");
  expect_refused(folder() / "v.img", "neither the name nor the first bytes tell the format");
}

}  // namespace
}  // namespace raytruth::test
