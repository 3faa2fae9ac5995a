#include "raytruth/tables/fast_second_order.hpp"
#include "raytruth/tables/second_order.hpp"

#include "raytruth/core/random.hpp"
#include "raytruth/kernels/slab_kernels.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/tables/partial_pre_integration.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/study_transfers.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace raytruth {
namespace {

using Vec4 = Rules<double>::vec4;

constexpr TableAxes axes{.size = 9, .low = 0, .high = 1, .length = 2};

const std::array<SecondOrderMethod, 4> methods{Iterations{.count = 8}, Iterations{.count = 64, .is_left = true},
                                               NyquistIterations{}, Ideal{}};

/// Values at a table's entries, linear in between.
template <class OpticsOf>
PiecewiseLinear at_entries(const TableAxes& axes, const OpticsOf& optics_of) {
  std::vector<TransferPoint> points;
  for (std::size_t i = 0; i < axes.size; ++i) points.push_back({axes.scalar(i), optics_of(i)});
  return PiecewiseLinear(std::move(points));
}

TEST(SecondOrder, ConstantTransferFunctionsGiveOneValueEverywhere) {
  const PiecewiseLinear constant({{0.5, {1.5, {1, 0.5, 0.25}}}});
  const double opacity = -std::expm1(-3.0);
  SecondOrderSlabs slabs(constant, axes, Emission::associated);
  for (const SecondOrderMethod& method : methods)
    for (const double middle : {-1.0, 0.0, 0.3, 1.0}) {
      const Vec4 slab = slabs({0.2, middle, 0.9}, method);
      EXPECT_LE((slab - opacity * Vec4(1, 0.5, 0.25, 1)).abs().maxCoeff(), 1e-14);
    }
  const PiecewiseLinear at_all = at_entries(axes, [](std::size_t) { return Optics{1.5, {1, 0.5, 0.25}}; });
  const Table3<float> table = second_order_table(at_all, axes, Emission::associated, Ideal{});
  for (std::size_t i = 0; i < table.values.size(); ++i)
    ASSERT_NEAR(table.values[i], opacity * Vec4(1, 0.5, 0.25, 1)[static_cast<Eigen::Index>(i % 4)], 2e-6) << i / 4;
}

TEST(SecondOrder, StraightSlabsAreThoseOfFirstOrder) {
  const PiecewiseLinear transfer = random_transfer(3, 1);
  SecondOrderSlabs slabs(transfer, axes, Emission::associated);
  RayIntegral integrate(transfer, Emission::associated);
  const Chain<3> linear{
      .pieces = {{.start = 0.0, .length = 2, .polynomial = Bernstein<1>{{0.125, 0.875}}.elevated<3>()}}, .end = 2.0};
  const Certified expected = integrate(linear);
  const Certified found = slabs.certified({0.125, 0.5, 0.875});
  EXPECT_NEAR(found.opacity, expected.opacity, found.radius + expected.radius);
  EXPECT_LE((found.color - expected.color).abs().maxCoeff(), found.radius + expected.radius);
}

// Midpoints are of second order, front ends of first: h -> h / 4.
TEST(SecondOrder, IterationsConverge) {
  const PiecewiseLinear transfer = ramp_transfer(2);
  SecondOrderSlabs slabs(transfer, axes, Emission::associated);
  const std::array scalars{0.1, 0.9, 0.4};
  const Vec4 exact = slabs(scalars, Ideal{});
  const auto error = [&](int count, bool is_left) {
    return (slabs(scalars, Iterations{.count = count, .is_left = is_left}) - exact).abs().maxCoeff();
  };
  EXPECT_NEAR(error(64, false) / error(256, false), 16, 0.5);
  EXPECT_NEAR(error(64, true) / error(256, true), 4, 0.2);
}

// P = 4 u (1 - u) from 0 over 1 to 0, extinction s: the depth is 2/3 of the length.
TEST(SecondOrder, AParabolaUnderARampHasAClosedForm) {
  SecondOrderSlabs slabs(ramp_transfer(1), axes, Emission::associated);
  EXPECT_NEAR(slabs({0, 1, 0}, Ideal{})[3], -std::expm1(-4.0 / 3), 1e-14);
}

// P leaves [0, 1] by 1/8: clamped there, though the transfer function goes on.
TEST(SecondOrder, ScalarsAreClampedToTheRange) {
  const PiecewiseLinear transfer({{-1, {5, {1, 1, 1}}}, {0, {1, {0, 0, 0}}}, {1, {1, {0, 0, 0}}}, {2, {5, {1, 1, 1}}}});
  SecondOrderSlabs slabs(transfer, axes, Emission::associated);
  for (const SecondOrderMethod& method : methods)
    EXPECT_LE((slabs({1, 1, 0}, method) - Vec4(0, 0, 0, -std::expm1(-2.0))).abs().maxCoeff(), 1e-14);
}

TEST(SecondOrder, NyquistAsksForTwiceTheSteepestSlope) {
  EXPECT_EQ(nyquist_iterations(axes, {0.5, 0.5, 0.5}), 8);
  EXPECT_EQ(nyquist_iterations(axes, {0, 0.5, 1}), 510);
  EXPECT_EQ(nyquist_iterations(axes, {0, 1, 0}), 2040);  // errata: up to 2040, not 256
  // Steepest at the end, P' = 4 t - 1, and at the beginning, P' = 4 t - 3.
  EXPECT_EQ(nyquist_iterations(axes, {0, 0, 1}), 1530);
  EXPECT_EQ(nyquist_iterations(axes, {1, 0, 0}), 1530);
}

TEST(SecondOrder, AFullTableIsTheSlabs) {
  const PiecewiseLinear transfer = gaussian_transfer(4);
  const Table3<float> table = second_order_table(transfer, axes, Emission::plain, Ideal{});
  SecondOrderSlabs slabs(transfer, axes, Emission::plain);
  const Vec4 expected = slabs({axes.scalar(1), axes.scalar(5), axes.scalar(7)}, Ideal{});
  EXPECT_LE((table.at(1, 5, 7).cast<double>() - expected).abs().maxCoeff(), 0x1p-22);
}

// In binary32: places to 2^-24 of 32 entries, under differences of neighbours of up to 1; the exponential to 4.4e-7.
TEST(SecondOrder, KernelsGiveTheNumbersOfThePlainLoop) {
  constexpr std::size_t size = 33;  // no multiple of any number of lanes
  const TableAxes fine{.size = size, .low = 0, .high = 1, .length = 1};
  const PiecewiseLinear random = random_transfer(20, 1);
  const PiecewiseLinear transfer = at_entries(fine, [&](std::size_t i) { return random.at(fine.scalar(i)); });
  ASSERT_TRUE(is_linear_between_entries(transfer, fine));
  SecondOrderSlabs slabs(transfer, fine, Emission::associated);
  for (const SlabKernels* const version : slab_kernel_versions())
    for (const Iterations iterations : {Iterations{.count = 8}, {.count = 64}, {.count = 9, .is_left = true}}) {
      Table3<float> table(fine);
      fill_second_order_table(table, transfer, iterations, *version);
      for (std::size_t back = 0; back < size; back += 4)
        for (std::size_t middle = 0; middle < size; middle += 3)
          for (std::size_t front = 0; front < size; ++front) {
            const Vec4 expected = slabs({fine.scalar(front), fine.scalar(middle), fine.scalar(back)}, iterations);
            ASSERT_LE((table.at(front, middle, back).cast<double>() - expected).abs().maxCoeff(), 1e-5)
                << front << ' ' << middle << ' ' << back << ' ' << iterations.count;
          }
    }
}

// 5 * 10^-6 is the goal: products of 2 * 33 transmittances in binary32 err by 4 * 10^-6 at most, rules by 10^-6. The
// coarse table has intervals that are too deep for the kernels.
TEST(SecondOrder, ExactKernelsGiveCertifiedSlabs) {
  for (const std::size_t size : {2U, 5U, 33U}) {
    const TableAxes table_axes{.size = size, .low = -1, .high = 3, .length = 2};
    SCOPED_TRACE(size);
    for (const double depth : {0.01, 5.0, 30.0, 1e4}) {
      SCOPED_TRACE(depth);
      if (depth > 30 && size > 5) continue;
      const PiecewiseLinear all = random_transfer(depth / 2, 1);
      const std::vector<PiecewiseLinear> transfers{
          at_entries(table_axes, [&](std::size_t i) { return all.at(0.123 * static_cast<double>(i)); }),
          at_entries(table_axes,
                     [&](std::size_t i) {
                       return Optics{i == size / 2 ? depth / 2 : 0, {i < size / 2 ? 0.0 : 1.0, 1, i % 2 ? 1.0 : 0.0}};
                     }),
          at_entries(table_axes, [&](std::size_t i) {
            const double s = static_cast<double>(i) / static_cast<double>(size - 1);
            return Optics{depth / 2 * s, {s, 1 - s, 0.5}};
          })};
      for (const PiecewiseLinear& transfer : transfers) {
        SecondOrderSlabs slabs(transfer, table_axes, Emission::associated);
        const std::size_t stride = size < 33 ? 1 : 3;
        for (const SlabKernels* const version : slab_kernel_versions()) {
          Table3<float> table(table_axes);
          fill_exact_second_order_table(table, transfer, *version);
          for (std::size_t back = 0; back < size; back += stride)
            for (std::size_t middle = 0; middle < size; middle += stride)
              for (std::size_t front = 0; front < size; front += stride) {
                const Vec4 expected =
                    slabs({table_axes.scalar(front), table_axes.scalar(middle), table_axes.scalar(back)}, Ideal{});
                ASSERT_LE((table.at(front, middle, back).cast<double>() - expected).abs().maxCoeff(), 5e-6)
                    << front << ' ' << middle << ' ' << back << ' ' << version->parabola_lanes;
              }
        }
      }
    }
  }
}

TEST(SecondOrder, TablesAreTheSameOnAnyNumberOfThreads) {
  const TableAxes table_axes{.size = 40, .low = 0, .high = 1, .length = 1};
  const PiecewiseLinear all = random_transfer(5, 1);
  const PiecewiseLinear transfer = at_entries(table_axes, [&](std::size_t i) { return all.at(table_axes.scalar(i)); });
  const auto values_on = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    Table3<float> table(table_axes);
    fill_exact_second_order_table(table, transfer, *slab_kernel_versions().front());
    return table.values;
  };
  EXPECT_EQ(values_on(1), values_on(2));
}

