#include "experiments/output.hpp"
#include "experiments/version.hpp"
#include "program/command.hpp"
#include "program/features.hpp"
#include "program/interruption.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/core/memory_limit.hpp"
#include "raytruth/core/one_line.hpp"
#include "raytruth/volume/files/find_volume.hpp"
#include "raytruth/volume/files/read_volume.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <csignal>
#include <exception>
#include <functional>
#include <limits>
#include <new>
#include <stdexcept>

namespace raytruth {

namespace {

constexpr int bad_input = 2;
constexpr int missing = 3;
constexpr int not_written = 4;
constexpr int most_threads = 9999;

CLI::Range any_seed() { return {std::int64_t{0}, std::numeric_limits<std::int64_t>::max()}; }

/// The command line: every command describes its options, and `chosen_` becomes what the one that is named does.
class CommandLine {
 public:
  CommandLine() {
    program_.require_subcommand(1);
    program_.set_version_flag("--version", fmt::format("raytruth {} ({})\n{}", version, commit, features()));
    program_.footer(fmt::format("Exit codes: {}.", fmt::join(exit_codes, "; ")));
    for (const Command* command : commands()) add(*command);
  }

  /// Returns the exit code.
  int run(int argc, char** argv) {
    try {
      program_.parse(argc, argv);
    } catch (const CLI::Success& request) {  // --help, --version
      std::ostringstream text;
      program_.exit(request, text, text);
      print(text.str() + (text.str().ends_with('\n') ? "" : "\n"));
      return 0;
    } catch (const CLI::ParseError& error) {
      if (program_.get_subcommands().empty() && argc > 1) refuse_command(argv[1]);
      throw InputError(fmt::format("command line: {}; `raytruth --help` tells what is allowed", error.what()));
    }
    set_memory_limit(memory_limit_);
    return chosen_();
  }

 private:
  void add(const Command& command) {
    CLI::App& added = *program_.add_subcommand(std::string(command.name), std::string(command.summary));
    CommandOptions options(added);
    const auto work = command.describe(options);
    added
        .add_option("--memory-limit", memory_limit_,
                    "Refuse volumes, images and documents that need more, as 64MiB or 8G (default: a quarter of this "
                    "machine's memory)")
        ->type_name("SIZE")
        ->envname("RAYTRUTH_MEMORY_LIMIT")
        ->transform(CLI::Validator(CLI::AsSizeValue(false)).description(""));
    added.callback([this, work] { chosen_ = work; });
    added.footer(
        fmt::format("{}{}Example:\n  {}", command.notes, command.notes.empty() ? "" : "\n\n", command.example));
  }

  [[noreturn]] void refuse_command(std::string_view found) {
    std::vector<std::string> names;
    for (const CLI::App* command : program_.get_subcommands({})) names.push_back(command->get_name());
    const auto closest = closest_word(found, names);
    throw InputError(fmt::format("command line: found {}{}; one of {} is allowed", found,
                                 closest.empty() ? "" : fmt::format(" (perhaps {})", closest), fmt::join(names, ", ")));
  }

