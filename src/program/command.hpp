#pragma once

#include "raytruth/documents/volume_source.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace raytruth {

/// What the options that concern volumes say.
struct VolumeOptions {
  std::string data;  ///< folders, separated by ':'
  std::optional<double> nan;
};

/// A quarter of this machine's memory: `memory_limit` where --memory-limit does not say.
std::uint64_t default_memory_limit();

/// What they say, for whoever reads volumes. Remarks on folders of --data that are not there.
VolumeAccess volume_access(const VolumeOptions& options);

/// The options of a command as it describes them: where each value goes, what it is called and what it means. Parsing,
/// --help and the refusal of other words follow. The places must live until the command has run.
class CommandOptions {
 public:
  explicit CommandOptions(CLI::App& parser) : parser_(parser) {}

  // What stands without an option's name.

  void operand(const std::string& name, std::string& value, const std::string& summary);
  /// One of these words, or nothing.
  void optional_operand(const std::string& name, std::string& value, const std::vector<std::string>& words,
                        const std::string& summary);
  void operands(const std::string& name, std::vector<std::string>& values, const std::string& summary);
  void optional_operands(const std::string& name, std::vector<std::string>& values, const std::string& summary);

  // What follows an option's name; `type` is how --help calls it.

  void text(const std::string& name, const std::string& type, std::string& value, const std::string& summary);
  void text(const std::string& name, const std::string& type, std::optional<std::string>& value,
            const std::string& summary);
  /// The command is refused without it.
  void required_text(const std::string& name, const std::string& type, std::string& value, const std::string& summary);
  void word(const std::string& name, std::string& value, const std::vector<std::string>& words,
            const std::string& summary);
  void word(const std::string& name, std::optional<std::string>& value, const std::vector<std::string>& words,
            const std::string& summary);
  void positive_number(const std::string& name, double& value, const std::string& summary);

  /// A whole number from 1 on.
  void count(const std::string& name, std::int64_t most, std::int64_t& value, const std::string& summary);
  void positive_number(const std::string& name, std::optional<double>& value, const std::string& summary);
  /// Two numbers, or none.
  void pair(const std::string& name, const std::string& type, std::vector<double>& values, const std::string& summary);

  void flag(const std::string& name, bool& value, const std::string& summary);

  // Options that several commands have.

  void threads(int& value);
  void programs(bool& value);
  void data(VolumeOptions& volumes);
  void nan(VolumeOptions& volumes);
  void time_step(std::optional<std::int64_t>& value);
  void spacing(std::vector<double>& value);
  void seed(std::int64_t& value, const std::string& summary);
  void seed(std::optional<std::int64_t>& value, const std::string& summary);

  /// The whole program, with all commands once all have been described.
  [[nodiscard]] const CLI::App& program() const;

 private:
  CLI::App& parser_;
};

/// What the program can be told to do: a row of `commands()`. It throws InputError (exit code 2), MissingError (3) or
/// OutputError (4).
struct Command {
  std::string_view name;
  std::string_view summary;
  std::string_view example;  ///< a command line
  std::string_view notes;    ///< before it in --help; empty: none
  /// Describes its options, and returns what does the work once they are read: the exit code.
  std::function<int()> (*describe)(CommandOptions&);
};

/// What the program's exit codes mean, each with its number.
inline constexpr std::array exit_codes{"0 done", "1 a bound does not hold (--check)", "2 bad input",
                                       "3 something is missing here", "4 the answer could not be written"};

/// All of them, in the order of --help; commands.cpp names them.
std::span<const Command* const> commands();

}  // namespace raytruth
