#pragma once

#include "experiments/verdict.hpp"
#include "raytruth/documents/field_document.hpp"
#include "raytruth/documents/json/json_reader.hpp"
#include "raytruth/documents/outside_program.hpp"
#include "raytruth/gl/device.hpp"
#include "raytruth/schemes/sampling.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"
#include "raytruth/volume/grid.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace raytruth {

/// Where a field of an experiment comes from.
struct FieldSource {
  std::string name;
  FieldDocument document;
  JsonReader json;  ///< the place that errors name
};

/// A field of an experiment, ready: values scaled to [0, 1] by `data_range`, for volumes the smallest and largest
/// value; generated fields lie in [0, 1] as they are.
struct Field {
  std::string name;
  Grid grid;
  std::pair<double, double> data_range;
  std::string file = {};  ///< without its folder; empty for generated fields
  bool repaired = false;
  std::vector<std::string> warnings = {};  ///< one line each
};

/// A transfer function of an experiment.
struct NamedTransfer {
  std::string name;
  PiecewiseLinear transfer;
};

/// The rays of a study: `count` of them per field, directions isotropic, all of `length` voxels.
struct RayEnsemble {
  std::int64_t count = 0;
  double length = 0;
};

struct Measure;
class AskedMeasure;

/// What an experiment file asks; experiments/schemas/experiment.json describes the file.
struct Experiment {
  std::string name;
  std::uint64_t seed = 1;
  std::vector<FieldSource> fields;
  RayEnsemble rays;
  std::vector<NamedTransfer> transfers;
  Emission emission = Emission::associated;
  std::vector<Sampling> samplings;
  std::vector<std::string> schemes;
  std::vector<OutsideProgram> programs;  ///< named among the schemes
  std::vector<std::shared_ptr<const AskedMeasure>> measures;
  std::vector<Claim> claims;
  std::vector<Check> checks;
  JsonReader json;                         ///< the whole document, profile merged in, defaults filled in
  std::vector<std::string> warnings = {};  ///< one line each
  GlPlatform gl = GlPlatform::osmesa;      ///< for measures that run shaders
  bool runs_programs = false;              ///< whether what names a program may run it; else its rows are refused
};

/// What `--gl` and an experiment's "gl" may say.
inline constexpr std::array gl_platforms{std::pair{std::string_view("osmesa"), GlPlatform::osmesa},
                                         std::pair{std::string_view("egl"), GlPlatform::egl}};

/// Whether a measure of the experiment runs shaders.
bool uses_gl(const Experiment& experiment);

/// Reads and checks an experiment. `profile` is "full" or "quick"; "quick" merges the member of that name into the
/// document (RFC 7396), and leaves out claims, checks and panels about fields, schemes and measures that are no longer
/// in it. `seed` replaces the document's, and `gl` that of a document that uses it. Throws InputError.
Experiment read_experiment(const std::string& path, std::string_view profile, std::optional<std::int64_t> seed,
                           const std::optional<std::string>& gl);
Experiment read_experiment(const JsonReader& document, std::string_view profile, std::optional<std::int64_t> seed,
                           const std::optional<std::string>& gl);

/// Makes a field, from its generator or its file found by `volumes`. Throws VolumeAbsent where no folder holds it.
Field make_field(const FieldSource& source, const VolumeAccess& volumes);

/// The columns of a result: `measure`, `field`, those of the measures, `status` and `why`.
std::vector<Column> result_columns(const Experiment& experiment);

}  // namespace raytruth
