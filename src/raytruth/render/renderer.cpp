#include "raytruth/render/renderer.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/render/pixel_light.hpp"
#include "raytruth/render/techniques/cell_march.hpp"
#include "raytruth/render/techniques/shaded_ray.hpp"
#include "raytruth/render/techniques/shaded_table.hpp"
#include "raytruth/render/techniques/table_march.hpp"
#include "raytruth/schemes/integral_schemes.hpp"
#include "raytruth/schemes/scheme_integral.hpp"
#include "raytruth/signals/cell_walk.hpp"
#include "raytruth/signals/field_kind.hpp"
#include "raytruth/signals/signal_error_bound.hpp"
#include "raytruth/signals/tricubic.hpp"
#include "raytruth/signals/trilinear.hpp"
#include "raytruth/skipping/block_refinement.hpp"
#include "raytruth/tables/second_order.hpp"
#include "raytruth/tables/table_builders.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <numeric>
#include <utility>

namespace raytruth {

namespace {

constexpr std::int64_t tile_side = 16;
constexpr double farthest = 0x1p30;  // voxels

/// What a thread renders pixels with.
using PixelRenderer = std::function<PixelLight(const PixelRay&)>;

Eigen::Array4d light_of(const Vector3<double>& color, double opacity) {
  return {color[0], color[1], color[2], opacity};
}

/// The scalar along rays through the scene's field: chains of degree 3 or 9, in voxels.
template <int Degree>
struct Field;

template <>
struct Field<3> {
  const Grid& grid;

  void trace(const Ray& ray, Chain<3>& chain) const { trace_trilinear(grid, ray, chain); }
  [[nodiscard]] SignalError error(const Ray& ray, const Chain<3>& chain, const std::vector<bool>& is_needless) const {
    return trilinear_error(grid, ray, chain, is_needless);
  }
};

template <>
struct Field<9> {
  const Grid& grid;
  CubicKernel kernel;
  double coefficient_error;

  void trace(const Ray& ray, Chain<9>& chain) const { trace_tricubic(grid, kernel, ray, chain); }
  [[nodiscard]] SignalError error(const Ray& ray, const Chain<9>& chain, const std::vector<bool>& is_needless) const {
    return tricubic_error(grid, kernel, ray, chain, coefficient_error, is_needless);
  }
};

template <int Degree>
void scale_lengths(Chain<Degree>& chain, double factor) {
  if (factor == 1) return;
  for (auto& piece : chain.pieces) {
    piece.start = piece.start * factor;
    piece.length *= factor;
  }
  chain.end = chain.end * factor;
}

/// The parts of a ray that are looked at.
class PartsOfRay {
 public:
  PartsOfRay(const std::array<std::int64_t, 3>& size, const OccupiedBlocks* blocks) : size_(size), blocks_(blocks) {}

  /// In `unit`s of a voxel behind the ray's entry; none: all of it. Valid until the next call.
  std::optional<std::span<const RayPart>> operator()(const Ray& ray, double unit = 1) {
    if (blocks_ == nullptr) return std::nullopt;
    parts_.clear();
    const Span inside = clip(size_, ray.origin, ray.direction);
    if (inside.begin < inside.end) {
      const auto begin = static_cast<double>(inside.begin);
      std::array<double, 3> entry{};
      for (std::size_t axis = 0; axis < 3; ++axis) entry[axis] = ray.origin[axis] + begin * ray.direction[axis];
      blocks_->parts(entry, ray.direction, static_cast<double>(inside.end - inside.begin), parts_);
    }
    for (RayPart& part : parts_) part = {part.begin * unit, part.end * unit};
    return parts_;
  }

 private:
  std::array<std::int64_t, 3> size_;
  const OccupiedBlocks* blocks_;
  std::vector<RayPart> parts_;
};

/// The certified integral. Whatever is clear by more than all rounding of rays and chains neither absorbs nor shines:
/// rays that meet no occupied block are done, and clear pieces are taken out before the others are certified.
template <int Degree>
class ReferenceRenderer {
 public:
  ReferenceRenderer(const Field<Degree>& field, const Scene& scene, const OccupiedBlocks& blocks, double margin)
      : field_(field),
        parts_of_(field.grid.size, &blocks),
        clear_(scene.transfer, scene.emission),
        margin_(margin),
        integrate_(scene.transfer, scene.emission) {}

