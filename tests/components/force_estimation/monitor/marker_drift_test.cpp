// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "components/force_estimation/pipeline/marker_pipeline.hpp"
#include "libs/robot/robot_model.hpp"
#include "tests/support/robots.hpp"

/// The four legs with nine markers that a camera sees, turned into the robot's frame by a
/// calibration that held once.
namespace palpate::force_estimation {
namespace {

using State = DriftReport::State;
using Kind = robot::ActuatorCommand::Kind;

constexpr double kMarkerNoise_m = 3e-4;
constexpr double kPeriod_s = 1.0 / 30.0;

std::unique_ptr<robot::RobotModel> FourLegs() {
  return std::make_unique<robot::RobotModel>(
      robot::BuildRobotBody(test_support::LinearFourLegRobot()));
}

class MarkerDriftTest : public testing::Test {
 protected:
  void Start(const std::vector<std::string>& contacts) {
    Config config;
    config.marker_sigma_m = kMarkerNoise_m;
    config.contacts = contacts;
    pipeline_ = std::make_unique<MarkerPipeline>(*robot_, config, robot::CalibrationFile());
  }

  /// Where the markers are with the cables pulled in so far and a force on the body, [3 x m].
  Eigen::Matrix3Xd Markers(const std::vector<double>& pulled_m, const Eigen::Vector3d& place_m,
                           const Eigen::Vector3d& force_N) {
    std::vector<robot::DeadLoad> loads;
    if (!force_N.isZero()) loads.push_back({truth_->Patch(place_m, 0.006).weights, force_N});
    SetCables(pulled_m);
    fem::StaticState state = truth_->RestState();
    EXPECT_TRUE(truth_->Solve(cables_, loads, &state).status.ok());
    Eigen::Matrix3Xd places_m(3, 9);
    for (std::size_t m = 0; m < 9; ++m) {
      places_m.col(static_cast<Eigen::Index>(m)) =
          truth_->body().markers[m].point.weights.Position(state.x_m);
    }
    return places_m;
  }
  void SetCables(const std::vector<double>& pulled_m) {
    cables_.clear();
    for (const double one_m : pulled_m) cables_.push_back({Kind::kDisplacement, one_m});
  }

  /// Shows them for so long; whether "moved" was said at any time.
  bool Watch(const Eigen::Matrix3Xd& places_m, double duration_s) {
    bool moved = false;
    for (const double end_s = t_s_ + duration_s; t_s_ < end_s; t_s_ += kPeriod_s) {
      MarkerFrame frame;
      frame.t_s = t_s_;
      frame.cables = cables_;
      for (const auto& place_m : places_m.colwise()) {
        const Eigen::Vector3d noise_m(normal_(random_), normal_(random_), normal_(random_));
        frame.markers.push_back({.valid = true, .position_m = place_m + kMarkerNoise_m * noise_m});
      }
      last_ = pipeline_->Update(std::move(frame)).drift;
      pipeline_->Monitor();
      moved = moved || last_.state == State::kMoved;
    }
    return moved;
  }

  /// By a camera that was shifted and turned about itself, its calibration kept.
  static Eigen::Matrix3Xd Seen(const Eigen::Matrix3Xd& places_m, const Eigen::Vector3d& shift_m,
                               const Eigen::Vector3d& turn_rad) {
    const Eigen::Vector3d eye_m(0.343, -0.198, 0.275);
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    if (!turn_rad.isZero()) turn = Eigen::AngleAxisd(turn_rad.norm(), turn_rad.normalized());
    return ((turn * (places_m.colwise() - eye_m)).colwise() + eye_m).colwise() + shift_m;
  }

  std::unique_ptr<robot::RobotModel> robot_ = FourLegs(), truth_ = FourLegs();
  std::unique_ptr<MarkerPipeline> pipeline_;
  std::vector<robot::ActuatorCommand> cables_;
  DriftReport last_;
  double t_s_ = 100.0;
  std::mt19937 random_{20261122};
  std::normal_distribution<double> normal_;
};

const std::string kTop = "top: 0, 0, 0.125, 0.006";
const Eigen::Vector3d kTop_m(0.0, 0.0, 0.125);
const Eigen::Vector3d kNoForce = Eigen::Vector3d::Zero();
const std::vector<double> kPulled_m = {0.004, 0.003, 0.002, 0.003};

/// While a force that is looked for acts, which takes up a part of the motion.
TEST_F(MarkerDriftTest, FindsACameraThatMovedByTwoMillimetresOrAThirdOfADegree) {
  const Eigen::Matrix3Xd places_m = Markers(kPulled_m, kTop_m, {0.3, 0.0, -0.6});
  for (int knock = 0; knock < 6; ++knock) {
    const Eigen::Vector3d unit = Eigen::Vector3d::Unit(knock % 3);
    const Eigen::Vector3d shift_m = (knock < 3 ? 2e-3 : 0.0) * unit;
    const Eigen::Vector3d turn_rad = (knock < 3 ? 0.0 : 5.24e-3) * unit;
    SCOPED_TRACE(testing::Message() << shift_m.transpose() << ", " << turn_rad.transpose());
    Start({kTop});
    EXPECT_FALSE(Watch(places_m, 7.0)) << last_.advice;
    EXPECT_EQ(last_.state, State::kHolds);
    EXPECT_TRUE(Watch(Seen(places_m, shift_m, turn_rad), 6.0));
    EXPECT_THAT(last_.advice, testing::HasSubstr("calibrate again"));
    const Eigen::Matrix3Xd off_m = Seen(places_m, shift_m, turn_rad) - places_m;
    const double error_m = 4.0 * last_.standard_error.tail<3>().norm() + 2e-4;
    EXPECT_NEAR(last_.motion.tail<3>().norm(), off_m.rowwise().mean().norm(), error_m);
    EXPECT_LT(last_.standard_error.tail<3>().maxCoeff(), 6e-4);
    Watch(places_m, 6.0);
    EXPECT_EQ(last_.state, State::kHolds);
  }
}

TEST_F(MarkerDriftTest, SaysNothingOfNoiseForcesAndCables) {
  Start({kTop});
  EXPECT_FALSE(Watch(Markers(kPulled_m, kTop_m, kNoForce), 60.0)) << last_.advice;
  EXPECT_EQ(last_.state, State::kHolds);
  EXPECT_FALSE(Watch(Markers(kPulled_m, kTop_m, {0.5, -0.3, -1.0}), 10.0)) << last_.advice;
  EXPECT_FALSE(Watch(Markers({0.001, 0.008, 0.006, 0.002}, kTop_m, kNoForce), 10.0))
      << last_.advice;
  EXPECT_EQ(last_.state, State::kHolds);
}

/// At a place where none is looked for.
TEST_F(MarkerDriftTest, AForceThatNobodyKnowsIsNoMotionOfTheCamera) {
  Start({kTop});
  EXPECT_FALSE(Watch(Markers(kPulled_m, kTop_m, kNoForce), 7.0)) << last_.advice;
  const Eigen::Vector3d place_m(0.06, 0.0, 0.085);
  EXPECT_FALSE(Watch(Markers(kPulled_m, place_m, {0.0, 1.0, 0.0}), 8.0)) << last_.advice;
  EXPECT_EQ(last_.state, State::kNotSeen);
}

}  // namespace
}  // namespace palpate::force_estimation
