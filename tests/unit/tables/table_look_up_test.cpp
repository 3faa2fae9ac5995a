#include "raytruth/tables/look_up.hpp"

#include "raytruth/core/random.hpp"
#include "raytruth/kernels/slab_kernels.hpp"
#include "raytruth/tables/brute_force.hpp"
#include "raytruth/tables/exact.hpp"
#include "raytruth/tables/table_error.hpp"
#include "raytruth/textures/texture_unit.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/study_transfers.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace raytruth {
namespace {

using Vec4 = Rules<double>::vec4;

constexpr TableAxes axes{.size = 17, .low = -2, .high = 6, .length = 1};

double uniform(std::uint64_t index) { return random_numbers(3, RandomStream::points, index)[0]; }

const Table<double>& table() {
  static const Table<double> made = [] {
    Table<double> random(axes);
    for (std::size_t i = 0; i < random.values.size(); ++i) random.values[i] = uniform(i);
    return random;
  }();
  return made;
}

Vec4 texel(std::size_t front, std::size_t back) { return table().at(front, back); }

// (i + 1/2) / n, and back: problem.md.
TEST(TablePlace, EntriesAreTheCentresOfTexels) {
  Rules<double> rules;
  for (const double n : {2.0, 17.0, 256.0, 2048.0})
    for (double i = 0; i < n; ++i) {
      const double coordinate = rules.table_coordinate(i / (n - 1), n);
      EXPECT_NEAR(coordinate, (i + 0.5) / n, 0x1p-52);
      EXPECT_NEAR(rules.table_share(coordinate, n), i / (n - 1), n * 0x1p-52);
    }
}

TEST(TablePlace, ScalarsBeyondTheEndsAreThoseOfTheEnds) {
  for (const auto& [scalar, entry] : {std::pair{-100.0, 0}, {-2.0, 0}, {6.0, 16}, {1e300, 16}}) {
    const auto place = TablePlace<double>::of(axes, scalar, 0);
    EXPECT_EQ(place.nearest(), static_cast<std::size_t>(entry)) << scalar;
  }
}

TEST(TableLookUp, AtEntriesIsTheEntry) {
  for (std::size_t front = 0; front < axes.size; ++front)
    for (std::size_t back = 0; back < axes.size; ++back) {
      const std::array scalars{axes.scalar(front), axes.scalar(back)};
      EXPECT_TRUE((nearest<double>(axes, texel, scalars) == texel(front, back)).all());
      // A place in entries is off by some units in the last place of 17, and neighbours by up to 1.
      EXPECT_LE((bilinear<double>(axes, texel, scalars) - texel(front, back)).abs().maxCoeff(), 17 * 0x1p-50);
    }
}

TEST(TableLookUp, IsExactForBilinearTables) {
  const auto formula = [](double f, double b) -> Vec4 { return Vec4(1, f, b, f * b); };
  const auto entry = [&](std::size_t f, std::size_t b) { return formula(axes.scalar(f), axes.scalar(b)); };
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const double front = -2 + 8 * uniform(2 * i);
    const double back = -2 + 8 * uniform(2 * i + 1);
    EXPECT_LE((bilinear<double>(axes, entry, {front, back}) - formula(front, back)).abs().maxCoeff(), 1e-13);
  }
}

TEST(TableLookUp, IsExactForTrilinearTables) {
  const auto formula = [](double f, double m, double b) -> Vec4 { return Vec4(f * m * b, f * m, m * b, 1); };
  const auto entry = [&](std::size_t f, std::size_t m, std::size_t b) {
    return formula(axes.scalar(f), axes.scalar(m), axes.scalar(b));
  };
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const std::array s{-2 + 8 * uniform(3 * i), -2 + 8 * uniform(3 * i + 1), -2 + 8 * uniform(3 * i + 2)};
    EXPECT_LE((trilinear<double>(axes, entry, s) - formula(s[0], s[1], s[2])).abs().maxCoeff(), 1e-12);
  }
}

// The table as a texture of floats, by the texture unit that a test compares with OpenGL's.
TEST(TableLookUp, IsThatOfATextureUnit) {
  Texture texture{.size = {17, 17, 1}, .dimensions = 2, .channels = 4};
  for (const double value : table().values) texture.texels.push_back(static_cast<float>(value));
  const auto entry = [](std::size_t front, std::size_t back) -> Vec4 {
    return texel(front, back).cast<float>().cast<double>();
  };
  for (const int bits : {0, 6, 8}) {
    const TextureUnit<double> unit(texture, bits);
    for (std::uint64_t i = 0; i < 1000; ++i) {
      const double f = uniform(2 * i);
      const double b = uniform(2 * i + 1);
      Rules<double> rules;
      const Vec4 expected = unit.linear({rules.table_coordinate(f, 17), rules.table_coordinate(b, 17), 0});
      const Vec4 found = bilinear<double>(axes, entry, {-2 + 8 * f, -2 + 8 * b}, bits);
      // A weight on the border between two levels may go either way: one level of a difference of at most 1 an axis.
      EXPECT_LE((found - expected).abs().maxCoeff(), bits > 0 ? std::ldexp(2.0, -bits) : 1e-13);
    }
  }
}

