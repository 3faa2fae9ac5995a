#include "raytruth/statistics/proportion.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/core/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace raytruth {
namespace {

TEST(ClusteredProportion, SingleTrialsGiveTheBinomialInterval) {
  std::vector<Cluster> clusters;
  for (int i = 0; i < 1000; ++i) clusters.push_back({.hits = i % 4 == 0 ? 1 : 0, .trials = 1});
  const Proportion p = clustered_proportion(clusters);
  EXPECT_DOUBLE_EQ(p.estimate, 0.25);
  EXPECT_NEAR(p.high - p.estimate, 1.96 * std::sqrt(0.25 * 0.75 / 999), 1e-5);
  EXPECT_NEAR(p.estimate - p.low, p.high - p.estimate, 1e-15);
}

TEST(ClusteredProportion, ClustersThatAgreeCountOnce) {
  // Ten copies of every trial say no more than one.
  std::vector<Cluster> single;
  std::vector<Cluster> copied;
  for (int i = 0; i < 500; ++i) {
    single.push_back({.hits = i % 5 == 0 ? 1 : 0, .trials = 1});
    copied.push_back({.hits = i % 5 == 0 ? 10 : 0, .trials = 10});
  }
  EXPECT_NEAR(clustered_proportion(single).high, clustered_proportion(copied).high, 1e-15);
}

TEST(ClusteredProportion, CoversTheTruthInAbout95PercentOfStudies) {
  // Clusters of 8 trials whose probability is common to the cluster: 0.1 or 0.3, so 0.2 in all.
  int covered = 0;
  constexpr int studies = 400;
  for (std::uint64_t study = 0; study < studies; ++study) {
    std::vector<Cluster> clusters(300);
    for (std::uint64_t i = 0; i < clusters.size(); ++i) {
      clusters[i].trials = 8;
      const double probability = random_numbers(study, RandomStream::points, i)[0] < 0.5 ? 0.1 : 0.3;
      for (std::uint32_t trial = 1; trial <= 2; ++trial)
        for (const double u : random_numbers(study, RandomStream::points, i, trial))
          clusters[i].hits += u < probability ? 1 : 0;
    }
    const Proportion p = clustered_proportion(clusters);
    covered += p.low <= 0.2 && 0.2 <= p.high ? 1 : 0;
  }
  // 95 % of 400, give or take four standard deviations.
  EXPECT_NEAR(covered, 380, 18);
}

TEST(ClusteredProportion, EndsOfTheScale) {
  const Proportion none = clustered_proportion({{0, 5}, {0, 7}, {0, 0}});
  EXPECT_EQ(none.estimate, 0);
  EXPECT_EQ(none.low, 0);
  EXPECT_NEAR(none.high, 1 - std::sqrt(0.05), 1e-15);
  const Proportion all = clustered_proportion({{5, 5}, {7, 7}});
  EXPECT_EQ(all.estimate, 1);
  EXPECT_EQ(all.high, 1);
  EXPECT_THROW(clustered_proportion({{0, 0}}), InputError);
}

}  // namespace
}  // namespace raytruth
