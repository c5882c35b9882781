// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/static_solver.hpp"

#include <gtest/gtest.h>

#include "tests/libs/fem/core/laws.hpp"
#include "tests/libs/fem/points/meshes.hpp"

namespace palpate::fem {
namespace {

using laws::Law;

/// A bar of 60 x 10 x 10 mm along x, held at x = 0.
struct Bar {
  explicit Bar(const Law& law, const StaticSettings& settings = {}, bool hold_far_end = false)
      : mesh(Mesh(law.element)),
        body(mesh, {{law.model, law.volumetric, 100e3, 0.4}},
             std::vector<int>(static_cast<size_t>(mesh.CellCount()), 0)),
        linearisation(body, {}, Held(mesh, hold_far_end)),
        solver(linearisation, settings),
        state(solver.RestState()),
        target(state.loads) {}

  static TetMesh Mesh(ElementType element) {
    const TetMesh box = BoxMesh({0.06, 0.01, 0.01}, {6, 1, 1});
    return element == ElementType::kTet4 ? box : MakeQuadratic(box);
  }
  static FixedDirections Held(const TetMesh& mesh, bool far_end) {
    FixedDirections fixed = FixedDirections::Constant(3, mesh.NodeCount(), false);
    for (int n = 0; n < mesh.NodeCount(); ++n) {
      const double x = mesh.nodes_m(0, n);
      if (x < 1e-9 || (far_end && x > 0.06 - 1e-9)) fixed.col(n).setConstant(true);
    }
    return fixed;
  }
  /// A dead load shared by the nodes of the far end.
  void PullTip(const Eigen::Vector3d& force_N) {
    std::vector<int> tip;
    for (int n = 0; n < mesh.NodeCount(); ++n) {
      if (mesh.nodes_m(0, n) > 0.06 - 1e-9) tip.push_back(n);
    }
    for (const int n : tip) {
      target.external_force_N.segment<3>(3 * n) = force_N / static_cast<double>(tip.size());
    }
  }
  /// Prescribes a rotation of the far end about the bar's axis.
  void TwistTip(double angle_rad) {
    const Eigen::Vector3d middle(0.0, 0.005, 0.005);
    const Eigen::Matrix3d R = laws::Rotation(angle_rad, Eigen::Vector3d::UnitX());
    for (int n = 0; n < mesh.NodeCount(); ++n) {
      if (mesh.nodes_m(0, n) < 0.06 - 1e-9) continue;
      target.fixed_position_m.segment<3>(3 * n) = R * (mesh.nodes_m.col(n) - middle) + middle;
    }
  }
  Eigen::Vector3d Reaction_N() {
    EXPECT_TRUE(
        linearisation.UpdateResidual(state.x_m, state.multipliers_N, state.loads.external_force_N)
            .ok());
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int n = 0; n < mesh.NodeCount(); ++n) {
      if (mesh.nodes_m(0, n) < 1e-9) sum -= linearisation.nodal_residual_N().segment<3>(3 * n);
    }
    return sum;
  }