  CLI::App program_{"Exact rays through volumes, and how far the schemes of volume rendering are from them.",
                    "raytruth"};
  std::uint64_t memory_limit_ = default_memory_limit();  ///< bytes, for one thing that a file announces
  std::function<int()> chosen_;
};

int run_program(int argc, char** argv) {
  try {
    // A reader that stops early, as `head` does, shows as an error of writing.
    std::signal(SIGPIPE, SIG_IGN);
    const InterruptionNotice told_at_ctrl_c("\nraytruth: interrupted; what was not finished is not written\n");
    return CommandLine().run(argc, argv);
  } catch (const InputError& error) {
    say(error.what());
    return bad_input;
  } catch (const MissingError& error) {
    say(error.what());
    return missing;
  } catch (const OutputError& error) {
    say(error.what());
    return not_written;
  } catch (const std::bad_alloc&) {
    say("this needs more memory than the machine has");
    return missing;
  } catch (const std::exception& error) {
    say(fmt::format("this should not have happened: {}", error.what()));
    return bad_input;
  }
}

}  // namespace

const CLI::App& CommandOptions::program() const { return *parser_.get_parent(); }

void CommandOptions::operand(const std::string& name, std::string& value, const std::string& summary) {
  parser_.add_option(name, value, summary)->required();
}

void CommandOptions::optional_operand(const std::string& name, std::string& value,
                                      const std::vector<std::string>& words, const std::string& summary) {
  parser_.add_option(name, value, summary)->check(CLI::IsMember(words));
}

void CommandOptions::operands(const std::string& name, std::vector<std::string>& values, const std::string& summary) {
  parser_.add_option(name, values, summary)->required();
}

void CommandOptions::optional_operands(const std::string& name, std::vector<std::string>& values,
                                       const std::string& summary) {
  parser_.add_option(name, values, summary);
}

void CommandOptions::text(const std::string& name, const std::string& type, std::string& value,
                          const std::string& summary) {
  parser_.add_option(name, value, summary)->type_name(type);
}

void CommandOptions::text(const std::string& name, const std::string& type, std::optional<std::string>& value,
                          const std::string& summary) {
  parser_.add_option(name, value, summary)->type_name(type);
}

void CommandOptions::required_text(const std::string& name, const std::string& type, std::string& value,
                                   const std::string& summary) {
  parser_.add_option(name, value, summary)->type_name(type)->required();
}

void CommandOptions::word(const std::string& name, std::string& value, const std::vector<std::string>& words,
                          const std::string& summary) {
  parser_.add_option(name, value, summary)->type_name("NAME")->check(CLI::IsMember(words));
}

void CommandOptions::word(const std::string& name, std::optional<std::string>& value,
                          const std::vector<std::string>& words, const std::string& summary) {
  parser_.add_option(name, value, summary)->type_name("NAME")->check(CLI::IsMember(words));
}

void CommandOptions::positive_number(const std::string& name, double& value, const std::string& summary) {
  parser_.add_option(name, value, summary)->type_name("X")->check(CLI::PositiveNumber);
}

void CommandOptions::positive_number(const std::string& name, std::optional<double>& value,
                                     const std::string& summary) {
  parser_.add_option(name, value, summary)->type_name("X")->check(CLI::PositiveNumber);
}

void CommandOptions::pair(const std::string& name, const std::string& type, std::vector<double>& values,
                          const std::string& summary) {
  parser_.add_option(name, values, summary)->type_name(type)->expected(2);
}

void CommandOptions::flag(const std::string& name, bool& value, const std::string& summary) {
  parser_.add_flag(name, value, summary);
}

void CommandOptions::programs(bool& value) {
  flag("--programs", value, "Run the programs that the file names as schemes; else they are refused");
}

void CommandOptions::threads(int& value) {
  parser_.add_option("-j", value, "Threads to use (default: all cores)")
      ->type_name("N")
      ->check(CLI::Range(1, most_threads));
}

void CommandOptions::data(VolumeOptions& volumes) {
  parser_.add_option("--data", volumes.data, "Folders of volumes, separated by ':'; before those of RAYTRUTH_DATA")
      ->type_name("DIR");
}

void CommandOptions::nan(VolumeOptions& volumes) {
  parser_
      .add_option("--nan", volumes.nan,
                  "Give voxels of files that are NaN this value (default: such files are refused)")
      ->type_name("VALUE");
}

void CommandOptions::count(const std::string& name, std::int64_t most, std::int64_t& value,
                           const std::string& summary) {
  parser_.add_option(name, value, summary)->type_name("N")->check(CLI::Range(std::int64_t{1}, most));
}

void CommandOptions::time_step(std::optional<std::int64_t>& value) {
  parser_.add_option("--time-step", value, "Read this volume of a series, from 0 (default: series are refused)")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber);
}

void CommandOptions::spacing(std::vector<double>& value) {
  parser_.add_option("--spacing", value, "Distances of voxels along x, y and z, instead of the file's")
      ->type_name("X")
      ->expected(3)
      ->check(CLI::PositiveNumber);
}

std::uint64_t default_memory_limit() { return memory_of_machine() / 4; }

VolumeAccess volume_access(const VolumeOptions& options) {
  if (options.nan && !std::isfinite(*options.nan))
    throw InputError(fmt::format("command line: --nan: found {}; a finite number is allowed", *options.nan));
  for (const auto& folder : absent_folders(folders_in(options.data)))
    say(fmt::format("warning: --data: {}: there is no such folder", folder.string()));
  return {.folders = volume_folders(options.data), .nan = options.nan, .memory_limit = memory_limit()};
}

void CommandOptions::seed(std::int64_t& value, const std::string& summary) {
  parser_.add_option("--seed", value, summary)->type_name("S")->check(any_seed());
}

void CommandOptions::seed(std::optional<std::int64_t>& value, const std::string& summary) {
  parser_.add_option("--seed", value, summary)->type_name("S")->check(any_seed());
}

}  // namespace raytruth

int main(int argc, char** argv) { return raytruth::run_program(argc, argv); }
