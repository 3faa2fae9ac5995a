#include "raytruth/advice/advice.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/images/image_file.hpp"
#include "raytruth/render/camera.hpp"
#include "raytruth/render/renderer.hpp"
#include "raytruth/schemes/integral_schemes.hpp"
#include "raytruth/schemes/scheme_integral.hpp"
#include "raytruth/signals/cell_walk.hpp"
#include "raytruth/signals/ray_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

namespace raytruth {

namespace {

constexpr std::array steps{4.0, 2.0, 1.0, 0.5, 0.25, 0.125, 0.0625};
constexpr std::array sampled_schemes{"riemann_mid", "trapezoid", "simpson", "sampled_virtual_catmull_rom_3"};
constexpr std::array table_format_words{"unorm8", "float16", "float32"};
constexpr std::int64_t first_rays = 512;
constexpr std::int64_t few_pixels = 4096;  // all of which are looked at
// So many rays that see something tell a mean; fewer than the second number may have missed what errs.
constexpr std::int64_t enough_matter = 256;
constexpr std::int64_t least_matter = 64;
// Tables are tried at so many steps, the longest of those at which exact slabs keep the error, or nearly.
constexpr std::size_t steps_with_tables = 2;
constexpr double nearly = 1.25;
// Where a table twice as large left that much of the error, still larger ones do not help.
constexpr double no_better = 0.95;

/// What a slab's table of a scheme may be.
struct TableChoice {
  std::string_view scheme;
  std::string_view builder;
  std::vector<std::size_t> sizes;
  std::size_t axes;
};

std::vector<TableChoice> table_choices(const Scene& scene) {
  // A lit slab has a table for each of its moments, so a larger one takes long, and much memory.
  if (scene.shading) return {{"order1", "exact", {64, 128, 256}, 2}};
  // Every entry of a table of parabolas is integrated exactly: larger ones take longer than the rest of the search.
  return {{"order1", "exact", {32, 64, 128, 256, 512, 1024}, 2}, {"order2", "second_order_exact", {32}, 3}};
}

/// The scene without what ways differ in, seen cleanly.
Scene bare(const Scene& scene) {
  Scene result = scene;
  result.scheme = "reference";
  result.step.reset();
  result.table.reset();
  result.opaque = std::numeric_limits<double>::infinity();
  result.empty_space.reset();
  result.covers_camera = false;
  return result;
}

/// Renders rays of one scene by one way after the other, without a copy of its voxels for each.
class Looker {
 public:
  explicit Looker(const Scene& scene) : original_(bare(scene)), scene_(original_) {}

  /// Throws InputError for a way that cannot render the scene.
  std::vector<PixelLight> operator()(const Way& way, const std::vector<PixelRay>& rays) {
    scene_.scheme = way.scheme;
    scene_.step = way.step;
    scene_.table = way.table;
    return render(rays);
  }

  std::vector<PixelLight> truth(const std::vector<PixelRay>& rays) {
    scene_ = original_;
    if (scene_.shading) scene_.shading->method = nullptr;  // every point has its own normal
    auto light = render(rays);
    scene_ = original_;
    return light;
  }

 private:
  std::vector<PixelLight> render(const std::vector<PixelRay>& rays) {
    try {
      Renderer renderer(std::move(scene_));
      auto light = renderer.light_of(rays);
      scene_ = std::move(renderer).take_scene();
      return light;
    } catch (const InputError&) {
      scene_ = original_;
      throw;
    }
  }

