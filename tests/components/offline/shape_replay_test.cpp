// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/forces/shape_replay.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "components/perception/predicted_surface.hpp"
#include "libs/app/yaml.hpp"
#include "libs/rgbd/png.hpp"
#include "libs/robot/robot_body.hpp"
#include "libs/robot/robot_description.hpp"
#include "tests/components/palpate/test_robot.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::offline {
namespace {

using experiment::Recording;
using experiment::RecordingKind;
using force_estimation::ForceEstimate;
using force_estimation::ShapeFrame;
using force_estimation::ShapePipeline;
using testing::Each;
using testing::ElementsAre;
using testing::SizeIs;

Eigen::Isometry3d LookingDown() {
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
  T_robot_camera.linear() = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  T_robot_camera.translation() = Eigen::Vector3d(0.03, 0.02, 0.4);
  return T_robot_camera;
}

// A perception and an estimator that record their inputs and return given results.
struct Fakes {
  int times_opened = 0;
  std::vector<std::int64_t> stamps_ns;
  std::vector<std::optional<perception::PredictedSurface>> predictions;
  std::vector<ShapeFrame> frames;
  std::vector<Eigen::Vector3d> gravity_m_s2;
  std::vector<force_estimation::FeatureReport> features;
  int prepared = 0;
  perception::CameraView view;  ///< of every camera
  perception::JointObservation observation;
  std::vector<std::vector<bool>> has_image;  ///< [updates] of the cameras
  ForceEstimate estimate;
  std::function<void(ForceEstimate*)> answer = [](ForceEstimate*) {};

  ReplayPerception Perception() {
    ReplayPerception fake;
    fake.open = [this](const std::vector<std::optional<rgbd::RgbdCamera>>& cameras) {
      ++times_opened;
      observation.views.resize(cameras.size(), view);
    };
    fake.update = [this](std::int64_t stamp_ns, const std::vector<perception::CameraFrame>& images)
        -> const perception::JointObservation& {
      stamps_ns.push_back(stamp_ns);
      observation.stamp_ns = stamp_ns;
      const perception::PredictedSurface* predicted = images[0].predicted;
      predictions.emplace_back(predicted ? std::optional(*predicted) : std::nullopt);
      has_image.emplace_back();
      for (const auto& camera : images) has_image.back().push_back(camera.images != nullptr);
      for (auto& seen : observation.views) seen = view;
      return observation;
    };
    return fake;
  }
  ShapePipeline::Estimator Estimator(const robot::RobotModel& model) {
    features.resize(model.body().feature_points.size());
    ShapePipeline::Estimator fake;
    fake.update = [this, &model](const ShapeFrame& frame) -> const ForceEstimate& {
      frames.push_back(frame);
      gravity_m_s2.push_back(model.gravity_m_s2());
      estimate.t_s = frame.t_s;
      answer(&estimate);
      return estimate;
    };
    fake.features = [this]() -> const std::vector<force_estimation::FeatureReport>& {
      return features;
    };
    fake.prepare_next = [this] { ++prepared; };
    return fake;
  }
};

class ShapeReplayTest : public testing::Test {
 protected:
  ShapeReplayTest()
      : model_(std::make_unique<robot::RobotModel>(robot::BuildRobotBody(
            robot::ReadRobotFile(command::WriteBarRobot(folder_), app::LoadYaml)))) {
    experiment_.T_robot_camera = LookingDown();
    fake_.view.frame.status = Status::Ok();
    fake_.estimate.status = Status(StatusCode::kNoContact, "");
    fake_.estimate.x_m = Nodes(0.1);
  }

