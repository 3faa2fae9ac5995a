#include "experiments/output.hpp"
#include "experiments/result.hpp"
#include "program/command.hpp"
#include "raytruth/documents/conformance/vectors.hpp"

#include <nlohmann/json.hpp>

namespace raytruth {

namespace {

struct VectorsOptions {
  std::optional<std::string> file;  ///< none: standard output
  std::int64_t seed = 1;
};

int write_vectors(const VectorsOptions& options) {
  const std::string text = result_text(vectors_json(static_cast<std::uint64_t>(options.seed)));
  if (options.file)
    write_whole(*options.file, text);
  else
    print(text);
  return 0;
}

std::function<int()> describe(CommandOptions& add) {
  const auto options = std::make_shared<VectorsOptions>();
  add.text("-o", "FILE", options->file, "Write this file (default: to standard output)");
  add.seed(options->seed, "Other vectors of the same levels (default: 1)");
  return [options] { return write_vectors(*options); };
}

}  // namespace

extern const Command vectors_command;
const Command vectors_command{
    .name = "vectors",
    .summary = "Write the conformance vectors: rays and slabs with certified colour and opacity, for any renderer",
    .example = "raytruth vectors -o vectors.json",
    .notes = "",
    .describe = describe};

}  // namespace raytruth
