#include "raytruth/documents/outside_program.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace raytruth {
namespace {

OutsideProgram program_of(std::vector<std::string> command) {
  return {.name = "one",
          .command = std::move(command),
          .version = {},
          .package = {},
          .folder = {},
          .seconds = 10,
          .megabytes = 1};
}

OutsideProgram read(const std::string& text) { return read_outside_program(JsonReader::from_text(text, "a.json")); }

TEST(OutsideProgram, IsReadWithDefaults) {
  const OutsideProgram program = read(R"({"program": ["cat", "x"], "name": "one"})");
  EXPECT_EQ(program.command, (std::vector<std::string>{"cat", "x"}));
  EXPECT_EQ(program.seconds, 600);
  EXPECT_EQ(program.megabytes, 64);
  EXPECT_TRUE(program.version.empty());
}

TEST(OutsideProgram, RefusesWhatItCannotRun) {
  for (const char* const text :
       {R"({"program": [], "name": "one"})", R"({"program": "cat", "name": "one"})", R"({"program": ["cat"]})",
        R"({"program": ["cat", ""], "name": "one"})", R"({"program": ["c\u0000t"], "name": "one"})",
        R"({"program": ["cat"], "name": "one", "seconds": 0})",
        R"({"program": ["cat"], "name": "one", "megabytes": 0.5})",
        R"({"program": ["cat"], "name": "one", "shell": true})"})
    EXPECT_THROW(read(text), InputError) << text;
}

TEST(OutsideProgram, AnswersWhatItReads) {
  const std::string question(3'000'000, 'q');  // more than a pipe holds
  OutsideProgram program = program_of({"cat"});
  program.megabytes = 3;
  EXPECT_EQ(ask(program, question).bytes, question);
  EXPECT_EQ(ask(program_of({"true"}), question).bytes, "");  // which reads nothing
}

TEST(OutsideProgram, StatesItsVersion) {
  OutsideProgram program = program_of({"cat"});
  program.version = {"printf", "one 1.2\nmore\n"};
  EXPECT_EQ(ask(program, "").version, "one 1.2");
  EXPECT_EQ(ask(program_of({"cat"}), "").version, std::nullopt);
}

TEST(OutsideProgram, KeepsItsLimits) {
  OutsideProgram slow = program_of({"sleep", "100"});
  slow.seconds = 0.1;
  EXPECT_THROW(ask(slow, ""), OutsideRefusal);
  EXPECT_THROW(ask(program_of({"yes"}), ""), OutsideRefusal);  // more than a megabyte
}

TEST(OutsideProgram, TellsWhatIsMissing) {
  OutsideProgram missing = program_of({"no_such_program"});
  missing.package = "no-such-package";
  try {
    ask(missing, "");
    FAIL();
  } catch (const OutsideMissing& error) {
    EXPECT_NE(std::string(error.what()).find("no-such-package"), std::string::npos);
  }
  EXPECT_THROW(ask(program_of({"false"}), ""), OutsideRefusal);
}

TEST(OutsideProgram, RunsInItsFolder) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "here") << "found";
  OutsideProgram program = program_of({"cat", "here"});
  program.folder = folder.path();
  EXPECT_EQ(ask(program, "").bytes, "found");
}

TEST(TemporaryFolder, IsGoneAfterwards) {
  std::filesystem::path path;
  {
    const TemporaryFolder folder;
    path = folder.path();
    std::ofstream(path / "file") << "x";
    EXPECT_TRUE(std::filesystem::exists(path / "file"));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace raytruth
