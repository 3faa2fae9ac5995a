#include "experiments/output.hpp"
#include "experiments/python.hpp"
#include "experiments/result.hpp"
#include "experiments/texts.hpp"
#include "program/command.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

namespace raytruth {

namespace {

struct PlotOptions {
  std::vector<std::string> results;
  std::string folder = ".";
  std::string format = "svg";
};

void require_matplotlib() {
  const auto outcome = run_python("import matplotlib", {});
  if (outcome.status != 0)
    throw MissingError(
        fmt::format("python cannot import matplotlib ({}); install python3-matplotlib", outcome.last_error));
}

void plot_result(const std::filesystem::path& result, const std::filesystem::path& file, const std::string& format) {
  const auto temporary = temporary_beside(file);
  const auto outcome = run_python(plot_script, {temporary.string(), format, result.string()});
  std::error_code ignored;
  if (outcome.status == 0 && std::filesystem::exists(temporary, ignored)) return move_into_place(temporary, file);
  std::filesystem::remove(temporary, ignored);
  throw InputError(fmt::format("{}: cannot be plotted: {}", result.string(), outcome.last_error));
}

int plot_results(const PlotOptions& options) {
  for (const std::string& path : options.results) read_result(path).at("experiment").at("plot").members();
  require_matplotlib();
  make_folder(options.folder);
  for (const std::string& path : options.results) {
    const std::filesystem::path result(path);
    plot_result(result, std::filesystem::path(options.folder) / (result.stem().string() + "." + options.format),
                options.format);
  }
  return 0;
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
