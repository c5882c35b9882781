// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <memory>

#include "libs/robot/compliance.hpp"
#include "libs/robot/frame_tracker.hpp"
#include "libs/robot/robot_model.hpp"
#include "tests/libs/fem/points/meshes.hpp"
#include "tests/support/heap_counter.hpp"

namespace palpate::robot {
namespace {

/// A box of soft tet10 held at x = 0, with two cables; one node of the far end slides along x.
RobotBody SoftBox() {
  RobotBody body;
  body.mesh = fem::MakeQuadratic(fem::BoxMesh({0.1, 0.02, 0.02}, {8, 2, 2}));
  body.materials = {
      {fem::MaterialModel::kStableNeoHookean, fem::Volumetric::kMeanDilatation, 65e3, 0.49}};
  body.material_of_cell.assign(static_cast<size_t>(body.mesh.CellCount()), 0);
  body.fixed = fem::FixedDirections::Constant(3, body.mesh.NodeCount(), false);
  for (int n = 0; n < body.mesh.NodeCount(); ++n) {
    if (body.mesh.nodes_m(0, n) < 1e-9) body.fixed.col(n).setConstant(true);
  }
  body.fixed(1, 8) = true;
  body.node_mass_kg = Eigen::VectorXd::Constant(body.mesh.NodeCount(), 1e-5);
  body.gravity_m_s2 = {0.0, 0.0, -9.81};
  const fem::PointLocator locator(body.mesh);
  for (const double z : {0.002, 0.018}) {
    const Eigen::Vector3d pull(0.0, 0.01, z);
    body.cables.push_back(
        {"cable", pull, {locator.Embed({0.05, 0.01, z}), locator.Embed({0.09, 0.01, z})}, 10.0});
  }
  return body;
}

TEST(Allocation, CountsEveryKindOfRequest) {
  if (!test_support::HeapRequestsAreCounted()) GTEST_SKIP() << "a sanitizer, or not glibc";
  const size_t before = test_support::HeapRequestCount();
  const auto one = std::make_unique<double>(1.0);
  const Eigen::VectorXd other = Eigen::VectorXd::Zero(1000);
  EXPECT_GE(test_support::HeapRequestCount(), before + 2);
  EXPECT_EQ(*one + other[0], 1.0);
}

TEST(Allocation, NothingIsAllocatedAfterTheFirstFrame) {
  if (!test_support::HeapRequestsAreCounted()) GTEST_SKIP() << "a sanitizer, or not glibc";
  RobotModel model(SoftBox());
  const fem::PointLocator locator(model.body().mesh);
  std::vector<fem::InterpolationWeights> effectors;
  for (int k = 0; k < 51; ++k) {
    effectors.push_back(locator.Embed({0.01 + 0.0015 * k, 0.02, 0.01}).weights);
  }
  Compliance compliance(model.linearisation(), RowsOfPoints(effectors));
  compliance.SetForces(
      {{effectors[40], Eigen::Vector3d::UnitY()}, {effectors[20], Eigen::Vector3d::UnitZ()}});
  Eigen::VectorXd x_m = model.RestState().x_m;
  Eigen::VectorXd force_N = Eigen::VectorXd::Zero(x_m.size());
  model.AddWeight(force_N);
  const Eigen::VectorXd lambda_a = Eigen::Vector2d(0.1, 0.2);
  const Eigen::VectorXd lambda_f = Eigen::Vector2d(0.0, 0.0);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Ones(model.linearisation().Size(), 5);
  Eigen::VectorXd effectors_m, cables_m;
  bool ok = true;
  const auto frame = [&] {
    ok = ok && model.linearisation().Update(x_m, lambda_a, force_N).ok();
    model.linearisation().Solve(columns);
    columns.setOnes();
    compliance.Compute(x_m, model.actuator_rest_m(), lambda_a, lambda_f);
    compliance.EffectorPositions(lambda_a, lambda_f, &effectors_m);
    compliance.CableDisplacements(lambda_a, lambda_f, &cables_m);
    compliance.UpdateConfiguration(lambda_a, lambda_f, 0.5, &x_m);
    ok = ok && model.linearisation().UpdateResidual(x_m, lambda_a, force_N).ok();
  };
  frame();
  const size_t before = test_support::HeapRequestCount();
  for (int k = 0; k < 3; ++k) frame();
  EXPECT_EQ(test_support::HeapRequestCount(), before);
  EXPECT_TRUE(ok);
}

TEST(Allocation, FollowingFramesTakesNoMemory) {
  if (!test_support::HeapRequestsAreCounted()) GTEST_SKIP() << "a sanitizer, or not glibc";
  RobotModel model(SoftBox());
  fem::StaticState state = model.RestState();
  std::vector<ActuatorCommand> cables(2, {ActuatorCommand::Kind::kDisplacement, 1e-3});
  ASSERT_TRUE(model.Solve(cables, {}, &state).status.ok());
  FrameTracker tracker(model, {.relative_tolerance = 1e-8});
  tracker.Start(state);
  Eigen::VectorXd force_N = Eigen::VectorXd::Zero(state.x_m.size());
  for (int k = 0; k < 6; ++k) {
    cables[0].value += 1e-3;
    force_N[force_N.size() - 1] = 0.01 * k;
    const size_t before = test_support::HeapRequestCount();
    // The third frame has no time: it says so, and the next goes on.
    const fem::TimeBudget budget(k == 2 ? 0.0 : 1e9);
    const StatusCode code = tracker.Follow(cables, force_N, budget).status.code();
    const size_t taken = test_support::HeapRequestCount() - before;
    EXPECT_TRUE(k == 0 || taken == 0) << taken << " in frame " << k;
    EXPECT_EQ(code, k == 2 ? StatusCode::kBudgetReached : StatusCode::kOk) << "frame " << k;
  }
}

}  // namespace
}  // namespace palpate::robot
