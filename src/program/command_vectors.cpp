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
  std::string form{vector_form_names.back()};
};

int write_vectors(const VectorsOptions& options) {
  const auto form = options.form == vector_form_names.front() ? VectorForm::first : VectorForm::second;
  const std::string text = result_text(vectors_json(static_cast<std::uint64_t>(options.seed), form));
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
  add.word("--form", options->form, {vector_form_names.begin(), vector_form_names.end()},
           "For readers of the first form, what it has of these (default: vectors/2)");
  return [options] { return write_vectors(*options); };
}

}  // namespace

extern const Command vectors_command;
const Command vectors_command{
    .name = "vectors",
    .summary = "Write the conformance vectors: rays and slabs with certified colour and opacity, for any renderer",
    .example = "raytruth vectors -o vectors.json",
    .notes =
        "Each vector is a ray, or a slab between two scalars, under a transfer function; its `reference` is\n"
        "certified: proven to within error_bound. experiments/schemas/vectors.json says what every member\n"
        "means. Levels from linear_rays on are for renderers that sample: their rays are linear between\n"
        "equidistant samples, so that nothing but the integral is asked. The form vectors/1 has the levels\n"
        "before them only, bit for bit.",
    .describe = describe};

}  // namespace raytruth
