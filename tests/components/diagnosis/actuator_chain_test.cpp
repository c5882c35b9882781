// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/actuator_chain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace palpate::diagnosis {
namespace {

constexpr double kOff = std::numeric_limits<double>::quiet_NaN();

/// Two cables with the commands `commanded`, one column for each of `t_s`; a sample of one frame at
/// each of `frames_s`.
ObservedExperiment Commanded(const std::vector<double>& t_s, const Eigen::Matrix2Xd& commanded,
                             const std::vector<double>& frames_s) {
  ObservedExperiment observed;
  observed.recordings.resize(1);
  observed.timeline.actuators = {{.name = "a"}, {.name = "b"}};
  observed.timeline.by_tension = {false, false};
  observed.timeline.t_s = t_s;
  for (const auto& command : commanded.colwise()) observed.timeline.command.emplace_back(command);
  observed.timeline.begin_s = {t_s.front()};
  observed.timeline.end_s = {t_s.back()};
  for (const double frame_s : frames_s) {
    Sample& sample = observed.samples.emplace_back();
    sample.t_s = frame_s;
    sample.frame_t_s = {frame_s};
  }
  return observed;
}

/// Cable a up to 10 mm in 10 s and back; cable b half as far.
ObservedExperiment UpAndDown(const std::vector<double>& frames_s) {
  Eigen::Matrix2Xd commanded(2, 3);
  commanded << 0.0, 0.010, 0.0,  //
      0.0, 0.005, 0.0;
  return Commanded({0.0, 10.0, 20.0}, commanded, frames_s);
}

TEST(ActuatorChain, TakesInTheMeanOfWhatItIsToldInTheFramesOfASample) {
  ObservedExperiment observed = UpAndDown({4.0});
  observed.samples[0].frame_t_s = {3.0, 4.5, 11.0};
  const Eigen::MatrixXd taken_in = ActuatorChain(observed).At(ActuatorSettings(2));
  EXPECT_NEAR(taken_in(0, 0), (0.003 + 0.0045 + 0.009) / 3.0, 1e-15);
  EXPECT_NEAR(taken_in(1, 0), 0.5 * (0.003 + 0.0045 + 0.009) / 3.0, 1e-15);
}

TEST(ActuatorChain, PartsOfASampleAreItsFramesInOrder) {
  ObservedExperiment observed = UpAndDown({4.0, 8.0});
  std::vector<double>& frames_s = observed.samples[0].frame_t_s;
  frames_s.clear();
  for (int frame = 0; frame < 12; ++frame) frames_s.push_back(0.5 * frame);
  observed.samples[0].still = false;
  const auto parts = ActuatorChain(observed).PartsAt(ActuatorSettings(2));
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].size(), 5u);
  EXPECT_EQ(parts[1].size(), 1u) << "nothing is moved in it";
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(2);
  double before = -1.0;
  for (const SamplePart& part : parts[0]) {
    EXPECT_GT(part.taken_in[0], before);
    before = part.taken_in[0];
    mean += part.share * part.taken_in;
  }
  EXPECT_LT((mean - ActuatorChain(observed).At(ActuatorSettings(2)).col(0)).norm(), 1e-15);
}

TEST(ActuatorChain, GainsAndOffsetsAreOfTheirCable) {
  ObservedExperiment observed = UpAndDown({5.0});
  ActuatorSettings settings(2);
  settings.gain[0] = 0.1;
  settings.offset_m[0] = -0.001;
  Eigen::MatrixXd taken_in = ActuatorChain(observed).At(settings);
  EXPECT_NEAR(taken_in(0, 0), 1.1 * 0.005 - 0.001, 1e-15);
  EXPECT_NEAR(taken_in(1, 0), 0.0025, 1e-15);
  // A force has a gain, but no zero of a length and no play.
  observed.timeline.by_tension = {true, true};
  settings.play_m[0] = 0.004;
  taken_in = ActuatorChain(observed).At(settings);
  EXPECT_NEAR(taken_in(0, 0), 1.1 * 0.005, 1e-15);
}

TEST(ActuatorChain, PlayLeavesALoopOfItsWidth) {
  const ObservedExperiment observed = UpAndDown({0.5, 5.0, 10.0, 11.0, 15.0, 20.0});
  ActuatorSettings settings(2);
  settings.play_m[0] = 0.002;
  const Eigen::RowVectorXd taken_in = ActuatorChain(observed).At(settings).row(0);
  // It begins in the middle of its play: the first half of it moves nothing.
  EXPECT_NEAR(taken_in[0], 0.0, 1e-15);
  EXPECT_NEAR(taken_in[1], 0.004, 1e-15);
  EXPECT_NEAR(taken_in[2], 0.009, 1e-15);
  EXPECT_NEAR(taken_in[3], 0.009, 1e-15) << "inside the play";
  EXPECT_NEAR(taken_in[4], 0.006, 1e-15);
  EXPECT_NEAR(taken_in[5], 0.001, 1e-15);
  EXPECT_NEAR(taken_in[4] - taken_in[1], settings.play_m[0], 1e-15);
}

