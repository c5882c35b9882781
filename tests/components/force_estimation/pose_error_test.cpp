// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/pose_error.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <iterator>
#include <limits>

#include "components/force_estimation/marker_force_estimator.hpp"
#include "libs/core/index.hpp"
#include "libs/core/statistics.hpp"
#include "tests/components/force_estimation/test_bodies.hpp"

namespace palpate::force_estimation {
namespace {

const Eigen::Vector3d kPushed_m(0.0, 0.007, 0.03);
constexpr char kPushedSite[] = "tip: 0, 0.007, 0.03, 0.005";
const PoseError kPoseError{
    .about_m = {0.1, -0.4, 0.2}, .translation_sigma_m = 2e-3, .rotation_sigma_rad = 5e-3};

const PoseError kSmallPoseError{
    .about_m = {0.1, -0.4, 0.2}, .translation_sigma_m = 3e-4, .rotation_sigma_rad = 7e-4};

/// The markers as a camera of this pose error sees them: one draw for the whole frame.
void Misplace(const PoseError& error, std::mt19937& random, MarkerFrame* frame) {
  const Eigen::Vector3d shift_m = NormalNoise(error.translation_sigma_m, random);
  const Eigen::Vector3d turn = NormalNoise(error.rotation_sigma_rad, random);
  const Eigen::AngleAxisd rotation(turn.norm(), turn.normalized());
  for (MarkerObservation& marker : frame->markers) {
    marker.position_m = error.about_m + shift_m + rotation * (marker.position_m - error.about_m);
  }
  frame->pose_error = error;
}

TEST(PoseError, ColumnsAreTheDerivativeOfTheMotion) {
  const Eigen::Matrix3Xd points_m = Eigen::Matrix3Xd::Random(3, 4);
  Eigen::Matrix3Xd from_m = Eigen::Matrix3Xd::Constant(3, 4, std::nan(""));
  from_m.col(2) = Eigen::Vector3d(0.3, 0.2, -0.1);
  const Eigen::MatrixXd columns_m = PoseErrorColumns(kPoseError, points_m, from_m);
  constexpr double kStep = 1e-4;
  for (Eigen::Index p = 0; p < 6; ++p) {
    const auto moved = [&](const Eigen::Vector3d& point_m, double step) -> Eigen::Vector3d {
      if (p >= 3)
        return point_m + step * kPoseError.translation_sigma_m * Eigen::Vector3d::Unit(p - 3);
      const Eigen::AngleAxisd turn(step * kPoseError.rotation_sigma_rad, Eigen::Vector3d::Unit(p));
      return kPoseError.about_m + turn * (point_m - kPoseError.about_m);
    };
    for (Eigen::Index m = 0; m < 4; ++m) {
      Eigen::Vector3d derivative_m =
          (moved(points_m.col(m), kStep) - moved(points_m.col(m), -kStep)) / (2.0 * kStep);
      if (m == 2) {
        derivative_m -=
            (moved(from_m.col(m), kStep) - moved(from_m.col(m), -kStep)) / (2.0 * kStep);
      }
      EXPECT_LT((columns_m.block<3, 1>(3 * m, p) - derivative_m).norm(), 1e-9) << p << " " << m;
    }
  }
}

/// The camera's own place is uncertain by that of the middle and by the turn about it.
TEST(PoseError, OfACalibrationIsThatOfTheMiddle) {
  robot::CalibratedPose pose;
  pose.T_robot_camera.translation() = Eigen::Vector3d(0.0, 0.0, 0.5);
  const Eigen::Vector3d middle_m(0.0, 0.0, 0.1);
  pose.rotation_error_rad.setConstant(2e-3);
  const double by_turn_m = 0.4 * 2e-3;
  pose.translation_error_m =
      Eigen::Vector3d(std::hypot(3e-4, by_turn_m), std::hypot(2e-4, by_turn_m), 1e-4);
  const PoseError error = CalibratedPoseError(pose, middle_m);
  EXPECT_EQ(error.about_m, middle_m);
  EXPECT_NEAR(error.translation_sigma_m, 3e-4, 1e-9);
  EXPECT_DOUBLE_EQ(error.rotation_sigma_rad, 2e-3);
}

/// Without a reference window the error is the same for all markers: several times their noise, and
/// twenty times that of their mean.
TEST(PoseError, IntervalsHoldTheTruthWhateverThePoseIsOff) {
  const auto model = Build(BeamRobot());
  const Eigen::Vector3d force_N(0.0, 0.0, -0.3);
  const MarkerFrame clean = FrameUnder(*model, {}, {LoadAt(*model, kPushed_m, 0.005, force_N)});
  MarkerForceEstimator estimator(*model, WithContacts({kPushedSite}));
  MarkerForceEstimator trusting(*model, WithContacts({kPushedSite}));
  std::mt19937 random(20261128);
  constexpr int kDraws = 40;
  int covered = 0;
  int covered_where_exact = 0;
  const auto covers = [&](const ContactForce& contact) {
    return std::abs(contact.force_N.norm() - force_N.norm()) <= contact.ci95_N ? 1 : 0;
  };
  for (int draw = 0; draw < kDraws; ++draw) {
    MarkerFrame frame = clean;
    AddNoise(1e-4, random, &frame);
    Misplace(kSmallPoseError, random, &frame);
    const ForceEstimate& estimate = estimator.Update(frame);
    ASSERT_EQ(estimate.contacts.size(), 1U) << estimate.status.message();
    covered += covers(estimate.contacts[0]);
    frame.pose_error = {};
    covered_where_exact += covers(trusting.Update(frame).contacts[0]);
  }
  EXPECT_GE(covered, 0.95 * kDraws);
  EXPECT_LT(covered_where_exact, 0.8 * kDraws);
}

/// Neither at a given place nor where contacts are searched.
TEST(PoseError, IsNoContact) {
  const auto model = Build(BeamRobot());
  const MarkerFrame at_rest = FrameUnder(*model, {}, {});
  for (const std::vector<std::string>& contacts :
       {std::vector<std::string>{kPushedSite}, std::vector<std::string>{}}) {
    MarkerForceEstimator estimator(*model, WithContacts(contacts));
    MarkerForceEstimator trusting(*model, WithContacts(contacts));
    std::mt19937 random(7);
    int found = 0;
    int found_where_exact = 0;
    constexpr int kDraws = 4;
    for (int draw = 0; draw < kDraws; ++draw) {
      MarkerFrame frame = at_rest;
      AddNoise(1e-4, random, &frame);
      Misplace(kPoseError, random, &frame);
      found += estimator.Update(frame).status.ok() ? 1 : 0;
      frame.pose_error = {};
      found_where_exact += trusting.Update(frame).status.ok() ? 1 : 0;
    }
    EXPECT_EQ(found, 0) << contacts.size();
    EXPECT_GE(found_where_exact, kDraws / 2) << contacts.size();
  }
}

/// A marker that is off by far more than its noise makes a search find something, whose interval
/// then holds zero. That is no contact-free frame.
TEST(PoseError, BelowTheNoiseExplainsNoContact) {
  const auto model = Build(BeamRobot());
  MarkerFrame frame = FrameUnder(*model, {}, {});
  frame.markers[6].position_m.y() += 8e-3;
  MarkerForceEstimator exact(*model, WithContacts({}));
  const ForceEstimate expected = exact.Update(frame);
  ASSERT_EQ(expected.status.code(), StatusCode::kOk);
  for (const ContactForce& contact : expected.contacts) {
    ASSERT_EQ(contact.status.code(), StatusCode::kNoContact);
  }
  const auto code_with = [&](const PoseError& error) {
    frame.pose_error = error;
    MarkerForceEstimator estimator(*model, WithContacts({}));
    return estimator.Update(frame).status.code();
  };
  PoseError tiny = kPoseError;
  tiny.translation_sigma_m = tiny.rotation_sigma_rad = 1e-6;
  EXPECT_EQ(code_with(tiny), StatusCode::kOk);
  EXPECT_EQ(code_with(kPoseError), StatusCode::kNoContact);
}

/// The fitter holds the last candidates that it tried, not those that the search chose.
TEST(PoseError, WidensWhereContactsAreSearched) {
  const auto model = Build(BeamRobot());
  for (const double force_N : {0.5, 2.0}) {
    MarkerFrame frame =
        FrameUnder(*model, {}, {LoadAt(*model, kPushed_m, 0.005, {0.0, 0.0, -force_N})});
    MarkerForceEstimator exact(*model, WithContacts({}));
    const ForceEstimate expected = exact.Update(frame);
    frame.pose_error = kSmallPoseError;
    MarkerForceEstimator estimator(*model, WithContacts({}));
    const ForceEstimate& estimate = estimator.Update(frame);
    ASSERT_EQ(estimate.contacts.size(), expected.contacts.size()) << force_N;
    for (std::size_t c = 0; c < estimate.contacts.size(); ++c) {
      EXPECT_GT(estimate.contacts[c].covariance_N2.trace(),
                expected.contacts[c].covariance_N2.trace())
          << force_N;
    }
    EXPECT_EQ(estimator.Misfit().response_m.cols(), 3 * std::ssize(estimate.contacts)) << force_N;
  }
}

/// After a reference window only the turn of a displacement counts.
TEST(PoseError, WidensLessAfterAReferenceWindow) {
  const auto model = Build(BeamRobot());
  const Eigen::Vector3d force_N(0.0, 0.0, -0.3);
  MarkerFrame reference = FrameUnder(*model, {}, {});
  MarkerFrame frame = FrameUnder(*model, {}, {LoadAt(*model, kPushed_m, 0.005, force_N)});
  reference.reference = ReferenceShape::kEquilibrium;
  const auto half_width_N = [&](const PoseError& error, bool with_reference) {
    MarkerForceEstimator estimator(*model, WithContacts({kPushedSite}));
    reference.pose_error = frame.pose_error = error;
    if (with_reference) static_cast<void>(estimator.Update(reference));
    return estimator.Update(frame).contacts[0].ci95_N;
  };
  const double exact_N = half_width_N({}, true);
  const double with_pose_N = half_width_N(kSmallPoseError, true);
  EXPECT_GT(with_pose_N, exact_N);
  EXPECT_LT(with_pose_N, 0.5 * half_width_N(kSmallPoseError, false));
}

}  // namespace
}  // namespace palpate::force_estimation
