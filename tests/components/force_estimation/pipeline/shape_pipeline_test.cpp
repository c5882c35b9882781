// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/pipeline/shape_pipeline.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/components/force_estimation/shape_scene.hpp"
#include "tests/components/force_estimation/test_bodies.hpp"

namespace palpate::force_estimation {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::SizeIs;

const Eigen::Vector3d kBeamTip_m(0.0, 0.015, 0.03);

/// The pipeline of a beam with an estimator that records its inputs and returns given results.
class ShapePipelineTest : public testing::Test {
 protected:
  ShapePipelineTest() : model_(Build(BeamRobot())) {
    estimate_.status = Status(StatusCode::kNoContact, {});
    estimate_.x_m = model_->RestState().x_m;
    features_.resize(model_->body().feature_points.size());
  }

  ShapePipeline MakePipeline(int contact_free_frames, std::vector<ContactSite> contacts = {}) {
    return ShapePipeline(
        model_->body(), std::move(contacts), contact_free_frames,
        {.update = [this](const ShapeFrame& frame) -> const ForceEstimate& {
           frames_.push_back(frame);
           return estimate_;
         },
         .features = [this]() -> const std::vector<FeatureReport>& { return features_; },
         .prepare_next = [] {}});
  }
  static PerceivedShape Seen() {
    PerceivedShape shape;
    shape.perception = Status::Ok();
    return shape;
  }
  static PerceivedShape NotSeen() {
    PerceivedShape shape;
    shape.perception = Status(StatusCode::kNoRobotSeen, "too dark");
    return shape;
  }
  std::vector<bool> ContactFree() const {
    std::vector<bool> flags;
    for (const ShapeFrame& frame : frames_) flags.push_back(frame.untouched);
    return flags;
  }
  std::vector<std::string> LastContacts() const {
    std::vector<std::string> names;
    for (const SeenContact& contact : frames_.back().contacts) names.push_back(contact.name);
    return names;
  }

