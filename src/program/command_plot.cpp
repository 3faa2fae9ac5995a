#include "experiments/output.hpp"
#include "experiments/python.hpp"
#include "experiments/result.hpp"
#include "experiments/texts.hpp"
#include "program/commands.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

namespace raytruth {

namespace {

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

}  // namespace

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

}  // namespace raytruth
