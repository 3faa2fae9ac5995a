// What a user of the library writes, without JSON: a signal, a transfer function, the certified reference, a scheme, a
// table and a scene. Prints what was found, and returns 0 where all of it agrees.

#include <cmath>
#include <iostream>
#include <raytruth/core/named.hpp>
#include <raytruth/metrics/signal_error.hpp>
#include <raytruth/reference/ray_integral.hpp>
#include <raytruth/render/renderer.hpp>
#include <raytruth/schemes/integral_schemes.hpp>
#include <raytruth/schemes/order2.hpp>
#include <raytruth/schemes/scheme_integral.hpp>
#include <raytruth/signals/random_field.hpp>
#include <raytruth/signals/trilinear.hpp>
#include <raytruth/tables/table_builders.hpp>
#include <raytruth/tables/table_file.hpp>
#include <raytruth/transfer/study_transfers.hpp>

namespace {

using namespace raytruth;

bool is_right(const char* what, bool holds) {
  std::cout << what << (holds ? ": as it should be\n" : ": wrong\n");
  return holds;
}

}  // namespace

int main() {
  const Grid grid = random_field(16, 1, 1);
  const Chain<3> signal = trace_trilinear(grid, {{-1, 3.2, 4.1}, {1, 0.4, 0.3}});
  Samples<double> samples;
  sample_cells(signal, samples);
  Chain<3> approximation;
  approximate<Order2>(signal, samples, approximation);
  const double error = xi(signal, approximation);

  const PiecewiseLinear transfer = ramp_transfer(0.5);
  const Certified truth = RayIntegral(transfer, Emission::associated)(signal);
  const Outcome<> outcome = SchemeIntegral(transfer, Emission::associated)(
      *find_named(catalogue::integral_schemes(), "order2"), signal, samples);

  const TableAxes axes{.size = 32, .low = 0, .high = 1, .length = 1};
  const Table<double> table = find_named(catalogue::table_builders(), "exact")->make(transfer, axes, Emission::associated);
  const auto bytes = npy_bytes({32, 32, 4}, table.values, *find_named(table_formats, "float32"));

  Scene scene{.grid = grid, .transfer = transfer};
  scene.camera = {.eye = {40, 30, 50}, .target = {8, 8, 8}, .up = {0, 1, 0}, .projection = Orthographic{20}, .size = {8, 8}};
  const Rendering image = Renderer(scene).render();

  bool all = is_right("xi of second order", error > 0 && error < 0.1);
  all &= is_right("the certified ray", truth.radius > 0 && truth.radius < 1e-12 && truth.opacity > 0);
  all &= is_right("second order beside it", std::abs(outcome.opacity - truth.opacity) < 0.05);
  all &= is_right("the table's file", bytes.size() > 4 * 4 * 32 * 32);
  all &= is_right("the certified image", image.is_certified && image.radii.size() == 64);
  return all ? 0 : 1;
}