  Scene original_;
  Scene scene_;
};

std::vector<PixelRay> all_rays(const AdviceRequest& request) {
  std::vector<PixelRay> rays;
  for (const Camera& camera : request.views) {
    const CameraView view(camera, request.scene.grid.spacing);
    for (std::int64_t row = 0; row < camera.size[1]; ++row)
      for (std::int64_t column = 0; column < camera.size[0]; ++column) rays.push_back(view(column, row));
  }
  return rays;
}

/// So many rays of the views, of pixels that chance takes from equal parts of the images.
std::vector<PixelRay> rays_of_round(const AdviceRequest& request, std::int64_t count, std::uint32_t round) {
  std::vector<PixelRay> rays;
  const auto views = static_cast<std::int64_t>(request.views.size());
  const double per_view = std::max(1.0, static_cast<double>(count) / static_cast<double>(views));
  std::uint64_t index = 0;
  for (const Camera& camera : request.views) {
    const CameraView view(camera, request.scene.grid.spacing);
    const auto width = static_cast<double>(camera.size[0]);
    const auto height = static_cast<double>(camera.size[1]);
    const double columns = std::clamp(std::round(std::sqrt(per_view * width / height)), 1.0, width);
    const double rows = std::clamp(std::round(per_view / columns), 1.0, height);
    for (double row = 0; row < rows; ++row)
      for (double column = 0; column < columns; ++column) {
        const auto chance = random_numbers(request.seed, RandomStream::pixels, index++, round);
        const auto place = [](double part, double of, double pixels, double share) {
          return std::min(static_cast<std::int64_t>((part + share) * pixels / of),
                          static_cast<std::int64_t>(pixels) - 1);
        };
        rays.push_back(view(place(column, columns, width, chance[0]), place(row, rows, height, chance[1])));
      }
  }
  return rays;
}

double encoded(double light) { return srgb_of(std::clamp(light, 0.0, 1.0)); }

/// The error of a pixel; of `rmse` its square.
double error_of(ErrorKind kind, const Eigen::Array4d& light, const Eigen::Array4d& truth) {
  double result = 0;
  for (int channel = 0; channel < 3; ++channel) {
    const double difference = kind == ErrorKind::encoded ? encoded(light[channel]) - encoded(truth[channel])
                                                         : light[channel] - truth[channel];
    if (kind == ErrorKind::rmse)
      result += difference * difference / 3;
    else
      result = std::max(result, std::abs(difference));
  }
  return result;
}

/// A way on its way to a decision.
struct Candidate {
  Way way;
  std::vector<double> errors = {};
};

/// Samples and look-ups of a way for a pixel; one look-up for a slab where slabs are read from a table.
void count_reads(Way& way, bool has_slabs, const Scene& scene, const std::vector<PixelRay>& rays) {
  const IntegralScheme& scheme = *find_named(catalogue::integral_schemes(), way.scheme);
  SchemeIntegral integrate(scene.transfer, scene.emission);
  Samples<double> samples;
  // Few rays tell a mean well.
  constexpr std::size_t most = 64;
  const std::size_t every = std::max<std::size_t>(1, rays.size() / most);
  double counted = 0;
  for (std::size_t i = 0; i < rays.size(); i += every) {
    std::visit(
        [&]<class Field>(const Field& field) {
          Chain<Field::degree> chain;
          field.trace(rays[i].ray, chain);
          scale_lengths(chain, rays[i].length_unit);
          take_samples(chain, way.step, samples);
          const Outcome<> outcome = integrate(scheme, chain, samples);
          way.samples += static_cast<double>(outcome.fetches);
          way.look_ups += static_cast<double>(has_slabs ? outcome.composites : outcome.lookups);
        },
        ray_field(scene.grid, scene.field, scene.border));
    ++counted;
  }
  way.samples /= counted;
  way.look_ups /= counted;
}

bool is_cheaper(const Way& a, const Way& b) {
  return std::tuple(a.reads(), a.table_bytes) < std::tuple(b.reads(), b.table_bytes);
}

/// Looks for the advice.
class Search {
 public:
  Search(const AdviceRequest& request, const std::function<void(std::size_t, std::size_t)>& progress)
      : request_(request), progress_(progress), look_(request.scene) {
    for (const Camera& camera : request.views) advice_.pixels += camera.size[0] * camera.size[1];
    advice_.is_certified = !request.scene.shading.has_value();
    add_ways_without_tables();
  }

  Advice run() {
    has_all_ = advice_.pixels <= few_pixels;
    if (has_all_) {
      look_at(all_rays(request_), true);
      return conclude();
    }
    std::int64_t count = first_rays;
    for (std::uint32_t round = 0;; ++round) {
      look_at(rays_of_round(request_, count, round), round == 0);
      if (advice_.rays >= request_.most_rays || (!is_open() && has_seen_enough())) break;
      count = std::min(advice_.rays, request_.most_rays - advice_.rays);
    }
    return conclude();
  }

