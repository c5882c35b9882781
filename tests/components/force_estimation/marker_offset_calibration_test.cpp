// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <limits>

#include "components/force_estimation/marker_force_estimator.hpp"
#include "tests/components/force_estimation/test_bodies.hpp"

namespace palpate::force_estimation {
namespace {

const Eigen::Vector3d kTareHub(0.0, 0.0, 0.125);
const Eigen::Vector3d kTareForce_N(0.2, -0.1, -0.7);

/// four_leg whose markers are stuck on some millimetres from where the robot file has them.
class MarkerTareTest : public testing::Test {
 protected:
  MarkerTareTest()
      : model_(Build(QuickFourLegRobot())),
        estimator_(*model_, WithContacts({"hub: 0, 0, 0.125, 0.008"})) {
    std::mt19937 random(4);
    for (size_t m = 0; m < model_->body().markers.size(); ++m) {
      offsets_m_.push_back(NormalNoise(3e-3, random));
    }
  }

  MarkerFrame Shifted(MarkerFrame frame) const {
    for (size_t m = 0; m < offsets_m_.size(); ++m) frame.markers[m].position_m += offsets_m_[m];
    return frame;
  }
  MarkerFrame Reference(const fem::StaticState& state, ReferenceShape shape) const {
    MarkerFrame frame = Shifted(FrameOf(*model_, state, cables_));
    frame.reference = shape;
    return frame;
  }
  MarkerFrame Undeformed() const {
    return Reference(model_->RestState(), ReferenceShape::kUndeformed);
  }
  MarkerFrame UnderForce() {
    return Shifted(FrameUnder(*model_, cables_, {LoadAt(*model_, kTareHub, 0.008, kTareForce_N)}));
  }
  void ExpectTheForce(const MarkerFrame& frame) {
    const ForceEstimate& estimate = estimator_.Update(frame);
    ASSERT_TRUE(estimate.status.ok()) << ToString(estimate.status.code());
    EXPECT_LT((estimate.contacts[0].force_N - kTareForce_N).norm(), 1e-6);
    EXPECT_LT(estimate.residual_rms_m, 1e-9);
  }

  std::vector<robot::ActuatorCommand> cables_{4, {Kind::kDisplacement, 0.004}};
  std::unique_ptr<robot::RobotModel> model_;
  MarkerForceEstimator estimator_;
  std::vector<Eigen::Vector3d> offsets_m_;
};

TEST_F(MarkerTareTest, UndeformedReferenceRemovesTheOffsets) {
  const ForceEstimate& tared = estimator_.Update(Undeformed());
  EXPECT_EQ(tared.status.code(), StatusCode::kNoCalibration);
  EXPECT_TRUE(tared.contacts.empty());
  ExpectTheForce(UnderForce());
}

TEST_F(MarkerTareTest, EquilibriumReferenceRemovesTheOffsets) {
  const fem::StaticState at_rest = SolveTruth(*model_, cables_, {});
  EXPECT_EQ(estimator_.Update(Reference(at_rest, ReferenceShape::kEquilibrium)).status.code(),
            StatusCode::kNoCalibration);
  ExpectTheForce(UnderForce());
}

TEST_F(MarkerTareTest, WithoutItTheOffsetsSpoilTheForce) {
  const ForceEstimate& estimate = estimator_.Update(UnderForce());
  ASSERT_FALSE(estimate.contacts.empty());
  EXPECT_GT((estimate.contacts[0].force_N - kTareForce_N).norm(), 0.01);
}

TEST_F(MarkerTareTest, AveragesTheReferenceFrames) {
  const Eigen::Vector3d shake_m(1e-3, -2e-3, 5e-4);
  for (const double sign : {-1.0, 1.0}) {
    MarkerFrame frame = Undeformed();
    for (MarkerObservation& marker : frame.markers) marker.position_m += sign * shake_m;
    EXPECT_EQ(estimator_.Update(frame).status.code(), StatusCode::kNoCalibration);
  }
  ExpectTheForce(UnderForce());
}

TEST_F(MarkerTareTest, NewReferenceReplacesTheOldOne) {
  MarkerFrame wrong = Undeformed();
  for (MarkerObservation& marker : wrong.markers) marker.position_m.x() += 0.005;
  estimator_.Update(wrong);
  estimator_.Update(UnderForce());
  estimator_.Update(Undeformed());
  ExpectTheForce(UnderForce());
}

TEST_F(MarkerTareTest, FramesOfAnotherShapeStartAgain) {
  MarkerFrame wrong = Undeformed();
  for (MarkerObservation& marker : wrong.markers) marker.position_m.x() += 0.005;
  estimator_.Update(wrong);
  const fem::StaticState at_rest = SolveTruth(*model_, cables_, {});
  estimator_.Update(Reference(at_rest, ReferenceShape::kEquilibrium));
  ExpectTheForce(UnderForce());
}

TEST_F(MarkerTareTest, MarkerThatTheReferenceDoesNotShowIsNotUsed) {
  MarkerFrame reference = Undeformed();
  reference.markers[3].valid = false;
  estimator_.Update(reference);
  MarkerFrame frame = UnderForce();
  frame.markers[3].position_m.setConstant(0.3);
  ExpectTheForce(frame);
  EXPECT_EQ(estimator_.Update(frame).degrees_of_freedom, 21 - 3);  // one more is on the contact
}

TEST_F(MarkerTareTest, NanInTheReferenceIsNotSeen) {
  estimator_.Update(Undeformed());
  MarkerFrame reference = Undeformed();
  reference.markers[2].position_m.z() = std::numeric_limits<double>::quiet_NaN();
  estimator_.Update(reference);
  ExpectTheForce(UnderForce());
  EXPECT_EQ(estimator_.Update(UnderForce()).degrees_of_freedom, 24 - 3);
}

TEST_F(MarkerTareTest, ReferenceThatTheModelCannotReachIsSaid) {
  MarkerFrame reference = Reference(model_->RestState(), ReferenceShape::kEquilibrium);
  reference.cables[0] = {Kind::kTension, 100.0};
  estimator_.Update(reference);
  const ForceEstimate& estimate = estimator_.Update(UnderForce());
  EXPECT_EQ(estimate.status.code(), StatusCode::kTensionLimit);
  EXPECT_TRUE(estimate.contacts.empty());
}

}  // namespace
}  // namespace palpate::force_estimation