  PixelLight operator()(const PixelRay& pixel) {
    if (parts_of_(pixel.ray)->empty()) return {};
    field_.trace(pixel.ray, chain_);
    is_clear_.clear();
    for (const auto& piece : chain_.pieces) {
      const auto& b = piece.polynomial.coefficients;
      const auto [low, high] = std::minmax_element(b.begin(), b.end());
      is_clear_.push_back(clear_.contain(*low - margin_, *high + margin_));
    }
    SignalError error = field_.error(pixel.ray, chain_, is_clear_);
    error.of_length *= pixel.length_unit;
    error.unclaimed *= pixel.length_unit;
    take_out_clear_pieces(error);
    scale_lengths(chain_, pixel.length_unit);
    const Certified truth = integrate_(chain_, error);
    return {light_of(truth.color, truth.opacity), truth.radius, truth.status};
  }

 private:
  void take_out_clear_pieces(SignalError& error) {
    std::size_t kept = 0;
    DoubleDouble end = 0.0;
    for (std::size_t i = 0; i < chain_.pieces.size(); ++i) {
      if (is_clear_[i]) continue;
      chain_.pieces[kept] = chain_.pieces[i];
      error.of_pieces[kept] = error.of_pieces[i];
      chain_.pieces[kept].start = end;
      end = end + DoubleDouble(chain_.pieces[kept].length);
      ++kept;
    }
    chain_.pieces.resize(kept);
    error.of_pieces.resize(kept);
    chain_.end = end;
  }

