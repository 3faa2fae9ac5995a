#include "raytruth/documents/advice_document.hpp"

#include "raytruth/core/one_line.hpp"
#include "raytruth/documents/scene_warnings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <utility>

namespace raytruth {

namespace {

/// The error that is asked for, and of what.
void read_error(const AdviceOptions& options, AdviceRequest& request) {
  if (options.error == "invisible") {
    request.kind = ErrorKind::encoded;
    request.error = invisible_error;
    return;
  }
  const char* const end = options.error.data() + options.error.size();
  const auto read = std::from_chars(options.error.data(), end, request.error);
  if (read.ec != std::errc() || read.ptr != end || !(request.error > 0) || !(request.error < 1e300))
    throw InputError(one_line(fmt::format("--error: found {}; a number > 0, or invisible, is allowed", options.error)));
  const auto found = std::find(error_kind_names.begin(), error_kind_names.end(), options.of);
  if (found == error_kind_names.end())
    throw InputError(
        one_line(fmt::format("--of: found {}; {} is allowed", options.of, fmt::join(error_kind_names, ", "))));
  request.kind = static_cast<ErrorKind>(found - error_kind_names.begin());
}

}  // namespace

AdviceDocument read_advice_document(const JsonReader& json, const AdviceOptions& options) {
  AdviceDocument result{.request = {.scene = {.transfer = PiecewiseLinear(std::vector<TransferPoint>(1))}}};
  AdviceRequest& request = result.request;
  read_error(options, request);
  request.seed = options.seed;
  request.most_rays = options.most_rays;
  json.members();
  auto document = json.json();
  // What it says of a way to render is left aside: other ways are compared.
  for (const char* const member : {"scheme", "sampling", "step", "table", "early_termination", "empty_space"})
    document.erase(member);
  document["scheme"] = "reference";
  SceneFile scene =
      read_scene(JsonReader::from_json(std::move(document), json), {.volumes = options.volumes, .opacity = {}});
  if (!scene.scene.isosurfaces.empty())
    json.at("transfer_function")
        .refuse("isosurfaces, which only the reference renders", "a transfer function without them");
  request.views =
      scene.fitted_camera.is_null()
          ? std::vector{scene.scene.camera}
          : views_around(scene.scene.grid, static_cast<std::size_t>(options.views), scene.scene.camera.size);
  result.warnings = std::move(scene.warnings);
  warn_of_conventions(scene.scene, result.warnings);
  request.scene = std::move(scene.scene);
  result.volume = std::move(scene.volume);
  result.transfer_function = std::move(scene.transfer_function);
  return result;
}

}  // namespace raytruth
