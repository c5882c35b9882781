// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "libs/fem/constrained_tangent.hpp"
#include "libs/robot/chamber.hpp"
#include "tests/libs/fem/verification/static_problem.hpp"
#include "tests/libs/robot/chambers/hollow_bodies.hpp"

namespace palpate::robot {
namespace {

using fem::ElementType;
using fem::verification::NearestNode;
using fem::verification::Solution;
using fem::verification::Solve;
using fem::verification::StaticProblem;
using Mode = fem::ConstraintCommand::Mode;

constexpr double kModulus_Pa = 100e3;
constexpr double kRatio = 0.3;
constexpr double kPressure_Pa = 1.0;  // strains of 1e-5: small

const fem::Material kLinearWall{.model = fem::MaterialModel::kLinear,
                                .youngs_modulus_Pa = kModulus_Pa,
                                .poissons_ratio = kRatio};

/// Holds a ball against rigid motions where its own motion along the axes stays free.
void HoldOnAxes(double outer_m, StaticProblem* problem) {
  for (int axis = 0; axis < 3; ++axis) {
    const int node = NearestNode(problem->mesh, outer_m * Eigen::Vector3d::Unit(axis));
    problem->fixed((axis + 1) % 3, node) = true;
    problem->fixed((axis + 2) % 3, node) = true;
  }
}

/// A chamber in a problem, under a given pressure.
class Pressurised {
 public:
  Pressurised(fem::MovingSurface wall, double pressure_Pa, StaticProblem* problem)
      : chamber_(std::move(wall), problem->mesh.nodes_m.reshaped()) {
    problem->constraints = {&chamber_};
    problem->commands = {{.mode = Mode::kMultiplier, .value = pressure_Pa * chamber_.area_m2()}};
  }
  const Chamber& chamber() const { return chamber_; }

 private:
  Chamber chamber_;
};

/// Error of the mean radial displacement of the inner wall, over the exact one.
double ErrorAtWall(const Solution& solution, const fem::TetMesh& mesh, int dimensions,
                   double exact_m) {
  double sum_m = 0.0;
  int count = 0;
  for (int node = 0; node < mesh.NodeCount(); ++node) {
    Eigen::Vector3d radial = mesh.nodes_m.col(node);
    if (dimensions == 2) radial.z() = 0.0;
    if (std::abs(radial.norm() - kInner_m) > 1e-9) continue;
    sum_m += solution.Displacement(node).dot(radial.normalized());
    ++count;
  }
  return std::abs(sum_m / count / exact_m - 1.0);
}

double SphereError(ElementType element, int layers, int divisions) {
  StaticProblem problem(SphericalShell(layers, divisions, element), kLinearWall);
  HoldOnAxes(kOuter_m, &problem);
  const Pressurised chamber(CavityWall(problem.mesh), kPressure_Pa, &problem);
  const Solution solution = Solve(problem);
  EXPECT_TRUE(solution.result.status.ok()) << solution.result.status.message();
  const double a3 = std::pow(kInner_m, 3), b3 = std::pow(kOuter_m, 3);
  const double exact_m =
      kPressure_Pa * a3 / (kModulus_Pa * (b3 - a3)) *
      ((1.0 - 2.0 * kRatio) * kInner_m + (1.0 + kRatio) * b3 / (2.0 * kInner_m * kInner_m));
  return ErrorAtWall(solution, problem.mesh, 3, exact_m);
}

/// Lame: u(a) of a thick-walled sphere.
TEST(PressureVessel, SphereOfQuadraticTetsConvergesToLame) {
  const double coarse = SphereError(ElementType::kTet10, 1, 3);
  const double fine = SphereError(ElementType::kTet10, 2, 6);
  EXPECT_LT(fine, 0.002);
  EXPECT_GT(coarse / fine, 6.0) << coarse << " " << fine;
}

TEST(PressureVessel, SphereOfLinearTetsConvergesToLame) {
  const double coarse = SphereError(ElementType::kTet4, 2, 6);
  const double fine = SphereError(ElementType::kTet4, 4, 12);
  EXPECT_LT(fine, 0.03);
  EXPECT_GT(coarse / fine, 2.5) << coarse << " " << fine;
}

double TubeError(ElementType element, int layers, int around) {
  const double length_m = 0.002;
  StaticProblem problem(Tube(length_m, layers, around, element), kLinearWall);
  problem.Fix([](const Eigen::Vector3d&) { return true; }, false, false, true);  // plane strain
  problem.Fix([](const Eigen::Vector3d& p) { return std::abs(p.x()) < 1e-9; }, true, false, false);
  problem.Fix([](const Eigen::Vector3d& p) { return std::abs(p.y()) < 1e-9; }, false, true, false);
  const Pressurised chamber(TubeWall(problem.mesh, length_m), kPressure_Pa, &problem);
  const Solution solution = Solve(problem);
  EXPECT_TRUE(solution.result.status.ok()) << solution.result.status.message();
  const double a2 = kInner_m * kInner_m, b2 = kOuter_m * kOuter_m;
  const double exact_m = kPressure_Pa * a2 * (1.0 + kRatio) / (kModulus_Pa * (b2 - a2)) *
                         ((1.0 - 2.0 * kRatio) * kInner_m + b2 / kInner_m);
  return ErrorAtWall(solution, problem.mesh, 2, exact_m);
}

/// Lame: u(a) of a thick-walled tube that keeps its length.
TEST(PressureVessel, TubeOfQuadraticTetsConvergesToLame) {
  const double coarse = TubeError(ElementType::kTet10, 1, 12);
  const double fine = TubeError(ElementType::kTet10, 2, 24);
  EXPECT_LT(fine, 0.002);
  EXPECT_GT(coarse / fine, 6.0) << coarse << " " << fine;
}

TEST(PressureVessel, TheLidsOfATubeHoldItsVolume) {
  const double length_m = 0.002;
  const fem::TetMesh tube = Tube(length_m, 1, 24, ElementType::kTet10);
  const Chamber chamber(TubeWall(tube, length_m), tube.nodes_m.reshaped());
  const double exact_m3 = std::numbers::pi * kInner_m * kInner_m * length_m;
  EXPECT_NEAR(chamber.Volume_m3(tube.nodes_m.reshaped()), exact_m3, 1e-4 * exact_m3);
}

class NeoHookeanSphere : public testing::Test {
 protected:
  NeoHookeanSphere()
      : problem_(SphericalShell(2, 4, ElementType::kTet10),
                 {.model = fem::MaterialModel::kStableNeoHookean,
                  .volumetric = fem::Volumetric::kMeanDilatation,
                  .youngs_modulus_Pa = kModulus_Pa,
                  .poissons_ratio = 0.499}),
        chamber_(CavityWall(problem_.mesh), problem_.mesh.nodes_m.reshaped()) {
    HoldOnAxes(kOuter_m, &problem_);
    problem_.constraints = {&chamber_};
  }