  const Field<Degree>& field_;
  PartsOfRay parts_of_;
  ClearScalars clear_;
  double margin_;
  RayIntegral integrate_;
  Chain<Degree> chain_;
  std::vector<bool> is_clear_;
};

template <int Degree>
void take_samples(const Chain<Degree>& chain, const std::optional<double>& step, Samples<double>& samples) {
  if (step)
    sample_constant(chain, *step, samples);
  else
    sample_cells(chain, samples);
}

template <int Degree>
PixelRenderer scheme_renderer(const Field<Degree>& field, const Scene& scene, const IntegralScheme& scheme,
                              const OccupiedBlocks* blocks) {
  return [&field, &scene, &scheme, parts_of = PartsOfRay(field.grid.size, blocks), chain = Chain<Degree>(),
          samples = Samples<double>(),
          integrate = SchemeIntegral(scene.transfer, scene.emission)](const PixelRay& pixel) mutable -> PixelLight {
    const auto parts = parts_of(pixel.ray, pixel.length_unit);
    if (parts && parts->empty()) return {};
    field.trace(pixel.ray, chain);
    scale_lengths(chain, pixel.length_unit);
    take_samples(chain, scene.step, samples);
    const Outcome<> outcome = integrate(scheme, chain, samples, {.occupied = parts, .opaque = scene.opaque});
    if (!outcome.refusal.empty()) throw InputError(fmt::format("{}: {}", scheme.name, outcome.refusal));
    return {light_of(outcome.color, outcome.opacity)};
  };
}

/// Intervals from sample to sample that are one slab of a table.
std::size_t slab_intervals(const Scene& scene) { return scene.scheme == "order2" ? 2 : 1; }

/// Of the slabs that a table holds.
double table_length(const Scene& scene) { return static_cast<double>(slab_intervals(scene)) * scene.step.value_or(1); }

Eigen::Array4d corrected_slab(const Eigen::Array4d& slab, double share) {
  Rules<double> rules;
  if (share == 1) return slab;
  return rules.opacity_corrected_slab(slab, rules.opacity_correction(slab[3], share), share);
}

/// Slabs of any length from a table made for the step: `slab_of(view, first, last, samples, share)` gives that from
/// sample `first` to `last`, a share of the table's length, its opacity corrected as if it were homogeneous.
template <int Degree, class MakeView, class SlabOf>
PixelRenderer slab_renderer(const Field<Degree>& field, const Scene& scene, const OccupiedBlocks* blocks,
                            const MakeView& make_view, const SlabOf& slab_of) {
  return [&field, &scene, make_view, slab_of, length = table_length(scene),
          parts_of = PartsOfRay(field.grid.size, blocks), chain = Chain<Degree>(),
          samples = Samples<double>()](const PixelRay& pixel) mutable -> PixelLight {
    const auto parts = parts_of(pixel.ray, pixel.length_unit);
    if (parts && parts->empty()) return {};
    field.trace(pixel.ray, chain);
    scale_lengths(chain, pixel.length_unit);
    take_samples(chain, scene.step, samples);
    const Omissions omissions{.occupied = parts, .opaque = scene.opaque};
    PixelLight result;
    const auto view = make_view(pixel);
    const std::size_t full = full_intervals(samples);
    const std::size_t intervals = slab_intervals(scene);
    for (std::size_t first = 0, last = 0; first < samples.interval_count() && result.light[3] < omissions.opaque;
         first = last) {
      last = std::min(first + intervals, samples.interval_count());
      if (omissions.omit(static_cast<double>(samples.positions[first]), static_cast<double>(samples.positions[last])))
        continue;
      const bool is_full = samples.step && last == first + intervals && last <= full;
      const double share =
          is_full ? 1 : static_cast<double>(samples.positions[last] - samples.positions[first]) / length;
      result.light = Rules<double>{}.over(result.light, slab_of(view, first, last, samples, share));
    }
    return result;
  };
}

template <int Degree>
PixelRenderer table_renderer(const Field<Degree>& field, const Scene& scene, const Table<double>& table,
                             const OccupiedBlocks* blocks) {
  const auto slab_of = [&scene, &table](int /*view*/, std::size_t first, std::size_t last,
                                        const Samples<double>& samples, double share) {
    const auto texel = [&table](std::size_t front, std::size_t back) { return table.at(front, back); };
    const std::array scalars{samples.values[first], samples.values[last]};
    return corrected_slab(scene.table->filter == TableFilter::linear ? bilinear<double>(table.axes, texel, scalars)
                                                                     : nearest<double>(table.axes, texel, scalars),
                          share);
  };
  return slab_renderer(
      field, scene, blocks, [](const PixelRay& /*pixel*/) { return 0; }, slab_of);
}

/// The parabola through the samples of a pair of intervals, or the line of an unpaired one, at the middle of its slab.
double middle_scalar(const Samples<double>& samples, std::size_t first, std::size_t last) {
  const auto at = [&samples](std::size_t k) { return samples.values[k]; };
  if (last == first + 1) return std::midpoint(at(first), at(last));
  const double front_length = samples.length_of(first);
  const double split = front_length / (front_length + samples.length_of(first + 1));
  if (std::abs(split - 0.5) < 1e-9) return at(first + 1);
  Rules<double> rules;
  if (split > 0.5)
    return Rules<double>::cubic(rules.order2_front(at(first), at(first + 1), at(last), split)).value(0.5 / split);
  return Rules<double>::cubic(rules.order2_back(at(first), at(first + 1), at(last), split))
      .value((0.5 - split) / (1 - split));
}

template <int Degree>
PixelRenderer second_order_renderer(const Field<Degree>& field, const Scene& scene, const Table3<float>& table,
                                    const OccupiedBlocks* blocks) {
  const auto slab_of = [&scene, &table](int /*view*/, std::size_t first, std::size_t last,
                                        const Samples<double>& samples, double share) {
    const auto texel = [&table](std::size_t front, std::size_t middle, std::size_t back) -> Eigen::Array4d {
      return table.at(front, middle, back).cast<double>();
    };
    const std::array scalars{samples.values[first], middle_scalar(samples, first, last), samples.values[last]};
    const auto entry = [&](std::size_t i) { return TablePlace<double>::of(table.axes, scalars[i], 0).nearest(); };
    return corrected_slab(scene.table->filter == TableFilter::linear ? trilinear<double>(table.axes, texel, scalars)
                                                                     : texel(entry(0), entry(1), entry(2)),
                          share);
  };
  return slab_renderer(
      field, scene, blocks, [](const PixelRay& /*pixel*/) { return 0; }, slab_of);
}

template <int Degree>
PixelRenderer shaded_table_renderer(const Field<Degree>& field, const Scene& scene, const ShadedTable& table,
                                    const OccupiedBlocks* blocks) {
  const auto view_of = [&scene](const PixelRay& pixel) { return LitView(scene.grid, *scene.shading, pixel); };
  const auto slab_of = [&scene, &table, clear = ClearScalars(scene.transfer, scene.emission)](
                           const LitView& view, std::size_t first, std::size_t last, const Samples<double>& samples,
                           double share) {
    const double front = samples.values[first];
    const double back = samples.values[last];
    if (clear.contain(std::min(front, back), std::max(front, back))) return Eigen::Array4d(Eigen::Array4d::Zero());
    const auto [shader, model] = view.slab_light(*scene.shading, static_cast<double>(samples.positions[first]),
                                                 static_cast<double>(samples.positions[last]));
    return table(front, back, share, shader, model);
  };
  return slab_renderer(field, scene, blocks, view_of, slab_of);
}

template <int Degree>
PixelRenderer shaded_renderer(const Field<Degree>& field, const Scene& scene, const OccupiedBlocks* blocks) {
  return [&field, &scene, parts_of = PartsOfRay(field.grid.size, blocks), chain = Chain<Degree>(),
          samples = Samples<double>(), shaded = ShadedRay<Degree>(scene)](const PixelRay& pixel) mutable -> PixelLight {
    const auto parts = parts_of(pixel.ray, pixel.length_unit);
    if (parts && parts->empty()) return {};
    field.trace(pixel.ray, chain);
    scale_lengths(chain, pixel.length_unit);
    take_samples(chain, scene.step, samples);
    return shaded(pixel, chain, samples, {.occupied = parts, .opaque = scene.opaque});
  };
}

/// The lit truth: as a scheme's rays, but whatever is skipped is clear for certain, and rays never end early.
template <int Degree>
PixelRenderer shaded_reference(const Field<Degree>& field, const Scene& scene, const OccupiedBlocks& blocks) {
  return [&field, parts_of = PartsOfRay(field.grid.size, &blocks), chain = Chain<Degree>(),
          shaded = ShadedRay<Degree>(scene)](const PixelRay& pixel) mutable -> PixelLight {
    if (parts_of(pixel.ray)->empty()) return {};
    field.trace(pixel.ray, chain);
    scale_lengths(chain, pixel.length_unit);
    return shaded(pixel, chain, {}, {});
  };
}

CubicKernel kernel_of(FieldKind kind) {
  return kind == FieldKind::catmull_rom ? CubicKernel::catmull_rom : CubicKernel::bspline;
}

/// More than what a displacement by 10^-9 of a voxel changes in a field: no cubic kernel has a derivative above 16/3
/// per axis and unit of the voxels' range. And more than a chain's rounding, some units in the last place of its
/// voxels.
double margin_of(const Grid& grid) {
  const auto [low, high] = grid.range();
  return 1e-7 * std::max({high - low, std::abs(low), std::abs(high)});
}

/// Blocks that hold for every point of every ray.
OccupiedBlocks certain_blocks(const Scene& scene, const Grid& grid) {
  const std::int64_t growth = scene.field == FieldKind::trilinear ? 0 : 1;
  const double overshoot = field_overshoot(scene.field);
  return {grid,
          ClearScalars(scene.transfer, scene.emission),
          8,
          {.growth = growth, .overshoot = overshoot, .margin = margin_of(grid)}};
}

TableAxes table_axes(const Scene& scene) {
  const auto [low, high] = scene.grid.range();
  // A constant grid asks for one entry only.
  return {.size = scene.table->size, .low = low, .high = low < high ? high : low + 1, .length = table_length(scene)};
}

/// Of second order; of 4 numbers for every entry in binary32.
Table3<float> second_order_table_of(const Scene& scene) {
  const SceneTable& asked = *scene.table;
  Table3<float> table;
  if (asked.builder == second_order_builder_names[0])
    table = second_order_table(scene.transfer, table_axes(scene), scene.emission, Ideal{});
  else if (asked.builder == second_order_builder_names[1])
    table = second_order_table(scene.transfer, table_axes(scene), scene.emission, NyquistIterations{});
  else if (asked.builder == second_order_builder_names[2])
    table = second_order_table(scene.transfer, table_axes(scene), scene.emission, Iterations{asked.iterations});
  else
    throw InputError(fmt::format("table builder {} with the scheme order2; {} are allowed", asked.builder,
                                 fmt::join(second_order_builder_names, ", ")));
  for (float& number : table.values) number = static_cast<float>(stored(asked.format, number));
  return table;
}

Table<double> table_of(const Scene& scene) {
  const auto& builders = catalogue::table_builders();
  const auto builder = std::find_if(builders.begin(), builders.end(),
                                    [&](const TableBuilder& row) { return row.name == scene.table->builder; });
  if (builder == builders.end())
    throw InputError(fmt::format("table builder {}; one of the listed is allowed", scene.table->builder));
  return stored(scene.table->format, builder->make(scene.transfer, table_axes(scene), scene.emission));
}

}  // namespace

struct Renderer::Parts {
  explicit Parts(Scene its_scene) : scene(std::move(its_scene)), view(scene.camera, scene.grid.spacing) {
    refuse_far_cameras();
    // A longer step makes the same samples, both ends of the ray, but numbers that nobody can calculate with.
    if (scene.step) scene.step = std::min(*scene.step, 2 * diagonal());
    const bool is_trilinear = scene.field == FieldKind::trilinear;
    if (scene.field == FieldKind::bspline_prefiltered) coefficients = bspline_coefficients(scene.grid);
    const Grid& grid = coefficients ? *coefficients : scene.grid;
    if (is_trilinear)
      choose(field_3.emplace(Field<3>{scene.grid}));
    else
      choose(field_9.emplace(
          Field<9>{grid, kernel_of(scene.field), coefficients ? prefilter_error(scene.grid, grid) : 0.0}));
  }

