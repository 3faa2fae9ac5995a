#include "experiments/output.hpp"
#include "experiments/result.hpp"
#include "program/command.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/documents/conformance/hit_vectors.hpp"
#include "raytruth/documents/conformance/vector_volume.hpp"
#include "raytruth/documents/conformance/vectors.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <utility>
#include <vector>

namespace raytruth {

namespace {

constexpr std::int64_t most_intervals = 4096;  // of a ray: ball arithmetic takes its time

struct VectorsOptions {
  std::optional<std::string> file;  ///< none: standard output
  std::int64_t seed = 1;
  std::string form{vector_form_names.back()};
  std::optional<std::string> volumes;  ///< a folder
  std::int64_t intervals = 256;        ///< along a ray, of the volumes
  bool hits = false;
};

/// Writes every vector as a volume and a scene, and beside them what their pixels are: vectors again.
void write_volumes(const std::vector<ConformanceVector>& vectors, VectorForm form, const VectorsOptions& options) {
  const std::filesystem::path folder = *options.volumes;
  make_folder(folder);
  std::vector<ConformanceVector> asked;
  for (const ConformanceVector& vector : vectors) {
    VectorVolume volume = vector_volume(vector, options.intervals);
    write_whole(folder / (vector.id + ".nrrd"), volume.nrrd);
    write_whole(folder / (vector.id + ".json"), volume.scene.dump(2) + "\n");
    asked.push_back(std::move(volume.asked));
  }
  write_whole(folder / "vectors.json",
              result_text(vectors_json(static_cast<std::uint64_t>(options.seed), form, asked)));
}

int write_vectors(const VectorsOptions& options) {
  if (options.hits && options.volumes)
    throw InputError("command line: --volumes: found it beside --hits; one of them is allowed");
  const auto form = options.form == vector_form_names.front() ? VectorForm::first : VectorForm::second;
  const auto seed = static_cast<std::uint64_t>(options.seed);
  if (options.volumes) write_volumes(conformance_vectors(seed, form), form, options);
  if (options.volumes && !options.file) return 0;
  const std::string text = result_text(options.hits ? hit_vectors_json(seed) : vectors_json(seed, form));
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
  add.flag("--hits", options->hits,
           "Write 200 rays with their crossings of isosurfaces instead, for `score` of a CSV id,hit,t,surface");
  add.text("--volumes", "DIR", options->volumes,
           "For renderers of voxels: every ray as a thin volume ID.nrrd with its scene ID.json, and in vectors.json\n"
           "what every pixel of its image is, certified: `score DIR/vectors.json answers.csv`");
  add.count("--intervals", most_intervals, options->intervals,
            "Of the volumes: voxels along a ray, less one (default: 256)");
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
        "before them only, bit for bit.\n"
        "\n"
        "With --hits each vector is a ray and the scalars of isosurfaces, with all crossings certified: t and\n"
        "its radius. Where the scalar touches a surface from one side nothing is crossed, nor at a ray's ends.\n"
        "\n"
        "A volume holds the ray's samples in binary32, as columns along z; its scene ends it at the centres of\n"
        "voxels. The pixels' truth is that of these numbers, linear between them, so sampling is no part of it.",
    .describe = describe};

}  // namespace raytruth