  /// Incompressible closed form: p = integral over the wall of dW/dlambda / (lambda^3 - 1).
  static double Pressure_Pa(double stretch) {
    const double mu_Pa = kModulus_Pa / 3.0;
    const double outer =
        std::cbrt(1.0 + (std::pow(stretch, 3) - 1.0) * std::pow(kInner_m / kOuter_m, 3));
    const auto branch = [](double lambda) { return 1.0 / lambda + 0.25 / std::pow(lambda, 4); };
    return 2.0 * mu_Pa * (branch(outer) - branch(stretch));
  }

  /// Stretches the inner radius; asks for the pressure that does so.
  double PressureAt(double stretch, fem::StaticSolver* solver, fem::StaticState* state) const {
    const double rest_m = chamber_.rest_value_m();
    fem::LoadState loads = state->loads;
    loads.commands = {{.mode = Mode::kUpperBound,
                       .value = rest_m * std::pow(stretch, 3),
                       .min_multiplier_N = kVacuum_Pa * chamber_.area_m2()}};
    const fem::StaticResult result = solver->Solve(loads, state);
    EXPECT_TRUE(result.status.ok()) << stretch << ": " << result.status.message();
    return state->multipliers_N[0] / chamber_.area_m2();
  }

  /// By how much the thrust falls with each metre of the piston beyond the largest pressure, N/m.
  double Fall_N_m(double stretch) const {
    const double step = 1e-4;
    const double rest_m3 = chamber_.area_m2() * std::abs(chamber_.rest_value_m());
    const double change_Pa = Pressure_Pa(stretch + step) - Pressure_Pa(stretch - step);
    const double change_m3 = rest_m3 * (std::pow(stretch + step, 3) - std::pow(stretch - step, 3));
    return -change_Pa / change_m3 * chamber_.area_m2() * chamber_.area_m2();
  }

