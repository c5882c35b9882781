// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/history.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace palpate::diagnosis {
namespace {

/// What the quantity is where every command is zero.
constexpr double kAtZero = 0.7;

/// A quantity that goes linearly between these.
struct Path {
  std::vector<double> t_s;
  std::vector<double> value;

  double At(double now_s) const {
    std::size_t k = 1;
    while (k + 1 < t_s.size() && t_s[k] < now_s) ++k;
    return value[k - 1] + (value[k] - value[k - 1]) * (now_s - t_s[k - 1]) / (t_s[k] - t_s[k - 1]);
  }
  /// Integral of exp(-(now - s) / tau) dvalue/ds ds, by the midpoint rule.
  double Fading(double now_s, double tau_s) const {
    constexpr int kSteps = 200000;
    const double step_s = (now_s - t_s.front()) / kSteps;
    double sum = 0.0;
    for (int k = 0; k < kSteps; ++k) {
      const double from_s = t_s.front() + k * step_s;
      sum +=
          std::exp(-(now_s - from_s - 0.5 * step_s) / tau_s) * (At(from_s + step_s) - At(from_s));
    }
    return sum;
  }
};

void AddSample(int recording, double piece_begin_s, double piece_end_s, bool still,
               const std::vector<double>& frames_s, ObservedExperiment* observed) {
  Sample& sample = observed->samples.emplace_back();
  sample.recording = recording;
  sample.frame_t_s = frames_s;
  for (const double t_s : frames_s) sample.t_s += t_s / static_cast<double>(frames_s.size());
  sample.piece_begin_s = piece_begin_s;
  sample.piece_end_s = piece_end_s;
  sample.still = still;
}

/// Up in two samples, a hold of two; a rest; another hold of one and a way on.
ObservedExperiment TwoRecordings() {
  ObservedExperiment observed;
  observed.recordings.resize(2);
  observed.timeline.begin_s = {0.0, 16.0};
  observed.timeline.end_s = {10.0, 24.0};
  AddSample(0, 0.0, 4.0, false, {0.5, 1.0, 1.5}, &observed);
  AddSample(0, 0.0, 4.0, false, {2.5, 3.0, 3.5}, &observed);
  AddSample(0, 4.0, 10.0, true, {4.5, 5.5}, &observed);
  AddSample(0, 4.0, 10.0, true, {7.0, 8.0, 9.0}, &observed);
  AddSample(1, 16.0, 20.0, true, {17.0, 19.0}, &observed);
  AddSample(1, 20.0, 24.0, false, {21.0, 22.0}, &observed);
  AddSample(1, 20.0, 24.0, false, {22.5, 23.5}, &observed);
  return observed;
}

/// Zero commands are reached in the middle of the rest.
Path PathThroughBoth() {
  return {{0.0, 4.0, 10.0, 13.0, 16.0, 20.0, 24.0}, {1.0, 3.0, 3.0, kAtZero, 2.0, 2.0, -0.5}};
}

Eigen::VectorXd ValuesOf(const ObservedExperiment& observed, const Path& path) {
  const auto samples = std::ssize(observed.samples);
  Eigen::VectorXd values(3 * samples + 1);
  for (Eigen::Index s = 0; s < samples; ++s) {
    const Sample& sample = observed.samples[static_cast<std::size_t>(s)];
    values[s] = path.At(sample.t_s);
    values[samples + 1 + 2 * s] = path.At(sample.piece_begin_s);
    values[samples + 2 + 2 * s] = path.At(sample.piece_end_s);
  }
  values[samples] = kAtZero;
  return values;
}

/// Of three samples, with nothing anywhere else.
Eigen::VectorXd OnlyAtSamples(const HistoryOperator& history, const Eigen::Vector3d& at_samples) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(history.ColumnCount());
  values.head<3>() = at_samples;
  return values;
}

TEST(HistoryOperator, IsTheConvolutionWithWhatGoesLinearly) {
  const ObservedExperiment observed = TwoRecordings();
  const HistoryOperator history(observed);
  const Path path = PathThroughBoth();
  for (const double tau_s : {0.4, 3.0, 40.0}) {
    const Eigen::VectorXd remembered = history.Fading(tau_s) * ValuesOf(observed, path);
    for (std::size_t s = 0; s < observed.samples.size(); ++s) {
      double expected = 0.0;
      const std::vector<double>& frames_s = observed.samples[s].frame_t_s;
      for (const double t_s : frames_s) {
        expected += path.Fading(t_s, tau_s) / static_cast<double>(frames_s.size());
      }
      EXPECT_NEAR(remembered[static_cast<Eigen::Index>(s)], expected, 2e-4)
          << "tau " << tau_s << ", sample " << s;
    }
  }
}