TEST(TableFormats, KeepNumbersToHalfAStep) {
  for (const TableFormat& format : table_formats) {
    const double bound = format.is_texel ? largest_texel_error(format.type) + 0x1p-24 : 0;
    for (std::uint64_t i = 0; i < 1000; ++i)
      EXPECT_LE(std::abs(stored(format, uniform(i)) - uniform(i)), bound) << format.name;
    EXPECT_EQ(stored(format, 1), 1);
    EXPECT_EQ(stored(format, 0), 0);
  }
}

TEST(SlabKernels, MarchFourRaysAsOneAfterTheOther) {
  const TableAxes of_table{.size = 64, .low = 0, .high = 1, .length = 1};
  const Table<float> slabs = rounded(exact_table(random_transfer(0.3, 1), of_table, Emission::associated));
  constexpr std::size_t count = 50;
  std::vector<float> scalars;
  // Beyond the ends too, and at them.
  for (std::uint64_t i = 0; i < 4 * (count + 1); ++i) scalars.push_back(static_cast<float>(1.2 * uniform(i) - 0.1));
  scalars[0] = 1;
  scalars[5] = 0;
  for (const SlabKernels* const version : slab_kernel_versions()) {
    std::array<float, 16> found{};
    version->march_four({slabs.values.data(), 64, 63, 0}, scalars.data(), count, found.data());
    for (std::size_t ray = 0; ray < 4; ++ray) {
      Vec4 expected = Vec4::Constant(0);
      for (std::size_t k = 0; k < count; ++k)
        expected = Rules<double>{}.over(
            expected, bilinear<double>(
                          of_table, [&](std::size_t f, std::size_t b) -> Vec4 { return slabs.at(f, b).cast<double>(); },
                          {static_cast<double>(scalars[4 * k + ray]), static_cast<double>(scalars[4 * k + 4 + ray])}));
      // In binary32 places err by 64 units, entries by one, and 50 composites by as many.
      for (std::size_t c = 0; c < 4; ++c)
        EXPECT_NEAR(static_cast<double>(found[4 * ray + c]), expected[static_cast<Eigen::Index>(c)], 128 * 0x1p-24);
    }
  }
}

TEST(CertifiedCells, OfASmallTableAreAllOfThem) {
  const CertifiedCells cells =
      certified_cells(ramp_transfer(5), {.size = 9, .low = 0, .high = 1, .length = 1}, Emission::associated, 8, 1);
  ASSERT_EQ(cells.cells.size(), 64U);
  double area = 0;
  double band = 0;
  for (const CertifiedCell& cell : cells.cells) {
    area += cell.weight;
    band += cell.band_weight;
    EXPECT_EQ(cell.is_in_band(), cell.band_weight > 0);
  }
  EXPECT_EQ(area, 64);
  EXPECT_EQ(band, 22);  // 8 on the diagonal, 7 on either side
  EXPECT_LT(cells.radius, 1e-12);
}

TEST(CertifiedCells, OfALargeTableStandForAllOfThem) {
  const CertifiedCells cells =
      certified_cells(step_transfer(5), {.size = 100, .low = 0, .high = 1, .length = 1}, Emission::associated, 7, 1);
  double area = 0;
  bool has_jump = false;
  for (const CertifiedCell& cell : cells.cells) {
    area += cell.weight;
    has_jump |= cell.front == 49 && cell.back == 49;
  }
  EXPECT_EQ(area, 99 * 99);
  EXPECT_TRUE(has_jump);
}

// A table whose every entry is off by 1/8 in one channel has that error everywhere.
TEST(TableError, IsWhatIsWrong) {
  const CertifiedCells cells =
      certified_cells(PiecewiseLinear({{0, {2, {1, 1, 1}}}}), {.size = 9, .low = 0, .high = 1, .length = 1},
                      Emission::associated, 4, 1);
  const TableError error = bilinear_error(cells, [](const CertifiedCell& cell, std::size_t f, std::size_t b) -> Vec4 {
    return cell.entry(f, b) + Vec4(0.125, 0, 0, 0);
  });
  EXPECT_NEAR(error.max, 0.125, 1e-14);
  EXPECT_NEAR(error.mean, 0.125 / 4, 1e-14);
  EXPECT_NEAR(error.root_mean_square, 0.125 / 2, 1e-14);
  EXPECT_NEAR(error.band_max, 0.125, 1e-14);
  EXPECT_NEAR(error.band_mean, 0.125 / 4, 1e-14);
}

}  // namespace
}  // namespace raytruth
