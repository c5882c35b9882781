// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/node/page_feed.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "components/view/node/experiment_source.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"
#include "libs/rgbd/jpeg.hpp"
#include "tests/components/view/node/page_messages.hpp"
#include "tests/components/view/robot/cabled_beam.hpp"

namespace palpate::view {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

robot::RobotBody MarkedBeam() { return CabledBeam({{"tip", {0.0, 0.015, 0.03}, {}}}); }

/// A feed that knows the robot, and what it has told the page.
class FeedOfKnownRobot : public testing::Test {
 protected:
  void TellShape() {
    const robot::RobotBody& body = robot_.body();
    feed_.Take(*dds::ToMesh({body.name, body.mesh_hash, body.mesh.nodes_m, body.mesh.cells,
                             body.boundary.DrawnTriangles()},
                            1));
    feed_.Take(*dds::ToMeshState(body.mesh.nodes_m.reshaped(), body.mesh_hash, 2));
  }
  void TellMarker(double sigma_m) {
    feed_.TakeMarkers({.stamp_ns = 2,
                       .names = {"tip"},
                       .measured_m = Eigen::Vector3d(0.0, 0.015, 0.031),
                       .model_m = Eigen::Vector3d(0.0, 0.015, 0.03),
                       .sigma_m = Eigen::Vector3d::Constant(sigma_m)});
  }
  Json Probe() { return Json::parse(*feed_.Probe({.vertex = 0}).head); }