  TetMesh mesh;
  ElasticBody body;
  Linearisation linearisation;
  StaticSolver solver;
  StaticState state;
  LoadState target;
};

class StaticSolverLaw : public ::testing::TestWithParam<Law> {};

TEST_P(StaticSolverLaw, BalancesADeadLoadWithTheReaction) {
  Bar bar(GetParam());
  const Eigen::Vector3d force_N(0.02, 0.0, -0.05);
  bar.PullTip(force_N);
  const StaticResult result = bar.solver.Solve(bar.target, &bar.state);
  ASSERT_TRUE(result.status.ok()) << result.status.message();
  EXPECT_EQ(result.load_fraction, 1.0);
  EXPECT_LE(result.residual_relative, 1e-10);
  EXPECT_GT(result.iterations, 0);
  EXPECT_LE((bar.Reaction_N() + force_N).norm(), 1e-9);
  EXPECT_LT(bar.state.x_m.reshaped(3, bar.mesh.NodeCount()).row(2).minCoeff(), -0.005);
}

TEST_P(StaticSolverLaw, PrescribedAffineBoundaryGivesAnAffineBody) {
  // A crooked box with inner nodes, its surface moved by 10 % strains.
  const TetMesh straight = BoxMesh({0.03, 0.03, 0.03}, {3, 3, 3});
  TetMesh corners = straight;
  std::mt19937 engine(1);
  for (int n = 0; n < corners.NodeCount(); ++n) {
    const Eigen::Array3d p = straight.nodes_m.col(n);
    const bool inside = (p > 1e-9).all() && (p < 0.03 - 1e-9).all();
    if (inside) corners.nodes_m.col(n) += laws::RandomVector(3, 0.002, &engine);
  }
  const TetMesh mesh = GetParam().element == ElementType::kTet4 ? corners : MakeQuadratic(corners);
  FixedDirections fixed = FixedDirections::Constant(3, mesh.NodeCount(), false);
  for (int n = 0; n < mesh.NodeCount(); ++n) {
    const Eigen::Array3d p = mesh.nodes_m.col(n);
    if ((p < 1e-9).any() || (p > 0.03 - 1e-9).any()) fixed.col(n).setConstant(true);
  }
  ASSERT_LT(fixed.count(), fixed.size());
  ElasticBody body(mesh, {{GetParam().model, GetParam().volumetric, 180e3, 0.45}},
                   std::vector<int>(static_cast<size_t>(mesh.CellCount()), 0));
  Linearisation linearisation(body, {}, fixed);
  StaticSettings settings;
  settings.relative_tolerance = 1e-14;
  StaticSolver solver(linearisation, settings);
  StaticState state = solver.RestState();
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F += 0.1 * (Eigen::Matrix3d() << 1.0, 0.5, -0.3, 0.2, -1.0, 0.4, -0.6, 0.1, 0.7).finished();
  LoadState target = state.loads;
  target.fixed_position_m = (F * mesh.nodes_m).reshaped();
  const StaticResult result = solver.Solve(target, &state);
  ASSERT_TRUE(result.status.ok()) << result.status.message();
  EXPECT_LE((state.x_m - target.fixed_position_m).cwiseAbs().maxCoeff(), 1e-15);  // m
}

INSTANTIATE_TEST_SUITE_P(AllLaws, StaticSolverLaw, ::testing::ValuesIn(laws::AllLaws()),
                         [](const auto& law_info) { return laws::Name(law_info.param); });

constexpr Law kStable{MaterialModel::kStableNeoHookean, Volumetric::kPointwise,
                      ElementType::kTet10};

TEST(StaticSolver, EndsInTheSameBalanceWithTangentsThatAreKept) {
  StaticSettings keeping;
  keeping.keep_tangent_below = 0.2;
  Bar bar(kStable, {});
  Bar kept(kStable, keeping);
  for (const double pull_N : {-0.05, -0.12, 0.03}) {
    bar.PullTip({0.0, 0.02, pull_N});
    kept.PullTip({0.0, 0.02, pull_N});
    const StaticResult result = bar.solver.Solve(bar.target, &bar.state);
    const StaticResult with_kept = kept.solver.Solve(kept.target, &kept.state);
    ASSERT_TRUE(result.status.ok()) << result.status.message();
    ASSERT_TRUE(with_kept.status.ok()) << with_kept.status.message();
    EXPECT_LT((bar.state.x_m - kept.state.x_m).cwiseAbs().maxCoeff(), 1e-9) << pull_N << " N";
    // Chords converge linearly: no fewer steps, but most without a factorisation.
    EXPECT_GE(with_kept.iterations, result.iterations);
  }
  EXPECT_LT(kept.linearisation.factor_count(), bar.linearisation.factor_count());
}

TEST(StaticSolver, KeepsATangentForTheNextBalanceNearby) {
  StaticSettings keeping;
  keeping.keep_tangent_below = 0.2;
  Bar bar(kStable, keeping);
  bar.PullTip({0.0, 0.02, -0.05});
  ASSERT_TRUE(bar.solver.Solve(bar.target, &bar.state).status.ok());
  const int factors = bar.linearisation.factor_count();
  bar.PullTip({0.0, 0.02, -0.0500005});
  const StaticResult near = bar.solver.Solve(bar.target, &bar.state);
  ASSERT_TRUE(near.status.ok()) << near.status.message();
  EXPECT_LE(near.residual_relative, StaticSettings{}.relative_tolerance);
  EXPECT_EQ(bar.linearisation.factor_count(), factors);
  // A factor that somebody else made in between is not taken for its own.
  ASSERT_TRUE(
      bar.linearisation
          .Update(bar.body.rest_m(), bar.state.multipliers_N, bar.state.loads.external_force_N)
          .ok());
  bar.PullTip({0.0, 0.02, -0.050001});
  ASSERT_TRUE(bar.solver.Solve(bar.target, &bar.state).status.ok());
  EXPECT_EQ(bar.linearisation.factor_count(), factors + 2);
}

TEST(StaticSolver, NeedsNoTangentWhereTheBodyIsBalanced) {
  StaticSettings keeping;
  keeping.keep_tangent_below = 0.2;
  Bar bar(kStable, keeping);
  bar.PullTip({0.0, 0.02, -0.05});
  ASSERT_TRUE(bar.solver.Solve(bar.target, &bar.state).status.ok());
  const Eigen::VectorXd balanced_m = bar.state.x_m;
  ASSERT_TRUE(
      bar.linearisation
          .Update(bar.body.rest_m(), bar.state.multipliers_N, bar.state.loads.external_force_N)
          .ok());
  const int factors = bar.linearisation.factor_count();
  const StaticResult again = bar.solver.Solve(bar.target, &bar.state);
  ASSERT_TRUE(again.status.ok()) << again.status.message();
  EXPECT_EQ(bar.state.x_m, balanced_m);
  EXPECT_EQ(bar.linearisation.factor_count(), factors);
}

TEST(StaticSolver, SaysThatItDidNotConverge) {
  StaticSettings one_step;
  one_step.max_newton_iterations = 1;
  one_step.max_full_steps = 1;
  Bar bar(kStable, one_step);
  bar.PullTip({0.0, 0.0, -0.3});
  const StaticResult result = bar.solver.Solve(bar.target, &bar.state);
  EXPECT_EQ(result.status.code(), StatusCode::kNotConverged);
  EXPECT_LT(result.load_fraction, 1.0);
  EXPECT_GT(result.residual_relative, 1e-10);
}

TEST(StaticSolver, SaysThatItsLoadStepsAreUsedUp) {
  // Twisted in one go the last elements turn inside out; in halves they do not.
  StaticSettings settings;
  settings.max_load_steps = 2;
  Bar bar(kStable, settings, /*hold_far_end=*/true);
  bar.TwistTip(3.0);
  const StaticResult result = bar.solver.Solve(bar.target, &bar.state);
  EXPECT_EQ(result.load_steps, 1);
  EXPECT_EQ(result.status.code(), StatusCode::kNotConverged);
  EXPECT_LT(result.load_fraction, 1.0);
  EXPECT_GT(result.load_fraction, 0.0);
}

TEST(StaticSolver, ReachesInLoadStepsWhatOneStepCannot) {
  Bar bar(kStable, {}, /*hold_far_end=*/true);
  bar.TwistTip(3.0);
  const StaticResult result = bar.solver.Solve(bar.target, &bar.state);
  ASSERT_TRUE(result.status.ok()) << result.status.message();
  EXPECT_GT(result.load_steps, 1);
  EXPECT_EQ(result.load_fraction, 1.0);
  EXPECT_GT(bar.linearisation.min_J(), 0.0);
}

TEST(StaticSolver, StopsWhereItsTimeIsUsedUp) {
  double now_s = 0.0;
  Bar bar(kStable, {}, /*hold_far_end=*/true);
  bar.TwistTip(3.0);
  const Eigen::VectorXd before = bar.state.x_m;
  const TimeBudget budget(0.0035, [&now_s] { return now_s += 0.001; });
  const StaticResult result = bar.solver.Solve(bar.target, &bar.state, budget);
  EXPECT_EQ(result.status.code(), StatusCode::kBudgetReached);
  EXPECT_EQ(result.iterations, 3);
  EXPECT_EQ(bar.state.x_m, before);
}

TEST(StaticSolver, TellsItsObserverHowFarItIsAndStopsWhereItSays) {
  Bar bar(kStable, {}, /*hold_far_end=*/true);
  bar.TwistTip(3.0);
  const Eigen::VectorXd before = bar.state.x_m;
  std::vector<int> iterations;
  bar.solver.SetObserver([&](const StaticResult& so_far) {
    iterations.push_back(so_far.iterations);
    return so_far.iterations < 2;
  });
  const StaticResult stopped = bar.solver.Solve(bar.target, &bar.state);
  EXPECT_EQ(stopped.status.code(), StatusCode::kBudgetReached);
  EXPECT_EQ(iterations, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(bar.state.x_m, before);
  double largest_fraction = 0.0;
  bar.solver.SetObserver([&](const StaticResult& so_far) {
    largest_fraction = std::max(largest_fraction, so_far.load_fraction);
    return true;
  });
  EXPECT_TRUE(bar.solver.Solve(bar.target, &bar.state).status.ok());
  EXPECT_GT(largest_fraction, 0.0);  // it takes several load steps
  EXPECT_LT(largest_fraction, 1.0);
}

TEST(StaticSolver, AFailureLeavesTheLastBalance) {
  Bar bar(kStable, {}, /*hold_far_end=*/true);
  for (int n = 0; n < bar.mesh.NodeCount(); ++n) {  // the ends would change places
    if (bar.mesh.nodes_m(0, n) > 0.06 - 1e-9) bar.target.fixed_position_m[3 * n] -= 0.12;
  }
  const StaticResult result = bar.solver.Solve(bar.target, &bar.state);
  EXPECT_FALSE(result.status.ok());
  EXPECT_LT(result.load_fraction, 1.0);
  const Status balance = bar.linearisation.UpdateResidual(bar.state.x_m, bar.state.multipliers_N,
                                                          bar.state.loads.external_force_N);
  EXPECT_TRUE(balance.ok());
  EXPECT_LE(bar.linearisation.residual_N().norm(),
            1e-9 * bar.linearisation.internal_force_norm_N());
}

TEST(StaticSolver, RefusesALoadThatIsNotANumber) {
  Bar bar(kStable);
  bar.target.external_force_N[bar.target.external_force_N.size() - 1] = std::nan("");
  const Eigen::VectorXd before = bar.state.x_m;
  EXPECT_EQ(bar.solver.Solve(bar.target, &bar.state).status.code(), StatusCode::kInvalidInput);
  EXPECT_EQ(bar.state.x_m, before);
}

}  // namespace
}  // namespace palpate::fem