  std::unique_ptr<robot::RobotModel> model_;
  ForceEstimate estimate_;
  std::vector<FeatureReport> features_;
  std::vector<ShapeFrame> frames_;
};

TEST_F(ShapePipelineTest, CountsTheFirstFramesWithARobotAsContactFree) {
  ShapePipeline pipeline = MakePipeline(2);
  pipeline.Update(Seen());
  pipeline.Update(NotSeen());
  pipeline.Update(Seen());
  pipeline.Update(Seen());
  EXPECT_THAT(ContactFree(), ElementsAre(true, true, true, false));
}

TEST_F(ShapePipelineTest, KeepsTheMarkOfAContactFreeFrame) {
  ShapePipeline pipeline = MakePipeline(0);
  PerceivedShape contact_free = Seen();
  contact_free.frame.untouched = true;
  pipeline.Update(std::move(contact_free));
  pipeline.Update(Seen());
  EXPECT_THAT(ContactFree(), ElementsAre(true, false));
}

TEST_F(ShapePipelineTest, ReportsPerceptionsReasonWhereTheRobotIsNotSeen) {
  ShapePipeline pipeline = MakePipeline(0);
  estimate_.status = Status(StatusCode::kNoRobotSeen, "only 0 points");
  const PipelineResult& result = pipeline.Update(NotSeen());
  EXPECT_EQ(result.estimate.status.message(), "too dark");
  EXPECT_FALSE(result.state.ok());
  EXPECT_TRUE(result.state_is_known);  // where perception is to search
  pipeline.Update(Seen());
  EXPECT_EQ(result.estimate.status.message(), "only 0 points");
  estimate_.status = Status(StatusCode::kInvalidInput, "a cable input");
  pipeline.Update(NotSeen());
  EXPECT_EQ(result.estimate.status.message(), "a cable input");
}

TEST_F(ShapePipelineTest, PredictsTheShapeInSinglePrecision) {
  ShapePipeline pipeline = MakePipeline(0);
  EXPECT_EQ(pipeline.PredictedNodes_m().cols(), 0);
  estimate_.x_m *= 1.0 + 0.1 / 3.0;
  pipeline.Update(Seen());
  const Eigen::Matrix3Xf nodes_m = pipeline.PredictedNodes_m();
  EXPECT_EQ(nodes_m.reshaped(), estimate_.x_m.cast<float>());

  const Eigen::VectorXd x_m = estimate_.x_m;
  estimate_.x_m *= 2.0;
  estimate_.status = Status(StatusCode::kNotConverged, {});
  EXPECT_FALSE(pipeline.Update(Seen()).state_is_known);
  EXPECT_EQ(pipeline.PredictedNodes_m(), nodes_m);
  estimate_.status = Status::Ok();
  estimate_.x_m[4] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(pipeline.Update(Seen()).state_is_known);
  EXPECT_EQ(pipeline.PredictedNodes_m(), nodes_m);
}

TEST_F(ShapePipelineTest, KnowsTheStateWhileTheDepthBiasIsEstimated) {
  ShapePipeline pipeline = MakePipeline(1);
  estimate_.status = Status(StatusCode::kNoCalibration, "the depth bias is being estimated");
  const PipelineResult& result = pipeline.Update(Seen());
  EXPECT_TRUE(result.state.ok());
  EXPECT_EQ(result.estimate.status.code(), StatusCode::kNoCalibration);
}

TEST_F(ShapePipelineTest, KnownContactsReplaceThoseOfPerceptionAndTheSettingsThoseOfLoads) {
  PerceivedShape shape = Seen();
  shape.frame.contacts.resize(2);
  shape.frame.contacts[0].name = "near";
  shape.frame.contacts[0].position_m = kBeamTip_m;
  shape.frame.contacts[1].name = "far";
  shape.frame.contacts[1].position_m = {-0.05, 0.015, 0.03};
  shape.loads = {{.name = "load_1", .position_m = kBeamTip_m}};
  ShapePipeline without_settings = MakePipeline(0);
  without_settings.Update(shape);
  EXPECT_THAT(LastContacts(), ElementsAre("load_1", "far"));
  ShapePipeline with_settings = MakePipeline(0, {{.name = "given", .position_m = kBeamTip_m}});
  with_settings.Update(shape);
  EXPECT_THAT(LastContacts(), ElementsAre("given", "far"));
}

TEST_F(ShapePipelineTest, MovesKnownContactsWithThePredictedShape) {
  ShapePipeline pipeline = MakePipeline(0, {{.name = "given", .position_m = kBeamTip_m}});
  estimate_.x_m += Eigen::Vector3d(0.0, 0.0, -0.01).replicate(estimate_.x_m.size() / 3, 1);
  pipeline.Update(Seen());
  pipeline.Update(Seen());
  ASSERT_THAT(frames_, Each(testing::Field(&ShapeFrame::contacts, SizeIs(1))));
  EXPECT_NEAR(frames_[0].contacts[0].position_m.z(), 0.03, 1e-6);
  EXPECT_NEAR(frames_[1].contacts[0].position_m.z(), 0.02, 1e-6);
}

/// A push that perception did not see, at a place that --contact gives: it has that name, and is
/// not searched for.
TEST(ShapePipelineOfFourLegs, EstimatesTheForceAtAGivenContact) {
  const Eigen::Vector3d place_m(0.0, 0.0, 0.125);
  ShapeScene scene(51);
  const std::vector<robot::ActuatorCommand> cables(4);
  const Eigen::VectorXd free_m = SolveTruth(*scene.model, cables, {}).x_m;
  const robot::DeadLoad push = LoadAt(*scene.model, place_m, 0.006, {0.0, 0.0, -1.0});
  const Eigen::VectorXd pushed_m = SolveTruth(*scene.model, cables, {push}).x_m;
  ShapeConfig shape_config;
  shape_config.untouched_frames = 3;
  ShapePipeline pipeline(*scene.model, WithContacts({"top: 0, 0, 0.125, 0.006"}), shape_config,
                         robot::CalibrationFile());
  std::mt19937 random(1);
  ForceEstimate estimate;
  for (int k = 0; k < 6; ++k) {
    PerceivedShape shape;
    shape.perception = Status::Ok();
    shape.frame = FrameOf(Cast(scene, k < 3 ? free_m : pushed_m, BenchPose()));
    AddDepthNoise(random, &shape.frame.views[0].cloud);
    shape.frame.t_s = 0.033 * k;
    shape.frame.cables = cables;
    estimate = pipeline.Update(std::move(shape)).estimate;
    EXPECT_EQ(estimate.status.code() == StatusCode::kNoCalibration, k < 3);
  }
  ASSERT_TRUE(estimate.status.ok()) << estimate.status.message();
  std::vector<std::string> names;
  for (const ContactForce& contact : estimate.contacts) names.push_back(contact.name);
  ASSERT_THAT(names, ElementsAre("top"));
  EXPECT_NEAR(estimate.contacts[0].force_N.z(), -1.0, 0.1);
}

}  // namespace
}  // namespace palpate::force_estimation