  StaticProblem problem_;
  Chamber chamber_;
};

/// Up to a largest pressure, and on under less where the volume is held.
TEST_F(NeoHookeanSphere, BlowsUpThroughItsLimitPointAsTheClosedFormSays) {
  fem::ElasticBody body(problem_.mesh, {problem_.material},
                        std::vector<int>(static_cast<size_t>(problem_.mesh.CellCount()), 0));
  fem::Linearisation linearisation(body, problem_.constraints, problem_.fixed);
  fem::StaticSolver solver(linearisation);
  fem::StaticState state = solver.RestState();
  double largest_Pa = 0.0, last_Pa = 0.0;
  for (const double stretch : {0.95, 1.1, 1.3, 1.5, 1.7, 1.9, 2.1, 2.4}) {
    last_Pa = PressureAt(stretch, &solver, &state);
    largest_Pa = std::max(largest_Pa, last_Pa);
    EXPECT_NEAR(last_Pa, Pressure_Pa(stretch), 0.01 * std::abs(Pressure_Pa(stretch))) << stretch;
  }
  EXPECT_LT(last_Pa, 0.98 * largest_Pa);
}

/// A gas that yields less than the thrust falls with the volume holds the balloon; one that yields
/// more does not: it goes on to blow the balloon up.
TEST_F(NeoHookeanSphere, IsHeldBeyondItsLimitPointByAGasThatYieldsLittle) {
  fem::ElasticBody body(problem_.mesh, {problem_.material},
                        std::vector<int>(static_cast<size_t>(problem_.mesh.CellCount()), 0));
  fem::Linearisation linearisation(body, problem_.constraints, problem_.fixed);
  fem::StaticSolver solver(linearisation);
  fem::StaticState state = solver.RestState();
  for (const double stretch : {1.3, 1.7, 2.1}) PressureAt(stretch, &solver, &state);
  ASSERT_GT(Fall_N_m(2.1), 0.0);
  const auto yielding = [&](double share) {
    fem::LoadState loads = state.loads;
    loads.commands[0].compliance_m_N = share / Fall_N_m(2.1);
    loads.commands[0].value -= loads.commands[0].compliance_m_N * state.multipliers_N[0];
    return loads;
  };
  for (const double share : {0.0, 0.8, 1.2, 10.0}) {
    ASSERT_TRUE(linearisation
                    .Update(state.x_m, state.multipliers_N, state.loads.external_force_N,
                            /*allow_shift=*/true)
                    .ok());
    ASSERT_TRUE(linearisation.shifted());
    EXPECT_EQ(fem::IsStableUnderConstraints(linearisation, yielding(share), state.x_m,
                                            state.multipliers_N),
              share < 1.0)
        << share;
  }
  // A little more gas of the kind that holds.
  fem::LoadState more = yielding(0.5);
  more.commands[0].value += 0.05 * chamber_.rest_value_m();
  const fem::StaticResult result = solver.Solve(more, &state);
  ASSERT_TRUE(result.status.ok()) << result.status.message();
  const double stretch = std::cbrt(chamber_.Value(state.x_m) / chamber_.rest_value_m());
  EXPECT_GT(stretch, 2.1);
  const double pressure_Pa = state.multipliers_N[0] / chamber_.area_m2();
  EXPECT_NEAR(pressure_Pa, Pressure_Pa(stretch), 0.01 * pressure_Pa);
  EXPECT_NEAR(chamber_.Value(state.x_m), more.commands[0].Bound_m(state.multipliers_N[0]), 1e-9);
}

TEST_F(NeoHookeanSphere, HasNoStableBalanceUnderMoreThanItsLargestPressure) {
  fem::ElasticBody body(problem_.mesh, {problem_.material},
                        std::vector<int>(static_cast<size_t>(problem_.mesh.CellCount()), 0));
  fem::Linearisation linearisation(body, problem_.constraints, problem_.fixed);
  fem::StaticSolver solver(linearisation, {.max_load_steps = 8});
  double largest_Pa = 0.0;
  for (double stretch = 1.0; stretch < 3.0; stretch += 0.01) {
    largest_Pa = std::max(largest_Pa, Pressure_Pa(stretch));
  }
  fem::StaticState state = solver.RestState();
  fem::LoadState loads = state.loads;
  loads.commands = {{.mode = Mode::kMultiplier, .value = 1.05 * largest_Pa * chamber_.area_m2()}};
  const fem::StaticResult result = solver.Solve(loads, &state);
  EXPECT_FALSE(result.status.ok());
  EXPECT_LT(result.load_fraction, 0.99);
}

}  // namespace
}  // namespace palpate::robot
