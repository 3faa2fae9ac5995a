#include <fmt/format.h>
#include <sys/stat.h>

#include <cstdint>
#include <limits>

#include "unit/volume/volume_files.hpp"

namespace raytruth::test {
namespace {

/// The fields of a header; the tests change one or two of them.
struct NrrdFields {
  std::string magic = "NRRD0004";
  std::string type = "uint8";
  std::string dimension = "3";
  std::string sizes = "3 2 2";
  std::string encoding = "raw";
  std::string endian = "little";
  std::string more = "# whole lines\n";

  [[nodiscard]] std::string header() const {
    return fmt::format("{}\ntype: {}\ndimension: {}\nsizes: {}\nencoding: {}\nendian: {}\n{}", magic, type, dimension,
                       sizes, encoding, endian, more);
  }
  [[nodiscard]] std::string attached(std::string_view data) const { return header() + "\n" + std::string(data); }
};

constexpr std::string_view twelve_bytes = "abcdefghijkl";

class VolumeNrrd : public VolumeFiles {
 protected:
  [[nodiscard]] Volume read(std::string_view content, const std::string& name = "v.nrrd") const {
    return read_volume(write(name, content));
  }
  void refused(std::string_view content, std::string_view phrase) const {
    expect_refused(write("bad.nrrd", content), phrase);
  }
};

std::vector<double> letters(std::string_view text) { return {text.begin(), text.end()}; }

template <class T>
class VolumeNrrdTypes : public VolumeNrrd {};

using VoxelTypes = testing::Types<std::int8_t, std::uint8_t, std::int16_t, std::uint16_t, std::int32_t, std::uint32_t,
                                  std::int64_t, std::uint64_t, float, double>;
TYPED_TEST_SUITE(VolumeNrrdTypes, VoxelTypes, );

std::string type_name(VoxelType type) {
  if (type == VoxelType::float32) return "float";
  if (type == VoxelType::float64) return "double";
  return std::string(facts(type).name);
}

template <class T>
constexpr VoxelType voxel_type() {
  if constexpr (std::is_same_v<T, float>) return VoxelType::float32;
  if constexpr (std::is_same_v<T, double>) return VoxelType::float64;
  constexpr int width = std::countr_zero(sizeof(T));
  return static_cast<VoxelType>(2 * width + (std::is_signed_v<T> ? 0 : 1));
}

TYPED_TEST(VolumeNrrdTypes, BothEndiansAllEncodingsAttachedAndDetached) {
  const auto values = twelve_values<TypeParam>();
  constexpr auto type = voxel_type<TypeParam>();
  for (const auto endian : {std::endian::little, std::endian::big}) {
    for (const std::string encoding : {"raw", "gzip", "ascii"}) {
      auto data = stored<TypeParam>(values, endian);
      if (encoding == "gzip") data = gzip(data);
      if (encoding == "ascii") {
        data.clear();
        for (const auto value : values) data += fmt::format("{} ", value);
      }
      NrrdFields fields{
          .type = type_name(type), .encoding = encoding, .endian = endian == std::endian::little ? "little" : "big"};
      const auto attached = this->read(fields.attached(data));
      fields.more = "data file: v.data\n";
      (void)this->write("v.data", data);
      const auto detached = this->read(fields.header(), "v.nhdr");
      for (const auto& volume : {attached, detached}) {
        SCOPED_TRACE(fields.header());
        EXPECT_EQ(volume.grid.values, as_double(values));
        EXPECT_EQ(volume.grid.size, (std::array<std::int64_t, 3>{3, 2, 2}));
        EXPECT_EQ(volume.grid.spacing, (std::array<double, 3>{1, 1, 1}));
        EXPECT_EQ(volume.format, "NRRD");
        EXPECT_EQ(volume.type, type);
        EXPECT_EQ(name(volume.encoding), encoding);
        EXPECT_EQ(volume.endian, endian);
        EXPECT_EQ(volume.slope, 1);
        EXPECT_EQ(volume.intercept, 0);
        EXPECT_FALSE(volume.lost_first_byte);
      }
    }
  }
}

TEST_F(VolumeNrrd, OtherNamesOfTypesEncodingsAndFields) {
  const auto expected = letters(twelve_bytes);
  for (const std::string type : {"unsigned char", "uchar", "uint8_t", "signed char", "int8"}) {
    EXPECT_EQ(read(NrrdFields{.type = type}.attached(twelve_bytes)).grid.values, expected) << type;
  }
  EXPECT_EQ(read(NrrdFields{.encoding = "gz"}.attached(gzip(twelve_bytes))).grid.values, expected);
  EXPECT_EQ(read(NrrdFields{.encoding = "txt"}.attached("1 2 3 4 5 6 7 8 9 10 11 12")).grid.values.back(), 12);
  for (const std::string magic :
       {"NRRD00.01", "NRRD0001", "NRRD0002", "NRRD0003", "NRRD0004", "NRRD0005", "NRRD0006"}) {
    EXPECT_EQ(read(NrrdFields{.magic = magic}.attached(twelve_bytes)).grid.values, expected) << magic;
  }
  (void)write("v.raw", twelve_bytes);
  EXPECT_EQ(read(NrrdFields{.more = "datafile: v.raw\n"}.header()).grid.values, expected);
}

TEST_F(VolumeNrrd, EndianIsNotNeededForBytes) {
  const std::string header = "NRRD0001\ntype: uchar\ndimension: 3\nsizes: 3 2 2\nencoding: raw\n\n";
  EXPECT_EQ(read(header + std::string(twelve_bytes)).grid.values, letters(twelve_bytes));
}

TEST_F(VolumeNrrd, FieldsThatSayNothingAboutVoxels) {
  const NrrdFields fields{.more =
                              "# a comment\ncontent: %s%n%s\nkey:=value: with \"all\" %n\nlabels: \"x\" \"y\" \"z\"\n"
                              "min: 3\nold min: 0\nnumber: 12\ncenters: cell cell cell\n"};
  EXPECT_EQ(read(fields.attached(twelve_bytes)).grid.values, letters(twelve_bytes));
}

TEST_F(VolumeNrrd, CarriageReturns) {
  std::string content;
  for (const char character : NrrdFields{}.attached(""))
    content += character == '\n' ? "\r\n" : std::string(1, character);
  EXPECT_EQ(read(content + std::string(twelve_bytes)).grid.values, letters(twelve_bytes));
}

TEST_F(VolumeNrrd, Spacing) {
  const auto spacing = [&](const std::string& more) {
    return read(NrrdFields{.more = more}.attached(twelve_bytes)).grid.spacing;
  };
  EXPECT_EQ(spacing("spacings: 0.5 2 1.25\n"), (std::array{0.5, 2.0, 1.25}));
  EXPECT_EQ(spacing("spacings: nan 2 nan\n"), (std::array{1.0, 2.0, 1.0}));
  EXPECT_EQ(spacing("space: left-posterior-superior\nspace directions: (0,3,4) (-2,0,0) (0,0,0.5)\n"),
            (std::array{5.0, 2.0, 0.5}));
}

TEST_F(VolumeNrrd, ExtraAxesOfSizeOneAreDropped) {
  const auto first =
      read(NrrdFields{.dimension = "4", .sizes = "1 3 2 2", .more = "spacings: 9 2 3 4\n"}.attached(twelve_bytes));
  EXPECT_EQ(first.grid.size, (std::array<std::int64_t, 3>{3, 2, 2}));
  EXPECT_EQ(first.grid.spacing, (std::array{2.0, 3.0, 4.0}));
  const auto last = read(NrrdFields{.dimension = "5", .sizes = "1 12 1 1 1"}.attached(twelve_bytes));
  EXPECT_EQ(last.grid.size, (std::array<std::int64_t, 3>{1, 12, 1}));
  const auto flat = read(NrrdFields{.sizes = "12 1 1"}.attached(twelve_bytes));
  EXPECT_EQ(flat.grid.size, (std::array<std::int64_t, 3>{12, 1, 1}));
  const auto vector =
      read(NrrdFields{.dimension = "4", .sizes = "1 3 2 2", .more = "kinds: vector domain space domain\n"}.attached(
          twelve_bytes));
  EXPECT_EQ(vector.grid.values, letters(twelve_bytes));
}

TEST_F(VolumeNrrd, LinesAndBytesBeforeTheData) {
  const auto expected = letters(twelve_bytes);
  const std::string before = "two\nlines\n";
  const std::string data(twelve_bytes);
  EXPECT_EQ(read(NrrdFields{.more = "line skip: 2\n"}.attached(before + data)).grid.values, expected);
  EXPECT_EQ(read(NrrdFields{.more = "byte skip: 10\n"}.attached(before + data)).grid.values, expected);
  EXPECT_EQ(read(NrrdFields{.more = "line skip: 1\nbyte skip: 6\n"}.attached(before + data)).grid.values, expected);
  EXPECT_EQ(read(NrrdFields{.more = "byte skip: -1\n"}.attached(before + data)).grid.values, expected);
  EXPECT_EQ(read(NrrdFields{.encoding = "gzip", .more = "byte skip: 10\n"}.attached(gzip(before + data))).grid.values,
            expected);
  EXPECT_EQ(read(NrrdFields{.encoding = "gzip", .more = "line skip: 2\n"}.attached(before + gzip(data))).grid.values,
            expected);
}

TEST_F(VolumeNrrd, DataInSeveralFiles) {
  const auto expected = letters(twelve_bytes);
  for (const auto* name : {"s1", "s2", "s08", "s10"})
    (void)write(name, name[2] == '\0' ? (name[1] == '1' ? "abcdef" : "ghijkl") : "");
  EXPECT_EQ(read(NrrdFields{.more = "data file: LIST\ns1\ns2\n"}.header(), "v.nhdr").grid.values, expected);
  EXPECT_EQ(read(NrrdFields{.more = "data file: s%d 1 2 1\n"}.header(), "v.nhdr").grid.values, expected);
  (void)write("s08", "ghijkl");
  (void)write("s10", "abcdef");
  EXPECT_EQ(read(NrrdFields{.more = "data file: ./s%02d 10 8 -2 2\n"}.header(), "v.nhdr").grid.values, expected);
  (void)write("a name", twelve_bytes);
  EXPECT_EQ(
      read(NrrdFields{.more = fmt::format("data file: {}\n", (folder() / "a name").string())}.header()).grid.values,
      expected);
}

TEST_F(VolumeNrrd, AsciiNumbers) {
  const NrrdFields integers{.type = "short", .encoding = "ascii"};
  EXPECT_EQ(read(integers.attached("-1, +2,3\t4\r\n5 6 7 8 9 10\n11 , 12\n\n")).grid.values,
            (std::vector<double>{-1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
  const NrrdFields reals{.type = "double", .sizes = "2 1 1", .encoding = "ascii"};
  EXPECT_EQ(read(reals.attached("1e-3 0.1")).grid.values, (std::vector<double>{1e-3, 0.1}));
}

TEST_F(VolumeNrrd, ConcatenatedGzipStreamsAreOneStream) {
  const NrrdFields fields{.encoding = "gzip"};
  EXPECT_EQ(read(fields.attached(gzip("abcd") + gzip("efghijkl"))).grid.values, letters(twelve_bytes));
}

TEST_F(VolumeNrrd, LastByteThatLooksLikeANewline) {
  EXPECT_TRUE(read(NrrdFields{}.attached("abcdefghijk\n")).lost_first_byte);
  EXPECT_TRUE(read(NrrdFields{.encoding = "gzip"}.attached(gzip("abcdefghijk\n"))).lost_first_byte);
  EXPECT_FALSE(read(NrrdFields{}.attached("abcdefghij\nl")).lost_first_byte);
  EXPECT_FALSE(read(NrrdFields{.type = "short", .sizes = "3 2 1"}.attached("abcdefghijk\n")).lost_first_byte);
  EXPECT_FALSE(read(NrrdFields{.sizes = "1 1 1", .encoding = "ascii"}.attached("10\n")).lost_first_byte);
}

TEST_F(VolumeNrrd, EndsOfAxesMakeSpacing) {
  const std::string ends = "axis mins: 0 -1 0\naxis maxs: 6 3 2\n";
  const auto cells = read(NrrdFields{.more = ends + "centers: cell cell cell\n"}.attached(twelve_bytes));
  EXPECT_EQ(cells.grid.spacing, (std::array{2.0, 2.0, 1.0}));
  EXPECT_EQ(cells.warnings, std::vector<std::string>{});
  const auto nodes = read(NrrdFields{.more = ends + "centers: node node cell\n"}.attached(twelve_bytes));
  EXPECT_EQ(nodes.grid.spacing, (std::array{3.0, 4.0, 1.0}));
  const auto unsaid = read(NrrdFields{.more = ends}.attached(twelve_bytes));
  EXPECT_EQ(unsaid.grid.spacing, cells.grid.spacing);
  EXPECT_EQ(unsaid.warnings.size(), 3U);
  const auto backwards =
      read(NrrdFields{.more = "axis mins: 6 0 0\naxis maxs: 0 4 2\ncenters: cell cell cell\n"}.attached(twelve_bytes));
  EXPECT_EQ(backwards.grid.spacing, cells.grid.spacing);
  EXPECT_EQ(backwards.warnings.size(), 1U);
  const auto both =
      read(NrrdFields{.more = ends + "centers: cell cell cell\nspacings: 2 2 5\n"}.attached(twelve_bytes));
  EXPECT_EQ(both.grid.spacing, (std::array{2.0, 2.0, 5.0}));
  EXPECT_EQ(both.warnings,
            std::vector<std::string>{
                "axis 2 has the spacing 5, and 1 by \"axis mins\" and \"axis maxs\"; the first is taken"});
  refused(NrrdFields{.more = "axis mins: 1 0 0\naxis maxs: 1 4 2\ncenters: cell cell cell\n"}.attached(twelve_bytes),
          "the spacing of axis 0 is 0");
  const auto directions =
      read(NrrdFields{.more = ends + "space dimension: 3\nspace directions: (2,0,0) (0,2,0) (0,0,2)\n"}.attached(
          twelve_bytes));
  EXPECT_EQ(directions.grid.spacing, (std::array{2.0, 2.0, 2.0}));
  EXPECT_EQ(directions.warnings.size(), 1U);
  EXPECT_FALSE(read(NrrdFields{}.attached(twelve_bytes)).has_spacing);
  EXPECT_TRUE(cells.has_spacing);
}

TEST_F(VolumeNrrd, SpacingThatIsAskedFor) {
  const auto file = write("v.nrrd", NrrdFields{.more = "spacings: 1 2 3\n"}.attached(twelve_bytes));
  const auto volume = read_volume(file, {.spacing = {{0.5, 2, 3}}});
  EXPECT_EQ(volume.grid.spacing, (std::array{0.5, 2.0, 3.0}));
  EXPECT_EQ(volume.warnings,
            std::vector<std::string>{"the file states the spacing 1 2 3; 0.5 2 3, which is asked for, is taken"});
  EXPECT_EQ(read_volume(file, {.spacing = {{1, 2, 3}}}).warnings, std::vector<std::string>{});
}

TEST_F(VolumeNrrd, ShearIsSaid) {
  const auto warnings = [&](const std::string& directions) {
    return read(NrrdFields{.more = "space dimension: 3\nspace directions: " + directions + "\n"}.attached(twelve_bytes))
        .warnings;
  };
  EXPECT_EQ(warnings("(0,3,4) (-2,0,0) (0,-4,3)"), std::vector<std::string>{});
  EXPECT_EQ(warnings("(1,0,0) (1,1,0) (0,0,1)"),
            std::vector<std::string>{
                "the space directions are sheared, two of them meet at 45.0 degrees; a grid of right angles is taken"});
}

TEST_F(VolumeNrrd, SeriesOfVolumes) {
  const auto slowest =
      write("slowest.nrrd",
            NrrdFields{.dimension = "4", .sizes = "3 2 1 2", .more = "kinds: space space space time\n"}.attached(
                twelve_bytes));
  expect_refused(slowest, "axis 3 has the kind time: it holds 2 volumes; one volume is allowed");
  EXPECT_EQ(read_volume(slowest, {.time_step = 1}).grid.values, letters("ghijkl"));
  // As 3D Slicer writes sequences.
  const auto fastest = write(
      "fastest.nrrd",
      NrrdFields{
          .dimension = "4",
          .sizes = "2 3 2 1",
          .more =
              "space dimension: 3\nspace directions: none (1,0,0) (0,2,0) (0,0,3)\nkinds: list domain domain domain\n"}
          .attached(twelve_bytes));
  expect_refused(fastest, "axis 0 has the kind list: it holds 2 volumes");
  const auto second = read_volume(fastest, {.time_step = 1});
  EXPECT_EQ(second.grid.values, letters("bdfhjl"));
  EXPECT_EQ(second.grid.spacing, (std::array{1.0, 2.0, 3.0}));
  const auto packed = write(
      "packed.nrrd",
      NrrdFields{.dimension = "4", .sizes = "3 1 2 2", .encoding = "gzip", .more = "kinds: space space time space\n"}
          .attached(gzip(twelve_bytes)));
  EXPECT_EQ(read_volume(packed, {.time_step = 1}).grid.values, letters("defjkl"));
  refused(NrrdFields{.more = "kinds: space space time\n"}.attached(twelve_bytes), "axis 2 has the kind time");
}

TEST_F(VolumeNrrd, ByteSkipMinus1TakesTheLastBytes) {
  const NrrdFields fields{.encoding = "gzip", .more = "byte skip: -1\n"};
  EXPECT_EQ(read(fields.attached(gzip("before" + std::string(twelve_bytes)))).grid.values, letters(twelve_bytes));
  EXPECT_EQ(read(fields.attached(gzip(twelve_bytes))).grid.values, letters(twelve_bytes));
}

TEST_F(VolumeNrrd, WarnsOfWhatIsBehindTheData) {
  const std::string thirteen = std::string(twelve_bytes) + "m";
  for (const auto& volume :
       {read(NrrdFields{}.attached(thirteen)), read(NrrdFields{.encoding = "gzip"}.attached(gzip(thirteen))),
        read(NrrdFields{.encoding = "gzip"}.attached(gzip(twelve_bytes) + "more")),
        read(NrrdFields{.encoding = "gzip"}.attached(twelve_bytes))}) {
    EXPECT_EQ(volume.grid.values, letters(twelve_bytes));
    EXPECT_EQ(volume.warnings.size(), 1U);
  }
  EXPECT_EQ(read(NrrdFields{.encoding = "ascii"}.attached("1 2 3 4 5 6 7 8 9 10 11 12 13 x")).warnings,
            std::vector<std::string>{"the header announces 12 numbers; the 2 words behind them are not read"});
}

TEST_F(VolumeNrrd, IntegersThatBinary64DoesNotKeepApart) {
  const std::vector<std::int64_t> values{(std::int64_t{1} << 53) + 1,
                                         -(std::int64_t{1} << 53) - 1,
                                         std::int64_t{1} << 53,
                                         std::int64_t{1} << 60,
                                         std::numeric_limits<std::int64_t>::min(),
                                         7};
  const NrrdFields fields{.type = "int64", .sizes = "3 2 1"};
  EXPECT_EQ(read(fields.attached(stored<std::int64_t>(values, std::endian::little))).warnings,
            std::vector<std::string>{
                "5 of 6 voxels are integers beyond 2^53, which binary64 does not keep apart: 2 of them are "
                "rounded, and different ones may have become the same"});
  const std::vector<std::uint64_t> exact{1ULL << 63U, 1ULL << 53U, 0};
  EXPECT_EQ(
      read(NrrdFields{.type = "uint64", .sizes = "3 1 1"}.attached(stored<std::uint64_t>(exact, std::endian::little)))
          .warnings,
      std::vector<std::string>{});
  const std::vector<std::uint64_t> largest{std::numeric_limits<std::uint64_t>::max(), 0, 0};
  EXPECT_EQ(
      read(NrrdFields{.type = "uint64", .sizes = "3 1 1"}.attached(stored<std::uint64_t>(largest, std::endian::little)))
          .warnings.size(),
      1U);
}

TEST_F(VolumeNrrd, VoxelsThatAreNaNGetAValue) {
  auto values = twelve_values<float>();
  values[3] = values[7] = std::numeric_limits<float>::quiet_NaN();
  const auto file = write("v.nrrd", NrrdFields{.type = "float"}.attached(stored<float>(values, std::endian::little)));
  expect_refused(
      file,
      "2 of 12 voxels are NaN, the first is voxel (0, 1, 0); only finite values are allowed; --nan VALUE, or \"nan\"");
  const auto volume = read_volume(file, {.nan = -2});
  EXPECT_EQ(volume.grid.values[3], -2);
  EXPECT_EQ(volume.grid.values[7], -2);
  EXPECT_EQ(volume.warnings, std::vector<std::string>{
                                 "2 of 12 voxels are NaN, the first is voxel (0, 1, 0); they are given the value -2"});
  values[4] = std::numeric_limits<float>::infinity();
  expect_refused(write("v.nrrd", NrrdFields{.type = "float"}.attached(stored<float>(values, std::endian::little))),
                 "1 of 12 voxels are infinite, the first is voxel (1, 1, 0)", {}, {.nan = -2});
}

TEST_F(VolumeNrrd, MemoryLimit) {
  const auto file = write("v.nrrd", NrrdFields{}.attached(twelve_bytes));
  EXPECT_NO_THROW((void)read_volume(file, {}, 96));
  try {
    (void)read_volume(file, {}, 95);
    FAIL() << "read";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("the header announces 3 x 2 x 2 voxels of type uint8, which need 96 bytes of memory; "
                        "the memory limit is 95 bytes; --memory-limit SIZE"),
              std::string::npos)
        << error.what();
  }
}

TEST_F(VolumeNrrd, FirstBytesTellTheFormatOfOtherNames) {
  const auto volume = read(NrrdFields{}.attached(twelve_bytes), "v.data");
  EXPECT_EQ(volume.grid.values, letters(twelve_bytes));
  EXPECT_EQ(volume.warnings,
            std::vector<std::string>{"the name does not tell the format; the first bytes are those of NRRD"});
  EXPECT_EQ(read(NrrdFields{}.attached(twelve_bytes), "V.NRRD").warnings, std::vector<std::string>{});
}

TEST_F(VolumeNrrd, RefusesFilesThatAreNone) {
  expect_refused(folder() / "missing.nrrd", "no such file");
  std::filesystem::create_directory(folder() / "folder.nrrd");
  expect_refused(folder() / "folder.nrrd", "not a regular file");
  ASSERT_EQ(::mkfifo((folder() / "pipe.nrrd").c_str(), 0600), 0);
  expect_refused(folder() / "pipe.nrrd", "not a regular file");
  expect_refused(write("volume.raw", twelve_bytes), ".nrrd, .nhdr, .nii, .nii.gz, .hdr and .npy are allowed");
  expect_refused(write("volume", twelve_bytes), "neither the name nor the first bytes tell the format");
  expect_refused(write("new\nline.nrrd", "x"), "header is \"x\"", "new\\nline.nrrd");
  if (::geteuid() != 0) {
    const auto closed = write("closed.nrrd", NrrdFields{}.attached(twelve_bytes));
    std::filesystem::permissions(closed, std::filesystem::perms::none);
    expect_refused(closed, "Permission denied");
  }
}

TEST_F(VolumeNrrd, RefusesMalformedHeaders) {
  refused("", "no field \"type\"");
  refused("\n", "no field \"type\"");
  refused("NRRD0004", "no field \"type\"");
  refused("P5\n3 2 255\nabcdef", "line 1 of the header is \"P5\"");
  refused("PK\x03\x04", "line 1 of the header");
  refused(NrrdFields{.magic = "NRRD0009"}.attached(twelve_bytes),
          "\"NRRD0009\"; text is allowed, with \"NRRD0001\" to \"NRRD0006\"");
  refused(NrrdFields{.more = "nonsense\n"}.attached(twelve_bytes), "line 7 of the header is \"nonsense\"");
  refused(NrrdFields{.more = "volume: 7\n"}.attached(twelve_bytes), "line 7 of the header is \"volume: 7\"");
  refused(NrrdFields{.more = "type: short\n"}.attached(twelve_bytes), "\"type\" stands twice");
  refused(NrrdFields{.more = std::string("content: a\0b\n", 13)}.attached(twelve_bytes), "text is allowed");
  refused(NrrdFields{.type = "uint7"}.attached(twelve_bytes), "the type is \"uint7\"; integer");
  refused(NrrdFields{.type = "%s%s%n"}.attached(twelve_bytes), "the type is \"%s%s%n\"");
  refused(NrrdFields{.encoding = "rar"}.attached(twelve_bytes),
          "the encoding is \"rar\"; raw, gzip and ascii are allowed");
  refused(NrrdFields{.endian = "middle"}.attached(twelve_bytes), "couldn't parse endian \"middle\"");
  for (const std::string bad : {"three", "3x", "3.0", "3 3", ""}) {
    refused(NrrdFields{.dimension = bad}.attached(twelve_bytes),
            fmt::format("\"dimension\" is \"{}\"; a whole number", bad));
  }
  refused(NrrdFields{.more = "kinds: " + std::string(3000, '9') + "\n"}.attached(twelve_bytes),
          "at most 500 characters");
  refused(NrrdFields{.magic = "NRRD0004" + std::string(3000, '9')}.attached(twelve_bytes), "line 1 of the header");
  refused(NrrdFields{.dimension = "0"}.attached(twelve_bytes), "NRRD header is not valid");
  refused(NrrdFields{.dimension = "17"}.attached(twelve_bytes), "NRRD header is not valid");
  refused(NrrdFields{.dimension = "4"}.attached(twelve_bytes), "parsed 3 values, but dimension is 4");
  refused(NrrdFields{.dimension = "2"}.attached(twelve_bytes), "more than expected 2 sizes");
  refused("NRRD0004\ntype: short\ndimension: 3\nsizes: 3 2 1\nencoding: raw\n\nabcdefghijkl", "require endian info");
  refused(NrrdFields{.more = "x" + std::string(2 << 20, 'x')}.header(), "header of at most 1 MiB");
  for (const std::string missing : {"type", "dimension", "sizes", "encoding"}) {
    std::string content = NrrdFields{}.attached(twelve_bytes);
    content.insert(content.find("\n" + missing) + 1, "#");
    refused(content, fmt::format("no field \"{}\"", missing));
  }
}

TEST_F(VolumeNrrd, RefusesWhatIsNotAScalarVolume) {
  const std::string three_axes = "three axes are allowed, and further ones of size 1";
  refused(NrrdFields{.dimension = "2", .sizes = "3 4"}.attached(twelve_bytes), three_axes);
  refused(NrrdFields{.dimension = "4", .sizes = "3 2 2 2"}.attached(twelve_bytes),
          "the sizes are 3 x 2 x 2 x 2; " + three_axes);
  refused(NrrdFields{.more = "kinds: RGB-color domain domain\n"}.attached(twelve_bytes),
          "axis 0 holds the 3 parts of a RGB-color");
  refused(NrrdFields{.dimension = "4", .sizes = "2 3 2 1", .more = "kinds: vector domain domain domain\n"}.attached(
              twelve_bytes),
          "axis 0 holds the 2 parts of a vector");
  refused(NrrdFields{.more = "space dimension: 2\nspace directions: none (1,0) (0,1)\n"}.attached(twelve_bytes),
          "axis 0 has the direction none, so it is no axis of space, and its size is 3");
  refused(NrrdFields{.more = "space dimension: 3\nspace directions: none (0,-2,0) (0,0,7)\n"}.attached(twelve_bytes),
          "axis 0 has the direction none");
  refused(NrrdFields{.type = "block", .more = "block size: 1\n"}.attached(twelve_bytes),
          "the type is \"block\"; integer and floating types are allowed");
  refused(NrrdFields{.encoding = "hex"}.attached(twelve_bytes),
          "the encoding is \"hex\"; raw, gzip and ascii are allowed");
  refused(NrrdFields{.encoding = "bzip2"}.attached(twelve_bytes), "the encoding is \"bzip2\"");
}

TEST_F(VolumeNrrd, RefusesImpossibleSizes) {
  const std::string allowed = "sizes >= 1 and at most 2^33 voxels are allowed";
  for (const std::string bad :
       {"0 2 2", "-3 2 2", "-1 -1 12", "3 two 2", "3 2 2.0", "8589934593 1 1" /* 2^33 + 1 */,
        "1048576 1048576 1" /* 2^40 */, "4294967296 4294967296 4294967296" /* 2^96 */,
        "4294967296 4294967296 12" /* 0 modulo 2^64 */, "18446744073709551615 2 2", "99999999999999999999999 2 2"}) {
    refused(NrrdFields{.sizes = bad}.attached(twelve_bytes), fmt::format("the sizes are {}; {}", bad, allowed));
  }
  // As many as the limits allow, but not in this file; 2^33 is refused before memory is asked for.
  refused(NrrdFields{.sizes = "8589934592 1 1"}.attached(twelve_bytes), "can hold no more than 12 bytes");
  refused(NrrdFields{.sizes = "65536 65536 1", .encoding = "gzip"}.attached(gzip(twelve_bytes)), "can hold no more");
  refused(NrrdFields{.sizes = "65536 65536 1", .encoding = "ascii"}.attached(twelve_bytes),
          "can hold no more than 12 bytes");
}

TEST_F(VolumeNrrd, RefusesImpossibleSpacing) {
  for (const std::string bad : {"spacings: 1 0 1\n", "spacings: 1 inf 1\n", "spacings: 1 1\n", "spacings: 1 x 1\n",
                                "spacings: 1 banana 1\n", "spacings: 1 2x 1\n", "spacings: 1 1e999 1\n",
                                "space: left-posterior-superior\nspace directions: (0,0,0) (0,1,0) (0,0,1)\n",
                                "space directions: (1,0,0) (0,1,0) (0,0,1)\n"}) {
    SCOPED_TRACE(bad);
    refused(NrrdFields{.more = bad}.attached(twelve_bytes), "");
  }
  const auto backwards = read(NrrdFields{.more = "spacings: 1 -2 1\n"}.attached(twelve_bytes));
  EXPECT_EQ(backwards.grid.spacing, (std::array{1.0, 2.0, 1.0}));
  EXPECT_EQ(backwards.warnings.size(), 1U);
}

TEST_F(VolumeNrrd, RefusesDataOfAnotherLengthThanAnnounced) {
  const std::string eleven(twelve_bytes.substr(0, 11));
  refused(NrrdFields{}.attached(eleven), "can hold no more than 11 bytes of data; the header announces 12 voxels");
  refused(NrrdFields{}.attached(""), "can hold no more than 0 bytes");
  refused(NrrdFields{}.header(), "the header ends without an empty line");
  refused(NrrdFields{.encoding = "gzip"}.attached(gzip(eleven)),
          "the data end after 11 bytes; the header announces 12");
  refused(NrrdFields{.type = "short", .sizes = "2 3 1", .encoding = "gzip"}.attached(gzip(eleven)),
          "the data end after 11 bytes; the header announces 12");
  refused(NrrdFields{.encoding = "ascii"}.attached("1 2 3 4 5 6 7 8 9 10 11   "), "the data end after 11 numbers");
  refused(NrrdFields{.type = "short", .sizes = "2 3 1"}.attached(eleven), "no more than 11 bytes of data");
  refused(NrrdFields{.more = "byte skip: 1\n"}.attached(twelve_bytes), "no more than 11 bytes of data");
  refused(NrrdFields{.more = "byte skip: 9223372036854775807\n"}.attached(twelve_bytes),
          "no more than 0 bytes of data");
  refused(NrrdFields{.more = "byte skip: -1\n"}.attached(eleven), "has 11 bytes of data; the header announces 12");
  refused(NrrdFields{.more = "byte skip: -2\n"}.attached(twelve_bytes), "\"byte skip\" is -2");
  refused(NrrdFields{.encoding = "gzip", .more = "byte skip: -1\n"}.attached(gzip(eleven)),
          "has 11 bytes of data; the header announces 12");
  refused(NrrdFields{.encoding = "ascii", .more = "byte skip: -1\n"}.attached("1"), "\"byte skip\" is -1");
  refused(NrrdFields{.more = "line skip: 4000000000\n"}.attached(twelve_bytes), "lines too early");
}

/// What is read in several goes, for there are more than 65536 voxels, is whole, and ends where it should.
TEST_F(VolumeNrrd, MoreVoxelsThanAreReadAtOnce) {
  constexpr std::size_t count = 3 * 43691;  // 2^17 + 1
  std::string data;
  for (std::size_t i = 0; i < count; ++i) {
    const auto value = static_cast<std::uint16_t>(i % 65521);
    data += static_cast<char>(value & 0xffU);
    data += static_cast<char>(value >> 8U);
  }
  for (const char* const encoding : {"raw", "gzip"}) {
    const NrrdFields fields{.type = "ushort", .sizes = "43691 3 1", .encoding = encoding};
    const bool is_raw = fields.encoding == "raw";
    const auto volume = read(fields.attached(is_raw ? data : gzip(data)));
    ASSERT_EQ(volume.grid.values.size(), count);
    for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(volume.grid.values[i], static_cast<double>(i % 65521)) << i;
    EXPECT_EQ(volume.warnings.size(), 0U);
    if (is_raw) continue;
    refused(fields.attached(gzip(data.substr(0, data.size() - 1))),
            "the data end after 262145 bytes; the header announces 262146");
    refused(fields.attached(gzip(data.substr(0, 131073))),
            "the data end after 131073 bytes; the header announces 262146");
    EXPECT_EQ(read(fields.attached(gzip(data + "x"))).warnings.size(), 1U);
  }
}

TEST_F(VolumeNrrd, RefusesDamagedGzipData) {
  const NrrdFields fields{.encoding = "gzip"};
  const auto whole = gzip(twelve_bytes);
  for (std::size_t length = 0; length < whole.size(); ++length) {
    SCOPED_TRACE(length);
    refused(fields.attached(whole.substr(0, length)), "");
  }
  refused(fields.attached(whole.substr(0, whole.size() - 1)),
          "the gzip data end early; whole gzip streams are allowed");
  refused(fields.attached(twelve_bytes.substr(1)), "can hold no more than 11 bytes of data");
  refused(fields.attached(std::string(twelve_bytes) + "m"), "the data are not gzip, and 13 bytes");
  constexpr std::size_t header_size = 10;
  for (std::size_t position = header_size; position < whole.size(); ++position) {
    SCOPED_TRACE(position);
    auto damaged = whole;
    damaged[position] = static_cast<char>(damaged[position] ^ 1);
    refused(fields.attached(damaged), "");
  }
  auto wrong_checksum = whole;
  wrong_checksum[whole.size() - 8] = static_cast<char>(wrong_checksum[whole.size() - 8] ^ 1);
  refused(fields.attached(wrong_checksum), "incorrect data check");
}

// Data that fill buffers whole: the end of the file is met between the last voxel and the checksum behind it.
TEST_F(VolumeNrrd, RefusesGzipDataWithoutAllOfTheirChecksum) {
  for (const std::string size : {"1", "64", "65536", "262144"}) {
    const NrrdFields fields{.sizes = "1 1 " + size, .encoding = "gzip"};
    const auto whole = gzip(std::string(std::stoul(size), 'x'));
    EXPECT_NO_THROW((void)read(fields.attached(whole)));
    for (std::size_t missing = 1; missing <= 12; ++missing) {
      refused(fields.attached(whole.substr(0, whole.size() - missing)), "the gzip data end early");
    }
  }
}

TEST_F(VolumeNrrd, RefusesValuesThatAreNotFinite) {
  auto values = twelve_values<float>();
  constexpr std::size_t second_in_each_axis = 1 + 3 + 6;
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity()}) {
    values[second_in_each_axis] = bad;
    refused(NrrdFields{.type = "float"}.attached(stored<float>(values, std::endian::little)),
            "the first is voxel (1, 1, 1); only finite values are allowed");
  }
  refused(NrrdFields{.type = "double", .sizes = "2 1 1", .encoding = "ascii"}.attached("1 nan"),
          "1 of 2 voxels are NaN, the first is voxel (1, 0, 0)");
}

TEST_F(VolumeNrrd, RefusesAsciiThatIsNoNumberOfTheType) {
  const auto byte = [&](std::string_view text) {
    return NrrdFields{.sizes = "2 1 1", .encoding = "ascii"}.attached(text);
  };
  refused(byte("1 256"), "voxel (1, 0, 0) is \"256\"; a number of type uint8 is allowed");
  for (const auto* bad : {"1 -1", "1 1.5", "1 2x", "1 x", "1 0x1", "1 ++1", "1 1e0", "1 \xff\xff"}) {
    SCOPED_TRACE(bad);
    refused(byte(bad), "voxel (1, 0, 0) is ");
  }
  refused(byte(std::string(5000, '1') + " 1"), "voxel (0, 0, 0) is \"1111");
  refused(NrrdFields{.type = "double", .sizes = "1 1 1", .encoding = "ascii"}.attached("0." + std::string(5000, '1')),
          "voxel (0, 0, 0) is \"0.111");
  refused(NrrdFields{.type = "float", .sizes = "1 1 1", .encoding = "ascii"}.attached("1e39"),
          "a number of type float32");
}

TEST_F(VolumeNrrd, RefusesBadDetachedData) {
  const auto header = [](const std::string& value) {
    return NrrdFields{.more = "data file: " + value + "\n"}.header();
  };
  expect_refused(write("v.nhdr", header("none.raw")), "no such file", "none.raw");
  expect_refused(write("v.nhdr", header("-")), "no such file", "-");
  expect_refused(write("v.nhdr", header(".")), "not a regular file", ".");
  expect_refused(write("v.nhdr", header("/dev/zero")), "not a regular file", "zero");
  (void)write("short.raw", twelve_bytes.substr(1));
  expect_refused(write("v.nhdr", header("short.raw")), "no more than 11 bytes", "short.raw");
  expect_refused(write("v.nhdr", header("LIST")), "list of data files is empty");
  expect_refused(write("v.nhdr", header("LIST\nshort.raw\nshort.raw\nshort.raw\nshort.raw\nshort.raw")),
                 "5 data files hold 12 voxels");
  expect_refused(write("v.nhdr", header("LIST\nshort.raw\nnone.raw")), "no such file", "none.raw");
  expect_refused(write("v.nhdr", header("SKIPLIST\n1 short.raw")), "line 8 of the header");
  expect_refused(write("v.nhdr", header("SKIPLIST")), "SKIPLIST");
  for (const std::string bad : {"s%d 1 2 0", "s%d 2 1 1", "s%d 1 2 -1", "s%d 1 2 -5", "s%d -999999999 999999999 1"}) {
    expect_refused(write("v.nhdr", header(bad)), "a step that leads from the first to the last number");
  }
  // What is no pattern is a name; none of it reaches printf.
  for (const std::string name : {"s%s 1 2 1", "s%n%n%d 1 2 1", "s%d%d 1 2 1", "s%999d 1 2 1", "s%d 1 2", "s%d 1 2 x",
                                 "s%*d 1 2 1", "s%d 1 99999999999 1", "s% 1 2 1"}) {
    expect_refused(write("v.nhdr", header(name)), "no such file", name);
  }
  expect_refused(write("v.nhdr", header("s%d 1 2 1")), "no such file", "s1");
}

}  // namespace
}  // namespace raytruth::test