/// A pull, a hold and the way back, of each motion one sample: where a hold and zero commands begin
/// and end is known without.
TEST(HistoryOperator, KnowsHoldsAndZeroCommandsBetweenFewSamples) {
  ObservedExperiment observed;
  observed.recordings.resize(2);
  Timeline& timeline = observed.timeline;
  timeline.actuators = {{.name = "pull"}, {.name = "tendon"}};
  timeline.by_tension = {false, true};
  timeline.t_s = {0.0, 2.0, 12.0, 14.0, 18.0, 20.0};
  // Metres are not small beside newtons.
  for (const double command_m : {0.0, 0.01, 0.01, 0.0}) {
    timeline.command.emplace_back(Eigen::Vector2d(command_m, 0.0));
  }
  for (int k = 0; k < 2; ++k) timeline.command.emplace_back(Eigen::Vector2d(0.0, 5.0));
  timeline.begin_s = {0.0, 18.0};
  timeline.end_s = {14.0, 20.0};
  AddSample(0, 0.0, 2.0, false, {0.8, 1.2}, &observed);
  AddSample(0, 2.0, 12.0, true, {3.0, 5.0}, &observed);
  AddSample(0, 12.0, 14.0, false, {12.7, 13.1}, &observed);
  AddSample(1, 18.0, 20.0, true, {18.5, 19.0}, &observed);
  const Path path{{0.0, 2.0, 12.0, 14.0, 20.0}, {kAtZero, 3.0, 3.0, kAtZero, kAtZero}};
  const HistoryOperator history(observed);
  for (const double tau_s : {0.4, 3.0, 40.0}) {
    const Eigen::VectorXd remembered = history.Fading(tau_s) * ValuesOf(observed, path);
    for (std::size_t s = 0; s < observed.samples.size(); ++s) {
      double expected = 0.0;
      for (const double t_s : observed.samples[s].frame_t_s) {
        expected += 0.5 * path.Fading(t_s, tau_s);
      }
      EXPECT_NEAR(remembered[static_cast<Eigen::Index>(s)], expected, 2e-4)
          << "tau " << tau_s << ", sample " << s;
    }
  }
}

/// Up and down, one sample each, and it goes up by more where it turns than samples tell.
TEST(HistoryOperator, KnowsWhereMotionsTurn) {
  ObservedExperiment observed;
  observed.recordings.resize(1);
  observed.timeline.begin_s = {0.0};
  observed.timeline.end_s = {8.0};
  AddSample(0, 0.0, 4.0, false, {1.0, 3.0}, &observed);
  AddSample(0, 4.0, 8.0, false, {5.0, 7.0}, &observed);
  const Path path{{0.0, 2.0, 4.0, 6.0, 8.0}, {-0.5, 1.0, 5.0, 1.0, -0.5}};
  const HistoryOperator history(observed);
  const Eigen::VectorXd values = ValuesOf(observed, path);
  constexpr double kTau_s = 2.0;
  const Eigen::VectorXd remembered = history.Fading(kTau_s) * values;
  EXPECT_NEAR(remembered[0], 0.5 * (path.Fading(1.0, kTau_s) + path.Fading(3.0, kTau_s)), 2e-4);
  EXPECT_NEAR(remembered[1], 0.5 * (path.Fading(5.0, kTau_s) + path.Fading(7.0, kTau_s)), 2e-4);
  const HistoryOperator::Course course = history.Follow(values.transpose().cast<float>());
  for (Eigen::Index look = HistoryOperator::kTimesPerSample;
       look < 2 * HistoryOperator::kTimesPerSample; ++look) {
    EXPECT_FLOAT_EQ(course.largest(0, look), 5.0F) << look;
  }
}

TEST(HistoryOperator, BeginsWhereABodyThatWasHeldUndeformedIsLetGo) {
  ObservedExperiment observed;
  observed.recordings.resize(1);
  observed.recordings[0].held_until_s = 1.0;
  observed.timeline.begin_s = {0.0};
  observed.timeline.end_s = {9.0};
  AddSample(0, 3.0, 9.0, true, {4.0}, &observed);
  AddSample(0, 3.0, 9.0, true, {8.0}, &observed);
  const HistoryOperator history(observed);
  constexpr double kTau_s = 2.5;
  // From nothing to 2 at once, and there it stays; with zero commands it would be something else.
  const Eigen::VectorXd remembered =
      history.Fading(kTau_s) * OnlyAtSamples(history, {2.0, 2.0, 5.0});
  EXPECT_NEAR(remembered[0], 2.0 * std::exp(-3.0 / kTau_s), 1e-12);
  EXPECT_NEAR(remembered[1], 2.0 * std::exp(-7.0 / kTau_s), 1e-12);
}

