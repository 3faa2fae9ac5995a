#include "experiments/shard.hpp"

#include "experiments/digest.hpp"
#include "raytruth/core/error.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

namespace raytruth {
namespace {

/// FIPS 180-4, examples of the NIST.
TEST(Sha256, IsTheStandards) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Shard, ReadsNumberAndCount) {
  const Shard shard = read_shard("3/64");
  EXPECT_EQ(shard.number, 3);
  EXPECT_EQ(shard.count, 64);
  for (const char* const wrong : {"", "3", "3/", "/3", "0/3", "4/3", "-1/3", "+1/3", " 1/3", "1/3 ", "1/3/5", "1.0/3",
                                  "1/1000000001", "99999999999999999999/3"})
    EXPECT_THROW(read_shard(wrong), InputError) << wrong;
}

TEST(Shard, EveryUnitIsInOneShard) {
  for (const std::size_t n : {1, 4, 20, 1000})
    for (const std::int64_t count : {1, 2, 7, 20, 64, 1000, 1'000'000}) {
      std::vector<Unit> units(n);
      std::size_t next = 0;
      for (std::int64_t number = 1; number <= count; ++number)
        for (const Unit& unit : units_of_shard(units, {number, count})) {
          const auto i = static_cast<std::size_t>(&unit - units.data());
          ASSERT_EQ(i, next++) << n << ' ' << number << '/' << count;
          ASSERT_EQ(shard_of_unit(i, n, count).number, number) << i << ' ' << n << ' ' << count;
        }
      ASSERT_EQ(next, n) << count;
    }
}

}  // namespace
}  // namespace raytruth
