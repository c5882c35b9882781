// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "tests/libs/fem/verification/calculix.hpp"
#include "tests/libs/fem/verification/static_problem.hpp"

namespace palpate::fem::verification {
namespace {

const Eigen::Vector3d kSize_m(0.1, 0.02, 0.02);

/// 100 x 20 x 20 mm, E = 180 kPa, nu = 0.45, clamped at x = 0, 800 mN downwards spread over the tip
/// face, four bricks per thickness.
StaticProblem MakeCalculixBeam(const TetMesh& mesh) {
  StaticProblem beam(mesh, {.model = MaterialModel::kStableNeoHookean,
                            .youngs_modulus_Pa = 180e3,
                            .poissons_ratio = 0.45});
  beam.Fix([](const Eigen::Vector3d& p) { return p[0] < 1e-9; });
  beam.AddTraction([](const Eigen::Vector3d& p) { return p[0] > kSize_m[0] - 1e-9; },
                   [](const Eigen::Vector3d&) {
                     return Eigen::Vector3d(0.0, 0.0, -0.8 / (kSize_m[1] * kSize_m[2]));
                   });
  return beam;
}

StaticProblem QuadraticBeam() {
  return MakeCalculixBeam(MakeBox({20, 4, 4}, ElementType::kTet10, kSize_m));
}

StaticProblem LinearBeam() {
  return MakeCalculixBeam(MakeBox({16, 4, 4}, ElementType::kTet4, kSize_m, Cut::kSix));
}

/// How far the middle of the tip face moves: along the beam, and downwards, mm.
Eigen::Vector2d Tip_mm(const StaticProblem& beam, const Eigen::VectorXd& u_m) {
  const int node = NearestNode(beam.mesh, {kSize_m[0], kSize_m[1] / 2.0, kSize_m[2] / 2.0});
  return 1e3 * Eigen::Vector2d(u_m[3 * node], -u_m[3 * node + 2]);
}

/// Both programs on the same nodes and cells, under the same nodal forces. Their neo-Hookean
/// materials are the same in small strains and part where the beam bends most; StVK instead of
/// either moves the tip by 1.2 mm.
void ExpectSameAsCalculix(const StaticProblem& beam, double tolerance_mm) {
  const auto ccx = FindCalculix();
  if (!ccx) GTEST_SKIP() << "ccx (CalculiX, package calculix-ccx) is not installed";
  const Solution ours = Solve(beam);
  ASSERT_TRUE(ours.result.status.ok()) << ours.result.status.message();
  const Eigen::VectorXd theirs_m = SolveWithCalculix(*ccx, beam);
  EXPECT_LT((Tip_mm(beam, ours.u_m) - Tip_mm(beam, theirs_m)).norm(), tolerance_mm)
      << "ours " << Tip_mm(beam, ours.u_m).transpose() << " CalculiX "
      << Tip_mm(beam, theirs_m).transpose();
}

TEST(CalculixBeam, QuadraticTetsBendAsC3D10) { ExpectSameAsCalculix(QuadraticBeam(), 0.12); }

TEST(CalculixBeam, LinearTetsBendAsC3D4) { ExpectSameAsCalculix(LinearBeam(), 0.12); }

TEST(CalculixBeam, QuadraticTetsReachThePublishedTip) {
  const StaticProblem beam = QuadraticBeam();
  const Solution solution = Solve(beam);
  ASSERT_TRUE(solution.result.status.ok()) << solution.result.status.message();
  const Eigen::Vector2d tip_mm = Tip_mm(beam, solution.u_m);
  EXPECT_NEAR(tip_mm[0], -27.997, 0.15);
  EXPECT_NEAR(tip_mm[1], 64.830, 0.15);
}

/// A locked element's answer depends on how bricks are cut: five tets each give (-24.1, 60.5) mm,
/// six around one diagonal (-17.0, 52.2) mm.
TEST(CalculixBeam, LinearTetsLockByTheKnownAmount) {
  const StaticProblem beam = LinearBeam();
  const Solution solution = Solve(beam);
  ASSERT_TRUE(solution.result.status.ok()) << solution.result.status.message();
  const Eigen::Vector2d tip_mm = Tip_mm(beam, solution.u_m);
  EXPECT_NEAR(tip_mm[0], -15.695, 0.4);
  EXPECT_NEAR(tip_mm[1], 50.493, 0.4);
}

}  // namespace
}  // namespace palpate::fem::verification
