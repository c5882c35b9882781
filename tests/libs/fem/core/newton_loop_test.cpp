// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/newton_loop.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace palpate::fem {
namespace {

/// One unknown x with f(x) = 0 to be found; writes down what the loop asks of it.
class Scalar final : public NewtonProblem {
 public:
  Scalar(double start, std::function<double(double)> f, std::function<double(double)> slope)
      : x(start), f_(std::move(f)), slope_(std::move(slope)) {}

  Status PrepareExactStep() override {
    calls += 'E';
    if (exact_fails) return {StatusCode::kNotPositiveDefinite, {}};
    tangent_ = slope_(x);
    step_ = -f_(x) / tangent_;
    return Status::Ok();
  }
  Status PrepareChordStep() override {
    calls += 'C';
    step_ = -f_(x) / tangent_;
    return Status::Ok();
  }
  Status PrepareFrozenFactorStep() override {
    calls += 'K';
    if (kept_slope == 0.0) return {};
    tangent_ = kept_slope;
    step_ = -f_(x) / tangent_;
    return Status::Ok();
  }
  bool StepWasCut() const override { return cut; }
  double StartError() const override { return std::abs(f_(x)); }
  Status Try(double length, bool last) override {
    told_last.push_back(last);
    trial_ = x + length * step_;
    if (trial_ > inverted_above) return {StatusCode::kInverted, {}};
    lengths.push_back(length);
    return Status::Ok();
  }
  double TrialError() const override { return std::abs(f_(trial_)); }
  void AcceptTrial() override {
    x = trial_;
    step_ = -f_(x) / tangent_;
  }

  double x;
  std::string calls;
  std::vector<double> lengths;  ///< of the steps that inverted nothing
  std::vector<bool> told_last;
  bool exact_fails = false;
  bool cut = false;
  double kept_slope = 0.0;  ///< of an earlier frame; 0: there is none
  double inverted_above = std::numeric_limits<double>::infinity();

