// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/node/convert.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "libs/dds/stamp.hpp"
#include "tests/components/force_estimation/node/test_robot.hpp"
#include "tests/support/not_a_number.hpp"

namespace palpate::force_estimation {
namespace {

using ::testing::HasSubstr;

const std::vector<std::string> kMarkers{"m1", "m2", "m3"};

dds::Message<idl::palpate_msgs::MarkerArray3> TwoMarkers() {
  dds::Message<idl::palpate_msgs::MarkerArray3> message;
  dds::SetHeader(message->header, 1'500'000'000, "robot");
  message->reference_shape = palpate_msgs_msg_MarkerArray3_Constants_REFERENCE_EQUILIBRIUM;
  dds::Resize(message->markers, 2);
  auto* markers = message->markers._buffer;
  dds::SetText(markers[0].name, "m3");
  markers[0].position_m = {0.1, 0.2, 0.3};
  markers[0].sigma_m = {1e-4, 2e-4, 3e-4};
  markers[0].valid = true;
  dds::SetText(markers[1].name, "m1");
  markers[1].position_m = {kNaN, 0.0, 0.0};
  return message;
}

template <typename Change>
std::string RefusalAfter(const Change& change) {
  auto message = TwoMarkers();
  change(*message);
  MarkerFrame frame;
  const Status status = FromMarkerArray(*message, kMarkers, &frame);
  EXPECT_TRUE(status.ok() || status.code() == StatusCode::kInvalidInput);
  return status.message();
}

TEST(EstimationConvert, MarkersComeInTheRobotsOrderAndUnseenOnesAreNotValid) {
  MarkerFrame frame;
  ASSERT_TRUE(FromMarkerArray(*TwoMarkers(), kMarkers, &frame).ok());
  EXPECT_EQ(frame.t_s, 1.5);
  EXPECT_EQ(frame.reference, ReferenceShape::kEquilibrium);
  ASSERT_EQ(frame.markers.size(), 3u);
  EXPECT_FALSE(frame.markers[0].valid);
  EXPECT_FALSE(frame.markers[1].valid);
  EXPECT_TRUE(frame.markers[2].valid);
  EXPECT_EQ(frame.markers[2].position_m, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(frame.markers[2].sigma_m, Eigen::Vector3d(1e-4, 2e-4, 3e-4));
}

TEST(EstimationConvert, RefusesMarkersThatCannotBeUsed) {
  using Markers = idl::palpate_msgs::MarkerArray3;
  EXPECT_EQ(RefusalAfter([](Markers&) {}), "");
  EXPECT_THAT(RefusalAfter([](Markers& m) { dds::SetText(m.header.frame_id, "camera"); }),
              HasSubstr("frame_id is 'camera', expected 'robot'"));
  EXPECT_THAT(RefusalAfter([](Markers& m) { dds::SetText(m.markers._buffer[0].name, "m1"); }),
              HasSubstr("'m1' comes twice"));
  EXPECT_THAT(RefusalAfter([](Markers& m) { m.reference_shape = 9; }),
              HasSubstr("unknown reference_shape 9"));
  EXPECT_THAT(RefusalAfter([](Markers& m) { m.pose_rotation_sigma_rad = -1.0; }),
              HasSubstr("standard error of the markers' pose"));
  EXPECT_THAT(RefusalAfter([](Markers& m) { m.pose_translation_sigma_m = kNaN; }),
              HasSubstr("standard error of the markers' pose"));
}

TEST(EstimationConvert, TheErrorOfTheMarkersPoseComesWithThem) {
  MarkerFrame frame;
  auto message = TwoMarkers();
  ASSERT_TRUE(FromMarkerArray(*message, kMarkers, &frame).ok());
  EXPECT_TRUE(frame.pose_error.IsZero());
  message->pose_about_m = {0.1, 0.2, 0.3};
  message->pose_translation_sigma_m = 0.001;
  message->pose_rotation_sigma_rad = 0.002;
  ASSERT_TRUE(FromMarkerArray(*message, kMarkers, &frame).ok());
  EXPECT_EQ(frame.pose_error, (PoseError{Eigen::Vector3d(0.1, 0.2, 0.3), 0.001, 0.002}));
}

TEST(EstimationConvert, ForcesKeepTheirNumbersAndTheFrameTheyAnswer) {
  ContactForce contact;
  contact.status = Status(StatusCode::kTangentialUnobservable, "seen from one side");
  contact.name = "tip";
  contact.position_m = {0.1, 0.0, 0.0};
  contact.force_N = {0.0, 0.0, -2.0};
  contact.covariance_N2 << 1, 2, 3, 2, 4, 5, 3, 5, 6;
  contact.ci95_N = 0.25;
  contact.location_covariance_m2 << 1e-6, 0, 2e-6, 0, 3e-6, 0, 2e-6, 0, 5e-6;
  const auto forces = ToForceArray({1'500'000'000, 12, "rec", {}}, Status::Ok(), {contact});
  EXPECT_EQ(forces->marker_counter, 12u);
  EXPECT_EQ(dds::Text(forces->recording), "rec");
  EXPECT_EQ(dds::Text(forces->header.frame_id), "robot");
  EXPECT_EQ(dds::StampNs(forces->header.stamp), 1'500'000'000);
  EXPECT_EQ(dds::Text(forces->status), "ok");
  ASSERT_EQ(forces->forces._length, 1u);
  EXPECT_EQ(forces->forces._buffer[0].force_n.z, -2.0);
  EXPECT_EQ(forces->forces._buffer[0].ci95_n, 0.25);
  EXPECT_THAT(forces->forces._buffer[0].covariance_n2,
              testing::ElementsAre(1, 2, 3, 2, 4, 5, 3, 5, 6));
  EXPECT_THAT(forces->forces._buffer[0].location_covariance_m2,
              testing::ElementsAre(1e-6, 0, 2e-6, 0, 3e-6, 0, 2e-6, 0, 5e-6));
  EXPECT_EQ(dds::Text(forces->forces._buffer[0].status), "tangential_unobservable");
  EXPECT_EQ(dds::Text(forces->forces._buffer[0].reason), "seen from one side");
  // r x F about the origin: (0.1, 0, 0) x (0, 0, -2) = (0, 0.2, 0).
  EXPECT_DOUBLE_EQ(ToWrench(0, contact)->wrench.torque.y, 0.2);
}

TEST(EstimationConvert, AnUnobservableForceIsNotANumber) {
  ContactForce contact;
  contact.status = Status(StatusCode::kUnobservable, "");
  const auto forces = ToForceArray({}, Status::Ok(), {contact});
  EXPECT_TRUE(std::isnan(forces->forces._buffer[0].force_n.x));
  EXPECT_TRUE(std::isnan(forces->forces._buffer[0].ci95_n));
  EXPECT_TRUE(std::isnan(forces->forces._buffer[0].covariance_n2[0]));
}

TEST(EstimationConvert, AMeshStateThatMayNotBeUsedHasNoPositions) {
  FrameResult result;
  result.estimate.x_m = Eigen::VectorXd::Constant(6, 0.5);
  result.state = Status(StatusCode::kNotConverged, "");
  const auto failed = ToMeshState(result, "hash");
  EXPECT_EQ(failed->positions_m._length, 0u);
  EXPECT_EQ(dds::Text(failed->status), "not_converged");
  result.state = Status::Ok();
  result.state_is_known = true;
  const auto good = ToMeshState(result, "hash");
  ASSERT_EQ(good->positions_m._length, 6u);
  EXPECT_EQ(good->positions_m._buffer[5], 0.5f);
  EXPECT_EQ(dds::Text(good->status), "ok");
}

TEST(EstimationConvert, TheMeshIsTheRobots) {
  const auto model = NodeTestRobot();
  const auto& body = model->body();
  const auto mesh = ToMesh(body, 0);
  EXPECT_EQ(dds::Text(mesh->mesh_hash), body.mesh_hash);
  EXPECT_EQ(dds::Text(mesh->element), "tet4");
  EXPECT_EQ(mesh->nodes_m._length, static_cast<uint32_t>(3 * body.mesh.NodeCount()));
  EXPECT_EQ(mesh->cells._length, static_cast<uint32_t>(4 * body.mesh.CellCount()));
  EXPECT_EQ(mesh->surface_triangles._length, static_cast<uint32_t>(3 * body.boundary.FaceCount()));
  EXPECT_EQ(mesh->nodes_m._buffer[3], body.mesh.nodes_m(0, 1));
}

TEST(ModelGapMeter, SplitsTheResidualOverTheMarkersThatWereSeen) {
  const auto model = NodeTestRobot();
  const ModelGapMeter meter(model->body(), 1e-3, 0.0);
  MarkerFrame frame;
  frame.markers.assign(3, {true, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()});
  frame.markers[2].valid = false;
  ForceEstimate estimate;
  estimate.status = Status::Ok();
  estimate.marker_residual_m = Eigen::VectorXd::Zero(9);
  estimate.marker_residual_m.head<3>() << 0.003, 0.0, 0.0;
  const ModelGapReport report = meter.Measure(frame, estimate);
  EXPECT_EQ(report.whole.sample_count, 2);
  EXPECT_DOUBLE_EQ(report.whole.residual_rms_m, 0.003 / std::sqrt(6.0));
  EXPECT_DOUBLE_EQ(report.whole.noise_rms_m, 1e-3);
  ASSERT_EQ(report.regions.size(), 1u);
  EXPECT_EQ(report.regions[0].name, "body");
  ASSERT_EQ(report.cables.size(), 1u);
  EXPECT_EQ(report.cables[0].name, "top");
  EXPECT_EQ(report.cables[0].sample_count, 2);

  estimate.status = Status(StatusCode::kNotConverged, "");
  EXPECT_EQ(meter.Measure(frame, estimate).whole.sample_count, 0);
}

}  // namespace
}  // namespace palpate::force_estimation
