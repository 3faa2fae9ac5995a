#include "experiments/measure.hpp"
#include "measures/ray_study.hpp"
#include "raytruth/cells/tetrahedral_field.hpp"
#include "raytruth/metrics/signal_error.hpp"
#include "raytruth/reference/ray_truth.hpp"
#include "raytruth/signals/ray_ensemble.hpp"
#include "raytruth/signals/trilinear.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

namespace {

struct Options {};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind"});
  return {};
}

struct Split {
  std::string_view name;
  GridSplit split;
  SplitParity parity;
};

constexpr std::array splits{Split{"five", GridSplit::five, SplitParity::even},
                            Split{"five_odd", GridSplit::five, SplitParity::odd},
                            Split{"six", GridSplit::six, SplitParity::even}};

/// The errors of rays, in the order of the rays.
struct Errors {
  double xi = 0;  ///< mean
  double xi_max = 0;
  double opacity_max = 0;
  double opacity_square = 0;
  double color_max = 0;
  double color_square = 0;
  double radius = 0;
  double pieces = 0;  ///< mean
};

struct Record {
  TransferKeys keys;
  std::string_view split;
  Errors errors;
  double grid_pieces = 0;
  std::int64_t rays = 0;
};

Certified truth_of(const MeshRay& ray, RayIntegral& integrate) {
  const auto [chain, error] = ray.chain();
  return ray_truth(
      integrate, chain, error, [&ray]() -> const auto& { return ray.signal; });
}

std::vector<Record> records_of_field(const Experiment& experiment, const Options& /*options*/, const Field& field) {
  std::vector<Record> records;
  const auto count = static_cast<std::size_t>(experiment.rays.count);
  for (const Split& split : splits) {
    const TetrahedralField cells(split_grid(field.grid, split.split, split.parity));
    for (const NamedTransfer& transfer : experiment.transfers) {
      std::vector<Errors> of_rays(count);
      std::vector<std::size_t> pieces(count);
      tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        const Ray ray = random_ray(field.grid, experiment.rays.length, experiment.seed, i);
        const auto chain = trace_trilinear(field.grid, ray, Border::voxel_centres);
        const MeshRay met = cells.trace(ray);
        RayIntegral integrate(transfer.transfer, experiment.emission);
        const Certified grid =
            ray_truth(integrate, chain, trilinear_error(field.grid, ray, chain, {}, {}, Border::voxel_centres),
                      [&] { return trace_trilinear_precisely(field.grid, ray, {}, Border::voxel_centres); });
        const Certified mesh = truth_of(met, integrate);
        Chain<3> of_mesh = met.chain().first;
        of_mesh.end = chain.end;
        const double opacity = std::abs(mesh.opacity - grid.opacity);
        const double color = (mesh.color - grid.color).abs().maxCoeff();
        of_rays[i] = {xi(chain, of_mesh),
                      xi_max(chain, of_mesh),
                      opacity,
                      opacity * opacity,
                      color,
                      color * color,
                      mesh.radius + grid.radius,
                      static_cast<double>(met.cells.size())};
        pieces[i] = chain.pieces.size();
      });
      Record record{.keys = {transfer.name, experiment.emission}, .split = split.name, .errors = {}};
      record.rays = experiment.rays.count;
      const auto share = 1 / static_cast<double>(count);
      for (std::size_t i = 0; i < count; ++i) {
        const Errors& one = of_rays[i];
        Errors& all = record.errors;
        all.xi += share * one.xi / experiment.rays.length;
        all.xi_max = std::max(all.xi_max, one.xi_max);
        all.opacity_max = std::max(all.opacity_max, one.opacity_max);
        all.opacity_square += share * one.opacity_square;
        all.color_max = std::max(all.color_max, one.color_max);
        all.color_square += share * one.color_square;
        all.radius = std::max(all.radius, one.radius);
        all.pieces += share * one.pieces;
        record.grid_pieces += share * static_cast<double>(pieces[i]);
      }
      records.push_back(record);
    }
  }
  return records;
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns;
  append_part(columns, &Record::keys, transfer_key_columns());
  append(columns,
         Columns<Record>{
             {.name = "split",
              .description = "of every cube of eight voxel centres: into five, into five with the parities exchanged, "
                             "or into six tetrahedra",
              .is_key = true,
              .cell = &Record::split},
             {.name = "xi_per_length",
              .description =
                  "mean over rays of the integral of the scalar's distance from the trilinear field's, per length",
              .cell = [](const Record& record) { return record.errors.xi; }},
             {.name = "scalar_max",
              .description = "largest distance of the two scalars on any ray",
              .cell = [](const Record& record) { return record.errors.xi_max; }},
             {.name = "opacity_error_max",
              .description = "largest difference of the opacities of the two certified rays",
              .radius = "radius",
              .cell = [](const Record& record) { return record.errors.opacity_max; }},
             {.name = "opacity_error_l2",
              .description = "root mean square of it",
              .radius = "radius",
              .cell = [](const Record& record) { return std::sqrt(record.errors.opacity_square); }},
             {.name = "color_error_max",
              .description = "largest difference of a colour channel",
              .radius = "radius",
              .cell = [](const Record& record) { return record.errors.color_max; }},
             {.name = "color_error_l2",
              .description = "root mean square of the largest channel's",
              .radius = "radius",
              .cell = [](const Record& record) { return std::sqrt(record.errors.color_square); }},
             {.name = "radius",
              .description = "bound on the error of the differences: the sum of both references'",
              .cell = [](const Record& record) { return record.errors.radius; }},
             {.name = "cells_per_ray",
              .description = "mean number of tetrahedra",
              .cell = [](const Record& record) { return record.errors.pieces; }},
             {.name = "cubes_per_ray",
              .description = "mean number of cubics of the trilinear field",
              .cell = &Record::grid_pieces},
             {.name = "rays", .description = "in all", .cell = &Record::rays},
         });
  return columns;
}

}  // namespace

extern const Measure cells_against_grid_measure;
const Measure cells_against_grid_measure{MeasureDefinition<Options, Record>{
    .name = "cells_against_grid",
    .summary = "what splitting a grid into tetrahedra costs: certified rays through both",
    .needs = {.transfers = true},
    .read = read_options,
    .columns = columns,
    .of_field = records_of_field}};

}  // namespace raytruth