 private:
  std::function<double(double)> f_, slope_;
  double tangent_ = 0.0, step_ = 0.0, trial_ = 0.0;
};

Scalar SquareRootOfTwo(double start) {
  return Scalar(
      start, [](double x) { return x * x - 2.0; }, [](double x) { return 2.0 * x; });
}

TEST(NewtonLoop, EndsAfterOneExactStepWhereThatIsEnough) {
  Scalar line(
      5.0, [](double x) { return 3.0 * x; }, [](double) { return 3.0; });
  const FrameOutcome outcome = SolveNewton(line, {}, TimeBudget());
  EXPECT_TRUE(outcome.converged());
  EXPECT_EQ(line.calls, "E");
  EXPECT_EQ(outcome.exact_steps, 1);
  EXPECT_EQ(outcome.chord_steps, 0);
  EXPECT_EQ(line.x, 0.0);
}

TEST(NewtonLoop, ConvergesWithChordStepsBetweenTheExactOnes) {
  Scalar root = SquareRootOfTwo(1.5);
  const FrameOutcome outcome = SolveNewton(root, {.relative_tolerance = 1e-12}, TimeBudget());
  EXPECT_TRUE(outcome.converged());
  EXPECT_NEAR(root.x, std::sqrt(2.0), 1e-12);
  EXPECT_EQ(outcome.exact_steps, 2);
  EXPECT_GE(outcome.chord_steps, 1);
  EXPECT_LE(outcome.error, 1e-12);
}

TEST(NewtonLoop, DropsAChordStepThatGainsTooLittle) {
  // From far away the old slope is several times too steep: the chord step gains a tenth.
  Scalar root = SquareRootOfTwo(20.0);
  const FrameOutcome outcome =
      SolveNewton(root, {.relative_tolerance = 1e-12, .max_exact_steps = 1}, TimeBudget());
  EXPECT_EQ(root.calls, "EC");
  EXPECT_EQ(outcome.chord_steps, 0);
  const double after_one_step = 20.0 - (400.0 - 2.0) / 40.0;
  EXPECT_EQ(root.x, after_one_step);
  EXPECT_EQ(outcome.error, after_one_step * after_one_step - 2.0);
}

TEST(NewtonLoop, SaysThatItsStepsAreUsedUp) {
  Scalar root = SquareRootOfTwo(20.0);
  const FrameOutcome outcome =
      SolveNewton(root, {.relative_tolerance = 1e-12, .max_exact_steps = 2}, TimeBudget());
  EXPECT_EQ(outcome.status.code(), StatusCode::kBudgetReached);
  EXPECT_EQ(outcome.status.message(), "steps used up");
  EXPECT_FALSE(outcome.converged());
  EXPECT_FALSE(outcome.diverged());
  EXPECT_EQ(outcome.exact_steps, 2);
  EXPECT_GT(outcome.error, 1e-12);
}

TEST(NewtonLoop, StopsBeforeAStepThatWouldOverrunTheTime) {
  double now_s = 0.0;
  Scalar root = SquareRootOfTwo(20.0);
  // Each look at the clock takes a millisecond: a step takes two or three.
  const TimeBudget budget(0.007, [&now_s] { return now_s += 0.001; });
  const FrameOutcome outcome = SolveNewton(root, {.relative_tolerance = 1e-12}, budget);
  EXPECT_EQ(outcome.status.code(), StatusCode::kBudgetReached);
  EXPECT_EQ(outcome.status.message(), "time used up");
  EXPECT_LT(now_s, 0.0095);
  EXPECT_GE(outcome.exact_steps, 1);
  EXPECT_LT(outcome.exact_steps, 4);
}

TEST(NewtonLoop, MakesOneExactStepHoweverLittleTimeThereIs) {
  Scalar root = SquareRootOfTwo(1.5);
  const FrameOutcome outcome = SolveNewton(root, {}, TimeBudget(0.0));
  EXPECT_EQ(outcome.status.code(), StatusCode::kBudgetReached);
  EXPECT_EQ(root.calls, "E");
  EXPECT_EQ(root.told_last, std::vector<bool>{true});
  EXPECT_LT(std::abs(root.x - std::sqrt(2.0)), 0.01);
}

TEST(NewtonLoop, SaysThatMoreStepsMayFollowAsLongAsThereIsTime) {
  Scalar root = SquareRootOfTwo(1.5);
  ASSERT_TRUE(SolveNewton(root, {}, TimeBudget()).converged());
  ASSERT_GE(root.told_last.size(), 2U);
  for (const bool last : root.told_last) EXPECT_FALSE(last);
}

TEST(NewtonLoop, ConvergedIsConvergedAlsoWhenTheTimeIsUp) {
  Scalar line(
      5.0, [](double x) { return 3.0 * x; }, [](double) { return 3.0; });
  EXPECT_TRUE(SolveNewton(line, {}, TimeBudget(0.0)).converged());
}

TEST(NewtonLoop, HalvesAStepThatWouldInvertAnElement) {
  Scalar root = SquareRootOfTwo(0.5);  // the first step leads to 2.25
  root.inverted_above = 1.0;
  const FrameOutcome outcome = SolveNewton(root, {.max_exact_steps = 1}, TimeBudget(0.0));
  ASSERT_EQ(root.lengths.size(), 1U);
  EXPECT_EQ(root.lengths[0], 0.25);
  EXPECT_EQ(outcome.exact_steps, 1);
}

TEST(NewtonLoop, GivesUpWhereEvenAShortStepInverts) {
  Scalar root = SquareRootOfTwo(0.5);
  root.inverted_above = 0.5;
  const FrameOutcome outcome = SolveNewton(root, {}, TimeBudget());
  EXPECT_TRUE(outcome.diverged());
  EXPECT_EQ(outcome.status.code(), StatusCode::kInverted);
  EXPECT_EQ(root.x, 0.5);
}

TEST(NewtonLoop, SaysWhyThereIsNoStep) {
  Scalar root = SquareRootOfTwo(1.5);
  root.exact_fails = true;
  const FrameOutcome outcome = SolveNewton(root, {}, TimeBudget());
  EXPECT_TRUE(outcome.diverged());
  EXPECT_EQ(outcome.status.code(), StatusCode::kNotPositiveDefinite);
}

TEST(NewtonLoop, GivesUpWhereTheErrorDoesNotFall) {
  // Newton's method walks between 0 and 1 for ever.
  Scalar cycle(
      0.0, [](double x) { return x * x * x - 2.0 * x + 2.0; },
      [](double x) { return 3.0 * x * x - 2.0; });
  const FrameOutcome outcome = SolveNewton(cycle, {}, TimeBudget());
  EXPECT_TRUE(outcome.diverged());
  EXPECT_EQ(outcome.status.code(), StatusCode::kNotConverged);
  EXPECT_LE(outcome.exact_steps, 8);
}

TEST(NewtonLoop, AFirstStepThatRaisesTheErrorIsNoDivergence) {
  Scalar root = SquareRootOfTwo(0.05);  // the first step leads to 20
  const FrameOutcome outcome = SolveNewton(root, {}, TimeBudget());
  EXPECT_TRUE(outcome.converged());
  EXPECT_NEAR(root.x, std::sqrt(2.0), 1e-8);
}

TEST(NewtonLoop, AnErrorThatIsNoNumberIsDivergence) {
  Scalar root(
      -1.0, [](double x) { return std::log(2.0 + x) + 5.0; }, [](double) { return 1.0; });
  const FrameOutcome outcome = SolveNewton(root, {}, TimeBudget());
  EXPECT_TRUE(outcome.diverged());
  EXPECT_EQ(root.x, -1.0);
}

TEST(TimeBudget, CountsFromWhereItWasMade) {
  double now_s = 100.0;
  const TimeBudget budget(0.5, [&now_s] { return now_s; });
  now_s = 100.4;
  EXPECT_NEAR(budget.Elapsed_s(), 0.4, 1e-12);
  EXPECT_FALSE(budget.Over());
  EXPECT_TRUE(budget.Over(0.2));
  now_s = 100.6;
  EXPECT_TRUE(budget.Over());
  EXPECT_FALSE(TimeBudget().Over(1e9));
}

TEST(NewtonLoop, AKeptFactorThatIsGoodEnoughIsAllThatIsNeeded) {
  Scalar root = SquareRootOfTwo(1.41);
  root.kept_slope = 2.9;
  const FrameOutcome outcome =
      SolveNewton(root, {.relative_tolerance = 1e-10, .keep_factor = true}, TimeBudget());
  EXPECT_TRUE(outcome.converged());
  EXPECT_EQ(root.calls, "K");
  EXPECT_EQ(outcome.exact_steps, 0);
  EXPECT_GE(outcome.chord_steps, 5);
  EXPECT_NEAR(root.x, std::sqrt(2.0), 1e-10);
}

TEST(NewtonLoop, AKeptFactorThatGainsTooLittleIsDropped) {
  Scalar root = SquareRootOfTwo(1.6);
  root.kept_slope = 30.0;
  const FrameOutcome outcome =
      SolveNewton(root, {.relative_tolerance = 1e-10, .keep_factor = true}, TimeBudget());
  EXPECT_TRUE(outcome.converged());
  EXPECT_EQ(root.calls.substr(0, 2), "KE");
  EXPECT_GE(outcome.exact_steps, 1);
}

TEST(NewtonLoop, WithoutAFactorToKeepTheFirstStepIsExact) {
  Scalar root = SquareRootOfTwo(1.5);
  EXPECT_TRUE(SolveNewton(root, {.keep_factor = true}, TimeBudget()).converged());
  EXPECT_EQ(root.calls.substr(0, 2), "KE");
  Scalar unasked = SquareRootOfTwo(1.5);
  unasked.kept_slope = 2.8;
  EXPECT_TRUE(SolveNewton(unasked, {}, TimeBudget()).converged());
  EXPECT_EQ(unasked.calls[0], 'E');
}

/// Of which each look at the residual takes 1.
TimeBudget BudgetOfTrials(const Scalar& problem, double trials) {
  return TimeBudget(trials, [&problem] { return static_cast<double>(problem.told_last.size()); });
}

/// Its chord steps halve the error, about.
Scalar SlowSquareRootOfTwo() {
  Scalar root = SquareRootOfTwo(1.5);
  root.kept_slope = 5.6;
  return root;
}

TEST(NewtonLoop, SlowStepsWithAKeptFactorAreTakenWhereAnExactOneCostsMore) {
  Scalar root = SlowSquareRootOfTwo();
  const FrameOutcome outcome = SolveNewton(
      root, {.relative_tolerance = 1e-3, .keep_factor = true, .exact_step_cost_s = 50.0},
      BudgetOfTrials(root, std::numeric_limits<double>::infinity()));
  EXPECT_TRUE(outcome.converged());
  EXPECT_EQ(outcome.exact_steps, 0);
  EXPECT_GT(outcome.chord_steps, 4);
  EXPECT_NEAR(root.x, std::sqrt(2.0), 1e-3);
}

TEST(NewtonLoop, SlowStepsWithAKeptFactorGiveWayToACheapExactOne) {
  Scalar root = SlowSquareRootOfTwo();
  const FrameOutcome outcome =
      SolveNewton(root, {.relative_tolerance = 1e-3, .keep_factor = true, .exact_step_cost_s = 2.0},
                  BudgetOfTrials(root, std::numeric_limits<double>::infinity()));
  EXPECT_TRUE(outcome.converged());
  EXPECT_EQ(outcome.exact_steps, 1);
}

TEST(NewtonLoop, SlowChordStepsFollowAnExactOneOnlyWhereAnotherCostsMore) {
  const auto run = [](double exact_step_cost) {
    Scalar root(
        1.5, [](double x) { return x * x - 2.0; }, [](double) { return 5.6; });
    return SolveNewton(root, {.relative_tolerance = 1e-3, .exact_step_cost_s = exact_step_cost},
                       BudgetOfTrials(root, std::numeric_limits<double>::infinity()));
  };
  EXPECT_EQ(run(50.0).exact_steps, 1);
  EXPECT_GT(run(50.0).chord_steps, 4);
  EXPECT_GT(run(2.0).exact_steps, 1);
  EXPECT_TRUE(run(2.0).converged());
}

TEST(NewtonLoop, WithoutRoomForAnExactStepTheKeptOnesEndWithTheBudget) {
  Scalar root = SlowSquareRootOfTwo();
  const FrameSettings settings{
      .relative_tolerance = 1e-3, .keep_factor = true, .exact_step_cost_s = 10.0};
  const FrameOutcome first = SolveNewton(root, settings, BudgetOfTrials(root, 3.0));
  EXPECT_EQ(first.status.code(), StatusCode::kBudgetReached);
  EXPECT_EQ(first.exact_steps, 0);
  EXPECT_EQ(first.chord_steps, 3);
  EXPECT_GT(first.error, settings.relative_tolerance);
  int frames = 1;
  while (!SolveNewton(root, settings, BudgetOfTrials(root, 3.0 * ++frames)).converged()) {
    ASSERT_LT(frames, 10);
  }
  EXPECT_GT(frames, 1);
  EXPECT_NEAR(root.x, std::sqrt(2.0), 1e-3);
}

/// A residual that is the same within each range of x: f(x) of the last entry whose x is above.
Scalar Stairs(const std::vector<std::pair<double, double>>& stairs) {
  Scalar scalar(
      1.0,
      [stairs](double x) {
        for (const auto& [from, value] : stairs) {
          if (x > from) return value;
        }
        return 0.0;
      },
      [](double) { return 1.0; });
  scalar.kept_slope = 1.0;
  return scalar;
}

FrameOutcome RunWithKeptFactor(Scalar& problem, double exact_step_cost) {
  return SolveNewton(
      problem,
      {.relative_tolerance = 1e-3, .keep_factor = true, .exact_step_cost_s = exact_step_cost},
      BudgetOfTrials(problem, std::numeric_limits<double>::infinity()));
}

TEST(NewtonLoop, TheFirstStepWithAKeptFactorMayRaiseTheErrorWhereAnExactOneIsDear) {
  const std::vector<std::pair<double, double>> rising = {{0.95, 0.1}, {0.7, 0.4}, {0.48, 0.04}};
  Scalar dear = Stairs(rising);
  EXPECT_EQ(RunWithKeptFactor(dear, 50.0).exact_steps, 0);
  EXPECT_EQ(dear.calls, "K");
  Scalar unknown = Stairs(rising);
  EXPECT_GT(RunWithKeptFactor(unknown, 0.0).exact_steps, 0);
  Scalar far_up = Stairs({{0.95, 0.1}, {0.7, 0.9}, {-0.1, 0.04}});
  EXPECT_GT(RunWithKeptFactor(far_up, 50.0).exact_steps, 0);
  Scalar slow_thereafter = Stairs({{0.95, 0.1}, {0.7, 0.4}, {0.3, 0.32}});
  EXPECT_GT(RunWithKeptFactor(slow_thereafter, 50.0).exact_steps, 0);
}

TEST(NewtonLoop, AStepThatWasCutIsNotJudgedByItsError) {
  const std::vector<std::pair<double, double>> slow = {
      {0.95, 0.1}, {0.85, 0.2}, {0.6, 0.25}, {0.42, 0.05}};
  Scalar cut = Stairs(slow);
  cut.cut = true;
  EXPECT_EQ(RunWithKeptFactor(cut, 50.0).exact_steps, 0);
  Scalar whole = Stairs(slow);
  EXPECT_GT(RunWithKeptFactor(whole, 50.0).exact_steps, 0);
}

}  // namespace
}  // namespace palpate::fem
