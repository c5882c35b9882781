// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "components/force_estimation/shape/camera_biases.hpp"
#include "components/force_estimation/shape/shape_targets.hpp"

namespace palpate::force_estimation {
namespace {

constexpr double kSigma_m = 1e-4;
constexpr int kFeatures = 10;

/// Features that each look at the x coordinate of a node of their own, at 0 in the model's shape.
class Targets : public testing::Test {
 protected:
  Targets() : targets_(config_, 0.01), bias_(kFeatures, config_) {
    for (int f = 0; f < kFeatures; ++f) {
      correspondence::FeatureMatch& match = matches_.emplace_back();
      match.feature = f;
      match.state = correspondence::MatchState::kMatched;
      match.row.nodes = {f};
      match.row.coefficients = {Eigen::Vector3d::UnitX()};
      match.sigma_m = kSigma_m;
      match.normal = Eigen::Vector3d::UnitX();
      match.position_m = {0.01 * f, 0.0, 0.45};
    }
    bias_.HaveCameras(1);
    for (int k = 0; k < 40; ++k) bias_.Learn(matches_, x_m_, kHere, 0);
    EXPECT_TRUE(bias_.Finish().ok());
  }

  void Build(const std::vector<ShapeSite>& sites = {}) {
    targets_.Build(matches_, texture_, bias_, kHere, x_m_, x_m_, sites);
  }
  /// Weight of a row over that of the first.
  double Share(Eigen::Index row) const {
    return targets_.targets().weight[row] / targets_.targets().weight[0];
  }

  const CameraPoses kHere = {Eigen::Isometry3d::Identity()};
  ShapeConfig config_;
  Eigen::VectorXd x_m_ = Eigen::VectorXd::Zero(3 * kFeatures);
  std::vector<correspondence::FeatureMatch> matches_;
  std::vector<TextureMatch> texture_;
  ShapeTargets targets_;
  CameraBiases bias_;
};

TEST_F(Targets, OnlyMatchedFeaturesAreRows) {
  matches_[3].state = correspondence::MatchState::kHidden;
  matches_[7].state = correspondence::MatchState::kOutlier;
  Build();
  EXPECT_EQ(targets_.Count(), kFeatures - 2);
  EXPECT_EQ(targets_.features(), (std::vector<int>{0, 1, 2, 4, 5, 6, 8, 9}));
}

TEST_F(Targets, AFeatureThatHasMovedIsKnownByTheModelsShareOfThat) {
  Eigen::VectorXd moved_m = x_m_;
  moved_m[3 * 4] = 0.01;
  targets_.Build(matches_, texture_, bias_, kHere, moved_m, x_m_, {});
  EXPECT_NEAR(targets_.sigma_m()[4], config_.model_relative_sigma * 0.01, 0.02 * 3e-4);
  EXPECT_LT(targets_.sigma_m()[5], 1.5 * kSigma_m);
}

TEST_F(Targets, TextureHasTwoRowsAfterThoseAlongNormals) {
  constexpr double kImage_m = 5e-5;
  matches_[3].state = correspondence::MatchState::kHidden;
  TextureMatch& match = texture_.emplace_back();
  match.feature = 4;
  match.number = 4;
  match.place = {.nodes = {4}, .weights = {1.0}};
  match.rows[0] = {.nodes = {4}, .coefficients = {Eigen::Vector3d::UnitY()}};
  match.rows[1] = {.nodes = {4}, .coefficients = {Eigen::Vector3d::UnitZ()}};
  match.target_m = {1e-3, 2e-3};
  match.sigma_m = kImage_m;
  Build();
  ASSERT_EQ(targets_.Count(), kFeatures - 1 + 2);
  ASSERT_EQ(targets_.AlongNormals(), kFeatures - 1);
  EXPECT_EQ(targets_.targets().value_m.tail<2>(), match.target_m) << "no depth bias shifts it";
  EXPECT_NEAR(targets_.targets().weight.tail<1>()[0], 1.0 / (kImage_m * kImage_m), 1e-3);
  EXPECT_EQ(targets_.features().back(), 4);
  std::set<std::size_t> numbers(targets_.matched().begin(), targets_.matched().end());
  EXPECT_EQ(numbers.size(), targets_.matched().size()) << "each row has a number of its own";
  EXPECT_LT(*numbers.rbegin(), targets_.MostRows());
}

TEST_F(Targets, AnOutlierLosesWeightAsHubersDoes) {
  constexpr double kOff = 5.0;  // other features lie where the model has them
  Build();
  matches_[6].target_m += targets_.targets().value_m[6] + kOff * targets_.sigma_m()[6];
  Build();
  targets_.WeighAt(x_m_);
  EXPECT_NEAR(Share(6), config_.robust_threshold / kOff, 0.02);
  EXPECT_NEAR(Share(5), 1.0, 1e-3);
}

TEST_F(Targets, AShapeThatIsFarOffTellsNoOutliers) {
  for (correspondence::FeatureMatch& match : matches_) match.target_m = 20.0 * kSigma_m;
  matches_[6].target_m = 60.0 * kSigma_m;
  Build();
  const Eigen::VectorXd before = targets_.targets().weight;
  targets_.WeighAt(x_m_);
  EXPECT_EQ(targets_.targets().weight, before);
}

TEST_F(Targets, ReweighingSaysWhetherItChangedMuch) {
  Build();
  Eigen::VectorXd residual_m = Eigen::VectorXd::Zero(kFeatures);
  EXPECT_FALSE(targets_.Reweight(residual_m));
  residual_m[2] = 10.0 * targets_.sigma_m()[2];
  EXPECT_TRUE(targets_.Reweight(residual_m));
  EXPECT_NEAR(Share(2), 0.1 * config_.robust_threshold, 0.02);
  EXPECT_FALSE(targets_.Reweight(residual_m));
  residual_m.setZero();
  EXPECT_TRUE(targets_.Reweight(residual_m)) << "a feature that fits again has its weight again";
  EXPECT_NEAR(Share(2), 1.0, 0.02);
}

}  // namespace
}  // namespace palpate::force_estimation