TEST(SecondOrder, KernelsAreForTransferFunctionsOfTheTablesEntriesOnly) {
  EXPECT_TRUE(is_linear_between_entries(random_transfer(1, 1), {.size = 256, .low = 0, .high = 1, .length = 1}));
  EXPECT_FALSE(is_linear_between_entries(random_transfer(1, 1), {.size = 128, .low = 0, .high = 1, .length = 1}));
  EXPECT_FALSE(is_linear_between_entries(step_transfer(1), {.size = 257, .low = 0, .high = 1, .length = 1}));
}

TEST(SecondOrder, RefusesTablesTooLarge) {
  EXPECT_THROW(Table3<float>({.size = 257, .low = 0, .high = 1, .length = 1}), InputError);
  EXPECT_THROW(Table3<float>({.size = 1, .low = 0, .high = 1, .length = 1}), InputError);
}

// D_f = D_b = D: psi = (1 - exp(-D)) / D. D_f = 0: integral exp(-D u^2 / 2) = sqrt(pi / (2 D)) erf(sqrt(D / 2)).
TEST(PartialPreIntegration, PsiHasClosedForms) {
  for (const double depth : {1e-9, 0.1, 1.0, 10.0, 100.0, 1e4}) {
    EXPECT_NEAR(partial_pre_integration_psi(depth, depth), -std::expm1(-depth) / depth, 1e-14) << depth;
    EXPECT_NEAR(partial_pre_integration_psi(0, depth),
                std::sqrt(std::acos(-1.0) / (2 * depth)) * std::erf(std::sqrt(depth / 2)), 1e-14)
        << depth;
  }
  EXPECT_EQ(partial_pre_integration_psi(0, 0), 1);
  EXPECT_EQ(partial_pre_integration_psi(std::numeric_limits<double>::infinity(), 1), 0);
}