TEST(HistoryOperator, KnowsTheLargestUntilNow) {
  const ObservedExperiment observed = TwoRecordings();
  const Eigen::VectorXd values = ValuesOf(observed, PathThroughBoth());
  const HistoryOperator::Course course =
      HistoryOperator(observed).Follow(values.transpose().cast<float>());
  // The first motion goes on to 3 beyond its last sample; later nothing is above that.
  constexpr Eigen::Index kMotion = 2 * HistoryOperator::kTimesPerSample;
  for (Eigen::Index look = 0; look < kMotion; ++look) {
    EXPECT_FLOAT_EQ(course.largest(0, look), course.now(0, look)) << look;
  }
  for (Eigen::Index look = kMotion; look < course.largest.cols(); ++look) {
    EXPECT_FLOAT_EQ(course.largest(0, look), 3.0F) << look;
  }
}

TEST(HistoryOperator, FollowsWhatGoesLinearlyThroughEachSample) {
  const ObservedExperiment observed = TwoRecordings();
  const Path path = PathThroughBoth();
  const Eigen::VectorXd values = ValuesOf(observed, path);
  const HistoryOperator::Course course =
      HistoryOperator(observed).Follow(values.transpose().cast<float>());
  ASSERT_EQ(course.now.cols(), HistoryOperator::kTimesPerSample * std::ssize(observed.samples));
  for (std::size_t s = 0; s < observed.samples.size(); ++s) {
    // The first, the middle and the last frame; of two frames the one or the other.
    const std::vector<double>& frames_s = observed.samples[s].frame_t_s;
    const auto look = HistoryOperator::kTimesPerSample * static_cast<Eigen::Index>(s);
    EXPECT_NEAR(course.now(0, look), path.At(frames_s.front()), 1e-6) << s;
    EXPECT_NEAR(course.now(0, look + HistoryOperator::kTimesPerSample / 2),
                path.At(frames_s[frames_s.size() / 2]), 1e-6)
        << s;
    EXPECT_NEAR(course.now(0, look + HistoryOperator::kTimesPerSample - 1),
                path.At(frames_s.back()), 1e-6)
        << s;
  }
}

TEST(HistoryOperator, FollowsNothingWhereNothingWasSeen) {
  const ObservedExperiment observed;
  EXPECT_EQ(HistoryOperator(observed).Follow(Eigen::MatrixXf::Ones(4, 1)).now.cols(), 0);
}

TEST(HistoryOperator, HasNothingOfWhatNeverChanges) {
  const ObservedExperiment observed = TwoRecordings();
  const HistoryOperator history(observed);
  for (const double tau_s : {0.01, 1.0, 1000.0}) {
    EXPECT_LT(history.Fading(tau_s).rowwise().sum().cwiseAbs().maxCoeff(), 1e-12) << tau_s;
  }
}

TEST(HistoryOperator, ForgetsAtOnceOrNever) {
  const ObservedExperiment observed = TwoRecordings();
  const HistoryOperator history(observed);
  const Path path = PathThroughBoth();
  const Eigen::VectorXd values = ValuesOf(observed, path);
  // What changes by 1.25 a second at most: less than that times tau.
  constexpr double kShort_s = 1e-4;
  EXPECT_LT((history.Fading(kShort_s) * values).cwiseAbs().maxCoeff(), 1.25 * kShort_s);
  constexpr double kLong_s = 1e6;
  const Eigen::VectorXd ever = history.Fading(kLong_s) * values;
  for (Eigen::Index s = 0; s < ever.size(); ++s) {
    EXPECT_NEAR(ever[s], values[s] - path.value.front(), 1e-4) << "sample " << s;
  }
}

TEST(HistoryOperator, NeverLooksAhead) {
  const ObservedExperiment observed = TwoRecordings();
  const Eigen::MatrixXd weights = HistoryOperator(observed).Fading(5.0);
  // Of the recording after; within one, a motion is carried back from its second sample.
  EXPECT_TRUE(weights.topRows(4).middleCols(4, 3).isZero(0.0));
}

TEST(HistoryOperator, ALoadThatComesIsAJump) {
  ObservedExperiment observed;
  observed.recordings.resize(1);
  observed.timeline.begin_s = {0.0};
  observed.timeline.end_s = {20.0};
  AddSample(0, 0.0, 10.0, true, {4.0, 6.0}, &observed);
  AddSample(0, 10.0, 20.0, true, {11.0}, &observed);
  AddSample(0, 10.0, 20.0, true, {17.0}, &observed);
  for (std::size_t s : {1U, 2U}) observed.samples[s].loads = {{10.0, {}, {0.0, 0.0, 1.0}, 0.0, {}}};
  constexpr double kTau_s = 3.0;
  const HistoryOperator history(observed);
  const Eigen::VectorXd remembered =
      history.Fading(kTau_s) * OnlyAtSamples(history, {1.0, 3.0, 3.0});
  EXPECT_NEAR(remembered[0], 0.0, 1e-12);
  EXPECT_NEAR(remembered[1], 2.0 * std::exp(-1.0 / kTau_s), 1e-12);
  EXPECT_NEAR(remembered[2], 2.0 * std::exp(-7.0 / kTau_s), 1e-12);
}

}  // namespace
}  // namespace palpate::diagnosis
