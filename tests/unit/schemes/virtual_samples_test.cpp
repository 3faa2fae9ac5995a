#include "experiments/measure.hpp"
#include "raytruth/core/real50.hpp"
#include "raytruth/metrics/sample_error.hpp"
#include "raytruth/signals/random_field.hpp"
#include "raytruth/signals/ray_ensemble.hpp"
#include "raytruth/signals/tricubic.hpp"
#include "raytruth/signals/tricubic_value.hpp"
#include "raytruth/signals/trilinear_value.hpp"
#include "unit/support/exact_ray.hpp"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <string>
#include <vector>

namespace raytruth {
namespace {

constexpr int ray_length = 5;

Experiment experiment_of(std::int64_t rays) {
  return {.name = "test",
          .seed = 1,
          .fields = {},
          .rays = {.count = rays, .length = ray_length},
          .transfers = {},
          .samplings = {},
          .schemes = {},
          .programs = {},
          .measures = {},
          .claims = {},
          .checks = {},
          .json = JsonReader::from_text(R"({"kind": "virtual_samples"})", "test")};
}

std::vector<Row> rows_of(const Grid& grid, std::int64_t rays) {
  const Experiment experiment = experiment_of(rays);
  const Measure& measure = measure_of(experiment.json);
  return measure.ask(measure, experiment, experiment.json)
      ->rows(experiment, {.name = "test", .grid = grid, .data_range = {0, 1}}, 0);
}

double number(const Row& row, std::string_view column) { return as_number(cell(row, column)).value_or(-1); }

const Row& find(const std::vector<Row>& rows, const std::string& reconstruction, const std::string& method,
                const std::string& over) {
  return *std::find_if(rows.begin(), rows.end(), [&](const Row& row) {
    return cell(row, "reconstruction") == Value(reconstruction) && cell(row, "method") == Value(method) &&
           cell(row, "over") == Value(over);
  });
}

/// The curve through four samples by eq. 2 of Lee 2010.
Real50 blended(const std::vector<Real50>& samples, std::size_t first, const Real50& t) {
  return (samples[first] * (-t * t * t + 2 * t * t - t) + samples[first + 1] * (3 * t * t * t - 5 * t * t + 2) +
          samples[first + 2] * (-3 * t * t * t + 4 * t * t + t) + samples[first + 3] * (t * t * t - t * t)) /
         2;
}

/// Every method at t = k + i/rate by its own words, from 50-digit samples a voxel apart; ghosts beyond both ends.
struct Expected {
  std::vector<Real50> cubic, linear;  // with a ghost at either end