  // Nodes with digits that single precision does not hold.
  Eigen::VectorXd Nodes(double stretch) const {
    const Eigen::Matrix3Xd& rest_m = model_->body().mesh.nodes_m;
    return (1.0 + stretch / 3.0) * Eigen::Map<const Eigen::VectorXd>(rest_m.data(), rest_m.size());
  }
  // What perception is given of them.
  perception::PredictedSurface Surface(const Eigen::VectorXd& nodes_m) const {
    const Eigen::Matrix3Xf travelled =
        Eigen::Map<const Eigen::Matrix3Xd>(nodes_m.data(), 3, nodes_m.size() / 3).cast<float>();
    return perception::MakePredictedSurface(travelled, model_->body().boundary.DrawnTriangles(),
                                            LookingDown());
  }
  // The same images of a camera beside the first, `late_s` later.
  experiment::CameraFiles FurtherImages(const Recording& first, const std::string& name,
                                        double late_s) const {
    experiment::CameraFiles camera;
    camera.name = name;
    camera.folder = first.folder;
    camera.camera_file = first.camera_file;
    camera.depth_images = first.depth_images;
    for (auto& image : camera.depth_images) image.t_ns += std::llround(1e9 * late_s);
    return camera;
  }
  // A recording with `count` frames from `t_s` on, 0.1 s apart.
  Recording Images(const std::string& name, RecordingKind kind, int count, double t_s = 1.0) const {
    std::filesystem::create_directories(folder_ / name);
    Recording recording;
    recording.name = name;
    recording.folder = folder_ / name;
    recording.kind = kind;
    recording.camera_file = folder_.Write(name + "/camera.yaml",
                                          "depth: {width_px: 4, height_px: 3, fx_px: 3, fy_px: 3, "
                                          "cx_px: 1.5, cy_px: 1, unit_m: 0.001}\n");
    rgbd::WriteDepthPng(folder_ / name / "d.png", rgbd::DepthImage(4, 3, 400));
    for (int i = 0; i < count; ++i) {
      const auto t_ns = static_cast<std::int64_t>(std::llround(1e9 * (t_s + 0.1 * i)));
      recording.depth_images.push_back({t_ns, folder_ / name / "d.png"});
    }
    return recording;
  }
  ShapeReplay Replay(int contact_free_frames = 0, bool expect_posture = true) {
    return ShapeReplay({.experiment = experiment_,
                        .model = model_.get(),
                        .cable_input = robot::CableInput::kDisplacement,
                        .expect_posture = expect_posture,
                        .open =
                            [](const Recording& recording) {
                              return experiment::OpenRecordingImages(recording, app::LoadYaml);
                            }},
                       ShapeStream(model_->body(), fake_.Perception(),
                                   std::make_unique<ShapePipeline>(
                                       model_->body(), std::vector<force_estimation::ContactSite>(),
                                       contact_free_frames, fake_.Estimator(*model_))));
  }
  std::vector<bool> ContactFree() const {
    std::vector<bool> flags;
    for (const ShapeFrame& frame : fake_.frames) flags.push_back(frame.untouched);
    return flags;
  }