 private:
  void add(Way way) { candidates_.push_back({std::move(way)}); }

  void add_ways_without_tables() {
    for (const double step : steps) {
      if (!request_.scene.shading)
        for (const char* const scheme : sampled_schemes) add({.scheme = scheme, .step = step});
    }
    if (!request_.scene.shading) add({.scheme = "cell_cubic"});
  }

  /// Tables at the longest steps at which exact slabs keep the error, or nearly; each size is looked at before a larger
  /// one is made.
  void look_at_tables(const std::vector<PixelRay>& rays, const std::vector<PixelLight>& truth) {
    // Exact slabs take long, and only tell which steps to look at.
    constexpr std::size_t share = 4;
    std::vector<PixelRay> some_rays;
    std::vector<PixelLight> some_truth;
    for (std::size_t i = 0; i < rays.size(); i += share) {
      some_rays.push_back(rays[i]);
      some_truth.push_back(truth[i]);
    }
    for (const TableChoice& choice : table_choices(request_.scene)) {
      std::size_t found = 0;
      Candidate exact;
      std::optional<Way> longer;  // the step before, which exceeds the error: what the next cheaper way would cost
      for (const double step : steps) {
        exact = {.way = {.scheme = std::string(choice.scheme), .step = step}};
        look_at(exact, some_rays, some_truth);
        if (!exact.way.refusal.empty()) continue;
        if (exact.way.error.value > nearly * request_.error) {
          longer = exact.way;
          continue;
        }
        if (longer) look_at_tables_of(*std::exchange(longer, {}), choice, rays, truth);
        look_at_tables_of(exact.way, choice, rays, truth);
        // Those that only nearly keep it may fail with every table.
        if (exact.way.error.value <= request_.error && ++found == steps_with_tables) break;
      }
      // Where none does, tables at the shortest step come closest.
      if (found == 0 && exact.way.refusal.empty()) look_at_tables_of(exact.way, choice, rays, truth);
    }
  }

  /// Tables for the slabs of a way with exact ones.
  void look_at_tables_of(Way exact, const TableChoice& choice, const std::vector<PixelRay>& rays,
                         const std::vector<PixelLight>& truth) {
    count_reads(exact, true, request_.scene, rays);
    double before = std::numeric_limits<double>::infinity();
    for (const std::size_t size : choice.sizes) {
      double least = std::numeric_limits<double>::infinity();
      for (const char* const format : table_format_words) {
        SceneTable table{
            .builder = std::string(choice.builder), .size = size, .format = *find_named(table_formats, format)};
        Way way = exact;
        way.table = table;
        way.table_bytes = 4 * table.format.bytes;
        for (std::size_t axis = 0; axis < choice.axes; ++axis) way.table_bytes *= size;
        add(std::move(way));
        look_at(candidates_.back(), rays, truth);
        least = std::min(least, candidates_.back().way.error.value);
      }
      if (least > no_better * before) return;
      before = least;
    }
  }

  void look_at(const std::vector<PixelRay>& rays, bool is_first) {
    const auto truth = look_.truth(rays);
    if (is_first && std::none_of(rays.begin(), rays.end(), [this](const PixelRay& ray) { return meets(ray); }))
      throw InputError("no pixel of the views sees the volume; a scene without a camera gets views that do");
    advice_.rays += static_cast<std::int64_t>(rays.size());
    for (const PixelLight& pixel : truth) {
      advice_.truth_radius = std::max(advice_.truth_radius, pixel.radius);
      if ((pixel.light != 0).any()) ++advice_.rays_with_matter;
    }
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      Candidate& candidate = candidates_[i];
      if (is_first) count_reads(candidate.way, false, request_.scene, rays);
      if (is_first || is_followed(candidate)) look_at(candidate, rays, truth);
      if (progress_) progress_(i + 1, candidates_.size());
    }
    if (is_first) look_at_tables(rays, truth);
    choose();
  }

  [[nodiscard]] bool meets(const PixelRay& ray) const {
    const Span inside = clip(request_.scene.grid.size, request_.scene.border, ray.ray.origin, ray.ray.direction);
    return inside.begin < inside.end;
  }

