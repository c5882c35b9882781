// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "components/diagnosis/data/observed_experiment.hpp"
#include "components/diagnosis/data/scatter.hpp"
#include "libs/core/error.hpp"
#include "tests/components/diagnosis/small_robot.hpp"

namespace palpate::diagnosis {
namespace {

constexpr unsigned kObserveSeed = 5;

class ObserveTest : public testing::Test {
 protected:
  /// One recording of cable `up`, a frame each 0.1 s.
  experiment::Recording& Add(const std::vector<Knot>& knots, const Seen& seen_m = nullptr) {
    const std::string name = "r" + std::to_string(experiment_.recordings.size());
    experiment_.recordings.push_back(MakeRecording(name, body_, knots, 0.1, seen_m));
    return experiment_.recordings.back();
  }
  ObservedExperiment Observed() const { return Observe(experiment_, body_); }

  robot::RobotBody body_ = SmallRobot();
  experiment::Experiment experiment_;
};

TEST_F(ObserveTest, CutsWhereCommandsTurn) {
  Add({{0.0, {0.0}}, {4.0, {0.006}}, {8.0, {0.002}}, {23.5, {0.002}}});
  const ObservedExperiment observed = Observed();
  ASSERT_EQ(observed.samples.size(), 13U) << "four of each way, five of the hold";
  for (std::size_t s = 0; s < 13; ++s) {
    const Sample& sample = observed.samples[s];
    EXPECT_EQ(sample.still, s >= 8);
    EXPECT_NEAR(sample.piece_begin_s, s < 4 ? 0.0 : s < 8 ? 4.0 : 8.0, 1e-12);
    EXPECT_NEAR(sample.piece_end_s, s < 4 ? 4.0 : s < 8 ? 8.0 : 23.5, 1e-12);
    // Of a motion equally long; of a hold each twice as long as the one before: 0.5, 1, 2, 4, 8 s.
    const double frames = s < 8 ? 10.0 : 5.0 * std::exp2(static_cast<double>(s) - 8.0);
    EXPECT_NEAR(static_cast<double>(sample.frame_t_s.size()), frames, 1.0) << "sample " << s;
    const double before_s = s > 0 ? observed.samples[s - 1].frame_t_s.back() : -1.0;
    EXPECT_GT(sample.frame_t_s.front(), before_s);
  }
}

TEST_F(ObserveTest, UsesEveryFrameOnce) {
  Add({{0.0, {0.0}}, {4.0, {0.006}}, {12.0, {0.006}}});
  std::size_t frames = 0;
  const ObservedExperiment observed = Observed();
  for (const Sample& sample : observed.samples) frames += sample.frame_t_s.size();
  EXPECT_EQ(frames, experiment_.recordings[0].markers->frames.size());
}

TEST_F(ObserveTest, AWobbleOfAHundredthIsNoTurn) {
  std::vector<Knot> knots;
  for (int k = 0; k <= 20; ++k) {
    knots.push_back({0.2 * k, {0.005 * k / 20.0 + (k % 2 == 0 ? 2e-5 : -2e-5)}});
  }
  Add(knots);
  const ObservedExperiment observed = Observed();
  EXPECT_EQ(observed.samples.size(), 4U);
  for (const Sample& sample : observed.samples) EXPECT_FALSE(sample.still);
}

TEST_F(ObserveTest, ASteadyWindowIsCutAtItsFirstStampToo) {
  // The window begins half-way up: the next stamp is the turn.
  Add({{0.0, {0.0}}, {4.0, {0.006}}, {8.0, {0.0}}}).steady_window_s = experiment::TimeWindow{2, 7};
  const ObservedExperiment observed = Observed();
  ASSERT_EQ(observed.samples.size(), 8U);
  EXPECT_EQ(observed.samples[3].piece_begin_s, 2.0);
  EXPECT_EQ(observed.samples[3].piece_end_s, 4.0);
  EXPECT_EQ(observed.samples[4].piece_begin_s, 4.0);
  EXPECT_EQ(observed.samples[7].piece_end_s, 7.0);
}

TEST_F(ObserveTest, CutsWhereALoadComesAndLeavesOutThatMoment) {
  const Eigen::Vector3d tip_m(0.09, 0.01, 0.0);
  Add({{0.0, {0.003}}, {20.0, {0.003}}}).loads = {{0.0, tip_m, Eigen::Vector3d::Zero(), 0.0, {}},
                                                  {10.0, tip_m, {0.0, 0.0, -0.1}, 0.0, {}}};
  const ObservedExperiment observed = Observed();
  ASSERT_EQ(observed.samples.size(), 10U);
  for (const Sample& sample : observed.samples) {
    ASSERT_EQ(sample.loads.size(), 1U);
    EXPECT_EQ(sample.loads[0].force_N.z(), sample.t_s < 10.0 ? 0.0 : -0.1);
    for (const double t_s : sample.frame_t_s) {
      EXPECT_NE(t_s, 10.0);
      EXPECT_EQ(t_s < 10.0, sample.piece_end_s <= 10.0);
    }
  }
}

TEST_F(ObserveTest, AveragesWhatWasSeen) {
  // Marker 1 is not seen in two frames inside the motion, marker 2 never, marker 3 at its end.
  const auto seen_m = [](double t_s, int marker) -> std::optional<Eigen::Vector3d> {
    const bool gap = marker == 1 && t_s > 0.15 && t_s < 0.35;
    if (gap || marker == 2 || (marker == 3 && t_s > 3.85)) return std::nullopt;
    return Eigen::Vector3d(t_s, 2.0 * t_s, marker);
  };
  Add({{0.0, {0.0}}, {4.0, {0.006}}}, seen_m);
  const ObservedExperiment observed = Observed();
  ASSERT_EQ(observed.samples.size(), 4U);
  const Sample& first = observed.samples[0];
  EXPECT_EQ(first.count, Eigen::Vector4i(11, 9, 0, 11));
  EXPECT_TRUE(first.position_m.col(0).isApprox(Eigen::Vector3d(0.5, 1.0, 0.0), 1e-12));
  EXPECT_TRUE(first.position_m.col(1).isApprox(Eigen::Vector3d(0.5, 1.0, 1.0), 1e-12))
      << "the mean of all frames, as of marker 0, not of those that saw it";
  EXPECT_TRUE(first.position_m.col(2).array().isNaN().all());
  const Sample& last = observed.samples[3];
  EXPECT_EQ(last.count, Eigen::Vector4i(10, 10, 0, 0)) << "nothing tells where marker 3 went";
  EXPECT_TRUE(last.position_m.col(3).array().isNaN().all());
}

/// A window of a motion may have two frames: one of them is not their middle.
TEST_F(ObserveTest, AveragesOverBothFramesOfAFastMotion) {
  const auto seen_m = [](double t_s, int marker) -> std::optional<Eigen::Vector3d> {
    if (marker == 0 && std::abs(t_s - 0.1) < 0.01) return std::nullopt;
    if (marker == 1 && t_s < 0.01) return std::nullopt;
    return Eigen::Vector3d(t_s, 2.0 * t_s, marker);
  };
  Add({{0.0, {0.0}}, {0.4, {0.006}}}, seen_m);
  const Sample first = Observed().samples[0];
  ASSERT_EQ(first.frame_t_s.size(), 2U);
  EXPECT_EQ(first.count, Eigen::Vector4i(1, 0, 2, 2));
  EXPECT_NEAR(first.position_m(0, 0), 0.05, 1e-12);
  EXPECT_TRUE(first.position_m.col(1).array().isNaN().all()) << "nothing was seen before it";
}

TEST_F(ObserveTest, MostFramesOfAMotionMustSeeAMarker) {
  const auto seen_m = [](double t_s, int marker) -> std::optional<Eigen::Vector3d> {
    if (marker == 0 && t_s > 0.15 && t_s < 1.95) return std::nullopt;
    return Eigen::Vector3d(t_s, 0.0, marker);
  };
  Add({{0.0, {0.0}}, {4.0, {0.006}}}, seen_m);
  const ObservedExperiment observed = Observed();
  EXPECT_EQ(observed.samples[0].count[0], 0) << "2 of 11";
  EXPECT_EQ(observed.samples[1].count[0], 0) << "1 of 10";
  EXPECT_EQ(observed.samples[2].count[0], 10);
}

/// A body at rest is where it was, whenever it was seen.
TEST_F(ObserveTest, InAHoldWhatWasSeenCounts) {
  Add({{0.0, {0.003}}, {0.5, {0.003}}},
      [](double t_s, int marker) -> std::optional<Eigen::Vector3d> {
        if (marker == 0 && t_s > 0.15) return std::nullopt;
        return Eigen::Vector3d(t_s, 0.0, marker);
      });
  const Sample first = Observed().samples[0];
  EXPECT_TRUE(first.still);
  EXPECT_EQ(first.count[0], 2);
  EXPECT_NEAR(first.position_m(0, 0), 0.05, 1e-12);
}

TEST_F(ObserveTest, AReferenceWindowStandsForTheRestPositionsInTheFrameThatMeasured) {
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
  T_robot_camera.linear() =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
  T_robot_camera.translation() << 0.1, -0.2, 0.5;
  const Eigen::Isometry3d T_camera_robot = T_robot_camera.inverse();
  const Eigen::Vector3d moved_m(0.001, 0.002, -0.003);
  // The camera says all of it a decimetre off: only what moves counts.
  const Eigen::Vector3d off_m(0.1, 0.0, 0.0);
  experiment::Recording& recording =
      Add({{0.0, {0.003}}, {10.0, {0.003}}}, [&](double t_s, int marker) {
        const Eigen::Vector3d& rest_m =
            body_.markers[static_cast<std::size_t>(marker)].point.rest_m;
        return std::optional<Eigen::Vector3d>(
            T_camera_robot * Eigen::Vector3d(rest_m + (t_s < 4.95 ? 0.0 : 1.0) * moved_m) + off_m);
      });
  recording.frame = experiment::MeasurementFrame::kCamera;
  recording.T_robot_camera = T_robot_camera;
  recording.reference = experiment::Reference{{0.0, 4.9}};
  recording.steady_window_s = experiment::TimeWindow{5.0, 10.0};
  const ObservedExperiment observed = Observed();
  EXPECT_TRUE(observed.recordings[0].held_until_s.has_value());
  ASSERT_FALSE(observed.samples.empty());
  for (const Sample& sample : observed.samples) {
    for (int m = 0; m < 4; ++m) {
      const Eigen::Vector3d expected_m =
          T_camera_robot * (body_.markers[static_cast<std::size_t>(m)].point.rest_m + moved_m);
      EXPECT_LT((sample.position_m.col(m) - expected_m).norm(), 1e-12);
    }
  }
}

TEST_F(ObserveTest, ADepthCameraSeesWhatIsBeforeItAndNothingThatCountsFromAHeldShape) {
  const auto seen_at = [&](double z_m) {
    return [z_m](double /*t_s*/, int marker) {
      return std::optional<Eigen::Vector3d>({0.0, 0.0, marker == 2 ? z_m : 0.4});
    };
  };
  const auto add = [&](double begin_s, double z_m) -> experiment::Recording& {
    experiment::Recording& recording =
        Add({{begin_s, {0.003}}, {begin_s + 4.0, {0.003}}}, seen_at(z_m));
    recording.frame = experiment::MeasurementFrame::kCamera;
    return recording;
  };
  add(0.0, 0.5);
  add(10.0, -0.5);
  add(20.0, 0.5).reference = experiment::Reference{{20.0, 21.0}};
  add(30.0, 0.5).frame = experiment::MeasurementFrame::kRobot;
  const ObservedExperiment observed = Observed();
  ASSERT_EQ(observed.recordings.size(), 4U);
  EXPECT_TRUE(observed.recordings[0].by_depth_camera);
  EXPECT_FALSE(observed.recordings[1].by_depth_camera);
  EXPECT_FALSE(observed.recordings[2].by_depth_camera);
  EXPECT_FALSE(observed.recordings[3].by_depth_camera);
  EXPECT_TRUE(HasDepthCamera(observed));
}

TEST_F(ObserveTest, AReferenceInEquilibriumIsNotTheUndeformedShape) {
  const Eigen::Vector3d sagged_m(0.0, 0.0, -0.004);
  Add({{0.0, {0.003}}, {10.0, {0.003}}}, [&](double /*t_s*/, int marker) {
    const Eigen::Vector3d& rest_m = body_.markers[static_cast<std::size_t>(marker)].point.rest_m;
    return std::optional<Eigen::Vector3d>(rest_m + sagged_m);
  }).reference = experiment::Reference{{0.0, 4.9}, experiment::ReferenceShape::kEquilibrium};
  const ObservedExperiment observed = Observed();
  EXPECT_FALSE(observed.recordings[0].held_until_s.has_value());
  const Eigen::Vector3d expected_m = body_.markers[0].point.rest_m + sagged_m;
  EXPECT_LT((observed.samples[0].position_m.col(0) - expected_m).norm(), 1e-12);
}

TEST_F(ObserveTest, TakesFewerMomentsWhereThereAreManyRecordings) {
  for (int r = 0; r < 6; ++r) {
    const double begin_s = 20.0 * r;
    Add({{begin_s, {0.0}}, {begin_s + 4.0, {0.006}}, {begin_s + 14.0, {0.006}}});
  }
  EXPECT_EQ(Observed().samples.size(), 54U);
  const ObservedExperiment few = Observe(experiment_, body_, {.most_samples = 40});
  EXPECT_LE(few.samples.size(), 40U);
  EXPECT_GE(few.samples.size(), 12U);
  EXPECT_EQ(few.samples.back().recording, 5);
}

TEST_F(ObserveTest, RefusesWhatIsNotTheRobotsAndWhatHasNoMarkers) {
  Add({{0.0, {0.0}}, {4.0, {0.006}}}).markers.reset();
  EXPECT_THROW(Observed(), InputError);
  Add({{10.0, {0.0}}, {14.0, {0.006}}}).markers->names[1] = "stranger";
  EXPECT_THROW(Observed(), InputError);
  experiment_.recordings[1].markers->names[1] = "m1";
  EXPECT_EQ(Observed().samples.front().recording, 1);
  experiment_.recordings[1].actuation->columns[0].cable = "stranger";
  EXPECT_THROW(Observed(), InputError);
}

TEST_F(ObserveTest, BetweenRecordingsCommandsGoToZeroInHalfTheRest) {
  Add({{0.0, {0.0}}, {4.0, {0.006}}});
  Add({{12.0, {0.0}}, {14.0, {0.004}}});
  experiment_.rest_between_s = 8.0;
  const Timeline timeline = Observed().timeline;
  EXPECT_NEAR(timeline.CommandAt(2.0)[0], 0.003, 1e-15);
  EXPECT_NEAR(timeline.CommandAt(6.0)[0], 0.003, 1e-15);
  EXPECT_NEAR(timeline.CommandAt(8.0)[0], 0.0, 1e-15);
  EXPECT_NEAR(timeline.CommandAt(11.0)[0], 0.0, 1e-15);
  EXPECT_NEAR(timeline.CommandAt(13.0)[0], 0.002, 1e-15);
  EXPECT_TRUE(std::isnan(timeline.CommandAt(2.0)[1])) << "no column: not driven";
  EXPECT_EQ(timeline.begin_s, (std::vector<double>{0.0, 12.0}));
}

TEST_F(ObserveTest, ScatterIsTheNoiseAboutAStraightWay) {
  std::mt19937 random(kObserveSeed);
  std::normal_distribution<double> normal;
  const Eigen::Vector3d sigma_m(2e-4, 4e-4, 1e-3);
  Add({{0.0, {0.0}}, {20.0, {0.006}}}, [&](double t_s, int /*marker*/) {
    const Eigen::Vector3d noise(normal(random), normal(random), normal(random));
    return std::optional<Eigen::Vector3d>(Eigen::Vector3d::Constant(0.01 * t_s) +
                                          sigma_m.cwiseProduct(noise));
  });
  // 800 positions: 2.5 % of one sigma.
  const Eigen::Vector3d measured_m = Observed().sigma_m;
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(measured_m[axis] / sigma_m[axis], 1.0, 0.1) << "seed " << kObserveSeed;
  }
  // What is stated holds unless there is clearly more.
  experiment_.markers_sigma_m = Eigen::Vector3d(5e-4, 4.2e-4, 1e-4);
  const Eigen::Vector3d stated_m = Observed().sigma_m;
  EXPECT_EQ(stated_m.x(), 5e-4);
  EXPECT_EQ(stated_m.y(), 4.2e-4);
  EXPECT_EQ(stated_m.z(), measured_m.z());
}

TEST(Scatter, OfTooFewFramesIsUnknown) {
  const Scatter none;
  EXPECT_TRUE(none.Measured_m().array().isNaN().all());
  EXPECT_EQ(none.Sigma_m(std::nullopt), Eigen::Vector3d::Constant(1e-6));
  EXPECT_EQ(none.Sigma_m(Eigen::Vector3d::Constant(3e-4)), Eigen::Vector3d::Constant(3e-4));
}

}  // namespace
}  // namespace palpate::diagnosis
