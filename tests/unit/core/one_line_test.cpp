#include "raytruth/core/one_line.hpp"

#include <gtest/gtest.h>

#include <array>

namespace raytruth {
namespace {

TEST(OneLine, EscapesWhatWouldBreakALine) {
  EXPECT_EQ(one_line("a\nb\tc\x1b[0m\x7f"), "a\\nb\\x09c\\x1b[0m\\x7f");
  EXPECT_EQ(one_line("gr\u00fcn \u03be \U0001F600"), "gr\u00fcn \u03be \U0001F600");
}

TEST(OneLine, ReplacesBytesThatAreNoUtf8) {
  EXPECT_EQ(one_line("a\xff"
                     "b\xc3"),
            "a?b?");
  EXPECT_EQ(one_line("\xc0\xaf\xe2\x82"), "????");
}

TEST(Shortened, CutsBetweenCharacters) {
  EXPECT_EQ(shortened("abc", 3), "abc");
  EXPECT_EQ(shortened("abcd", 3), "abc...");
  EXPECT_EQ(shortened("ab\u00fcd", 3), "ab...");
}

TEST(EditDistance, CountsLetters) {
  EXPECT_EQ(edit_distance("", ""), 0U);
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
  EXPECT_EQ(edit_distance("order1", "order1"), 0U);
}

TEST(ClosestWord, SuggestsOnlyWhatIsLikely) {
  const std::array<std::string_view, 3> words{"order1", "order2", "virtual_catmull_rom"};
  EXPECT_EQ(closest_word("ordre2", words), "order2");
  EXPECT_EQ(closest_word("virtual_catmul_rom", words), "virtual_catmull_rom");
  EXPECT_EQ(closest_word("trilinear", words), "");
  EXPECT_EQ(closest_word("", words), "");
}

}  // namespace
}  // namespace raytruth