  /// From there positions of 53 bits would miss voxels.
  void refuse_far_cameras() const {
    const auto [width, height] = scene.camera.size;
    for (const std::int64_t column : {std::int64_t{0}, width - 1})
      for (const std::int64_t row : {std::int64_t{0}, height - 1})
        for (const double x : view(column, row).ray.origin)
          if (!(std::abs(x) <= farthest))
            throw InputError(fmt::format("a ray from voxel coordinate {}; magnitudes up to 2^30 are allowed", x));
  }

  /// Of the grid, in smallest spacings.
  [[nodiscard]] double diagonal() const {
    const auto& [x, y, z] = scene.grid.spacing;
    const auto& size = scene.grid.size;
    return std::hypot(x * static_cast<double>(size[0]), y * static_cast<double>(size[1]),
                      z * static_cast<double>(size[2])) /
           std::min({x, y, z});
  }

  template <int Degree>
  void choose(const Field<Degree>& field) {
    if (scene.scheme == "reference") {
      blocks.emplace(certain_blocks(scene, field.grid));
      if (scene.shading) {
        [[maybe_unused]] const ShadedRay<Degree> refuses_what_it_cannot_light(scene);
        make_renderer = [&field, this] { return shaded_reference(field, scene, *blocks); };
        return;
      }
      make_renderer = [&field, this] {
        return ReferenceRenderer<Degree>(field, scene, *blocks, margin_of(field.grid));
      };
      return;
    }
    if (scene.empty_space)
      blocks.emplace(field.grid, ClearScalars(scene.transfer, scene.emission), scene.empty_space->block,
                     block_refinement(scene.field, scene.step, scene.empty_space->bounds));
    const OccupiedBlocks* const occupied = blocks ? &*blocks : nullptr;
    if (scene.table) return choose_table(field, occupied);
    scheme = find_named(catalogue::integral_schemes(), scene.scheme);
    if (scheme == nullptr) throw InputError(fmt::format("scheme {}; one of the listed is allowed", scene.scheme));
    if (scene.shading) {
      [[maybe_unused]] const ShadedRay<Degree> refuses_what_it_cannot_light(scene);
      refuse_unsuitable<Degree>();
      make_renderer = [&field, this, occupied] { return shaded_renderer(field, scene, occupied); };
      return;
    }
    if (Degree == 3 && std::holds_alternative<CellCubic>(scheme->method)) {
      cell_march.emplace(scene.grid, scene.transfer, scene.emission, scene.opaque);
      if (!blocks) blocks.emplace(certain_blocks(scene, field.grid));
      make_renderer = [this] {
        return [march = CellRay(*cell_march, scene.transfer, scene.emission),
                parts_of = PartsOfRay(scene.grid.size, &*blocks)](const PixelRay& pixel) mutable -> PixelLight {
          return {march(pixel, parts_of(pixel.ray))};
        };
      };
      return;
    }
    refuse_unsuitable<Degree>();
    make_renderer = [&field, this, occupied] { return scheme_renderer(field, scene, *scheme, occupied); };
  }

