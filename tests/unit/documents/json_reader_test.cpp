#include "raytruth/documents/json/json_reader.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>

namespace raytruth {
namespace {

JsonReader read(std::string_view text) { return JsonReader::from_text(text, "file.json"); }

/// The message of the InputError that `work` throws.
std::string refusal(const std::function<void()>& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing refused";
}

TEST(JsonReader, ReadsWhatIsThere) {
  const JsonReader json = read(R"({"a": [1, 2.5, "x"], "b": {"c": true}, "d": null})");
  EXPECT_EQ(json.at("a").items()[0].integer(0, 9), 1);
  EXPECT_EQ(json.at("a").items()[1].number(), 2.5);
  EXPECT_EQ(json.at("a").items()[2].text(), "x");
  EXPECT_TRUE(json.at("b").at("c").boolean());
  EXPECT_TRUE(json.at("d").is_null());
  EXPECT_TRUE(json.find("d"));
  EXPECT_FALSE(json.find("e"));
  EXPECT_EQ(json.members()[1].first, "b");
  EXPECT_EQ(read("[1, 2e0, -0.5]").numbers(), (std::vector<double>{1, 2, -0.5}));
}

TEST(JsonReader, NamesThePlace) {
  const JsonReader json = read(R"({"a": [{"b/c": 1, "~": 2}]})");
  const JsonReader item = json.at("a").items()[0];
  EXPECT_EQ(refusal([&] { item.at("b/c").text(); }),
            "file.json: /a/0/b~1c: found 1; a text that is not empty is allowed");
  EXPECT_EQ(refusal([&] { item.at("~").boolean(); }), "file.json: /a/0/~0: found 2; true or false is allowed");
  EXPECT_EQ(refusal([&] { item.at("z").number(); }), "file.json: /a/0/z: found nothing; a number is allowed");
  EXPECT_EQ(refusal([&] { json.text(); }),
            "file.json: /: found an object of 1 members; a text that is not empty is allowed");
  EXPECT_EQ(refusal([&] { read("5").at("z").number(); }), "file.json: /: found 5; an object is allowed");
}

TEST(JsonReader, KeepsMessagesShortAndOnOneLine) {
  const std::string message = refusal([] { read(R"(["line\n)" + std::string(200, 'x') + "\"]").numbers(); });
  EXPECT_EQ(message.find('\n'), std::string::npos);
  EXPECT_LT(message.size(), 130U);
  const std::string words = refusal([] { read(R"({"a\nb": "c\nd"})").at("a\nb").number(); });
  EXPECT_EQ(words, "file.json: /a\\nb: found \"c\\nd\"; a number is allowed");
}

TEST(JsonReader, ChecksRanges) {
  EXPECT_EQ(refusal([] { read("1.5").number(2); }), "file.json: /: found 1.5; a number >= 2 is allowed");
  EXPECT_EQ(refusal([] { read("1.5").number(2, 3); }), "file.json: /: found 1.5; a number from 2 to 3 is allowed");
  EXPECT_EQ(refusal([] { read("0").positive_number(); }), "file.json: /: found 0; a number > 0 is allowed");
  EXPECT_EQ(refusal([] { read("[]").items(2); }),
            "file.json: /: found a list of 0 items; a list of at least 2 is allowed");
  EXPECT_EQ(refusal([] { read("[1, null]").numbers(); }), "file.json: /1: found null; a number is allowed");
  EXPECT_EQ(refusal([] { read("[1, 2, 3]").numbers(2); }),
            "file.json: /: found a list of 3 items; a list of 1 to 2 numbers is allowed");
}

TEST(JsonReader, TakesWholeNumbersHoweverWritten) {
  constexpr auto largest = std::numeric_limits<std::int64_t>::max();
  EXPECT_EQ(read("5.0").integer(0, 9), 5);
  EXPECT_EQ(read("5e2").integer(0, 900), 500);
  EXPECT_EQ(read("-7").integer(-7, 0), -7);
  EXPECT_EQ(read("9223372036854775807").integer(0, largest), largest);
  for (const char* const bad :
       {"5.5", "9223372036854775808", "18446744073709551616", "1e300", "-1", "\"5\"", "null", "true"})
    EXPECT_THROW(read(bad).integer(0, largest), InputError) << bad;
}

TEST(JsonReader, SuggestsTheWordThatWasMeant) {
  EXPECT_EQ(refusal([] {
              read(R"("odrer1")").word({"order1", "linear"});
            }),
            "file.json: /: found \"odrer1\" (perhaps order1); one of order1, linear is allowed");
  EXPECT_EQ(refusal([] {
              read(R"({"sampling": 1, "shcemes": 2})").only({"sampling", "schemes"});
            }),
            "file.json: /shcemes: found an unknown key (perhaps schemes); one of sampling, schemes is allowed");
}

TEST(JsonReader, RefusesWhatIsNoJson) {
  const auto message = [](std::string_view text) { return refusal([text] { read(text); }); };
  EXPECT_EQ(message("nan"),
            "file.json: line 1, column 2: found invalid literal near 'na'; JSON as RFC 8259 defines it is allowed");
  EXPECT_TRUE(message("[1,\n  nan]").starts_with("file.json: line 2, column 4: found invalid literal near "));
  EXPECT_EQ(message(""),
            "file.json: line 1, column 1: found unexpected end of input; JSON as RFC 8259 defines it is allowed");
  EXPECT_EQ(message(R"({"a": {"b": 1, "b": 2}})"),
            "file.json: /a: found the key \"b\" twice; each key once is allowed");
  for (const char* const bad : {"[1,]", "{\"a\" 1}", "[1] 2", "[01]", "'a'", "[1e999]", "[-1e999]", "[Infinity]",
                                "[\"\x01\"]", "[\"\xff\"]", "// no\n1", "\xEF\xBB\xBF[1]", "[\"\\ud800\"]"})
    EXPECT_THROW(read(bad), InputError) << bad;
}

TEST(JsonReader, RefusesWhatIsTooDeepOrTooWide) {
  EXPECT_NO_THROW(read(std::string(64, '[') + std::string(64, ']')));
  EXPECT_THROW(read(std::string(65, '[') + std::string(65, ']')), InputError);
  EXPECT_THROW(read(std::string(1'000'000, '[')), InputError);
  std::string wide = "{";
  for (int i = 0; i < 1001; ++i) wide += fmt::format("{}\"{}\": 0", i > 0 ? "," : "", i);
  EXPECT_NE(refusal([&] { read(wide + "}"); }).find("more than 1000 members"), std::string::npos);
}

TEST(JsonReader, BlamesAPlaceForErrorsFromElsewhere) {
  const JsonReader json = read(R"({"volume": "v.nrrd"})");
  EXPECT_EQ(refusal([&] { json.at("volume").blame_for([] { throw InputError("v.nrrd: found nothing"); }); }),
            "file.json: /volume: v.nrrd: found nothing");
  EXPECT_EQ(json.blame_for([] { return 5; }), 5);
}

TEST(JsonReader, ResolvesPathsAgainstTheDocument) {
  EXPECT_EQ(JsonReader::from_text("1", "a/b.json").resolve("c.nrrd"), "a/c.nrrd");
  EXPECT_EQ(JsonReader::from_text("1", "b.json").resolve("c.nrrd"), "c.nrrd");
  EXPECT_EQ(JsonReader::from_text("1", "a/b.json").resolve("/c.nrrd"), "/c.nrrd");
}

}  // namespace
}  // namespace raytruth
