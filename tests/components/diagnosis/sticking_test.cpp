// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/sticking.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "components/diagnosis/forward/simulator.hpp"
#include "libs/robot/sensitivity/eyelet_slides.hpp"
#include "libs/robot/sticking.hpp"
#include "tests/components/diagnosis/small_robot.hpp"

namespace palpate::diagnosis {
namespace {

constexpr double kPresliding_m = robot::kPresliding_m;

TEST(StickOrSlide, FollowsWhatSlidesFreelyAndStaysWithinOne) {
  const Eigen::Vector3d before(0.2, 1.0, -0.5);
  const Eigen::Vector3d freely_m = kPresliding_m * Eigen::Vector3d(0.5, -3.0, 7.0);
  const Eigen::VectorXd s = robot::StickOrSlide(before, freely_m, Eigen::Matrix3d::Zero());
  EXPECT_LT((s - Eigen::Vector3d(-0.3, 1.0, -1.0)).norm(), 1e-12);
}

/// s is what the slide that goes with it makes of it, however the eyelets work on each other.
TEST(StickOrSlide, BalancesWhatItselfMoves) {
  std::mt19937 engine(11);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  int sticking = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::MatrixXd A = Eigen::MatrixXd::NullaryExpr(4, 4, [&] { return any(engine); });
    const Eigen::MatrixXd slide_m = 5.0 * kPresliding_m * A * A.transpose();
    const Eigen::VectorXd before = Eigen::VectorXd::NullaryExpr(4, [&] { return any(engine); });
    const Eigen::VectorXd freely_m =
        8.0 * kPresliding_m * Eigen::VectorXd::NullaryExpr(4, [&] { return any(engine); });
    const Eigen::VectorXd s = robot::StickOrSlide(before, freely_m, slide_m);
    const Eigen::VectorXd slid_m = freely_m + slide_m * (s - before);
    const Eigen::VectorXd wanted = (before - slid_m / kPresliding_m).cwiseMax(-1.0).cwiseMin(1.0);
    EXPECT_LT((s - wanted).cwiseAbs().maxCoeff(), 1e-3) << "trial " << trial;
    sticking += static_cast<int>((s.cwiseAbs().array() < 1.0).count());
  }
  EXPECT_GT(sticking, 100);
}

/// A small robot whose first cable is pulled, let out by half, and pulled again.
class StickingTest : public testing::Test {
 protected:
  StickingTest() { SetFriction(0.4); }

  void SetFriction(double coefficient) {
    hypothesis_.body.cables[0].friction_coefficient = coefficient;
  }
  static ObservedExperiment Ramps(const robot::RobotBody& body) {
    experiment::Experiment experiment;
    experiment.recordings = {MakeRecording(
        "ramps", body, {{0.0, {0.0}}, {4.0, {0.008}}, {6.0, {0.004}}, {8.0, {0.008}}}, 0.05)};
    return Observe(experiment, body, {.most_samples = 24});
  }
  /// One part after the other.
  std::vector<SamplePart> Parts() const {
    const ActuatorChain drives(observed_);
    std::vector<std::vector<SamplePart>> of_samples = drives.PartsAt(hypothesis_.actuators);
    Sticking(drives).Follow(hypothesis_, Simulator(observed_, 1).Run(hypothesis_).samples,
                            &of_samples);
    std::vector<SamplePart> all;
    for (const auto& parts : of_samples) all.insert(all.end(), parts.begin(), parts.end());
    return all;
  }

  robot::RobotBody body_ = SmallRobot();
  ObservedExperiment observed_ = Ramps(body_);
  ModelHypothesis hypothesis_ = NominalHypothesis(body_, observed_);
};

TEST_F(StickingTest, SlidesInUntilItTurnsRoundAndSticksOnTheWay) {
  const std::vector<robot::RubbingEyelet> eyelets = robot::RubbingEyelets(body_);
  ASSERT_EQ(eyelets.size(), 3U);  // of cables up (two) and down; each has a knot beside
  int sticking = 0;
  for (const SamplePart& part : Parts()) {
    const double first = part.sliding[0];
    const double second = part.sliding[1];
    if (part.t_s > 1.0 && part.t_s < 3.9) {
      EXPECT_GT(std::min(first, second), 0.999) << part.t_s;
    }
    if (part.t_s > 4.0 && part.t_s < 6.0) {
      EXPECT_LE(first, second + 1e-9) << part.t_s;  // tensions turn round from the actuator on
      sticking += std::abs(second) < 0.99 ? 1 : 0;
    }
    if (part.t_s > 5.9 && part.t_s < 6.0) {
      EXPECT_LT(std::max(first, second), -0.999);
    }
    if (part.t_s > 7.9) {
      EXPECT_GT(std::min(first, second), 0.999);
    }
  }
  EXPECT_GE(sticking, 2);
}

/// One that could not be simulated takes no other's sticking away.
TEST_F(StickingTest, StaysWhereOneMomentIsNotKnown) {
  const ActuatorChain drives(observed_);
  std::vector<SimulatedSample> samples = Simulator(observed_, 1).Run(hypothesis_).samples;
  const auto followed = [&] {
    std::vector<std::vector<SamplePart>> of_samples = drives.PartsAt(hypothesis_.actuators);
    Sticking(drives).Follow(hypothesis_, samples, &of_samples);
    return of_samples;
  };
  const auto with_all = followed();
  samples[samples.size() / 2].slides.clear();
  const auto without_one = followed();
  for (std::size_t s = 0; s < with_all.size(); ++s) {
    for (std::size_t k = 0; k < with_all[s].size(); ++k) {
      EXPECT_LT((with_all[s][k].sliding - without_one[s][k].sliding).cwiseAbs().maxCoeff(), 0.2)
          << s << " " << k;
    }
  }
}

TEST_F(StickingTest, TurnsRoundAtOnceWhereNothingRubs) {
  SetFriction(0.0);
  for (const SamplePart& part : Parts()) {
    if (part.t_s < 4.2 || part.t_s > 6.0) continue;
    EXPECT_LT(part.sliding.head(2).maxCoeff(), -0.999) << part.t_s;
  }
}

/// The same robot one frame after the other, each in balance with how far the cables have truly
/// slid since the one before.
class SmallSteps {
 public:
  SmallSteps(const ModelHypothesis& hypothesis, const ObservedExperiment& observed)
      : observed_(observed),
        solver_(hypothesis, observed),
        eyelets_(robot::RubbingEyelets(hypothesis.body)),
        coefficient_(robot::FrictionAt(eyelets_, hypothesis.body)),
        s_(Eigen::VectorXd::Zero(coefficient_.size())) {
    now_.middle.state = solver_.model().RestState();
    length_m_ = Lengths_m();
  }

