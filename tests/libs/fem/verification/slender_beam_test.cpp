// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/libs/fem/verification/section_turn.hpp"
#include "tests/libs/fem/verification/static_problem.hpp"

namespace palpate::fem::verification {
namespace {

constexpr double kLength_m = 1.0;
constexpr double kThickness_m = 0.01;
constexpr double kBeamModulus_Pa = 1e6;
constexpr double kBending_N_m2 =
    kBeamModulus_Pa * kThickness_m * kThickness_m * kThickness_m * kThickness_m / 12.0;
constexpr int kBeamCells = 80;

/// A slender square beam along x, clamped at x = 0; nu = 0, so that sections keep their shape, as
/// the theory of the elastica has it.
StaticProblem MakeSlenderBeam(MaterialModel model) {
  StaticProblem beam(
      MakeBox({kBeamCells, 1, 1}, ElementType::kTet10, {kLength_m, kThickness_m, kThickness_m}),
      {.model = model, .youngs_modulus_Pa = kBeamModulus_Pa, .poissons_ratio = 0.0});
  beam.Fix([](const Eigen::Vector3d& p) { return p[0] < 1e-9; });
  return beam;
}

/// How far the middle of the end face moves, over the length.
Eigen::Vector3d Tip(const StaticProblem& beam, const Solution& solution) {
  const int node = NearestNode(beam.mesh, {kLength_m, kThickness_m / 2.0, kThickness_m / 2.0});
  return solution.Displacement(node) / kLength_m;
}

struct ElasticaPoint {
  double load;        ///< P L^2 / (E I)
  double deflection;  ///< v / L
  double shortening;  ///< (L - x) / L
};

class Elastica : public testing::TestWithParam<ElasticaPoint> {};

/// Deflections of the elastica: elliptic integrals (Bisshopp & Drucker 1945; Mattiasson 1981).
/// Stretch and shear of the solid add less than 3e-4.
TEST_P(Elastica, TipFollowsUnderDeadLoad) {
  for (MaterialModel model : {MaterialModel::kCorotational, MaterialModel::kStableNeoHookean}) {
    StaticProblem beam = MakeSlenderBeam(model);
    const double force_N = GetParam().load * kBending_N_m2 / (kLength_m * kLength_m);
    beam.AddTraction([](const Eigen::Vector3d& p) { return p[0] > kLength_m - 1e-9; },
                     [&](const Eigen::Vector3d&) {
                       return Eigen::Vector3d(0.0, 0.0, -force_N / (kThickness_m * kThickness_m));
                     });
    const Solution solution = SolveInSteps(beam, 8);
    ASSERT_TRUE(solution.result.status.ok()) << solution.result.status.message();
    const Eigen::Vector3d tip = Tip(beam, solution);
    EXPECT_NEAR(-tip[2], GetParam().deflection, 1e-3) << ToString(model);
    EXPECT_NEAR(-tip[0], GetParam().shortening, 1e-3) << ToString(model);
    EXPECT_NEAR(tip[1], 0.0, 1e-6) << ToString(model);
  }
}

INSTANTIATE_TEST_SUITE_P(Loads, Elastica,
                         testing::Values(ElasticaPoint{1.0, 0.30172, 0.05643},
                                         ElasticaPoint{2.0, 0.49346, 0.16064},
                                         ElasticaPoint{5.0, 0.71379, 0.38763},
                                         ElasticaPoint{10.0, 0.81061, 0.55500}));

/// The tip under an end moment M = turn E I / L: the beam becomes an arc of that angle.
void ExpectRollsUpTo(double turn, const Eigen::Vector3d& tip_over_length) {
  StaticProblem beam = MakeSlenderBeam(MaterialModel::kCorotational);
  beam.Fix([](const Eigen::Vector3d&) { return true; }, false, true, false);  // bends in its plane
  std::vector<double> stations_m;
  for (int k = 0; k <= 16; ++k) stations_m.push_back(kLength_m * k / 16.0);
  SectionTurn end(beam.mesh, stations_m);
  beam.constraints = {&end};
  beam.commands = {
      {.mode = ConstraintCommand::Mode::kMultiplier, .value = turn * kBending_N_m2 / kLength_m}};
  const Solution solution = SolveInSteps(beam, 24);
  ASSERT_TRUE(solution.result.status.ok()) << solution.result.status.message();
  const Eigen::Vector3d tip = Tip(beam, solution) + Eigen::Vector3d::UnitX();
  EXPECT_NEAR(-end.Value(solution.x_m), turn, 1.5e-3 * turn);
  EXPECT_LT((tip - tip_over_length).norm(), 1e-3) << tip.transpose();
}

TEST(RollUp, EndMomentOfHalfATurnMakesHalfACircle) {
  ExpectRollsUpTo(std::numbers::pi, {0.0, 0.0, -2.0 / std::numbers::pi});
}

TEST(RollUp, EndMomentOfAFullTurnClosesTheCircle) {
  ExpectRollsUpTo(2.0 * std::numbers::pi, Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace palpate::fem::verification
