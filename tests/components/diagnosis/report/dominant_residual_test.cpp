// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/report/figures/dominant_residual.hpp"
#include "tests/support/not_a_number.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate::diagnosis {
namespace {

const Eigen::Vector3d kWay = Eigen::Vector3d(0.6, 0.0, -0.8);

/// Three markers: the first far off but still, the second going along kWay, the third a little.
std::vector<ComparedSample> MakeSamples(const std::vector<double>& way_m) {
  std::vector<ComparedSample> compared_samples(way_m.size());
  for (std::size_t i = 0; i < way_m.size(); ++i) {
    compared_samples[i].before_m.resize(3, 3);
    compared_samples[i].before_m.col(0) = Eigen::Vector3d(0.05, 0.0, 0.0);
    compared_samples[i].before_m.col(1) = way_m[i] * kWay + Eigen::Vector3d(0.0, 0.01, 0.0);
    compared_samples[i].before_m.col(2) = Eigen::Vector3d(0.0, 0.3 * way_m[i], 0.0);
    compared_samples[i].after_m = Eigen::Matrix3Xd::Zero(3, 3);
  }
  return compared_samples;
}

ComparedSamples Pointers(const std::vector<ComparedSample>& compared_samples) {
  ComparedSamples pointers;
  for (const ComparedSample& compared : compared_samples) pointers.push_back(&compared);
  return pointers;
}

TEST(DominantResidual, IsWhatVariesNotWhatIsFarOff) {
  const auto compared_samples = MakeSamples({0.0, 1e-3, 2e-3, 3e-3, 4e-3});
  const DominantResidual dominant = FindDominant(Pointers(compared_samples));
  EXPECT_EQ(dominant.marker, 1);
  EXPECT_NEAR((dominant.direction - kWay).norm(), 0.0, 1e-9);
  EXPECT_NEAR(Along_mm(dominant, compared_samples[4].before_m) -
                  Along_mm(dominant, compared_samples[0].before_m),
              4.0, 1e-9);
}

TEST(DominantResidual, PointsWhereTheLastHalfLies) {
  const auto compared_samples = MakeSamples({4e-3, 3e-3, 2e-3, 1e-3, 0.0});
  EXPECT_NEAR((FindDominant(Pointers(compared_samples)).direction + kWay).norm(), 0.0, 1e-9);
}

TEST(DominantResidual, RiseIsTheSlopeNotTheScatter) {
  auto compared_samples = MakeSamples({0.0, 1e-3, 2e-3, 3e-3, 4e-3, 5e-3});
  for (std::size_t i = 0; i < compared_samples.size(); ++i) {
    compared_samples[i].before_m(2, 2) =
        (i == 1 || i == 5 ? 0.02 : 0.0);  // evenly about the middle
  }
  const auto pointers = Pointers(compared_samples);
  EXPECT_EQ(FindDominant(pointers).marker, 2);
  const DominantResidual rise = FindRise(pointers, {kNaN, 1.0, 2.0, 3.0, 4.0, 5.0});
  EXPECT_EQ(rise.marker, 1);
  EXPECT_GT(rise.direction.dot(kWay), 0.99);
}

TEST(DominantResidual, NeedsFourMomentsThatSawTheMarker) {
  auto compared_samples = MakeSamples({0.0, 1e-3, 2e-3, 3e-3, 4e-3});
  for (const int i : {1, 3})
    compared_samples[static_cast<std::size_t>(i)].before_m.col(1).setConstant(kNaN);
  EXPECT_EQ(FindDominant(Pointers(compared_samples)).marker, 2);
  compared_samples.resize(3);
  EXPECT_EQ(FindDominant(Pointers(compared_samples)).marker, -1);
  EXPECT_EQ(FindDominant({}).marker, -1);
  EXPECT_TRUE(std::isnan(Along_mm({}, compared_samples[0].before_m)));
}

}  // namespace
}  // namespace palpate::diagnosis