TEST(PartialPreIntegration, SlabsAreCertifiedOnes) {
  const Optics front{3, {1, 0.25, 0}};
  const Optics back{0.5, {0, 0.5, 1}};
  RayIntegral integrate(PiecewiseLinear({{0, front}, {1, back}}), Emission::associated);
  const Certified truth = integrate(Chain<3>{
      .pieces = {{.start = 0.0, .length = 2, .polynomial = Bernstein<1>{{0.0, 1.0}}.elevated<3>()}}, .end = 2.0});
  const Vec4 slab = partially_pre_integrated_slab(front, back, 2, partial_pre_integration_psi(6, 1));
  EXPECT_LE((slab.head<3>() - truth.color).abs().maxCoeff(), 1e-14);
  EXPECT_NEAR(slab[3], truth.opacity, 1e-14);
}

// Bilinear look-ups are of second order in the table's size, nearest ones of first: at random places, away from the
// corner of infinite depths, where psi is not smooth.
TEST(PartialPreIntegration, LookUpsConverge) {
  const auto mean_error = [](std::size_t size, PsiLookUp look_up) {
    const PsiTable table(size);
    double sum = 0;
    for (std::uint64_t i = 0; i < 2000; ++i) {
      const auto random = random_numbers(1, RandomStream::points, i);
      const double front = 0.9 * random[0] / (1 - 0.9 * random[0]);
      const double back = 0.9 * random[1] / (1 - 0.9 * random[1]);
      sum += std::abs(table(front, back, look_up) - partial_pre_integration_psi(front, back));
    }
    return sum;
  };
  EXPECT_NEAR(mean_error(65, PsiLookUp::bilinear) / mean_error(257, PsiLookUp::bilinear), 16, 1);
  EXPECT_NEAR(mean_error(65, PsiLookUp::nearest) / mean_error(257, PsiLookUp::nearest), 4, 0.25);
}

}  // namespace
}  // namespace raytruth
