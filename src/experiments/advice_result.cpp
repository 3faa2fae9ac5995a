#include "experiments/advice_result.hpp"

#include "experiments/columns.hpp"
#include "experiments/result.hpp"
#include "raytruth/documents/camera_json.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kind_of(ErrorKind kind) { return error_kind_names[static_cast<std::size_t>(kind)]; }

/// Fewer rays that see anything are too few to tell what keeps an error.
constexpr std::int64_t few_rays = 64;

std::string_view words_of(ErrorKind kind) {
  constexpr std::array<std::string_view, 3> words{"RMSE of colours", "largest error of a colour",
                                                  "largest error of a colour encoded as sRGB"};
  return words[static_cast<std::size_t>(kind)];
}

const SceneTable* table_of(const Way& way) { return way.table ? &*way.table : nullptr; }

/// How a series of the plot is called.
std::string method_of(const Way& way) {
  if (!way.table) return way.scheme;
  return fmt::format("{}, table in {}", way.scheme, way.table->format.name);
}

Columns<Way> way_columns() {
  const auto of_table = [](auto member) {
    return [member](const Way& way) -> Value {
      const SceneTable* const table = table_of(way);
      return table == nullptr ? Value() : value_of(member(*table));
    };
  };
  const auto of_error = [](double ErrorEstimate::*member) {
    return [member](const Way& way) -> Value { return way.refusal.empty() ? Value(way.error.*member) : Value(); };
  };
  return {
      {.name = "scheme", .description = "of `raytruth list schemes`", .is_key = true, .cell = &Way::scheme},
      {.name = "step",
       .unit = "smallest spacing",
       .description = "of samples; null: cell by cell",
       .is_key = true,
       .cell = &Way::step},
      {.name = "builder",
       .description = "of the table that slabs are read from; null: none is",
       .is_key = true,
       .cell = of_table([](const SceneTable& table) { return table.builder; })},
      {.name = "table_size",
       .description = "entries along each side of the table",
       .is_key = true,
       .cell = of_table([](const SceneTable& table) { return table.size; })},
      {.name = "format",
       .description = "of the table's numbers",
       .is_key = true,
       .cell = of_table([](const SceneTable& table) { return std::string(table.format.name); })},
      {.name = "method", .description = "scheme, and format of the table", .cell = method_of},
      {.name = "table_bytes", .unit = "byte", .description = "of the table", .cell = &Way::table_bytes},
      {.name = "samples", .description = "of the volume for a pixel, mean", .cell = &Way::samples},
      {.name = "look_ups",
       .description = "of the transfer function or the table for a pixel, mean",
       .cell = &Way::look_ups},
      {.name = "reads", .description = "cost: samples and look-ups", .cell = &Way::reads},
      {.name = "error",
       .description = "estimated for all pixels of the views",
       .cell = of_error(&ErrorEstimate::value)},
      {.name = "error_low", .description = "lower bound of the estimate", .cell = of_error(&ErrorEstimate::low)},
      {.name = "error_high",
       .description = "upper bound of the estimate, which is compared with the error asked for",
       .cell = of_error(&ErrorEstimate::high)},
      {.name = "rays", .description = "pixels that were looked at", .cell = &Way::rays},
      {.name = "standing",
       .description = "keeps the error, exceeds it, is undecided, or not_needed: it costs more than one that keeps it",
       .cell = [](const Way& way) -> Value {
         return way.refusal.empty() ? Value(std::string(standing_names[static_cast<std::size_t>(way.standing)]))
                                    : Value();
       }},
      {.name = "status",
       .description = "ok, or refused: the scheme cannot render the scene",
       .cell = [](const Way& way) { return std::string(way.refusal.empty() ? "ok" : "refused"); }},
      {.name = "why",
       .description = "why it is refused",
       .cell = [](const Way& way) -> Value { return way.refusal.empty() ? Value() : Value(way.refusal); }},
  };
}

Json way_json(const std::vector<Way>& ways, std::optional<std::size_t> which) {
  return which ? to_json(row_of(way_columns(), ways[*which])) : Json();
}

/// A curve for each method, without the ways that are refused, and the error that is asked for.
Json plot_json(const AdviceRequest& request) {
  return {{"title", "What keeps the error, and what it costs"},
          {"note", fmt::format("asked for: {} of at most {}", words_of(request.kind), request.error)},
          {"panels",
           {{{"kind", "lines"},
             {"rows", {{"status", "ok"}}},
             {"x", "reads"},
             {"y", "error_high"},
             {"series", "method"},
             {"title", "Error against cost"},
             {"label_x", "samples and look-ups for a pixel"},
             {"label_y", fmt::format("{}, upper bound", words_of(request.kind))},
             {"log_x", true},
             {"log_y", true}}}}};
}

std::string bytes_text(std::size_t bytes) {
  if (bytes >= std::size_t{1} << 20) return fmt::format("{:.3g} MiB", static_cast<double>(bytes) / (1 << 20));
  return fmt::format("{:.3g} KiB", static_cast<double>(bytes) / 1024);
}