  /// What is seen with so much taken in.
  Eigen::VectorXd StepTo(const Eigen::VectorXd& taken_in) {
    constexpr int kMostRounds = 30;
    const Eigen::VectorXd before = s_;
    for (int round = 0; round < kMostRounds; ++round) {
      solver_.SetSliding(s_);
      solver_.Solve(observed_.samples.front(), taken_in, {}, &now_);
      EXPECT_TRUE(now_.status.ok()) << now_.status.message();
      const Eigen::MatrixXd slide_m =
          solver_.SlidesAboutShape(now_.middle).by_friction * coefficient_.asDiagonal();
      const Eigen::VectorXd freely_m = Lengths_m() - length_m_ - slide_m * (s_ - before);
      const Eigen::VectorXd next = robot::StickOrSlide(before, freely_m, slide_m);
      const double moved = (next - s_).cwiseAbs().maxCoeff();
      s_ = next;
      if (moved > 1e-6) continue;
      length_m_ = Lengths_m();
      return now_.seen_m;
    }
    ADD_FAILURE() << "no balance";
    return now_.seen_m;
  }

 private:
  /// [eyelets] from each to the end of its cable.
  Eigen::VectorXd Lengths_m() {
    Eigen::VectorXd lengths_m(std::ssize(eyelets_));
    for (std::size_t k = 0; k < eyelets_.size(); ++k) {
      const robot::Cable& cable = solver_.model().cable(eyelets_[k].cable);
      const Eigen::Matrix3Xd path_m = cable.Path_m(now_.middle.state.x_m);
      const auto pieces = path_m.cols() - 2 - eyelets_[k].eyelet;
      const Eigen::Matrix3Xd along_m =
          path_m.rightCols(pieces) - path_m.middleCols(path_m.cols() - 1 - pieces, pieces);
      lengths_m[static_cast<Eigen::Index>(k)] = along_m.colwise().norm().sum();
    }
    return lengths_m;
  }

  const ObservedExperiment& observed_;
  SampleSolver solver_;
  std::vector<robot::RubbingEyelet> eyelets_;
  Eigen::VectorXd coefficient_, s_, length_m_;
  SimulatedSample now_;
};

TEST_F(StickingTest, SimulationIsThatOfSmallStepsThroughTime) {
  SmallSteps steps(hypothesis_, observed_);
  const ActuatorChain drives(observed_);
  std::vector<Eigen::VectorXd> seen_m;  // [times]
  const Eigen::MatrixXd path = drives.Path(hypothesis_.actuators);
  for (const auto& taken_in : path.colwise()) {
    seen_m.push_back(steps.StepTo(taken_in));
  }
  const auto parts = drives.PartsAt(hypothesis_.actuators);
  const Simulation simulation = Simulator(observed_, 2).Run(hypothesis_);
  SetFriction(0.0);
  const Simulation without = Simulator(observed_, 2).Run(hypothesis_);
  ASSERT_TRUE(simulation.status.ok() && without.status.ok());
  double effect_m = 0.0;
  double apart_m = 0.0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    Eigen::VectorXd mean_m = Eigen::VectorXd::Zero(without.samples[k].seen_m.size());
    for (const SamplePart& part : parts[k]) {
      for (const int time : part.times) {
        mean_m += part.share / static_cast<double>(part.times.size()) *
                  seen_m[static_cast<std::size_t>(time)];
      }
    }
    effect_m = std::max(effect_m, (mean_m - without.samples[k].seen_m).cwiseAbs().maxCoeff());
    apart_m = std::max(apart_m, (mean_m - simulation.samples[k].seen_m).cwiseAbs().maxCoeff());
  }
  EXPECT_GT(effect_m, 1e-4);
  EXPECT_LT(apart_m, 0.02 * effect_m);  // where it turns round; else 1e-3 of it
}

}  // namespace
}  // namespace palpate::diagnosis