  test_support::TestFolder folder_;
  std::unique_ptr<robot::RobotModel> model_;
  experiment::Experiment experiment_;
  Fakes fake_;
  const TakeEstimate ignore_ = [](const ForceEstimate&) {};
};

TEST_F(ShapeReplayTest, PredictsFromTheLastEstimateAsItTravels) {
  Replay().Estimate(Images("r", RecordingKind::kFree, 2), ignore_);
  ASSERT_THAT(fake_.predictions, SizeIs(2));
  ASSERT_TRUE(fake_.predictions[1]);
  const auto expected = Surface(Nodes(0.1));
  EXPECT_EQ(fake_.predictions[1]->vertices_m, expected.vertices_m);  // to the last bit
  EXPECT_EQ(fake_.predictions[1]->triangles, expected.triangles);
}

TEST_F(ShapeReplayTest, TheFirstImageOfEachRecordingIsExpectedInThePostureOfItsCommands) {
  Recording pulled = Images("b", RecordingKind::kFree, 1);
  experiment::Actuation actuation;
  actuation.t_s = {1.0};
  actuation.columns.push_back({.cable = "top",
                               .quantity = experiment::ActuatorQuantity::kDisplacement,
                               .samples = {0.002},
                               .where = {}});
  pulled.actuation = actuation;
  ShapeReplay replay = Replay();
  replay.Estimate(Images("a", RecordingKind::kFree, 1), ignore_);
  replay.Estimate(pulled, ignore_);
  ASSERT_TRUE(fake_.predictions[0] && fake_.predictions[1]);
  for (const double displacement_m : {0.0, 0.002}) {
    fem::StaticState state = model_->RestState();
    const auto kind = displacement_m > 0.0 ? robot::ActuatorCommand::Kind::kDisplacement
                                           : robot::ActuatorCommand::Kind::kNone;
    ASSERT_TRUE(model_->Solve({{.kind = kind, .value = displacement_m}}, {}, &state).status.ok());
    const auto& seen = *fake_.predictions[displacement_m > 0.0 ? 1 : 0];
    EXPECT_TRUE(seen.vertices_m.isApprox(Surface(state.x_m).vertices_m, 1e-9)) << displacement_m;
  }
  EXPECT_GT((fake_.predictions[0]->vertices_m - fake_.predictions[1]->vertices_m).norm(), 1e-3);
}

TEST_F(ShapeReplayTest, TheProcessExpectsNothingBeforeItsFirstImage) {
  Replay(0, /*expect_posture=*/false).Estimate(Images("r", RecordingKind::kFree, 1), ignore_);
  EXPECT_FALSE(fake_.predictions[0]);
}

TEST_F(ShapeReplayTest, FirstFramesAreContactFreeUntilPerceptionLocatesAContact) {
  ShapeReplay replay = Replay();
  const Recording recording = Images("r", RecordingKind::kFree, 5);
  EXPECT_EQ(replay.EstimateDepthBiasFromStart(recording, 3).frames, 3);
  EXPECT_THAT(ContactFree(), ElementsAre(true, true, true));
  fake_.observation.contacts.resize(1);
  EXPECT_EQ(replay.EstimateDepthBiasFromStart(recording, 3).frames, 0);
  EXPECT_THAT(fake_.frames, SizeIs(3));
}

TEST_F(ShapeReplayTest, AFailedEstimatePredictsNothing) {
  int frame = 0;
  fake_.answer = [&](ForceEstimate* estimate) {
    estimate->x_m = Nodes(0.1 * ++frame);
    estimate->status = Status(frame == 2 ? StatusCode::kNotConverged : StatusCode::kOk, "");
    if (frame == 3) estimate->x_m[4] = std::nan("");
  };
  Replay().Estimate(Images("r", RecordingKind::kFree, 4), ignore_);
  ASSERT_TRUE(fake_.predictions[1] && fake_.predictions[2] && fake_.predictions[3]);
  EXPECT_EQ(fake_.predictions[2]->vertices_m, fake_.predictions[1]->vertices_m);
  EXPECT_EQ(fake_.predictions[3]->vertices_m, fake_.predictions[1]->vertices_m);
}

TEST_F(ShapeReplayTest, ARobotThatIsNotSeenIsLookedForWhereItWouldBe) {
  fake_.estimate.status = Status(StatusCode::kNoRobotSeen, "");
  Replay().Estimate(Images("r", RecordingKind::kFree, 2), ignore_);
  EXPECT_TRUE(fake_.predictions[1]);
}

TEST_F(ShapeReplayTest, OnlyFramesForTheDepthBiasAreContactFree) {
  ShapeReplay replay = Replay();
  EXPECT_EQ(replay.EstimateDepthBias(Images("a", RecordingKind::kRest, 2)), 2);
  int taken = 0;
  replay.Estimate(Images("b", RecordingKind::kRest, 1), [&](const ForceEstimate&) { ++taken; });
  EXPECT_THAT(ContactFree(), ElementsAre(true, true, false));
  EXPECT_EQ(taken, 1);
  EXPECT_EQ(fake_.times_opened, 2);
  EXPECT_TRUE(fake_.predictions[2]);  // the pipeline goes on from one recording to the next
  EXPECT_EQ(fake_.prepared, 3);
}

TEST_F(ShapeReplayTest, TheFirstFramesAreContactFreeAsInTheProcess) {
  ShapeReplay replay = Replay(2);
  replay.Estimate(Images("a", RecordingKind::kFree, 1), ignore_);
  fake_.view.frame.status = Status(StatusCode::kNoRobotSeen, "too dark");
  replay.Estimate(Images("dark", RecordingKind::kFree, 1), ignore_);  // does not count
  fake_.view.frame.status = Status::Ok();
  replay.Estimate(Images("b", RecordingKind::kFree, 2), ignore_);
  EXPECT_THAT(ContactFree(), ElementsAre(true, true, true, false));
}

TEST_F(ShapeReplayTest, CableInputsAreThoseOfTheFramesTime) {
  Recording recording = Images("r", RecordingKind::kFree, 2, 1.0);
  experiment::Actuation actuation;
  actuation.t_s = {0.9, 1.1};
  actuation.columns.push_back({.cable = "top",
                               .quantity = experiment::ActuatorQuantity::kDisplacement,
                               .samples = {0.0, 0.004},
                               .where = {}});
  recording.actuation = actuation;
  Replay().Estimate(recording, ignore_);
  ASSERT_THAT(fake_.frames, SizeIs(2));
  EXPECT_DOUBLE_EQ(fake_.frames[0].t_s, 1.0);
  EXPECT_EQ(fake_.stamps_ns[1], 1100000000);
  EXPECT_EQ(fake_.frames[0].cables[0].kind, robot::ActuatorCommand::Kind::kDisplacement);
  EXPECT_NEAR(fake_.frames[0].cables[0].value, 0.002, 1e-12);
  EXPECT_NEAR(fake_.frames[1].cables[0].value, 0.004, 1e-12);
}

TEST_F(ShapeReplayTest, AContactGoesFromTheCamerasFrameIntoTheRobots) {
  perception::DetectedContact contact;
  contact.name = "contact_7";
  contact.position_m = {0.01, 0.02, 0.3};
  contact.covariance_m2 = Eigen::Vector3d(1e-6, 2e-6, 9e-6).asDiagonal();
  contact.covariance_m2(0, 1) = contact.covariance_m2(1, 0) = 5e-7;
  contact.extent_m = {0.001, 0.002, 0.003};
  contact.point_count = 12;
  fake_.observation.contacts = {contact};
  fake_.view.frame.robot.points_m = Eigen::Matrix3Xf::Ones(3, 5);
  Replay().Estimate(Images("r", RecordingKind::kFree, 1), ignore_);
  const ShapeFrame& frame = fake_.frames.at(0);
  EXPECT_EQ(frame.views[0].cloud.Count(), 5);
  EXPECT_TRUE(frame.views[0].T_robot_camera.isApprox(LookingDown()));
  ASSERT_THAT(frame.contacts, SizeIs(1));
  EXPECT_EQ(frame.contacts[0].name, "contact_7");
  EXPECT_TRUE(frame.contacts[0].position_m.isApprox(Eigen::Vector3d(0.04, 0.0, 0.1), 1e-12));
  EXPECT_NEAR(frame.contacts[0].covariance_m2(0, 1), -5e-7, 1e-15);
  EXPECT_NEAR(frame.contacts[0].covariance_m2(2, 2), 9e-6, 1e-15);
  EXPECT_EQ(frame.contacts[0].extent_m, contact.extent_m);
  EXPECT_EQ(frame.contacts[0].point_count, 12);
}

TEST_F(ShapeReplayTest, AKnownLoadIsAContactWhileItActs) {
  Recording recording = Images("r", RecordingKind::kKnownLoad, 3);
  recording.loads.resize(2);
  recording.loads[0].t_s = 1.0;
  recording.loads[1].t_s = 1.15;
  recording.loads[0].position_m = recording.loads[1].position_m = {0.075, 0.01, 0.02};
  recording.loads[1].force_N = {0.0, 0.0, -0.5};
  Replay().Estimate(recording, ignore_);
  EXPECT_THAT(fake_.frames[1].contacts, SizeIs(0));
  ASSERT_THAT(fake_.frames[2].contacts, SizeIs(1));
  EXPECT_EQ(fake_.frames[2].contacts[0].name, "load_1");
  const Eigen::Vector3d there_m = (1.0 + 0.1 / 3.0) * Eigen::Vector3d(0.075, 0.01, 0.02);
  EXPECT_TRUE(fake_.frames[2].contacts[0].position_m.isApprox(there_m, 1e-6));
}

TEST_F(ShapeReplayTest, WithoutACameraPoseEachFrameSaysSo) {
  experiment_.T_robot_camera.reset();
  ShapeReplay replay = Replay();
  const Recording recording = Images("r", RecordingKind::kRest, 3);
  EXPECT_EQ(replay.EstimateDepthBias(recording), 0);
  std::vector<StatusCode> codes;
  replay.Estimate(recording, [&](const ForceEstimate& estimate) {
    codes.push_back(estimate.status.code());
    EXPECT_THAT(estimate.status.message(), testing::HasSubstr("no T_robot_camera is given"));
    EXPECT_GE(estimate.t_s, 1.0);
  });
  EXPECT_THAT(codes, ElementsAre(StatusCode::kNoCalibration, StatusCode::kNoCalibration,
                                 StatusCode::kNoCalibration));
  EXPECT_THAT(fake_.frames, SizeIs(0));
}

TEST_F(ShapeReplayTest, AFrameThatPerceptionRefusesKeepsItsReason) {
  fake_.view.frame.status = Status(StatusCode::kInvalidInput, "all depth is invalid");
  fake_.estimate.status = Status(StatusCode::kNoRobotSeen, "only 0 points");
  Replay().Estimate(Images("r", RecordingKind::kFree, 1), [&](const ForceEstimate& estimate) {
    EXPECT_EQ(estimate.status.code(), StatusCode::kInvalidInput);
    EXPECT_EQ(estimate.status.message(), "all depth is invalid");
  });
}

TEST_F(ShapeReplayTest, ATiltedBaseTiltsGravityForItsRecordingOnly) {
  Recording tilted = Images("a", RecordingKind::kBaseTilted, 1);
  tilted.base_tilt_deg = Eigen::Vector2d(90.0, 0.0);
  ShapeReplay replay = Replay();
  replay.Estimate(tilted, ignore_);
  replay.Estimate(Images("b", RecordingKind::kFree, 1), ignore_);
  EXPECT_NEAR(fake_.gravity_m_s2[0].y(), -9.81, 1e-9);
  EXPECT_NEAR(fake_.gravity_m_s2[1].z(), -9.81, 1e-9);
}

TEST_F(ShapeReplayTest, FramesOfTwoCamerasAreJoinedOnOneClock) {
  Recording recording = Images("r", RecordingKind::kFree, 3);
  recording.cameras = {FurtherImages(recording, "back", 0.26)};  // 0.25 s of clock, 0.01 s late
  experiment_.recordings = {recording};
  experiment_.cameras = {{.name = "back",
                          .T_robot_camera = LookingDown(),
                          .T_robot_camera_error = {},
                          .clock_offset_s = 0.25}};
  ShapeReplay replay = Replay();
  replay.Estimate(recording, ignore_);
  ASSERT_THAT(fake_.frames, SizeIs(3));
  EXPECT_THAT(fake_.has_image, Each(ElementsAre(true, true)));
  EXPECT_THAT(fake_.stamps_ns, ElementsAre(1000000000, 1100000000, 1200000000));
  EXPECT_THAT(fake_.frames[0].views, SizeIs(2));
  EXPECT_THAT(replay.TakeNotes(), SizeIs(0));
}

TEST_F(ShapeReplayTest, ACameraThatIsMissingIsNamedAndTheOthersGoOn) {
  Recording recording = Images("r", RecordingKind::kFree, 5);
  recording.cameras = {FurtherImages(recording, "back", 0.0)};
  auto& images = recording.cameras[0].depth_images;
  images.erase(images.begin() + 1, images.begin() + 3);
  experiment_.recordings = {recording};
  experiment_.cameras = {{.name = "back",
                          .T_robot_camera = LookingDown(),
                          .T_robot_camera_error = {},
                          .clock_offset_s = {}}};
  ShapeReplay replay = Replay();
  EXPECT_EQ(replay.Estimate(recording, ignore_).done, 5);
  EXPECT_THAT(fake_.has_image, ElementsAre(ElementsAre(true, true), ElementsAre(true, false),
                                           ElementsAre(true, false), ElementsAre(true, true),
                                           ElementsAre(true, true)));
  EXPECT_THAT(replay.TakeNotes(),
              ElementsAre("r: camera 'back' has no image in 2 of 5 frames: the other cameras were "
                          "used"));
}

TEST_F(ShapeReplayTest, TheFirstCameraMayBeTheOneThatIsMissing) {
  Recording recording = Images("r", RecordingKind::kFree, 3);
  recording.cameras = {FurtherImages(recording, "back", 0.0)};
  recording.depth_images.clear();
  experiment_.recordings = {recording};
  experiment_.cameras = {{.name = "back",
                          .T_robot_camera = LookingDown(),
                          .T_robot_camera_error = {},
                          .clock_offset_s = {}}};
  EXPECT_EQ(Replay().Estimate(recording, ignore_).done, 3);
  EXPECT_THAT(fake_.has_image, Each(ElementsAre(false, true)));
}

TEST_F(ShapeReplayTest, ACameraOfUnknownPoseIsNotUsed) {
  Recording recording = Images("r", RecordingKind::kFree, 3);
  recording.cameras = {FurtherImages(recording, "back", 0.0)};
  experiment_.recordings = {recording};
  ShapeReplay replay = Replay();
  EXPECT_EQ(replay.Estimate(recording, ignore_).done, 3);
  EXPECT_THAT(fake_.has_image, Each(ElementsAre(true, false)));
  EXPECT_THAT(replay.TakeNotes(),
              ElementsAre("r: camera 'back' is not used: its pose is not known"));
}

}  // namespace
}  // namespace palpate::offline
