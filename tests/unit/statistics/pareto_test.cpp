#include "raytruth/statistics/pareto.hpp"

#include <gtest/gtest.h>

namespace raytruth {
namespace {

TEST(ParetoFront, LeavesOutWhatAnotherBeats) {
  // (2, 3) is beaten by (2, 2), (4, 2) by the same, (5, 1) by nobody; (1, 9) is the cheapest.
  const std::vector<CostError> points{{1, 9}, {2, 3}, {2, 2}, {4, 2}, {5, 1}};
  EXPECT_EQ(pareto_front(points), (std::vector<bool>{true, false, true, false, true}));
}

TEST(ParetoFront, KeepsEqualsTogether) {
  EXPECT_EQ(pareto_front({{1, 1}, {1, 1}}), (std::vector<bool>{true, true}));
  EXPECT_TRUE(pareto_front({}).empty());
}

}  // namespace
}  // namespace raytruth
