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
#include <compare>
#include <cstddef>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>
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
// A largest error stands at edges that few pixels see, so so many of the worst pixels are asked for their neighbours in
// turn, until so many turns in a row found nothing worse.
constexpr std::size_t worst_pixels = 16;
constexpr int idle_turns = 4;

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

/// A pixel of one of the views.
struct Pixel {
  std::size_t view = 0;
  std::int64_t row = 0;
  std::int64_t column = 0;

  friend auto operator<=>(const Pixel&, const Pixel&) = default;
};

std::vector<Pixel> all_pixels(const AdviceRequest& request) {
  std::vector<Pixel> pixels;
  for (std::size_t view = 0; view < request.views.size(); ++view)
    for (std::int64_t row = 0; row < request.views[view].size[1]; ++row)
      for (std::int64_t column = 0; column < request.views[view].size[0]; ++column)
        pixels.push_back({view, row, column});
  return pixels;
}

/// So many pixels of the views, which chance takes from equal parts of the images.
std::vector<Pixel> pixels_of_round(const AdviceRequest& request, std::int64_t count, std::uint32_t round) {
  std::vector<Pixel> pixels;
  const auto views = static_cast<std::int64_t>(request.views.size());
  const double per_view = std::max(1.0, static_cast<double>(count) / static_cast<double>(views));
  std::uint64_t index = 0;
  for (std::size_t view = 0; view < request.views.size(); ++view) {
    const Camera& camera = request.views[view];
    const auto width = static_cast<double>(camera.size[0]);
    const auto height = static_cast<double>(camera.size[1]);
    const double columns = std::clamp(std::round(std::sqrt(per_view * width / height)), 1.0, width);
    const double rows = std::clamp(std::round(per_view / columns), 1.0, height);
    for (double row = 0; row < rows; ++row)
      for (double column = 0; column < columns; ++column) {
        const auto chance = random_numbers(request.seed, RandomStream::pixels, index++, round);
        const auto place = [](double part, double of, double length, double share) {
          return std::min(static_cast<std::int64_t>((part + share) * length / of),
                          static_cast<std::int64_t>(length) - 1);
        };
        pixels.push_back({view, place(row, rows, height, chance[1]), place(column, columns, width, chance[0])});
      }
  }
  return pixels;
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
  std::vector<double> errors = {};         ///< of the pixels that chance took
  std::map<Pixel, double> of_pixels = {};  ///< of these, and of those that stand beside the worst
  std::set<Pixel> asked_for_neighbours = {};
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
      look_at(all_pixels(request_), true);
      return conclude();
    }
    // What chance has missed of a largest error, the other half of the rays looks for.
    const std::int64_t most_by_chance =
        request_.kind == ErrorKind::rmse ? request_.most_rays : (request_.most_rays + 1) / 2;
    std::int64_t count = std::min(first_rays, most_by_chance);
    for (std::uint32_t round = 0;; ++round) {
      look_at(pixels_of_round(request_, count, round), round == 0);
      if (advice_.rays >= most_by_chance || (!is_open() && has_seen_enough())) break;
      count = std::min(advice_.rays, most_by_chance - advice_.rays);
    }
    if (request_.kind != ErrorKind::rmse) look_beside_the_worst();
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
  void look_at_tables(const std::vector<Pixel>& pixels) {
    // Exact slabs take long, and only tell which steps to look at.
    constexpr std::size_t share = 4;
    std::vector<Pixel> some;
    for (std::size_t i = 0; i < pixels.size(); i += share) some.push_back(pixels[i]);
    for (const TableChoice& choice : table_choices(request_.scene)) {
      std::size_t found = 0;
      Candidate exact;
      std::optional<Way> longer;  // the step before, which exceeds the error: what the next cheaper way would cost
      for (const double step : steps) {
        exact = {.way = {.scheme = std::string(choice.scheme), .step = step}};
        look_at(exact, some);
        if (!exact.way.refusal.empty()) continue;
        if (exact.way.error.value > nearly * request_.error) {
          longer = exact.way;
          continue;
        }
        if (longer) look_at_tables_of(*std::exchange(longer, {}), choice, pixels);
        look_at_tables_of(exact.way, choice, pixels);
        // Those that only nearly keep it may fail with every table.
        if (exact.way.error.value <= request_.error && ++found == steps_with_tables) break;
      }
      // Where none does, tables at the shortest step come closest.
      if (found == 0 && exact.way.refusal.empty()) look_at_tables_of(exact.way, choice, pixels);
    }
  }

  /// Tables for the slabs of a way with exact ones.
  void look_at_tables_of(Way exact, const TableChoice& choice, const std::vector<Pixel>& pixels) {
    count_reads(exact, true, request_.scene, rays_of(pixels));
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
        look_at(candidates_.back(), pixels);
        least = std::min(least, candidates_.back().way.error.value);
      }
      if (least > no_better * before) return;
      before = least;
    }
  }

  void look_at(const std::vector<Pixel>& pixels, bool is_first) {
    const auto rays = rays_of(pixels);
    if (is_first && std::none_of(rays.begin(), rays.end(), [this](const PixelRay& ray) { return meets(ray); }))
      throw InputError("no pixel of the views sees the volume; a scene without a camera gets views that do");
    learn_truth(pixels);
    for (const Pixel& pixel : pixels)
      if ((truth_.at(pixel) != 0).any()) ++advice_.rays_with_matter;
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      Candidate& candidate = candidates_[i];
      if (is_first) count_reads(candidate.way, false, request_.scene, rays);
      if (is_first || is_followed(candidate)) look_at(candidate, pixels);
      if (progress_) progress_(i + 1, candidates_.size());
    }
    if (is_first) look_at_tables(pixels);
    choose();
  }

  /// Follows the best way's error uphill, from pixel to neighbour: what stands at an edge that chance has met nearby is
  /// found so. A way whose error turns out too large gives way to the next best, as far as the rays go. One that they
  /// did not suffice for promises nothing.
  void look_beside_the_worst() {
    std::set<Pixel> beside;
    while (best_ != nullptr) {
      Candidate& best = candidates_[static_cast<std::size_t>(best_ - candidates_.data())];
      look_at_more(best, beside);
      for (int idle = 0; best.way.standing == Standing::keeps && idle < idle_turns; ++idle) {
        if (advice_.rays >= request_.most_rays) {
          // What was not followed to an end promises nothing.
          for (Candidate& candidate : candidates_)
            if (candidate.way.standing == Standing::keeps) candidate.way.standing = Standing::undecided;
          best_ = nullptr;
          break;
        }
        const double before = best.way.error.low;
        const auto neighbours = neighbours_of_the_worst(best);
        if (neighbours.empty()) break;
        learn_truth(neighbours);
        beside.insert(neighbours.begin(), neighbours.end());
        look_at_more(best, beside);
        if (best.way.error.low > before) idle = -1;
      }
      if (best.way.standing == Standing::keeps || best_ == nullptr) break;
      choose();
    }
    // What was found so may tell more about cheaper ways that chance has not decided.
    for (Candidate& candidate : candidates_)
      if (&candidate != best_ && is_followed(candidate)) look_at_more(candidate, beside);
  }

  /// Those of the worst pixels that were not asked before.
  [[nodiscard]] std::vector<Pixel> neighbours_of_the_worst(Candidate& candidate) const {
    std::vector<std::pair<double, Pixel>> worst;
    for (const auto& [pixel, error] : candidate.of_pixels)
      if (error > 0 && !candidate.asked_for_neighbours.contains(pixel)) worst.emplace_back(-error, pixel);
    const std::size_t count = std::min(worst_pixels, worst.size());
    std::partial_sort(worst.begin(), worst.begin() + static_cast<std::ptrdiff_t>(count), worst.end());
    std::set<Pixel> neighbours;
    for (std::size_t i = 0; i < count; ++i) {
      const Pixel& pixel = worst[i].second;
      candidate.asked_for_neighbours.insert(pixel);
      const auto& size = request_.views[pixel.view].size;
      for (std::int64_t row = std::max<std::int64_t>(0, pixel.row - 1); row <= std::min(size[1] - 1, pixel.row + 1);
           ++row)
        for (std::int64_t column = std::max<std::int64_t>(0, pixel.column - 1);
             column <= std::min(size[0] - 1, pixel.column + 1); ++column) {
          const Pixel neighbour{pixel.view, row, column};
          if (!candidate.of_pixels.contains(neighbour)) neighbours.insert(neighbour);
        }
    }
    return {neighbours.begin(), neighbours.end()};
  }

  [[nodiscard]] std::vector<PixelRay> rays_of(const std::vector<Pixel>& pixels) const {
    std::vector<CameraView> views;
    views.reserve(request_.views.size());
    for (const Camera& camera : request_.views) views.emplace_back(camera, request_.scene.grid.spacing);
    std::vector<PixelRay> rays;
    rays.reserve(pixels.size());
    for (const Pixel& pixel : pixels) rays.push_back(views[pixel.view](pixel.column, pixel.row));
    return rays;
  }

  /// The true light of those pixels of which it is not known yet.
  void learn_truth(const std::vector<Pixel>& pixels) {
    std::vector<Pixel> unknown;
    for (const Pixel& pixel : pixels)
      if (truth_.try_emplace(pixel, Eigen::Array4d::Zero()).second) unknown.push_back(pixel);
    const auto light = look_.truth(rays_of(unknown));
    for (std::size_t i = 0; i < unknown.size(); ++i) {
      truth_[unknown[i]] = light[i].light;
      advice_.truth_radius = std::max(advice_.truth_radius, light[i].radius);
    }
    advice_.rays += static_cast<std::int64_t>(unknown.size());
  }

  [[nodiscard]] bool meets(const PixelRay& ray) const {
    const Span inside = clip(request_.scene.grid.size, request_.scene.border, ray.ray.origin, ray.ray.direction);
    return inside.begin < inside.end;
  }

  /// Looks at pixels that chance took, whose truth is known.
  void look_at(Candidate& candidate, const std::vector<Pixel>& pixels) {
    if (const auto errors = errors_of(candidate, pixels)) {
      candidate.errors.insert(candidate.errors.end(), errors->begin(), errors->end());
      judge(candidate);
    }
  }

  /// Looks at those of the pixels that the candidate was not looked at before.
  void look_at_more(Candidate& candidate, const std::set<Pixel>& pixels) {
    std::vector<Pixel> unknown;
    for (const Pixel& pixel : pixels)
      if (!candidate.of_pixels.contains(pixel)) unknown.push_back(pixel);
    if (!unknown.empty() && errors_of(candidate, unknown)) judge(candidate);
  }

  std::optional<std::vector<double>> errors_of(Candidate& candidate, const std::vector<Pixel>& pixels) {
    try {
      const auto light = look_(candidate.way, rays_of(pixels));
      std::vector<double> errors;
      for (std::size_t i = 0; i < pixels.size(); ++i) {
        errors.push_back(error_of(request_.kind, light[i].light, truth_.at(pixels[i])));
        candidate.of_pixels[pixels[i]] = errors.back();
      }
      return errors;
    } catch (const InputError& error) {
      candidate.way.refusal = error.what();
      return std::nullopt;
    }
  }

  void judge(Candidate& candidate) const {
    Way& way = candidate.way;
    way.rays = static_cast<std::int64_t>(candidate.of_pixels.size());
    if (has_all_)
      way.error = error_of_all(request_.kind, candidate.errors);
    else if (request_.kind == ErrorKind::rmse)
      way.error = rmse_of_sample(candidate.errors, request_.confidence);
    else
      way.error = and_at_least(
          largest_of_sample(candidate.errors, static_cast<double>(advice_.pixels), request_.confidence),
          std::max_element(candidate.of_pixels.begin(), candidate.of_pixels.end(), [](const auto& a, const auto& b) {
            return a.second < b.second;
          })->second);
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
  std::map<Pixel, Eigen::Array4d> truth_;  ///< the light of the pixels that were looked at
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
