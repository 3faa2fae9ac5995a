#pragma once

#include "raytruth/documents/json/json_reader.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

/// A method from outside: a program that reads a question, one JSON document, from standard input, and writes the
/// answer to standard output. A document may name one where it may name a scheme. It must only be run where whoever
/// started this program allows it: a file that names a program would else be a file that runs it.
struct OutsideProgram {
  std::string name;                  ///< what rows call it
  std::vector<std::string> command;  ///< its words, the program first; no shell reads them
  std::vector<std::string> version;  ///< a command whose first line is the version; empty: none is stated
  std::string package;               ///< to be installed where something is missing; empty: none is stated
  std::filesystem::path folder;      ///< in which it runs: that of the document that names it
  double seconds = 0;                ///< that it may take
  std::int64_t megabytes = 0;        ///< of 10^6 bytes that it may answer
};

/// Why nothing came back that can be used, in one line: the `why` of a row that is refused.
struct OutsideRefusal : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Its reason: this machine lacks the program, or something that it needs.
struct OutsideMissing : OutsideRefusal {
  using OutsideRefusal::OutsideRefusal;
};

/// Why a program is not run where it is not allowed to.
inline constexpr std::string_view why_not_run = "it is a program, and programs run with --programs only";

/// Whether a scheme is named by a program, not by a word.
bool is_outside_program(const JsonReader& scheme);

/// Reads {"program": [...], "name": "...", "version": [...], "package": "...", "seconds": 600, "megabytes": 64}; all
/// but the first two may be left out. Throws InputError.
OutsideProgram read_outside_program(const JsonReader& json);

/// What came back.
struct OutsideAnswer {
  std::string bytes;
  std::optional<std::string> version = {};
};

/// Runs the program, and asks for its version first. One runs at a time, in a process group of its own that ends with
/// it: at its limits, and where this program is interrupted. Throws OutsideMissing for a program that
/// is not there, or ends with exit code 3, by which it says that something is missing; OutsideRefusal for one that
/// takes or writes too much, or ends with another code than 0.
OutsideAnswer ask(const OutsideProgram& program, std::string_view question);

/// A folder for what is handed to a program by name; it goes with all that is in it.
class TemporaryFolder {
 public:
  /// Throws OutsideRefusal where there is no place for one.
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  TemporaryFolder(TemporaryFolder&&) = delete;
  TemporaryFolder& operator=(TemporaryFolder&&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace raytruth
