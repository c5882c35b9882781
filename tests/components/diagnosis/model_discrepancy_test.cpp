// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "components/diagnosis/faults/catalogue.hpp"
#include "components/diagnosis/forward/posture.hpp"
#include "components/diagnosis/forward/simulator.hpp"
#include "components/diagnosis/inference/hypothesis_set.hpp"
#include "libs/core/index.hpp"
#include "tests/components/diagnosis/small_robot.hpp"
#include "tests/components/diagnosis/toy_faults.hpp"

namespace palpate::diagnosis {
namespace {

constexpr double kNamedFrom = 10.0;  ///< ln BF

/// A fault whose effect is one of those that the discrepancy can have, on robots that have one.
class DiscrepancyBesideAFault : public testing::Test {
 protected:
  static constexpr Eigen::Index kCoefficients = 40, kRows = 500;
  static constexpr int kRobots = 20;
  static constexpr double kDiscrepancy = 0.01;

  DiscrepancyBesideAFault() {
    J_ = Normal(kRows, kCoefficients + 1);
    J_.rightCols(kCoefficients) *= 50.0;
    const Eigen::VectorXd direction = Normal(kCoefficients, 1).normalized();
    J_.col(0) = J_.rightCols(kCoefficients) * direction;
  }

  static HypothesisSet Hypotheses(bool with_discrepancy) {
    std::vector<FaultModelPtr> models;
    models.push_back(std::make_unique<ToyFault>(
        "fault", std::vector<FaultParameter>{{.name = "size", .fault = 0.2}}));
    FaultParameter coefficient{.name = "share", .group = DiscrepancyGroup::kCables};
    if (with_discrepancy) coefficient.tolerance = coefficient.fault = 1.0;
    models.push_back(std::make_unique<ToyFault>(
        "discrepancy", std::vector<FaultParameter>(kCoefficients, coefficient)));
    return {std::move(models), {}};
  }
  Eigen::MatrixXd Normal(Eigen::Index rows, Eigen::Index cols) {
    std::normal_distribution<double> normal;
    return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return normal(random_); });
  }
  Information Robot(double fault) {
    Eigen::VectorXd z = kDiscrepancy * Normal(kCoefficients + 1, 1);
    z[0] = fault;
    const Eigen::VectorXd y = J_ * z + Normal(kRows, 1);
    Information data(kCoefficients + 1);
    data.H = J_.transpose() * J_;
    data.b = J_.transpose() * y;
    data.c = y.squaredNorm();
    return data;
  }
  int NamedOf(const HypothesisSet& hypotheses, double fault) {
    int named = 0;
    for (int robot = 0; robot < kRobots; ++robot) {
      const Information data = Robot(fault);
      const double ln_bayes_factor = hypotheses.InferWithin(data, {0}).ln_evidence -
                                     hypotheses.InferWithin(data, {}).ln_evidence;
      named += ln_bayes_factor > kNamedFrom ? 1 : 0;
    }
    return named;
  }

  std::mt19937 random_{7};
  Eigen::MatrixXd J_;
};

TEST_F(DiscrepancyBesideAFault, HealthyRobotsAreAccusedWithoutItAndAcquittedWithIt) {
  EXPECT_GT(NamedOf(Hypotheses(false), 0.0), kRobots / 2);
  EXPECT_EQ(NamedOf(Hypotheses(true), 0.0), 0);
}

TEST_F(DiscrepancyBesideAFault, LeavesAFaultThatIsThere) {
  EXPECT_GE(NamedOf(Hypotheses(true), 0.15), kRobots - 1);
}

TEST_F(DiscrepancyBesideAFault, IsAsLargeAsTheDataSay) {
  const double scale = Hypotheses(true).InferWithin(Robot(0.0), {}).scale[0];
  EXPECT_NEAR(std::log(scale / kDiscrepancy), 0.0, 0.35);
}

/// What it does to a sample is what the cable's zero offset does, as often as the posture says.
TEST(ModelDiscrepancy, ActsAsItsInputTimesAFunctionOfPosture) {
  const robot::RobotBody body = SmallRobot();
  const ObservedExperiment observed =
      Observe(SmallExperiment(body), body, {.most_samples = 14, .depth_cameras = SmallCameras()});
  const Simulator simulator(observed, 1);
  const ModelHypothesis nominal = NominalHypothesis(body, observed);
  Simulation simulation = simulator.Run(nominal);
  const HypothesisSet hypotheses(
      MakeFaultModels({.body = body, .observed = observed, .as_built = &simulation}, {}), {});
  const Eigen::VectorXd z = Eigen::VectorXd::Zero(hypotheses.parameter_count());
  const FaultModelList all = hypotheses.All();
  simulator.Differentiate(nominal, all, z, std::vector<bool>(all.size(), true), nominal,
                          &simulation);
  const auto functions = FunctionsOfPosture(body, simulation);
  ASSERT_TRUE(functions);
  const auto find = [&](const std::string& id, const std::string& where) {
    for (int k = 0; k < hypotheses.size(); ++k) {
      const CauseName& name = hypotheses.model(k).name();
      if (name.id == id && name.where == std::vector<std::string>{where}) return k;
    }
    return -1;
  };
  const std::string where = "cable:" + body.cables.front().name;
  const int offset = find("cable_offset", where);
  const int discrepancy = find("model_discrepancy", where);
  ASSERT_GE(offset, 0);
  ASSERT_GE(discrepancy, 0);
  EXPECT_FALSE(hypotheses.CanBeFault(discrepancy));
  EXPECT_TRUE(hypotheses.Simulated(Eigen::VectorXd::Ones(z.size()))
                  .segment(hypotheses.first(discrepancy), hypotheses.count(discrepancy))
                  .isZero(0.0));
  double factor = 0.0;  // the largest command, the same for all samples and functions
  int compared = 0;
  for (const SimulatedSample& sample : simulation.samples) {
    if (!sample.status.ok() || !sample.beside.empty()) continue;
    const Eigen::VectorXd of_offset = sample.jacobian_m.col(hypotheses.first(offset));
    const Eigen::VectorXd values = functions->At(sample.middle.state.x_m);
    for (Eigen::Index j = 0; j < values.size(); ++j) {
      const Eigen::VectorXd column = sample.jacobian_m.col(hypotheses.first(discrepancy) + j);
      const Eigen::VectorXd expected = values[j] * of_offset;
      if (expected.norm() < 1e-3) continue;
      if (factor == 0.0) factor = column.norm() / expected.norm();
      EXPECT_LT((column - factor * expected).norm(), 1e-6 * column.norm());
      ++compared;
    }
  }
  EXPECT_GT(compared, 5);
  EXPECT_GT(factor, 1e-3);  // m
}

}  // namespace
}  // namespace palpate::diagnosis
