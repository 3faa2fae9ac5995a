#include "experiments/output.hpp"
#include "experiments/python.hpp"
#include "experiments/result.hpp"
#include "experiments/texts.hpp"
#include "program/command.hpp"
#include "raytruth/core/one_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace raytruth {

namespace {

struct PlotOptions {
  std::vector<std::string> results;
  std::string folder = ".";
  std::string format = "svg";
};

/// A plot to be drawn: the script writes to `temporary`, which takes the place of `file` once it is whole.
struct Drawing {
  std::string result;
  std::filesystem::path file;
  std::filesystem::path temporary;
};

/// Those of the results whose experiment asks for a plot.
std::vector<Drawing> drawings_of(const PlotOptions& options) {
  std::vector<Drawing> drawings;
  for (const std::string& path : options.results) {
    const JsonReader experiment = read_result(path).at("experiment");
    if (!experiment.find("plot") && options.results.size() > 1) {
      say(fmt::format("{}: its experiment asks for no plot", path));
      continue;
    }
    experiment.at("plot").members();
    const std::string name = std::filesystem::path(path).stem().string() + "." + options.format;
    const auto file = std::filesystem::path(options.folder) / name;
    drawings.push_back({path, file, temporary_beside(file)});
  }
  return drawings;
}

/// What the script says that it could not do of a plot ("drawn" or "written"), and why; nothing where it could.
std::optional<std::string> why_not(std::string_view done, const std::string& result, const PythonOutcome& outcome) {
  const std::string begin = fmt::format("cannot be {}: {}: ", done, result);
  const auto line = std::find_if(outcome.errors.begin(), outcome.errors.end(),
                                 [&begin](const std::string& error) { return error.starts_with(begin); });
  if (line == outcome.errors.end()) return std::nullopt;
  return one_line(line->substr(begin.size()));
}

/// How many plots there are now, and how many there would be if they could be written.
struct Drawn {
  std::size_t drawn = 0;
  std::size_t unwritten = 0;
};

/// Draws them, and says why some are not there.
Drawn draw(const std::vector<Drawing>& drawings, const std::string& format) {
  std::vector<std::string> arguments{format};
  for (const Drawing& drawing : drawings) {
    arguments.push_back(drawing.result);
    arguments.push_back(drawing.temporary.string());
  }
  const PythonOutcome outcome = run_python(plot_script, arguments);
  constexpr int no_matplotlib = 3;
  if (outcome.status == no_matplotlib)
    throw MissingError(
        fmt::format("python cannot import matplotlib ({}); install python3-matplotlib", outcome.last_error()));
  std::error_code ignored;
  Drawn result;
  // Where Python itself broke off, a file may be half a plot: then each is drawn alone.
  if (outcome.status != 0 && drawings.size() > 1) {
    for (const Drawing& drawing : drawings) {
      const Drawn one = draw({drawing}, format);
      result.drawn += one.drawn;
      result.unwritten += one.unwritten;
    }
    return result;
  }
  for (const Drawing& drawing : drawings) {
    if (outcome.status == 0 && std::filesystem::exists(drawing.temporary, ignored)) {
      move_into_place(drawing.temporary, drawing.file);
      ++result.drawn;
      continue;
    }
    std::filesystem::remove(drawing.temporary, ignored);
    if (const auto why = why_not("written", drawing.result, outcome)) {
      ++result.unwritten;
      say(fmt::format("{}: cannot be written: {}; a place that can be written to is allowed", drawing.file.string(),
                      *why));
    } else {
      say(fmt::format("{}: cannot be plotted: {}", drawing.result,
                      why_not("drawn", drawing.result, outcome).value_or(one_line(outcome.last_error()))));
    }
  }
  return result;
}

int plot_results(const PlotOptions& options) {
  const std::vector<Drawing> drawings = drawings_of(options);
  if (drawings.empty()) return 0;
  make_folder(options.folder);
  constexpr int bad_input = 2;
  constexpr int not_written = 4;
  const Drawn result = draw(drawings, options.format);
  if (result.unwritten > 0) return not_written;
  return result.drawn > 0 ? 0 : bad_input;
}

std::function<int()> describe(CommandOptions& add) {
  const auto options = std::make_shared<PlotOptions>();
  add.operands("result", options->results, "JSON files");
  add.text("-o", "DIR", options->folder, "Write NAME.FORMAT into this folder (default: the current one)");
  add.word("--format", options->format, {"svg", "png", "pdf"}, "svg (default), png or pdf");
  return [options] { return plot_results(*options); };
}

}  // namespace

extern const Command plot_command;
const Command plot_command{.name = "plot",
                           .summary = "Draw the plots of results",
                           .example = "raytruth plot results/xi_adaptive.json -o plots",
                           .notes = "",
                           .describe = describe};

}  // namespace raytruth