  KnownRobot robot_{MarkedBeam()};
  PageMessages page_;
  PageFeed feed_{Config(), 0, &robot_, page_.Outputs()};
};

TEST_F(FeedOfKnownRobot, TellsStiffnessAndCablesAlongTheBody) {
  TellShape();
  const Json mesh = page_.Last("mesh");
  EXPECT_EQ(mesh.at("arrays").at("stiffness_Pa").at("length").get<std::size_t>() * 3,
            mesh.at("arrays").at("rest_m").at("length").get<std::size_t>());
  EXPECT_EQ(page_.Last("cable_paths").at("arrays").at("top").at("length"), 6);
  // A calibration changes the colours of the skin.
  const std::size_t before = page_.Count("mesh");
  dds::Message<idl::palpate_msgs::Calibration> calibration;
  dds::SetText(calibration->mesh_hash, robot_.body().mesh_hash);
  dds::Resize(calibration->moduli, 1);
  dds::SetText(calibration->moduli._buffer[0].part, "body");
  calibration->moduli._buffer[0].youngs_modulus_pa = 1e5;
  feed_.Take(*calibration);
  EXPECT_EQ(page_.Count("mesh"), before + 1);
  EXPECT_EQ(robot_.body().materials.front().youngs_modulus_Pa, 1e5);
}

TEST_F(FeedOfKnownRobot, AnswersAClickWithTheSmallestForce) {
  TellShape();
  TellMarker(1e-4);
  const double smallest_N = Probe().at("smallest_force_N").get<double>();
  EXPECT_GT(smallest_N, 0.0);
  TellMarker(2e-4);
  EXPECT_NEAR(Probe().at("smallest_force_N").get<double>(), 2.0 * smallest_N, 1e-6 * smallest_N);
}

TEST_F(FeedOfKnownRobot, SaysWhyItKnowsNoSmallestForce) {
  EXPECT_THAT(Probe().at("reason").get<std::string>(), HasSubstr("no state of the mesh"));
  TellShape();
  EXPECT_THAT(Probe().at("reason").get<std::string>(), HasSubstr("how large the noise is"));
  TellMarker(0.0);
  EXPECT_THAT(Probe().at("reason").get<std::string>(), HasSubstr("markers_sigma_m"));
  PageFeed without_robot(Config(), 0, nullptr, page_.Outputs());
  const robot::RobotBody& body = robot_.body();
  without_robot.Take(*dds::ToMesh({body.name, body.mesh_hash, body.mesh.nodes_m, body.mesh.cells,
                                   body.boundary.DrawnTriangles()},
                                  1));
  without_robot.Take(*dds::ToMeshState(body.mesh.nodes_m.reshaped(), body.mesh_hash, 2));
  const Json answer = Json::parse(*without_robot.Probe({.vertex = 0}).head);
  EXPECT_THAT(answer.at("reason").get<std::string>(), HasSubstr("ROBOT"));
  EXPECT_TRUE(answer.at("smallest_force_N").is_null());
}

TEST_F(FeedOfKnownRobot, TellsTheSmallestForceOfACloudByTheNoiseOfTheEstimator) {
  TellShape();
  rgbd::SensedCloud points;
  points.points_m = robot_.body().mesh.nodes_m.cast<float>();
  feed_.TakePoints(points, 2);
  feed_.Take(*dds::ToMeshState(robot_.body().mesh.nodes_m.reshaped(), robot_.body().mesh_hash, 3));
  dds::Message<idl::palpate_msgs::ModelGap> gap;
  gap->noise_rms_m = 1e-4;
  gap->sample_count = 100;
  feed_.Take(*gap);
  const double smallest_N = Probe().at("smallest_force_N").get<double>();
  gap->sample_count = 400;
  feed_.Take(*gap);
  EXPECT_NEAR(Probe().at("smallest_force_N").get<double>(), 0.5 * smallest_N, 1e-6 * smallest_N);
}

TEST_F(FeedOfKnownRobot, PassesMarkersOnWithTheirPlacesOnTheModel) {
  TellShape();
  dds::Message<idl::palpate_msgs::MarkerArray3> message;
  dds::SetHeader(message->header, 2, geometry::kRobotFrame);
  dds::Resize(message->markers, 2);
  dds::SetText(message->markers._buffer[0].name, "tip");
  dds::SetVector(message->markers._buffer[0].position_m, Eigen::Vector3d(0.0, 0.015, 0.031));
  message->markers._buffer[0].valid = true;
  dds::SetText(message->markers._buffer[1].name, "hidden");
  feed_.Take(*message);
  const Json markers = page_.Last("markers");
  EXPECT_EQ(markers.at("names"), Json({"tip"}));
  EXPECT_EQ(markers.at("arrays").at("model_m").at("length"), 3);
  EXPECT_THAT(page_.warnings(), IsEmpty());
}

TEST_F(FeedOfKnownRobot, ShowsImagesThatADriverHasPacked) {
  dds::Message<idl::sensor_msgs::CompressedImage> message;
  dds::SetText(message->format, "rgb8; jpeg compressed bgr8");
  const std::string jpeg = rgbd::EncodeJpeg(rgbd::ColorImage(32, 16, 200), 80);
  dds::SetNumbers(message->data, jpeg.data(), jpeg.size());
  feed_.TakePackedColor(*message);
  const Json image = page_.Last("color_image");
  EXPECT_EQ(image.at("width"), 32);
  EXPECT_EQ(image.at("height"), 16);
  EXPECT_THAT(page_.warnings(), IsEmpty());
  dds::Message<idl::sensor_msgs::CompressedImage> damaged;
  dds::SetNumbers(damaged->data, jpeg.data(), jpeg.size() / 2);
  PageFeed other(Config(), 0, nullptr, page_.Outputs());  // with its rate still free
  other.TakePackedColor(*damaged);
  EXPECT_THAT(page_.warnings(), SizeIs(1));
}

TEST_F(FeedOfKnownRobot, TakesAnotherPlaceOfARecordingForNoRestart) {
  const auto restarts = [&](double uptime_s) {
    dds::Message<idl::palpate_msgs::ComponentStatus> status;
    dds::SetText(status->component_name, "capture");
    dds::SetText(status->status, "ok");
    status->uptime_s = uptime_s;
    feed_.Take(*status);
    return feed_.TellHealth(0).processes.at(0).restarts;
  };
  EXPECT_EQ(restarts(100.0), 0U);
  feed_.Forget();
  EXPECT_EQ(restarts(5.0), 0U);
  EXPECT_EQ(restarts(1.0), 1U);  // within one place it is one
}

TEST_F(FeedOfKnownRobot, PlaysAnExperiment) {
  ShownExperiment shown;
  shown.experiment.markers_sigma_m = Eigen::Vector3d::Constant(1e-4);
  experiment::Recording recording;
  recording.name = "r1";
  recording.actuation = experiment::Actuation{{0.0, 10.0}, {{"top", {}, {0.0, 2e-3}, {}}}};
  recording.markers = experiment::MarkerTracks{{"tip"}, {{}}, {}};
  for (int k = 0; k <= 10; ++k) {
    recording.markers->frames.push_back({1.0 * k, {Eigen::Vector3d(0.0, 0.015, 0.03)}, 0});
  }
  shown.experiment.recordings = {recording};
  ExperimentSource source(shown, robot_, &feed_);
  EXPECT_EQ(page_.Count("mesh"), 1U);
  EXPECT_EQ(page_.Last("mesh_state").at("status"), "ok");
  EXPECT_EQ(page_.Last("markers").at("names"), Json({"tip"}));
  const double first_m = page_.Last("model_error").at("residual_rms_m").get<double>();
  source.Advance(0);
  source.Advance(9'500'000'000);
  EXPECT_EQ(page_.Last("mesh_state").at("stamp_ns"), "9000000000");
  EXPECT_GT(std::abs(page_.Last("model_error").at("residual_rms_m").get<double>() - first_m), 1e-5);
  EXPECT_NEAR(page_.Last("model_error").at("noise_rms_m").get<double>(), 1e-4, 1e-9);
  source.Seek({.position_s = 0.0});
  source.Advance(9'500'000'001);
  EXPECT_EQ(page_.Last("mesh_state").at("stamp_ns"), "0");
  source.Advance(99'000'000'000);
  const Json state = Json::parse(*source.State().head);
  EXPECT_TRUE(state.at("paused").get<bool>());
  EXPECT_EQ(state.at("part"), "r1");
  EXPECT_EQ(state.at("duration_s"), 10.0);
  EXPECT_THAT(page_.warnings(), IsEmpty());
}

}  // namespace
}  // namespace palpate::view
