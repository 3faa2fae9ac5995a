#include "experiments/experiment.hpp"
#include "experiments/output.hpp"
#include "experiments/python.hpp"
#include "experiments/result.hpp"
#include "experiments/texts.hpp"
#include "program/command.hpp"
#include "raytruth/core/one_line.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace raytruth {

namespace {

/// How many panels may stand side by side.
const std::vector<std::string> column_counts{"1", "2", "3", "4", "5", "6", "7", "8"};

struct PlotOptions {
  std::vector<std::string> results;
  std::string folder = ".";
  std::string format = "svg";
  std::optional<std::string> specification;  ///< the experiment whose plot is drawn instead of the results' own
  std::optional<double> width;               ///< inches
  std::optional<std::string> columns;
  std::optional<double> font_size;  ///< points
};

/// A plot to be drawn: the script writes to `temporary`, which takes the place of `file` once it is whole.
struct Drawing {
  std::string result;
  std::string plot;  ///< a specification that takes the place of the result's, as JSON; empty: none
  std::filesystem::path file;
  std::filesystem::path temporary;
};

/// The columns that a panel names, with their places.
std::vector<std::pair<JsonReader, std::string>> columns_of(const JsonReader& panel) {
  std::vector<std::pair<JsonReader, std::string>> columns;
  for (const char* const key :
       {"value", "low", "high", "group", "series", "printed", "x", "y", "front", "line", "pixels"}) {
    const auto named = panel.find(key);
    if (!named) continue;
    const bool is_distribution = key == std::string_view("value") && panel.at("kind").text() == "quantiles";
    columns.emplace_back(*named, named->text() + (is_distribution ? "_p50" : ""));
  }
  for (const auto& [name, value] : panel.at("rows").members()) columns.emplace_back(value, name);
  return columns;
}

/// Refuses a plot that asks for columns which the result does not have.
void need_columns(const JsonReader& plot, const JsonReader& result, const std::string& path) {
  const JsonReader columns = result.at("columns");
  for (const JsonReader& panel : plot.at("panels").items())
    for (const auto& [place, name] : columns_of(panel))
      if (!columns.find(name))
        place.refuse(fmt::format("the column \"{}\", which {} does not have", name, path),
                     "a column of the result, or the result of a new run,");
}

/// The plot that a specification asks for of a result. Throws InputError where it is another experiment's.
JsonReader plot_for(const std::string& specification, const JsonReader& result, const std::string& path) {
  const auto profile = result.at("provenance").find("profile");
  const Experiment experiment =
      read_experiment(specification, profile ? profile->text() : "full", std::nullopt, std::nullopt);
  const JsonReader name = result.at("experiment").at("name");
  if (name.text() != experiment.name)
    name.refuse(fmt::format("\"{}\"", name.text()),
                fmt::format("a result of \"{}\", whose specification {} is,", experiment.name, specification));
  JsonReader plot = experiment.json.at("plot");
  need_columns(plot, result, path);
  return plot;
}

/// Those of the results whose experiment asks for a plot.
std::vector<Drawing> drawings_of(const PlotOptions& options) {
  std::vector<Drawing> drawings;
  for (const std::string& path : options.results) {
    const JsonReader result = read_result(path);
    const JsonReader experiment = result.at("experiment");
    std::string plot;
    if (options.specification) {
      plot = plot_for(*options.specification, result, path).json().dump();
    } else if (!experiment.find("plot") && options.results.size() > 1) {
      say(fmt::format("{}: its experiment asks for no plot", path));
      continue;
    } else {
      experiment.at("plot").members();
    }
    const std::string name = std::filesystem::path(path).stem().string() + "." + options.format;
    const auto file = std::filesystem::path(options.folder) / name;
    drawings.push_back({path, std::move(plot), file, temporary_beside(file)});
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

/// What the script should know of how to draw.
std::string look_of(const PlotOptions& options) {
  nlohmann::ordered_json look{{"format", options.format}};
  if (options.width) look["width"] = *options.width;
  if (options.columns) look["columns"] = std::stoi(*options.columns);
  if (options.font_size) look["font_size"] = *options.font_size;
  return look.dump();
}

/// Draws them, and says why some are not there.
Drawn draw(const std::vector<Drawing>& drawings, const std::string& look) {
  std::vector<std::string> arguments{look};
  for (const Drawing& drawing : drawings)
    arguments.insert(arguments.end(), {drawing.result, drawing.temporary.string(), drawing.plot});
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
      const Drawn one = draw({drawing}, look);
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

/// Refuses a number that no plot can be made with.
void need_between(std::string_view option, const std::optional<double>& value, double low, double high) {
  if (value && !(*value >= low && *value <= high))
    throw InputError(fmt::format("{}: found {}; a number from {} to {} is allowed", option, *value, low, high));
}

int plot_results(const PlotOptions& options) {
  need_between("--width", options.width, 2, 60);
  need_between("--font-size", options.font_size, 4, 32);
  const std::vector<Drawing> drawings = drawings_of(options);
  if (drawings.empty()) return 0;
  make_folder(options.folder);
  constexpr int bad_input = 2;
  constexpr int not_written = 4;
  const Drawn result = draw(drawings, look_of(options));
  if (result.unwritten > 0) return not_written;
  return result.drawn > 0 ? 0 : bad_input;
}

std::function<int()> describe(CommandOptions& add) {
  const auto options = std::make_shared<PlotOptions>();
  add.operands("result", options->results, "JSON files");
  add.text("-o", "DIR", options->folder, "Write NAME.FORMAT into this folder (default: the current one)");
  add.word("--format", options->format, {"svg", "png", "pdf"}, "svg (default), png or pdf");
  add.text("--spec", "EXPERIMENT", options->specification,
           "Draw what this experiment's \"plot\" says, not what the result's does; nothing runs again");
  add.positive_number("--width", options->width, "Inches, of the whole plot (default: 3.7 for each column of panels)");
  add.word("--columns", options->columns, column_counts, "Panels side by side (default: as the experiment says)");
  add.positive_number("--font-size", options->font_size, "Points, of labels; other text keeps to it (default: 8)");
  return [options] { return plot_results(*options); };
}

}  // namespace

extern const Command plot_command;
const Command plot_command{.name = "plot",
                           .summary = "Draw the plots of results",
                           .example = "raytruth plot results/xi_adaptive.json -o plots",
                           .notes =
                               "For a publication: --format pdf (its fonts are TrueType) --width 3.4 --columns 1.\n"
                               "To change titles, labels or panels edit \"plot\" of the experiment and name it: --spec "
                               "experiments/xi_adaptive.json.",
                           .describe = describe};

}  // namespace raytruth
