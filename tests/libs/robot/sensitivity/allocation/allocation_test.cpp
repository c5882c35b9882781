// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/libs/robot/sensitivity/robot_case.hpp"
#include "tests/support/heap_counter.hpp"

namespace palpate::robot {
namespace {

using SensitivityAllocation = SensitivityCase;

TEST_P(SensitivityAllocation, NoneWhenCalledAgain) {
  if (!test_support::HeapRequestsAreCounted()) GTEST_SKIP() << "a sanitizer, or not glibc";
  Balance balance = Solve(robot_);
  SensitivitySolver solver(*balance.model);
  std::vector<ParameterPtr> parameters;
  for (const int material : {0, 1}) {
    parameters.push_back(YoungsModulus(material));
    parameters.push_back(PoissonsRatio(material));
  }
  parameters.push_back(MassFactor());
  parameters.push_back(GravityTurn(Eigen::Vector3d::UnitX()));
  parameters.push_back(CableOffset(0));
  parameters.push_back(CableGain(0));
  parameters.push_back(
      ExternalForce(robot_.body.markers[0].point.weights, Eigen::Vector3d::UnitY()));
  const std::vector<fem::InterpolationWeights> points(51, robot_.body.markers[1].point.weights);
  Eigen::MatrixXd motions_m;
  bool ok = true;
  const auto frame = [&] {
    ok = ok && solver.Compute(robot_.cables, balance.state, parameters).ok();
    solver.PointMotions(points, &motions_m);
  };
  frame();
  const size_t before = test_support::HeapRequestCount();
  for (int k = 0; k < 3; ++k) frame();
  EXPECT_EQ(test_support::HeapRequestCount(), before);
  EXPECT_TRUE(ok);
}

INSTANTIATE_TEST_SUITE_P(SoftBeam, SensitivityAllocation, AllCases());

}  // namespace
}  // namespace palpate::robot