  void look_at(Candidate& candidate, const std::vector<PixelRay>& rays, const std::vector<PixelLight>& truth) {
    Way& way = candidate.way;
    try {
      const auto light = look_(way, rays);
      for (std::size_t i = 0; i < rays.size(); ++i)
        candidate.errors.push_back(error_of(request_.kind, light[i].light, truth[i].light));
    } catch (const InputError& error) {
      way.refusal = error.what();
      return;
    }
    way.rays = static_cast<std::int64_t>(candidate.errors.size());
    way.error = has_all_ ? error_of_all(request_.kind, candidate.errors)
                : request_.kind == ErrorKind::rmse
                    ? rmse_of_sample(candidate.errors, request_.confidence)
                    : largest_of_sample(candidate.errors, static_cast<double>(advice_.pixels), request_.confidence);
    const bool may_promise = has_all_ || advice_.rays_with_matter >= least_matter;
    way.standing = may_promise && way.error.high <= request_.error ? Standing::keeps
                   : way.error.low > request_.error                ? Standing::exceeds
                                                                   : Standing::undecided;
  }

  void choose() {
    best_ = nullptr;
    for (const Candidate& candidate : candidates_)
      if (candidate.way.refusal.empty() && candidate.way.standing == Standing::keeps &&
          (best_ == nullptr || is_cheaper(candidate.way, best_->way)))
        best_ = &candidate;
  }

  /// Whether more rays of it may change the advice. The best is followed too: it might not keep the error after all.
  [[nodiscard]] bool is_followed(const Candidate& candidate) const {
    if (!candidate.way.refusal.empty()) return false;
    if (&candidate == best_) return true;
    return candidate.way.standing == Standing::undecided && (best_ == nullptr || is_cheaper(candidate.way, best_->way));
  }

  /// Whether the sample may be taken for the image.
  [[nodiscard]] bool has_seen_enough() const {
    return request_.kind == ErrorKind::rmse && advice_.rays_with_matter >= enough_matter;
  }

  [[nodiscard]] bool is_open() const {
    return std::any_of(candidates_.begin(), candidates_.end(),
                       [this](const Candidate& candidate) { return &candidate != best_ && is_followed(candidate); });
  }

  Advice conclude() {
    advice_.is_settled = !is_open();
    for (Candidate& candidate : candidates_) {
      if (candidate.way.standing == Standing::undecided && best_ != nullptr && is_cheaper(best_->way, candidate.way))
        candidate.way.standing = Standing::not_needed;
      advice_.ways.push_back(candidate.way);
    }
    std::stable_sort(advice_.ways.begin(), advice_.ways.end(), is_cheaper);
    for (std::size_t i = 0; i < advice_.ways.size(); ++i) {
      const Way& way = advice_.ways[i];
      if (!way.refusal.empty()) continue;
      if (way.standing == Standing::keeps) {
        advice_.best = i;
        break;
      }
      if (!advice_.next_cheaper || way.error.value <= advice_.ways[*advice_.next_cheaper].error.value)
        advice_.next_cheaper = i;
    }
    return std::move(advice_);
  }

  const AdviceRequest& request_;
  const std::function<void(std::size_t, std::size_t)>& progress_;
  Looker look_;
  std::vector<Candidate> candidates_;
  bool has_all_ = false;  ///< every pixel is looked at
  const Candidate* best_ = nullptr;
  Advice advice_;
};

}  // namespace

Advice advise(const AdviceRequest& request, const std::function<void(std::size_t, std::size_t)>& progress) {
  return Search(request, progress).run();
}

std::vector<Camera> views_around(const Grid& grid, std::size_t count, const std::array<std::int64_t, 2>& image_size) {
  std::vector<Camera> views;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (std::size_t i = 0; i < count; ++i) {
    // A spiral from pole to pole, in equal steps of height (R. Swinbank, R. J. Purser, Fibonacci grids, 2006).
    const double y = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(count);
    const double radius = std::sqrt(1 - y * y);
    const double angle = golden * static_cast<double>(i);
    views.push_back(
        fitted_camera(grid.size, grid.spacing, image_size, {radius * std::cos(angle), y, radius * std::sin(angle)}));
  }
  return views;
}

}  // namespace raytruth