  Real50 value(const std::string& method, std::size_t k, const Real50& t, const Real50& trilinear) const {
    if (method == "Cubic x1") return cubic[k + 1];
    if (method == "Linear x1") return linear[k + 1];
    if (method == "Linear x4") return trilinear;
    if (method == "Cubic x1 + LinearVS x3") return cubic[k + 1] + t * (cubic[k + 2] - cubic[k + 1]);
    return blended(method.starts_with("Cubic") ? cubic : linear, k, t);
  }
};

std::vector<Real50> with_ghosts(std::vector<Real50> v) {
  const std::size_t n = v.size();
  const Real50 before = 3 * v[0] - 3 * v[1] + v[2];
  const Real50 after = 3 * v[n - 1] - 3 * v[n - 2] + v[n - 3];
  v.insert(v.begin(), before);
  v.push_back(after);
  return v;
}

TEST(VirtualSamplesMeasure, AgreesWithItsDefinitionIn50DigitsToItsRadius) {
  const Grid grid = random_field(16, 0, 3);
  const Grid prefiltered = bspline_coefficients(grid);
  const std::int64_t count = 8;
  const auto rows = rows_of(grid, count);
  EXPECT_EQ(rows.size(), 2U * 7 * 2);
  for (const auto& [reconstruction, coefficients] :
       {std::pair{"bspline_raw", &grid}, {"bspline_prefiltered", &prefiltered}})
    for (const std::string method : {"Cubic x1 + VS x3", "Cubic x1 + VS x7", "Cubic x1 + LinearVS x3", "Cubic x1",
                                     "Linear x4", "Linear x1 + VS x3", "Linear x1"}) {
      SCOPED_TRACE(method);
      const std::size_t rate = method.ends_with("x7") ? 8 : 4;
      SampleError all;
      SampleError between;
      for (std::uint64_t i = 0; i < count; ++i) {
        const auto ray = testing_support::exact_ray(grid, random_ray(grid, ray_length, 1, i));
        const auto cubic = [&](const Real50& t) {
          return tricubic_value(*coefficients, CubicKernel::bspline, ray.point(t));
        };
        const auto linear = [&](const Real50& t) { return trilinear_value(grid, ray.point(t)); };
        Expected expected;
        for (int t = 0; t <= ray_length; ++t) {
          expected.cubic.push_back(cubic(t));
          expected.linear.push_back(linear(t));
        }
        expected.cubic = with_ghosts(expected.cubic);
        expected.linear = with_ghosts(expected.linear);
        for (std::size_t k = 0; k < ray_length; ++k)
          for (std::size_t part = 0; part < rate; ++part) {
            const Real50 u = Real50(part) / Real50(rate);
            const Real50 t = Real50(k) + u;
            const double error = to_double(expected.value(method, k, u, linear(t)) - cubic(t));
            all.add(error);
            if (part != 0) between.add(error);
          }
      }
      for (const auto& [over, error] : {std::pair{"all", all}, {"virtual", between}}) {
        const Row& row = find(rows, reconstruction, method, over);
        const double radius = number(row, "error_radius");
        EXPECT_EQ(number(row, "samples"), static_cast<double>(error.count));
        EXPECT_NEAR(number(row, "rmse"), error.rmse().value_or(0), radius);
        EXPECT_NEAR(number(row, "error_max"), error.maximum, radius);
        EXPECT_NEAR(number(row, "psnr"), error.psnr(1).value_or(0), number(row, "psnr_radius"));
        EXPECT_LT(number(row, "psnr_radius"), 1e-10);
      }
    }
}

TEST(VirtualSamplesMeasure, HasTheSameBytesOnAnyNumberOfThreads) {
  const Grid grid = random_field(16, 0.5, 3);
  tbb::task_arena one(1);
  tbb::task_arena two(2);
  EXPECT_EQ(one.execute([&] { return rows_of(grid, 200); }), two.execute([&] { return rows_of(grid, 200); }));
}

TEST(VirtualSamplesMeasure, SaysWhyThereIsNoPsnr) {
  Grid grid{.size = {400, 8, 8}, .spacing = {1, 1, 1}, .values = std::vector<double>(std::size_t{400} * 8 * 8, 0.25)};
  const auto constant = rows_of(grid, 4);
  const Row& nothing = find(constant, "bspline_raw", "Cubic x1", "all");
  EXPECT_EQ(number(nothing, "rays_constant"), 4);
  EXPECT_EQ(number(nothing, "samples"), 0);
  EXPECT_EQ(cell(nothing, "rmse"), Value());
  EXPECT_EQ(cell(nothing, "psnr"), Value());
  EXPECT_EQ(cell(nothing, "psnr_why"), Value("every ray is constant"));

  // Away from the borders of a ramp everything but holding samples is exact.
  for (std::size_t i = 0; i < grid.values.size(); ++i) grid.values[i] = static_cast<double>(i % 400) / 399;
  const auto ramp = rows_of(grid, 4);
  const Row& exact = find(ramp, "bspline_raw", "Linear x1 + VS x3", "virtual");
  EXPECT_EQ(number(exact, "rays_constant"), 0);
  EXPECT_EQ(number(exact, "samples"), 4 * 3 * ray_length);
  EXPECT_LE(number(exact, "rmse"), number(exact, "error_radius"));
  EXPECT_EQ(cell(exact, "psnr"), Value());
  EXPECT_EQ(cell(exact, "psnr_why"), Value("the RMSE is rounding"));
  EXPECT_EQ(cell(exact, "rmse_ratio"), Value());
  EXPECT_GT(number(find(ramp, "bspline_raw", "Cubic x1", "all"), "psnr"), 40);
}

}  // namespace
}  // namespace raytruth
