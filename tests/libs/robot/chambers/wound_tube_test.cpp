// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "libs/robot/chamber.hpp"
#include "libs/robot/fibre_paths.hpp"
#include "tests/libs/fem/verification/static_problem.hpp"
#include "tests/libs/robot/chambers/hollow_bodies.hpp"

namespace palpate::robot {
namespace {

using fem::ElementType;
using fem::verification::Solution;
using fem::verification::StaticProblem;

constexpr double kTubeModulus_Pa = 100e3;
constexpr double kTubeRatio = 0.3;
constexpr double kTubePressure_Pa = 1.0;  // strains of 1e-5: small
constexpr double kTubeLength_m = 0.001;
constexpr double kRings_m = 0.5 * (kInner_m + kOuter_m);  ///< radius of the rings

/// Radial displacement of the inner wall of a tube in plane strain that rings of `hoop_N_m` = EA /
/// spacing hold at the radius c. Each layer has Lame's u = A r + B / r. At c the displacement is
/// the same, and the radial stress jumps by the pressure of the rings, hoop_N_m u / c^2.
double ExactAtWall_m(double hoop_N_m) {
  const double mu_Pa = kTubeModulus_Pa / (2.0 * (1.0 + kTubeRatio));
  const double lambda_Pa = 2.0 * mu_Pa * kTubeRatio / (1.0 - 2.0 * kTubeRatio);
  const double a = kInner_m, b = kOuter_m, c = kRings_m;
  const auto stress = [&](double r) {  // of A and of B
    return Eigen::RowVector2d(2.0 * (lambda_Pa + mu_Pa), -2.0 * mu_Pa / (r * r));
  };
  const Eigen::RowVector2d u_c(c, 1.0 / c);
  Eigen::Matrix4d M = Eigen::Matrix4d::Zero();
  M.block<1, 2>(0, 0) = stress(a);
  M.block<1, 2>(1, 2) = stress(b);
  M.row(2) << u_c, -u_c;
  M.row(3) << -stress(c) - hoop_N_m / (c * c) * u_c, stress(c);
  const Eigen::Vector4d AB =
      Eigen::PartialPivLU<Eigen::Matrix4d>(M).solve(Eigen::Vector4d(-kTubePressure_Pa, 0, 0, 0));
  return AB[0] * a + AB[1] / a;
}

double AtWall_m(ElementType element, int layers, int around, double hoop_N_m) {
  StaticProblem problem(Tube(kTubeLength_m, layers, around, element),
                        {.model = fem::MaterialModel::kLinear,
                         .youngs_modulus_Pa = kTubeModulus_Pa,
                         .poissons_ratio = kTubeRatio});
  problem.Fix([](const Eigen::Vector3d&) { return true; }, false, false, true);  // plane strain
  problem.Fix([](const Eigen::Vector3d& p) { return std::abs(p.x()) < 1e-9; }, true, false, false);
  problem.Fix([](const Eigen::Vector3d& p) { return std::abs(p.y()) < 1e-9; }, false, true, false);
  Chamber chamber(TubeWall(problem.mesh, kTubeLength_m), problem.mesh.nodes_m.reshaped());
  problem.constraints = {&chamber};
  problem.commands = {{.mode = fem::ConstraintCommand::Mode::kMultiplier,
                       .value = kTubePressure_Pa * chamber.area_m2()}};
  if (hoop_N_m > 0.0) {
    FibreSettings rings;
    rings.winding = Winding{};
    rings.winding->kind = Winding::Kind::kRings;
    // So close that they hold the strip of elements as one sleeve does.
    rings.winding->spacing_m = 0.1 * kTubeLength_m;
    rings.winding->axis_m << 0.0, 0.0, 0.0, 0.0, 0.05 * kTubeLength_m, kTubeLength_m;
    rings.winding->radius_m = kRings_m;
    rings.axial_stiffness_N = hoop_N_m * rings.winding->spacing_m;
    problem.fibres = {LayFibre(rings, fem::PointLocator(problem.mesh), 0.0).embedded};
  }
  const Solution solution = fem::verification::Solve(problem);
  EXPECT_TRUE(solution.result.status.ok()) << solution.result.status.message();
  double sum_m = 0.0;
  int count = 0;
  for (int node = 0; node < problem.mesh.NodeCount(); ++node) {
    const Eigen::Vector2d radial_m = problem.mesh.nodes_m.col(node).head<2>();
    if (std::abs(radial_m.norm() - kInner_m) > 1e-9) continue;
    sum_m += solution.Displacement(node).head<2>().dot(radial_m.normalized());
    ++count;
  }
  return sum_m / count;
}

/// Rings of half the hoop stiffness of the wall, and of ten times that. The error is of the mesh.
TEST(WoundTube, RingsHoldItAsLamesSolutionWithAStiffCircleSays) {
  const double wall_N_m = kTubeModulus_Pa * (kOuter_m - kInner_m);
  for (const double hoop_N_m : {0.5 * wall_N_m, 5.0 * wall_N_m}) {
    const double exact_m = ExactAtWall_m(hoop_N_m);
    ASSERT_LT(exact_m, 0.8 * ExactAtWall_m(0.0));
    const double coarse_m = AtWall_m(ElementType::kTet10, 2, 12, hoop_N_m);
    const double fine_m = AtWall_m(ElementType::kTet10, 4, 24, hoop_N_m);
    EXPECT_NEAR(fine_m / exact_m, 1.0, 0.005) << hoop_N_m;
    EXPECT_LT(std::abs(fine_m - exact_m), 0.5 * std::abs(coarse_m - exact_m)) << hoop_N_m;
  }
}

TEST(WoundTube, WithoutRingsItIsLames) {
  EXPECT_NEAR(AtWall_m(ElementType::kTet10, 2, 24, 0.0) / ExactAtWall_m(0.0), 1.0, 0.002);
}

}  // namespace
}  // namespace palpate::robot