  template <int Degree>
  void choose_table(const Field<Degree>& field, const OccupiedBlocks* occupied) {
    if (scene.scheme != "order1" && scene.scheme != "order2")
      throw InputError(fmt::format("scheme {} with a table; order1 and order2 are allowed", scene.scheme));
    if (scene.scheme == "order2") {
      if (scene.shading) throw InputError("scheme order2 with a table and shading; either is allowed");
      second_order = second_order_table_of(scene);
      make_renderer = [&field, this, occupied] { return second_order_renderer(field, scene, *second_order, occupied); };
      return;
    }
    if (scene.shading) {
      [[maybe_unused]] const ShadedRay<Degree> refuses_what_it_cannot_light(scene);
      shaded_table.emplace(scene, table_axes(scene));
      make_renderer = [&field, this, occupied] { return shaded_table_renderer(field, scene, *shaded_table, occupied); };
      return;
    }
    table = table_of(scene);
    if (Degree == 3 && scene.step && !scene.table->in_binary64) {
      table_march.emplace(scene.grid, *table, scene.table->filter, *scene.step, scene.opaque);
      make_renderer = [this, occupied] {
        return [this, parts_of = PartsOfRay(scene.grid.size, occupied)](const PixelRay& pixel) mutable -> PixelLight {
          return {(*table_march)(pixel, parts_of(pixel.ray))};
        };
      };
    } else {
      make_renderer = [&field, this, occupied] { return table_renderer(field, scene, *table, occupied); };
    }
  }

