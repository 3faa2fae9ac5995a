#include "raytruth/core/error.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/render/technique.hpp"
#include "raytruth/render/techniques/shaded_ray.hpp"
#include "raytruth/render/techniques/shaded_table.hpp"
#include "raytruth/render/techniques/skipped_space.hpp"
#include "raytruth/render/techniques/table_march.hpp"
#include "raytruth/rules/rules.hpp"
#include "raytruth/schemes/order2.hpp"
#include "raytruth/tables/quadratic_gray_table.hpp"
#include "raytruth/tables/second_order.hpp"
#include "raytruth/tables/table_builders.hpp"
#include "raytruth/tables/table_for_format.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>

namespace raytruth {

namespace {

/// How many intervals from sample to sample are one slab of a table.
std::size_t slab_intervals(const Scene& scene) { return scene.scheme == "order1" ? 1 : 2; }

/// The length of the slabs that a table holds.
double table_length(const Scene& scene) { return static_cast<double>(slab_intervals(scene)) * scene.step.value_or(1); }

Eigen::Array4d corrected_slab(const Eigen::Array4d& slab, double share) {
  Rules<double> rules;
  if (share == 1) return slab;
  return rules.opacity_corrected_slab(slab, rules.opacity_correction(slab[3], share), share);
}

/// Slabs of any length from a table made for the step: `slab_of(view, first, last, samples, share)` gives that from
/// sample `first` to `last`, a share of the table's length, its opacity corrected as if it were homogeneous.
template <class Field, class MakeView, class SlabOf>
PixelRenderer slab_renderer(const Field& field, const Scene& scene, const std::shared_ptr<const OccupiedBlocks>& blocks,
                            const MakeView& make_view, const SlabOf& slab_of) {
  return [&field, &scene, blocks, make_view, slab_of, length = table_length(scene),
          parts_of = PartsOfRay(field.grid().size, field.border(), blocks.get()), chain = Chain<Field::degree>(),
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

template <class Field>
PixelRenderer table_renderer(const Field& field, const Scene& scene, const std::shared_ptr<const Table<double>>& table,
                             const std::shared_ptr<const OccupiedBlocks>& blocks) {
  const auto slab_of = [&scene, table](int /*view*/, std::size_t first, std::size_t last,
                                       const Samples<double>& samples, double share) {
    const auto texel = [&table](std::size_t front, std::size_t back) { return table->at(front, back); };
    const std::array scalars{samples.values[first], samples.values[last]};
    return corrected_slab(scene.table->filter == TableFilter::linear ? bilinear<double>(table->axes, texel, scalars)
                                                                     : nearest<double>(table->axes, texel, scalars),
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

template <class Field>
PixelRenderer second_order_renderer(const Field& field, const Scene& scene,
                                    const std::shared_ptr<const Table3<float>>& table,
                                    const std::shared_ptr<const OccupiedBlocks>& blocks) {
  const auto slab_of = [&scene, table](int /*view*/, std::size_t first, std::size_t last,
                                       const Samples<double>& samples, double share) {
    const auto texel = [&table](std::size_t front, std::size_t middle, std::size_t back) -> Eigen::Array4d {
      return table->at(front, middle, back).cast<double>();
    };
    const std::array scalars{samples.values[first], middle_scalar(samples, first, last), samples.values[last]};
    const auto entry = [&](std::size_t i) { return TablePlace<double>::of(table->axes, scalars[i], 0).nearest(); };
    return corrected_slab(scene.table->filter == TableFilter::linear ? trilinear<double>(table->axes, texel, scalars)
                                                                     : texel(entry(0), entry(1), entry(2)),
                          share);
  };
  return slab_renderer(
      field, scene, blocks, [](const PixelRay& /*pixel*/) { return 0; }, slab_of);
}

/// Shorter slabs are looked up by their three scalars, as if they had the table's length.
template <class Field>
PixelRenderer quadratic_gray_renderer(const Field& field, const Scene& scene,
                                      const std::shared_ptr<const QuadraticGrayTable<float>>& table,
                                      const std::shared_ptr<const OccupiedBlocks>& blocks) {
  const auto slab_of = [&scene, table, look_up = QuadraticGrayLookUp<float>(*table)](
                           int /*view*/, std::size_t first, std::size_t last, const Samples<double>& samples,
                           double share) {
    const std::array scalars{samples.values[first], middle_scalar(samples, first, last), samples.values[last]};
    return corrected_slab(look_up(scalars, scene.table->filter == TableFilter::nearest), share);
  };
  return slab_renderer(
      field, scene, blocks, [](const PixelRay& /*pixel*/) { return 0; }, slab_of);
}

template <class Field>
PixelRenderer shaded_table_renderer(const Field& field, const Scene& scene,
                                    const std::shared_ptr<const ShadedTable>& table,
                                    const std::shared_ptr<const OccupiedBlocks>& blocks) {
  const auto view_of = [&scene, gradient = gradient_of(scene, field)](const PixelRay& pixel) {
    return LitView(gradient, scene.border, *scene.shading, pixel);
  };
  const auto slab_of = [&scene, table, clear = ClearScalars(scene.transfer, scene.emission)](
                           const LitView& view, std::size_t first, std::size_t last, const Samples<double>& samples,
                           double share) {
    const double front = samples.values[first];
    const double back = samples.values[last];
    if (clear.contain(std::min(front, back), std::max(front, back))) return Eigen::Array4d(Eigen::Array4d::Zero());
    return (*table)(front, back, share,
                    view.slab_light(*scene.shading, static_cast<double>(samples.positions[first]),
                                    static_cast<double>(samples.positions[last])));
  };
  return slab_renderer(field, scene, blocks, view_of, slab_of);
}

TableAxes table_axes(const Scene& scene) {
  const auto [low, high] = scene.grid.range();
  // A constant grid asks for one entry only.
  return {.size = scene.table->size, .low = low, .high = low < high ? high : low + 1, .length = table_length(scene)};
}

/// The table of second order; 4 numbers for every entry in binary32.
Table3<float> second_order_table_of(const Scene& scene) {
  const SceneTable& asked = *scene.table;
  const SecondOrderBuilder* const builder = find_named(catalogue::second_order_builders, asked.builder);
  if (builder == nullptr)
    throw InputError(fmt::format("table builder {} with the scheme order2; {} are allowed", asked.builder,
                                 fmt::join(names_of(catalogue::second_order_builders), ", ")));
  Table3<float> table =
      second_order_table(scene.transfer, table_axes(scene), scene.emission, builder->method(asked.iterations));
  for (float& number : table.values) number = static_cast<float>(stored(asked.format, number));
  return table;
}

const QuadraticGrayBuilder* quadratic_gray_builder(const Scene& scene) {
  return find_named(catalogue::quadratic_gray_builders(), scene.table->builder);
}

QuadraticGrayTable<float> quadratic_gray_table_of(const Scene& scene) {
  const QuadraticGrayBuilder& builder = *quadratic_gray_builder(scene);
  QuadraticGrayTable<float> table =
      builder.make(scene.transfer, table_axes(scene), scene.table->radius.value_or(builder.radius), scene.emission);
  for (float& number : table.values) number = static_cast<float>(stored(scene.table->format, number));
  return table;
}

Table<double> table_of(const Scene& scene) {
  const TableBuilder* const builder = find_named(catalogue::table_builders(), scene.table->builder);
  if (builder == nullptr)
    throw InputError(fmt::format("table builder {}; one of the listed is allowed", scene.table->builder));
  const TableFormat& format = scene.table->format;
  return stored(format, table_for_format(*builder, scene.transfer, table_axes(scene), scene.emission, format));
}

/// A factory of renderers that `make(field)` makes, of any kind of field.
template <class Make>
PixelRendererFactory for_any_field(const PreparedScene& prepared, const Make& make) {
  return std::visit([&make](const auto& field) -> PixelRendererFactory { return make(field); }, prepared.field);
}

void refuse_other_schemes(const PreparedScene& prepared) {
  if (prepared.scene.scheme != "order1" && prepared.scene.scheme != "order2")
    throw InputError(fmt::format("scheme {} with a table; order1 and order2 are allowed", prepared.scene.scheme));
}

PixelRendererFactory prepare_second_order(const PreparedScene& prepared) {
  const Scene& scene = prepared.scene;
  const auto table = std::make_shared<const Table3<float>>(second_order_table_of(scene));
  return for_any_field(prepared, [&](const auto& field) {
    return [&field, &scene, table, blocks = asked_blocks(scene, field)] {
      return second_order_renderer(field, scene, table, blocks);
    };
  });
}

PixelRendererFactory prepare_quadratic_gray(const PreparedScene& prepared) {
  const Scene& scene = prepared.scene;
  const auto table = std::make_shared<const QuadraticGrayTable<float>>(quadratic_gray_table_of(scene));
  return for_any_field(prepared, [&](const auto& field) {
    return [&field, &scene, table, blocks = asked_blocks(scene, field)] {
      return quadratic_gray_renderer(field, scene, table, blocks);
    };
  });
}

PixelRendererFactory prepare_shaded(const PreparedScene& prepared) {
  const Scene& scene = prepared.scene;
  const auto table = std::make_shared<const ShadedTable>(scene, table_axes(scene));
  return for_any_field(prepared, [&](const auto& field) {
    return [&field, &scene, table, blocks = asked_blocks(scene, field)] {
      return shaded_table_renderer(field, scene, table, blocks);
    };
  });
}

/// Renders by TableMarch.
PixelRendererFactory prepare_march(const PreparedScene& prepared) {
  const Scene& scene = prepared.scene;
  const auto march = std::make_shared<const TableMarch>(scene.grid, scene.border, table_of(scene), scene.table->filter,
                                                        *scene.step, scene.opaque);
  const auto blocks = asked_blocks(scene, std::get<TrilinearField>(prepared.field));
  return [&scene, march, blocks]() -> PixelRenderer {
    return [march, blocks, parts_of = PartsOfRay(scene.grid.size, scene.border, blocks.get())](
               const PixelRay& pixel) mutable -> PixelLight { return {(*march)(pixel, parts_of(pixel.ray))}; };
  };
}

PixelRendererFactory prepare_table(const PreparedScene& prepared) {
  const Scene& scene = prepared.scene;
  const auto table = std::make_shared<const Table<double>>(table_of(scene));
  return for_any_field(prepared, [&](const auto& field) {
    return [&field, &scene, table, blocks = asked_blocks(scene, field)] {
      return table_renderer(field, scene, table, blocks);
    };
  });
}

}  // namespace

extern const Technique quadratic_gray_table_pixels;
const Technique quadratic_gray_table_pixels{
    .name = "quadratic_gray_table",
    .summary = "slabs of parabolas from a table over two scalars and the curvature",
    .applies =
        [](const Scene& scene) {
          return scene.table && scene.scheme != "order1" && quadratic_gray_builder(scene) != nullptr;
        },
    .refuse =
        [](const PreparedScene& prepared) {
          const Scene& scene = prepared.scene;
          if (scene.shading) throw InputError("a quadratic table and shading; either is allowed");
          if (scene.scheme != "order2" && scene.scheme != "quadratic_gray" && scene.scheme != "quadratic_gray_printed")
            throw InputError(fmt::format(
                "scheme {} with a quadratic table; order2, quadratic_gray and quadratic_gray_printed are allowed",
                scene.scheme));
        },
    .prepare = prepare_quadratic_gray};

extern const Technique second_order_table_pixels;
const Technique second_order_table_pixels{
    .name = "second_order_table",
    .summary = "slabs of parabolas from a table over three scalars",
    .applies = [](const Scene& scene) { return scene.table && scene.scheme == "order2"; },
    .refuse =
        [](const PreparedScene& prepared) {
          if (prepared.scene.shading) throw InputError("scheme order2 with a table and shading; either is allowed");
        },
    .prepare = prepare_second_order};

extern const Technique shaded_table_pixels;
const Technique shaded_table_pixels{.name = "shaded_table",
                                    .summary = "lit slabs from tables of their moments",
                                    .applies = [](const Scene& scene) { return scene.table && scene.shading; },
                                    .refuse =
                                        [](const PreparedScene& prepared) {
                                          refuse_other_schemes(prepared);
                                          refuse_unlit(prepared.scene);
                                        },
                                    .prepare = prepare_shaded};

extern const Technique table_march_pixels;
const Technique table_march_pixels{
    .name = "table_march",
    .summary = "slabs from a table, at equal steps through a trilinear grid, in binary32",
    .applies =
        [](const Scene& scene) {
          return scene.table && scene.field == FieldKind::trilinear && scene.step && !scene.table->in_binary64;
        },
    .refuse = refuse_other_schemes,
    .prepare = prepare_march};

extern const Technique table_pixels;
const Technique table_pixels{.name = "table",
                             .summary = "slabs from a table over the scalars at both ends",
                             .applies = [](const Scene& scene) { return scene.table.has_value(); },
                             .refuse = refuse_other_schemes,
                             .prepare = prepare_table};

}  // namespace raytruth
