#include "raytruth/cells/projected_tetrahedra.hpp"
#include "experiments/measure.hpp"
#include "raytruth/cells/cell_table.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/tables/partial_pre_integration.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

namespace {

using Vec4 = Rules<double>::vec4;

constexpr std::array<std::string_view, 4> mesh_names{"cross", "spire", "grid", "sheared"};
/// Slabs of projected_table that are not exact.
constexpr std::array<std::string_view, 2> more_slabs{"projected_table_64", "projected_partial"};
constexpr std::int64_t grid_side = 5;
constexpr std::size_t table_size = 64;
constexpr std::size_t table_distances = 17;

struct Options {
  std::vector<std::string> meshes;
  std::vector<double> extinctions;
  std::int64_t size = 64;
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "meshes", "extinctions", "size"});
  Options options;
  for (const JsonReader& mesh : json.at("meshes").items())
    options.meshes.push_back(mesh.word({mesh_names.begin(), mesh_names.end()}));
  for (const JsonReader& extinction : json.at("extinctions").items())
    options.extinctions.push_back(extinction.number(1e-6, 1e4));
  options.size = json.at("size").integer(2, 1024);
  return options;
}

/// A cell by itself, or a grid of random scalars in [0, 1] between -1 and 1 split into five.
TetrahedralField mesh_named(std::string_view name, std::uint64_t seed) {
  TetrahedralMesh mesh;
  if (name == "grid" || name == "sheared") {
    Grid grid{.size = {grid_side, grid_side, grid_side}, .spacing = {1, 1, 1}, .values = {}};
    for (std::uint64_t i = 0; i < grid_side * grid_side * grid_side; ++i)
      grid.values.push_back(random_numbers(seed, RandomStream::field, i)[0]);
    mesh = split_grid(grid, GridSplit::five);
    for (auto& point : mesh.points)
      for (double& x : point) x = x / 2 - 1;
    if (name == "sheared")
      for (auto& [x, y, z] : mesh.points) {
        x += 3 * z;
        y += 2 * z;
        z /= 2;
      }
    return TetrahedralField(std::move(mesh));
  }
  if (name == "cross")
    mesh.points = {{-1, 0, 0.5}, {1, 0, 0.5}, {0, -1, -0.5}, {0, 1, -0.5}};
  else
    mesh.points = {{0, 0, 1}, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  mesh.scalars = {0, 0.25, 0.75, 1};
  mesh.tetrahedra = {{0, 1, 2, 3}};
  complete(mesh);
  return TetrahedralField(std::move(mesh));
}

PiecewiseLinear ramp(double extinction) {
  return PiecewiseLinear({{.s = 0, .optics = {0, {1, 0, 1}}}, {.s = 1, .optics = {extinction, {0, 1, 1}}}});
}

struct Record {
  std::string mesh;
  bool is_perspective = false;
  double extinction = 0;
  std::string rule = {};
  std::string order = {};
  double error_max = 0;
  double root_mean_square = 0;
  double opacity_max = 0;
  double length_max = 0;
  double radius = 0;
  std::int64_t pixels = 0;
};

Vec4 slab_light(RayIntegral& integrate, double front, double back, double length) {
  if (!(length > 0)) return Vec4::Zero();
  const double step = (back - front) / 3;
  Chain<3> chain;
  chain.pieces = {{0.0, length, {{front, front + step, back - step, back}}}};
  chain.end = length;
  const Certified slab = integrate(chain);
  return {slab.color[0], slab.color[1], slab.color[2], slab.opacity};
}

/// Moreland's and Angel's: extinction and colour linear from one end's to the other's.
Vec4 partial_slab(const PiecewiseLinear& transfer, double front, double back, double length) {
  const Optics first = transfer.at(front);
  const Optics second = transfer.at(back);
  return partially_pre_integrated_slab(
      first, second, length, partial_pre_integration_psi(first.extinction * length, second.extinction * length));
}

struct Truth {
  std::vector<Vec4> light;
  std::vector<std::uint8_t> is_met;
  double length_error = 0;
  double radius = 0;
};

/// The certified picture, and by how much lengths that are linear in the triangles are off where there is one cell.
Truth truth_of(const TetrahedralField& field, const ProjectedView& view, const PiecewiseLinear& transfer) {
  Truth truth;
  RayIntegral integrate(transfer, Emission::associated);
  for (std::int64_t i = 0; i < view.size * view.size; ++i) {
    const Ray ray = view.ray(i % view.size, i / view.size);
    const MeshRay met = field.trace(ray);
    const auto [chain, error] = met.chain();
    const Certified certified = integrate(chain, error);
    truth.light.emplace_back(certified.color[0], certified.color[1], certified.color[2], certified.opacity);
    truth.is_met.push_back(met.cells.empty() ? 0 : 1);
    truth.radius = std::max(truth.radius, certified.radius);
    const std::array<double, 2> place =
        view.place({ray.origin[0] + ray.direction[0], ray.origin[1] + ray.direction[1], view.is_perspective ? 0 : 1.0});
    for (std::size_t k = 0; k < met.cells.size(); ++k) {
      std::array<double, 5> weights{};
      const double length = project(field.mesh(), met.cells[k], view).at(place, weights).length;
      truth.length_error = std::max(truth.length_error, std::abs(length - met.signal.pieces[k].length));
    }
  }
  return truth;
}

std::vector<Record> records(const Experiment& experiment, const Options& options) {
  std::vector<Record> records;
  for (const std::string& name : options.meshes) {
    const TetrahedralField field = mesh_named(name, experiment.seed);
    for (const bool is_perspective : {false, true})
      for (const double extinction : options.extinctions) {
        const ProjectedView view{.is_perspective = is_perspective, .height = 4, .half_side = 1, .size = options.size};
        const PiecewiseLinear transfer = ramp(extinction);
        const Truth truth = truth_of(field, view, transfer);
        const double longest = name == "cross" || name == "spire" ? 2 : 1;
        const CellTable table = cell_table(transfer, {.size = table_size, .low = 0, .high = 1, .length = 1},
                                           Emission::associated, CellTableAxis::mean_depth,
                                           cell_table_distances(CellTableAxis::mean_depth, table_distances, longest));
        for (std::size_t rule = 0; rule < projection_rule_names.size() + more_slabs.size(); ++rule)
          for (const CellOrder order : {CellOrder::exact, CellOrder::centre}) {
            if (order == CellOrder::centre && (name == "cross" || name == "spire")) continue;
            const bool has_own_slabs = rule >= projection_rule_names.size();
            const std::string_view name_of_rule =
                has_own_slabs ? more_slabs[rule - projection_rule_names.size()] : projection_rule_names[rule];
            RayIntegral integrate(transfer, Emission::associated);
            const CellSlab slab = [&](double front, double back, double length) -> Vec4 {
              if (name_of_rule == "projected_table_64") return look_up(table, front, back, length);
              if (name_of_rule == "projected_partial") return partial_slab(transfer, front, back, length);
              return slab_light(integrate, front, back, length);
            };
            Record record{.mesh = name, .is_perspective = is_perspective, .extinction = extinction};
            record.rule = name_of_rule;
            record.order = cell_order_names[static_cast<std::size_t>(order)];
            record.radius = truth.radius;
            record.length_max = truth.length_error;
            double sum = 0;
            for (std::int64_t i = 0; i < view.size * view.size; ++i) {
              if (truth.is_met[static_cast<std::size_t>(i)] == 0) continue;
              const Vec4 light =
                  projected_light(field, view, i % view.size, i / view.size, transfer,
                                  static_cast<ProjectionRule>(std::min<std::size_t>(rule, 2)), order, slab);
              const Vec4 error = (light - truth.light[static_cast<std::size_t>(i)]).abs();
              record.error_max = std::max(record.error_max, error.maxCoeff());
              record.opacity_max = std::max(record.opacity_max, error[3]);
              sum += error.square().mean();
              ++record.pixels;
            }
            record.root_mean_square = record.pixels > 0 ? std::sqrt(sum / static_cast<double>(record.pixels)) : 0;
            records.push_back(record);
          }
      }
  }
  return records;
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  return {
      {.name = "mesh",
       .description =
           "cross, spire: one cell, whose outline is a quadrilateral or a triangle; grid: 5^3 random scalars, "
           "split into five; sheared: the same, each layer beside the one before",
       .is_key = true,
       .cell = &Record::mesh},
      {.name = "projection",
       .description = "along -z: parallel, or perspective from 4 above the middle of what is 2 wide",
       .is_key = true,
       .cell = [](const Record& record) { return record.is_perspective ? "perspective" : "parallel"; }},
      {.name = "extinction",
       .description = "at scalar 1, linear from 0 at 0; the colour goes from (1, 0, 1) to (0, 1, 1)",
       .is_key = true,
       .cell = &Record::extinction},
      {.name = "rule",
       .description =
           "what is linear in the triangles of a cell; projected_table makes exact slabs, projected_table_64 "
           "looks them up among 64^2 scalars, without an axis for opacity, projected_partial has extinction and colour "
           "linear from one end of a slab to the other (Moreland and Angel)",
       .is_key = true,
       .cell = &Record::rule},
      {.name = "order",
       .description = "of cells: as rays meet them, or by their centres",
       .is_key = true,
       .cell = &Record::order},
      {.name = "error_max",
       .description = "largest, over pixels that meet a cell and four channels, against the certified picture",
       .radius = "radius",
       .cell = &Record::error_max},
      {.name = "error_l2",
       .description = "root mean square of it",
       .radius = "radius",
       .cell = &Record::root_mean_square},
      {.name = "opacity_error_max",
       .description = "largest, of opacity alone",
       .radius = "radius",
       .cell = &Record::opacity_max},
      {.name = "length_error_max",
       .unit = "length",
       .description = "of a cell's length that is linear in the picture, against the ray's",
       .cell = &Record::length_max},
      {.name = "radius", .description = "bound on the error of the errors: the reference's", .cell = &Record::radius},
      {.name = "pixels", .description = "that meet a cell", .cell = &Record::pixels},
  };
}

}  // namespace

extern const Measure projected_tetrahedra_measure;
const Measure projected_tetrahedra_measure{MeasureDefinition<Options, Record>{
    .name = "projected_tetrahedra",
    .summary = "errors of tetrahedra drawn as triangles: by what is linear in them, and by their order",
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

}  // namespace raytruth