  /// Tries the scheme on a ray of two cells, so that what it refuses is refused before any pixel.
  template <int Degree>
  void refuse_unsuitable() const {
    Chain<Degree> chain;
    const double length = scene.step.value_or(1);
    chain.pieces = {{0.0, length, {}}, {length, length, {}}};
    chain.end = 2 * length;
    Samples<double> samples;
    take_samples(chain, scene.step, samples);
    const Outcome<> outcome = SchemeIntegral(scene.transfer, scene.emission)(*scheme, chain, samples);
    if (!outcome.refusal.empty()) throw InputError(fmt::format("scheme {}: {}", scheme->name, outcome.refusal));
  }

  Scene scene;
  CameraView view;
  std::optional<Grid> coefficients;
  std::optional<Field<3>> field_3;
  std::optional<Field<9>> field_9;
  std::optional<OccupiedBlocks> blocks;
  const IntegralScheme* scheme = nullptr;
  std::optional<Table<double>> table;
  std::optional<Table3<float>> second_order;
  std::optional<ShadedTable> shaded_table;
  std::optional<TableMarch> table_march;
  std::optional<CellMarch> cell_march;
  std::function<PixelRenderer()> make_renderer;
};

Renderer::Renderer(Scene scene) : parts_(std::make_unique<const Parts>(std::move(scene))) {}
Renderer::~Renderer() = default;

Rendering Renderer::render(const std::function<void(std::size_t, std::size_t)>& progress) const {
  const auto [width, height] = parts_->scene.camera.size;
  const bool has_radii = parts_->scene.scheme == "reference";
  Rendering result{.image = Image(parts_->scene.camera.size),
                   .is_certified = has_radii && !parts_->scene.shading.has_value()};
  if (has_radii) result.radii.resize(result.image.pixels.size());
  const std::int64_t columns = (width + tile_side - 1) / tile_side;
  const std::int64_t tiles = columns * ((height + tile_side - 1) / tile_side);

  tbb::enumerable_thread_specific<PixelRenderer> renderers(parts_->make_renderer);
  std::atomic<std::int64_t> not_converged = 0;
  std::atomic<std::size_t> done = 0;
  std::mutex telling;
  tbb::parallel_for(std::int64_t{0}, tiles, [&](std::int64_t tile) {
    PixelRenderer& light_of_pixel = renderers.local();
    const std::int64_t top = tile / columns * tile_side;
    const std::int64_t left = tile % columns * tile_side;
    for (std::int64_t row = top; row < std::min(top + tile_side, height); ++row)
      for (std::int64_t column = left; column < std::min(left + tile_side, width); ++column) {
        const PixelLight pixel = light_of_pixel(parts_->view(column, row));
        result.image.at(column, row) = pixel.light;
        if (has_radii) result.radii[static_cast<std::size_t>(row * width + column)] = pixel.radius;
        if (pixel.status != Status::converged) ++not_converged;
      }
    ++done;
    if (!progress) return;
    if (const std::unique_lock lock(telling, std::try_to_lock); lock) progress(done, static_cast<std::size_t>(tiles));
  });
  result.not_converged = not_converged;
  return result;
}

}  // namespace raytruth