/// "order1 at steps of 0.5 from a table of 256 x 256 in float16 (512 KiB)".
std::string way_text(const Way& way) {
  std::string text = way.scheme;
  text += way.step ? fmt::format(" at steps of {}", *way.step) : " in every cell";
  if (!way.table) return text;
  const SceneTable& table = *way.table;
  const bool has_three_axes = way.table_bytes > 4 * table.format.bytes * table.size * table.size;
  return text + fmt::format(" from a table ({}) of {}{} in {} ({})", table.builder,
                            fmt::format("{0} x {0}", table.size),
                            has_three_axes ? fmt::format(" x {}", table.size) : "", table.format.name,
                            bytes_text(way.table_bytes));
}

}  // namespace

Json advice_result(const AdviceDocument& asked, const Advice& advice) {
  const AdviceRequest& request = asked.request;
  Json rows = Json::array();
  for (const Way& way : advice.ways) rows.push_back(to_json(row_of(way_columns(), way)));
  Json columns = Json::object();
  for (const RecordColumn<Way>& column : way_columns()) {
    columns[column.name] = {{"unit", column.unit}, {"description", column.description}};
    if (column.is_key) columns[column.name]["key"] = true;
  }
  Json views = Json::array();
  for (const Camera& camera : request.views) views.push_back(camera_json(camera));
  return {{"raytruth", "result/1"},
          {"experiment",
           {{"raytruth", "experiment/1"},
            {"name", "advice"},
            {"question", "Which is the cheapest way to render the scene that keeps the error?"},
            {"seed", request.seed},
            {"plot", plot_json(request)}}},
          {"provenance", build_identity()},
          {"styles", Json::object()},
          {"fields", Json::object()},
          {"columns", std::move(columns)},
          {"advice",
           {{"error", {{"of", kind_of(request.kind)}, {"at_most", request.error}}},
            {"confidence", request.confidence},
            {"best", way_json(advice.ways, advice.best)},
            {advice.best ? "next_cheaper" : "closest", way_json(advice.ways, advice.next_cheaper)},
            {"settled", advice.is_settled},
            {"rays", advice.rays},
            {"rays_with_matter", advice.rays_with_matter},
            {"pixels", advice.pixels},
            {"truth", {{"certified", advice.is_certified}, {"radius_max", advice.truth_radius}}},
            {"volume", asked.volume},
            {"transfer_function", asked.transfer_function},
            {"views", std::move(views)},
            {"warnings", asked.warnings}}},
          {"rows", std::move(rows)},
          {"published", Json::array()},
          {"checks", Json::array()}};
}

std::string advice_text(const AdviceDocument& asked, const Advice& advice) {
  const AdviceRequest& request = asked.request;
  std::string text = fmt::format("asked for       {} of at most {:.4g}, with a confidence of {:.0f} %\n",
                                 words_of(request.kind), request.error, 100 * request.confidence);
  text += fmt::format("looked at       {} of {} pixels in {} view{}, against {} values\n", advice.rays, advice.pixels,
                      request.views.size(), request.views.size() == 1 ? "" : "s",
                      advice.is_certified ? "certified" : "estimated");
  const auto line = [&](std::string_view name, const Way& way) {
    return fmt::format("{:<14}  {}\n                error {:.2g} ({:.2g} to {:.2g}), {:.0f} reads for a pixel\n", name,
                       way_text(way), way.error.value, way.error.low, way.error.high, way.reads());
  };
  if (advice.best)
    text += line("take", advice.ways[*advice.best]);
  else
    text += "take            nothing that was tried keeps it: ask for a larger error, or see what comes closest\n";
  if (advice.next_cheaper) text += line(advice.best ? "next cheaper" : "closest", advice.ways[*advice.next_cheaper]);
  if (!advice.best && advice.rays_with_matter < few_rays)
    text += fmt::format("too little seen {} of the pixels that were looked at see anything: --rays allows more\n",
                        advice.rays_with_matter);
  else if (!advice.is_settled)
    text += "not settled     a cheaper way may keep it too: --rays allows more to be looked at\n";

  text += fmt::format("\n{:>9}  {:>9}  {:>9}  {:<10}  {}\n", "reads", "error", "at most", "standing", "way");
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < advice.ways.size() && i <= advice.best.value_or(advice.ways.size()); ++i) {
    const Way& way = advice.ways[i];
    if (!way.refusal.empty() || way.error.value >= least) continue;  // a cheaper one is as good
    least = way.error.value;
    text += fmt::format("{:>9.0f}  {:>9.2g}  {:>9.2g}  {:<10}  {}{}\n", way.reads(), way.error.value, way.error.high,
                        standing_names[static_cast<std::size_t>(way.standing)], way_text(way),
                        advice.best == i ? "  <-" : "");
  }
  return text;
}

}  // namespace raytruth