TEST(ActuatorChain, DelayShiftsInTime) {
  const ObservedExperiment observed = UpAndDown({0.3, 5.0, 10.5, 12.0});
  ActuatorSettings settings(2);
  settings.delay_s = 0.7;
  const Eigen::RowVectorXd taken_in = ActuatorChain(observed).At(settings).row(0);
  EXPECT_NEAR(taken_in[0], 0.0, 1e-15);
  EXPECT_NEAR(taken_in[1], 0.0043, 1e-15);
  EXPECT_NEAR(taken_in[2], 0.0098, 1e-15);
  EXPECT_NEAR(taken_in[3], 0.0087, 1e-15);
}

TEST(ActuatorChain, FirstOrderIsExactForARampHoweverFewTheFrames) {
  const ObservedExperiment observed = UpAndDown({0.5, 7.0, 12.0});
  ActuatorSettings settings(2);
  settings.tau_s = 1.5;
  const Eigen::RowVectorXd taken_in = ActuatorChain(observed).At(settings).row(0);
  const auto rising = [&](double t_s) {
    return 0.001 * (t_s - settings.tau_s * (1.0 - std::exp(-t_s / settings.tau_s)));
  };
  EXPECT_NEAR(taken_in[0], rising(0.5), 1e-15);
  EXPECT_NEAR(taken_in[1], rising(7.0), 1e-15);
  // After the turn: the steady way down and the residual of the difference to it.
  const double steady_at_turn = 0.010 + 0.001 * settings.tau_s;
  const double expected = 0.008 + 0.001 * settings.tau_s +
                          (rising(10.0) - steady_at_turn) * std::exp(-2.0 / settings.tau_s);
  EXPECT_NEAR(taken_in[2], expected, 1e-15);
}

TEST(ActuatorChain, ADelayChangesNothingButTheTimeOfWhatFollows) {
  ActuatorSettings settings(2);
  settings.tau_s = 1.5;
  settings.play_m[0] = 0.002;
  const Eigen::MatrixXd prompt =
      ActuatorChain(UpAndDown({0.5, 7.0, 10.4, 12.0, 19.0})).At(settings);
  settings.delay_s = 0.7;
  const Eigen::MatrixXd late = ActuatorChain(UpAndDown({1.2, 7.7, 11.1, 12.7, 19.7})).At(settings);
  EXPECT_LT((late - prompt).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(ActuatorChain, MixesSwapsAndCouples) {
  const ObservedExperiment observed = UpAndDown({5.0});
  ActuatorSettings settings(2);
  settings.mixing << 0.0, 1.0, 1.0, 0.0;
  Eigen::VectorXd taken_in = ActuatorChain(observed).At(settings).col(0);
  EXPECT_NEAR(taken_in[0], 0.0025, 1e-15);
  EXPECT_NEAR(taken_in[1], 0.005, 1e-15);
  settings.mixing << 1.0, 0.2, 0.0, 1.0;
  taken_in = ActuatorChain(observed).At(settings).col(0);
  EXPECT_NEAR(taken_in[0], 0.005 + 0.2 * 0.0025, 1e-15);
  EXPECT_NEAR(taken_in[1], 0.0025, 1e-15);
}

TEST(ActuatorChain, ACableThatIsNotDrivenStaysSoUnlessItsDriveIsMixedIn) {
  Eigen::Matrix2Xd commanded(2, 2);
  commanded << 0.0, 0.010,  //
      kOff, kOff;
  const ObservedExperiment observed = Commanded({0.0, 10.0}, commanded, {5.0});
  ActuatorSettings settings(2);
  settings.tau_s = 0.5;
  settings.play_m.setConstant(0.001);
  Eigen::VectorXd taken_in = ActuatorChain(observed).At(settings).col(0);
  EXPECT_TRUE(std::isfinite(taken_in[0]));
  EXPECT_TRUE(std::isnan(taken_in[1]));
  ActuatorSettings coupled(2);
  coupled.mixing(1, 0) = 0.1;
  coupled.mixing(0, 1) = 0.1;
  taken_in = ActuatorChain(observed).At(coupled).col(0);
  EXPECT_NEAR(taken_in[0], 0.005, 1e-15);
  EXPECT_NEAR(taken_in[1], 0.0005, 1e-15);
}

TEST(ActuatorChain, SlidesTheWayItLastMovedPlayIncluded) {
  const ObservedExperiment observed = UpAndDown({0.0, 5.0, 11.0, 15.0});
  const auto sliding = [&](double play_m) -> Eigen::RowVectorXi {
    ActuatorSettings settings(2);
    settings.play_m[0] = play_m;
    return ActuatorChain(observed).Sliding(settings).row(0);
  };
  EXPECT_EQ(sliding(0.0), Eigen::RowVector4i(0, 1, -1, -1));
  EXPECT_EQ(sliding(0.003), Eigen::RowVector4i(0, 1, 1, -1));
}

TEST(ActuatorChain, PlayRemembersTheRecordingBefore) {
  // Up, back to zero between recordings, and a frame there: the play is still let out.
  Eigen::Matrix2Xd commanded(2, 4);
  commanded << 0.0, 0.010, 0.0, 0.0,  //
      0.0, 0.0, 0.0, 0.0;
  const ObservedExperiment observed = Commanded({0.0, 10.0, 14.0, 20.0}, commanded, {19.0});
  ActuatorSettings settings(2);
  settings.play_m[0] = 0.002;
  EXPECT_NEAR(ActuatorChain(observed).At(settings)(0, 0), 0.001, 1e-15);
}

}  // namespace
}  // namespace palpate::diagnosis
