#pragma once

#include "raytruth/advice/error_estimate.hpp"
#include "raytruth/render/scene.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

/// What advice is asked for: a scene, of which scheme, step, table, opaque end and empty space are left aside, seen by
/// some cameras, and the error that its images may have.
struct AdviceRequest {
  Scene scene;
  std::vector<Camera> views = {};  ///< at least one
  ErrorKind kind = ErrorKind::rmse;
  double error = 0;          ///< > 0
  double confidence = 0.95;  ///< that a way which is said to keep the error does, as far as ErrorEstimate can tell
  std::uint64_t seed = 1;    ///< of the pixels that are looked at
  std::int64_t most_rays = 16384;
};

/// Whether a way to render keeps the error.
enum class Standing {
  keeps,       ///< with the confidence that was asked for
  exceeds,     ///< likewise
  undecided,   ///< no more rays were allowed
  not_needed,  ///< it costs more than one that keeps the error, and was not followed to a decision
};

inline constexpr std::array<std::string_view, 4> standing_names{"keeps", "exceeds", "undecided", "not_needed"};

/// A way to render: a scheme with a step, and a table where it reads its slabs from one.
struct Way {
  std::string scheme;
  std::optional<double> step = {};  ///< smallest spacings; none: cell by cell
  std::optional<SceneTable> table = {};

  double samples = 0;   ///< of the volume for a pixel, mean over the pixels that were looked at
  double look_ups = 0;  ///< of the transfer function or the table, likewise
  std::size_t table_bytes = 0;
  ErrorEstimate error = {};
  std::int64_t rays = 0;  ///< that were looked at
  Standing standing = Standing::undecided;
  std::string refusal = {};  ///< why the scheme cannot render this scene; empty: it can

  /// Reads of textures for a pixel: samples and look-ups.
  [[nodiscard]] double reads() const { return samples + look_ups; }
};

/// The ways from the cheapest to the dearest, by reads and then by bytes of the table.
struct Advice {
  std::vector<Way> ways;
  std::optional<std::size_t> best = {};          ///< the cheapest that keeps the error
  std::optional<std::size_t> next_cheaper = {};  ///< of those that cost less the one with the smallest error
  bool is_settled = false;                       ///< whether all that cost less are known to exceed the error
  std::int64_t rays = 0;                         ///< that were looked at, of `pixels` of all views
  std::int64_t rays_with_matter = 0;             ///< of these, along which there is something to see
  std::int64_t pixels = 0;
  bool is_certified = false;  ///< the truth that errors are against; of lit scenes it is an estimate
  double truth_radius = 0;    ///< the largest of its rays
};

/// Finds the cheapest way that keeps the error. Ways are the schemes that renderers have, at steps from 4 smallest
/// spacings down to 1/16: the sampled ones, and slabs between samples from tables of 32 to 1024 entries a side in 8
/// bits, binary16 and binary32; and the exact cubics of cells. Lit scenes have lit slabs.
///
/// All pixels of the views are looked at where they are few (4096). Otherwise each is as likely to be as every other:
/// an image is divided into equal parts, in each of which chance takes one pixel, in rounds that double the rays until
/// every way cheaper than the best is decided, or `most_rays` are spent. Nothing is promised before 64 rays have seen
/// matter, and 256 are asked for. A largest error stands at edges that few rays meet: for it half of the rays is taken
/// so, and the others look at the neighbours of the best way's worst pixels in turn, until nothing worse is found.
/// Tables are tried at the longest steps at which exact slabs keep the error, from the smallest up to that which is no
/// better than the one before. Errors are those of the same rays against the reference. Equal requests give equal
/// advice.
///
/// `progress(done, of)` is told after each way. Throws InputError where no pixel sees the volume.
Advice advise(const AdviceRequest& request, const std::function<void(std::size_t, std::size_t)>& progress = {});

/// A camera from each of `count` directions that are spread evenly over the sphere, perspective, the whole volume in an
/// image of this size.
std::vector<Camera> views_around(const Grid& grid, std::size_t count, const std::array<std::int64_t, 2>& image_size);

}  // namespace raytruth
