#include "experiments/advice_result.hpp"
#include "experiments/output.hpp"
#include "experiments/result.hpp"
#include "program/command.hpp"
#include "program/progress_bar.hpp"
#include "raytruth/documents/advice_document.hpp"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <nlohmann/json.hpp>

#include <memory>
#include <optional>
#include <string>

namespace raytruth {

namespace {

struct AdviseOptions {
  std::string scene;
  std::string error;
  std::string of = "rmse";
  std::int64_t views = 6;
  std::int64_t rays = 16384;
  std::int64_t seed = 1;
  int threads = 0;
  bool json = false;
  std::optional<std::string> file;
  VolumeOptions volumes;
};

constexpr std::int64_t most_views = 100;
constexpr std::int64_t most_rays = std::int64_t{1} << 24;

int give_advice(const AdviseOptions& options) {
  const int threads = options.threads > 0 ? options.threads : tbb::info::default_concurrency();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  const AdviceDocument asked =
      read_advice_document(JsonReader::from_file(options.scene), {.error = options.error,
                                                                  .of = options.of,
                                                                  .views = options.views,
                                                                  .seed = static_cast<std::uint64_t>(options.seed),
                                                                  .most_rays = options.rays,
                                                                  .volumes = volume_access(options.volumes)});
  for (const std::string& warning : asked.warnings) say(warning);
  const Advice advice = [&] {
    constexpr std::size_t parts = 1000;
    ProgressBar bar(parts);
    bar.show("comparing ways to render");
    std::size_t told = 0;
    return advise(asked.request, [&](std::size_t done, std::size_t of) {
      for (const std::size_t now = parts * done / of; told < now; ++told) bar.advance();
    });
  }();
  const auto result = advice_result(asked, advice);
  if (options.file) write_whole(*options.file, result_text(result));
  print(options.json ? result_text(result) : advice_text(asked, advice));
  return advice.best ? 0 : 1;
}

std::function<int()> describe(CommandOptions& add) {
  const auto options = std::make_shared<AdviseOptions>();
  add.operand("scene", options->scene, "JSON file; '-' is standard input. Without a camera: views from all around");
  add.required_text("--error", "E", options->error, "What the image may be off by: a number, or invisible (in 8 bits)");
  add.word("--of", options->of, {"rmse", "largest", "encoded"},
           "What the number bounds: the RMSE, the largest error, or that of sRGB values (default: rmse)");
  add.count("--views", most_views, options->views, "Of a scene without a camera (default: 6)");
  add.count("--rays", most_rays, options->rays, "At most so many pixels are looked at (default: 16384)");
  add.seed(options->seed, "Of the pixels that are looked at (default: 1)");
  add.threads(options->threads);
  add.flag("--json", options->json, "As JSON");
  add.text("-o", "FILE", options->file,
           "Write the JSON to this file too; `raytruth plot FILE` draws error against cost");
  add.data(options->volumes);
  add.nan(options->volumes);
  return [options] { return give_advice(*options); };
}

}  // namespace

extern const Command advise_command;
const Command advise_command{
    .name = "advise",
    .summary = "Find the cheapest scheme, step, table and format that keep an error, for a volume at hand",
    .example = "raytruth advise scene.json --error 0.002",
    .notes =
        "A scene needs a volume and a transfer function, of this or another program; what it says of a scheme, a step\n"
        "or a table is left aside. Ways to render are compared with certified rays (of lit scenes with estimates), at\n"
        "pixels that chance takes from equal parts of the image, until everything cheaper than the best is known to\n"
        "exceed the error. Cost: reads of the volume and of the transfer function or the table for a pixel, then the\n"
        "table's bytes. Steps are in smallest spacings, errors those of colours in linear light.\n"
        "\n"
        "`invisible`: no colour, encoded as sRGB, is off by more than half a step of 8 bits. For a largest error half "
        "of\n"
        "the rays goes to the neighbours of the worst pixels, uphill until nothing worse is found; what stands where\n"
        "neither chance nor that search came is estimated by the tail of the errors, not bounded.\n"
        "\n"
        "Ends with 1 where nothing that was tried keeps the error.",
    .describe = describe};

}  // namespace raytruth
