// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/posture.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "libs/core/index.hpp"
#include "tests/components/diagnosis/small_robot.hpp"

namespace palpate::diagnosis {
namespace {

/// A body that is bent along two shapes through a round of samples.
class Posture : public testing::Test {
 protected:
  static constexpr int kSamples = 24;

  Simulation Bent(double first_m, double second_m) const {
    const Eigen::VectorXd rest_m = body_.mesh.nodes_m.reshaped();
    Simulation simulation;
    for (int s = 0; s < kSamples; ++s) {
      const double angle = 2.0 * M_PI * s / kSamples;
      Eigen::VectorXd x_m = rest_m;
      for (Eigen::Index node = 0; node < body_.mesh.nodes_m.cols(); ++node) {
        const double along = body_.mesh.nodes_m(0, node) / 0.1;
        x_m[3 * node + 2] += first_m * along * along * std::cos(angle);
        x_m[3 * node + 1] += second_m * along * std::sin(2.0 * angle);
      }
      SimulatedSample& sample = simulation.samples.emplace_back();
      sample.status = Status::Ok();
      sample.middle.state.x_m = x_m;
    }
    return simulation;
  }
  static Eigen::MatrixXd Values(const PostureFunctions& functions, const Simulation& simulation) {
    Eigen::MatrixXd values(functions.count(), std::ssize(simulation.samples));
    for (std::size_t s = 0; s < simulation.samples.size(); ++s) {
      values.col(ToIndex(s)) = functions.At(simulation.samples[s].middle.state.x_m);
    }
    return values;
  }

  robot::RobotBody body_ = SmallRobot();
};

TEST_F(Posture, FunctionsAreOrthogonalAndTheirSquaresAddUpToOne) {
  const Simulation simulation = Bent(0.01, 0.004);
  const auto functions = FunctionsOfPosture(body_, simulation);
  ASSERT_TRUE(functions);
  const Eigen::MatrixXd values = Values(*functions, simulation);
  EXPECT_LT(values.rowwise().mean().norm(), 1e-9);
  const Eigen::MatrixXd products = values * values.transpose() / kSamples;
  EXPECT_NEAR(products.trace(), 1.0, 1e-3);
  const Eigen::MatrixXd diagonal = products.diagonal().asDiagonal();
  EXPECT_LT((products - diagonal).norm(), 1e-9);
}

/// Linear ones follow the larger shape, and its square is among them, too.
TEST_F(Posture, FunctionsAreLinearAndQuadraticInTheShapes) {
  const Simulation simulation = Bent(0.01, 0.0);
  const auto functions = FunctionsOfPosture(body_, simulation);
  ASSERT_TRUE(functions);
  ASSERT_EQ(functions->count(), 2);
  const Eigen::MatrixXd values = Values(*functions, simulation);
  Eigen::MatrixXd expected(2, kSamples);
  for (int s = 0; s < kSamples; ++s) {
    const double cosine = std::cos(2.0 * M_PI * s / kSamples);
    expected.col(s) << cosine, cosine * cosine - 0.5;
  }
  for (Eigen::Index k = 0; k < 2; ++k) {
    const double correlation =
        std::abs(values.row(k).normalized().dot(expected.row(k).normalized()));
    EXPECT_NEAR(correlation, 1.0, 1e-6) << k;
  }
}

TEST_F(Posture, HasNoFunctionsWhereNothingMoves) {
  EXPECT_FALSE(FunctionsOfPosture(body_, Bent(0.0, 0.0)));
  Simulation failed = Bent(0.01, 0.004);
  for (SimulatedSample& sample : failed.samples)
    sample.status = {StatusCode::kNotConverged, "made up"};
  EXPECT_FALSE(FunctionsOfPosture(body_, failed));
  EXPECT_FALSE(FunctionsOfPosture(body_, {}));
}

}  // namespace
}  // namespace palpate::diagnosis
