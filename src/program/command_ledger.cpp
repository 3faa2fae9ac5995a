#include "experiments/ledger.hpp"
#include "experiments/output.hpp"
#include "experiments/python.hpp"
#include "experiments/result.hpp"
#include "experiments/texts.hpp"
#include "program/command.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace raytruth {

namespace {

struct LedgerOptions {
  std::vector<std::string> results;  ///< empty: those in results/
  std::string file = "results/ledger.json";
  std::string page;  ///< empty: none
  std::string plots = "plots";
};

namespace fs = std::filesystem;

/// The results of a folder by name; not what else is JSON there, nor the ledger itself.
std::vector<JsonReader> results_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  if (error) throw InputError(fmt::format("{}: {}; a folder of results is allowed", folder.string(), error.message()));
  std::sort(files.begin(), files.end());
  std::vector<JsonReader> results;
  for (const fs::path& file : files) {
    const JsonReader json = JsonReader::from_file(file.string());
    const auto format = json.is_object() ? json.find("raytruth") : std::nullopt;
    if (!format || format->json() != "result/1") continue;
    if (json.at("experiment").at("name").text() != "ledger") results.push_back(read_result(file.string()));
  }
  if (results.empty())
    throw InputError(fmt::format("{}: found no results; what `raytruth run` writes is allowed", folder.string()));
  return results;
}

void write_page(const fs::path& ledger, const fs::path& page, const std::string& plots) {
  const auto temporary = temporary_beside(page);
  const auto outcome = run_python(ledger_page_script, {ledger.string(), plots, temporary.string()});
  std::error_code ignored;
  if (outcome.status == 0) return move_into_place(temporary, page);
  fs::remove(temporary, ignored);
  throw OutputError(fmt::format("{}: cannot be written: {}", page.string(), outcome.last_error()));
}

int keep_ledger(const LedgerOptions& options) {
  std::vector<JsonReader> results;
  for (const std::string& path : options.results) results.push_back(read_result(path));
  if (results.empty()) results = results_in("results");
  const nlohmann::ordered_json ledger = make_ledger(results);
  write_whole(options.file, result_text(ledger));
  if (!options.page.empty()) write_page(options.file, options.page, options.plots);
  print(claims_table(ledger.at("rows")));
  return 0;
}

std::function<int()> describe(CommandOptions& add) {
  const auto options = std::make_shared<LedgerOptions>();
  add.optional_operands("result", options->results, "JSON files (default: those in results/)");
  add.text("-o", "FILE", options->file, "Write the ledger, a result, to this file (default: results/ledger.json)");
  add.text("--page", "FILE", options->page, "Write a page for people too, with the experiments' plots");
  add.text("--plots", "DIR", options->plots, "Where the page's plots are, NAME.svg (default: plots)");
  return [options] { return keep_ledger(*options); };
}

}  // namespace

extern const Command ledger_command;
const Command ledger_command{.name = "ledger",
                             .summary = "Collect the verdicts of results on the publications' claims",
                             .example = "raytruth ledger --page plots/ledger.html",
                             .notes = "",
                             .describe = describe};

}  // namespace raytruth
