// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/node/convert.hpp"

#include <gmock/gmock.h>

#include "components/force_estimation/node/calibration_input.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/stamp.hpp"
#include "tests/support/not_a_number.hpp"

namespace palpate::calibration {
namespace {

using ::testing::HasSubstr;

robot::CalibrationFile SomeCalibration() {
  robot::CalibrationFile file;
  file.robot = "beam";
  file.mesh_hash = "mesh";
  file.element = "tet10";
  file.model = "yeoh";
  file.poissons_ratio = 0.49;
  file.volumetric = "pointwise";
  file.c20_over_c10 = 0.1;
  file.c30_over_c10 = 0.2;
  file.date_utc = "2026-01-31T12:00:00Z";
  file.data = "frames";
  file.data_hash = "sha256-0";
  file.moduli = {{"body", 1e5, 2e3}, {"tip", 2e5, 3e3}};
  file.poissons_ratios = {{"tip", 0.47, 0.01}};
  file.gravity = robot::CalibratedGravity{{0.1, 0.2, -9.7}, {0.01, 0.02, 0.03}};
  robot::CalibratedPose& pose = file.pose.emplace();
  pose.T_robot_camera = Eigen::Translation3d(1.0, 2.0, 3.0) *
                        Eigen::AngleAxisd(0.4, Eigen::Vector3d(1.0, 2.0, -1.0).normalized());
  pose.rotation_error_rad = {0.01, 0.02, 0.03};
  pose.translation_error_m = {0.004, 0.005, 0.006};
  Eigen::MatrixXd root = Eigen::MatrixXd::Identity(9, 9);
  root(6, 2) = root(7, 4) = 0.5;
  file.depth_bias =
      robot::CalibratedDepthBias{.picture = {848, 480, 425.1, 425.2, 423.5, 239.5},
                                 .map = {.basis = {.order = 1, .span = 0.3},
                                         .coefficients = Eigen::Vector3d(1e-3, 2e-3, -3e-3),
                                         .covariance = 1e-6 * root * root.transpose()}};
  file.cameras.resize(2);
  file.cameras[0] = {.name = "back", .pose = pose, .depth_bias = file.depth_bias};
  file.cameras[0].pose.T_robot_camera.translation().x() = -1.0;
  file.cameras[0].pose.rotation_error_rad = {0.04, 0.05, 0.06};
  file.cameras[0].depth_bias->map.coefficients[0] = 4e-3;
  file.cameras[1].name = "top";
  file.drives = {{"top", {1e-3, 0.02}, {2e-4, 0.01}}};
  file.pressure_sensors = {
      {.chamber = "bend",
       .zero_Pa = robot::CalibratedNumber{-120.0, 15.0},
       .gain = robot::CalibratedNumber{0.03, 0.01}},
      {.chamber = "tip", .zero_Pa = robot::CalibratedNumber{40.0, 5.0}, .gain = {}}};
  file.geometry_scale = robot::CalibratedScale{1.02, 1e-3};
  file.cable_routes = {{"top", 2, {1e-3, 2e-3, 3e-3}, {1e-4, 2e-4, 3e-4}}};
  file.undetermined = {{"cable_gain:top", "a longer pull"}};
  file.residual_rms_m = 1e-4;
  file.chi_squared = 12.5;
  file.degrees_of_freedom = 11;
  return file;
}

/// As the joint calibration gives it: turn, then shift.
Eigen::Matrix<double, 6, 6> CovarianceOf(const robot::CalibratedPose& pose) {
  Eigen::Matrix<double, 6, 1> errors;
  errors << pose.rotation_error_rad, pose.translation_error_m;
  Eigen::Matrix<double, 6, 6> covariance = errors.cwiseAbs2().asDiagonal();
  covariance(0, 4) = covariance(4, 0) = 7e-6;
  return covariance;
}

dds::Message<idl::palpate_msgs::Calibration> SomeMessage() {
  const robot::CalibrationFile file = SomeCalibration();
  return ToCalibration(file, CovarianceOf(*file.pose), 5);
}

TEST(ConvertCalibration, ComesOutAtTheOtherEndAsItWentIn) {
  const robot::CalibrationFile sent = SomeCalibration();
  const auto message = SomeMessage();
  EXPECT_EQ(dds::StampNs(message->header.stamp), 5);
  robot::CalibrationFile got;
  ASSERT_TRUE(force_estimation::FromCalibration(*message, &got).ok());
  EXPECT_TRUE(robot::CheckCalibrated(got, sent).ok());
  EXPECT_EQ(got.date_utc, sent.date_utc);
  EXPECT_EQ(got.data, sent.data);
  EXPECT_EQ(got.data_hash, sent.data_hash);
  ASSERT_TRUE(got.pose);
  EXPECT_TRUE(got.pose->T_robot_camera.isApprox(sent.pose->T_robot_camera, 1e-14));
  EXPECT_TRUE(got.pose->rotation_error_rad.isApprox(sent.pose->rotation_error_rad, 1e-12));
  EXPECT_TRUE(got.pose->translation_error_m.isApprox(sent.pose->translation_error_m, 1e-12));
  ASSERT_TRUE(got.depth_bias);
  EXPECT_EQ(got.depth_bias->picture, sent.depth_bias->picture);
  EXPECT_EQ(got.depth_bias->map.basis, sent.depth_bias->map.basis);
  EXPECT_EQ(got.depth_bias->map.coefficients, sent.depth_bias->map.coefficients);
  EXPECT_EQ(got.depth_bias->map.covariance, sent.depth_bias->map.covariance);
  ASSERT_EQ(got.drives.size(), 1u);
  EXPECT_EQ(got.drives[0].cable, "top");
  EXPECT_EQ(got.drives[0].drive.offset_m, 1e-3);
  EXPECT_EQ(got.drives[0].drive.gain, 0.02);
  EXPECT_EQ(got.drives[0].standard_error.offset_m, 2e-4);
  EXPECT_EQ(got.drives[0].standard_error.gain, 0.01);
  ASSERT_EQ(got.pressure_sensors.size(), 2u);
  EXPECT_EQ(got.pressure_sensors[0].chamber, "bend");
  EXPECT_EQ(got.pressure_sensors[0].zero_Pa->value, -120.0);
  EXPECT_EQ(got.pressure_sensors[0].zero_Pa->standard_error, 15.0);
  EXPECT_EQ(got.pressure_sensors[0].gain->value, 0.03);
  EXPECT_EQ(got.pressure_sensors[0].gain->standard_error, 0.01);
  EXPECT_EQ(got.pressure_sensors[1].zero_Pa->value, 40.0);
  EXPECT_FALSE(got.pressure_sensors[1].gain) << "not determined is not 0";
  ASSERT_EQ(got.moduli.size(), 2u);
  EXPECT_EQ(got.moduli[1].part, "tip");
  EXPECT_EQ(got.moduli[1].youngs_modulus_Pa, 2e5);
  EXPECT_EQ(got.moduli[1].standard_error_Pa, 3e3);
  ASSERT_EQ(got.poissons_ratios.size(), 1u);
  EXPECT_EQ(got.poissons_ratios[0].part, "tip");
  EXPECT_EQ(got.poissons_ratios[0].poissons_ratio, 0.47);
  EXPECT_EQ(got.poissons_ratios[0].standard_error, 0.01);
  ASSERT_TRUE(got.gravity);
  EXPECT_EQ(got.gravity->gravity_m_s2, sent.gravity->gravity_m_s2);
  EXPECT_EQ(got.gravity->standard_error_m_s2, sent.gravity->standard_error_m_s2);
  ASSERT_TRUE(got.geometry_scale);
  EXPECT_EQ(got.geometry_scale->scale, 1.02);
  EXPECT_EQ(got.geometry_scale->standard_error, 1e-3);
  ASSERT_EQ(got.cable_routes.size(), 1u);
  EXPECT_EQ(got.cable_routes[0].cable, "top");
  EXPECT_EQ(got.cable_routes[0].point, 2);
  EXPECT_EQ(got.cable_routes[0].moved_m, sent.cable_routes[0].moved_m);
  EXPECT_EQ(got.cable_routes[0].standard_error_m, sent.cable_routes[0].standard_error_m);
  ASSERT_EQ(got.undetermined.size(), 1u);
  EXPECT_EQ(got.undetermined[0].name, "cable_gain:top");
  EXPECT_EQ(got.undetermined[0].what_would_tell, "a longer pull");
  EXPECT_EQ(got.residual_rms_m, 1e-4);
  EXPECT_EQ(got.chi_squared, 12.5);
  EXPECT_EQ(got.degrees_of_freedom, 11);
}

TEST(ConvertCalibration, FurtherCamerasComeOutAtTheOtherEndAsTheyWentIn) {
  const robot::CalibrationFile sent = SomeCalibration();
  robot::CalibrationFile got;
  ASSERT_TRUE(force_estimation::FromCalibration(*SomeMessage(), &got).ok());
  ASSERT_EQ(got.cameras.size(), 2u);
  EXPECT_EQ(got.cameras[0].name, "back");
  EXPECT_TRUE(
      got.cameras[0].pose.T_robot_camera.isApprox(sent.cameras[0].pose.T_robot_camera, 1e-14));
  EXPECT_TRUE(got.cameras[0].pose.rotation_error_rad.isApprox(
      sent.cameras[0].pose.rotation_error_rad, 1e-12));
  EXPECT_TRUE(got.cameras[0].pose.translation_error_m.isApprox(
      sent.cameras[0].pose.translation_error_m, 1e-12));
  ASSERT_TRUE(got.cameras[0].depth_bias);
  EXPECT_EQ(got.cameras[0].depth_bias->picture, sent.depth_bias->picture);
  EXPECT_EQ(got.cameras[0].depth_bias->map.coefficients,
            sent.cameras[0].depth_bias->map.coefficients);
  EXPECT_EQ(got.cameras[0].depth_bias->map.covariance, sent.depth_bias->map.covariance);
  EXPECT_EQ(got.cameras[1].name, "top");
  EXPECT_FALSE(got.cameras[1].depth_bias);
}

TEST(ConvertCalibration, RefusesFurtherCamerasThatAreNone) {
  robot::CalibrationFile got;
  auto message = SomeMessage();
  message->cameras._buffer[0].camera_in_robot.orientation.w = 3.0;
  EXPECT_THAT(force_estimation::FromCalibration(*message, &got).message(),
              HasSubstr("camera 'back': camera_in_robot is no pose"));
  message = SomeMessage();
  message->cameras._buffer[0].depth_bias.covariance._length = 80;
  EXPECT_THAT(force_estimation::FromCalibration(*message, &got).message(),
              HasSubstr("camera 'back': depth_bias has no covariance"));
  message = SomeMessage();
  dds::SetText(message->cameras._buffer[1].name, "back");
  EXPECT_THAT(force_estimation::FromCalibration(*message, &got).message(),
              HasSubstr("camera 'back' is there twice"));
}

TEST(ConvertCalibration, WhatIsNotInItDoesNotComeOut) {
  robot::CalibrationFile got = SomeCalibration();
  robot::CalibrationFile bare;
  bare.robot = "beam";
  const auto message = ToCalibration(bare, Eigen::Matrix<double, 6, 6>::Zero(), 5);
  ASSERT_TRUE(force_estimation::FromCalibration(*message, &got).ok());
  EXPECT_FALSE(got.pose || got.gravity || got.depth_bias || got.geometry_scale);
  EXPECT_TRUE(got.cable_routes.empty() && got.pressure_sensors.empty());
  EXPECT_TRUE(got.moduli.empty() && got.poissons_ratios.empty() && got.drives.empty());
  EXPECT_TRUE(got.undetermined.empty() && got.cameras.empty());
}

TEST(ConvertCalibration, HasTheCovarianceInTheOrderOfRos) {
  const auto message = SomeMessage();
  // Turn about x with shift along y: row 3, column 1 of x, y, z, about x, about y, about z.
  EXPECT_EQ(message->camera_covariance[6 * 3 + 1], 7e-6);
  EXPECT_EQ(message->camera_covariance[6 * 1 + 3], 7e-6);
  EXPECT_DOUBLE_EQ(message->camera_covariance[0], 0.004 * 0.004);
}

TEST(ConvertCalibration, RefusesNumbersThatAreNone) {
  robot::CalibrationFile got;
  auto message = SomeMessage();
  message->camera_in_robot.orientation.w = 3.0;
  EXPECT_THAT(force_estimation::FromCalibration(*message, &got).message(), HasSubstr("no pose"));
  message = SomeMessage();
  message->camera_covariance[7] = -1.0;
  EXPECT_THAT(force_estimation::FromCalibration(*message, &got).message(), HasSubstr("covariance"));
  message = SomeMessage();
  message->drives._buffer[0].offset_m = kNaN;
  EXPECT_THAT(force_estimation::FromCalibration(*message, &got).message(), HasSubstr("'top'"));
  message = SomeMessage();
  message->pressure_sensors._buffer[1].zero_pa = kNaN;
  EXPECT_THAT(force_estimation::FromCalibration(*message, &got).message(), HasSubstr("'tip'"));
  message = SomeMessage();
  message->moduli._buffer[1].youngs_modulus_pa = 0.0;
  EXPECT_THAT(force_estimation::FromCalibration(*message, &got).message(), HasSubstr("'tip'"));
  message = SomeMessage();
  message->depth_bias.covariance._length = 80;
  EXPECT_THAT(force_estimation::FromCalibration(*message, &got).message(),
              HasSubstr("depth_bias has no covariance"));
  message = SomeMessage();
  message->depth_bias.covariance._buffer[0] = -1e-9;
  EXPECT_THAT(force_estimation::FromCalibration(*message, &got).message(),
              HasSubstr("no covariance of 9"));
  message = SomeMessage();
  message->depth_bias.order = 0xffffffff;
  EXPECT_THAT(force_estimation::FromCalibration(*message, &got).message(), HasSubstr("order -1"));
  message = SomeMessage();
  message->depth_bias.coefficients._buffer[1] = kNaN;
  EXPECT_THAT(force_estimation::FromCalibration(*message, &got).message(),
              HasSubstr("no 3 coefficients"));
  message = SomeMessage();
  message->depth_bias.picture.width_px = 0;
  EXPECT_THAT(force_estimation::FromCalibration(*message, &got).message(), HasSubstr("no image"));
  message = SomeMessage();
  message->has_camera = false;
  EXPECT_THAT(force_estimation::FromCalibration(*message, &got).message(),
              HasSubstr("depth_bias comes without the camera"));
  message = SomeMessage();
  message->poissons_ratios._buffer[0].poissons_ratio = 0.5;
  EXPECT_THAT(force_estimation::FromCalibration(*message, &got).message(),
              HasSubstr("Poisson's ratio of 'tip'"));
  message = SomeMessage();
  message->geometry_scale = 0.0;
  EXPECT_THAT(force_estimation::FromCalibration(*message, &got).message(),
              HasSubstr("geometry_scale 0"));
  message = SomeMessage();
  message->cable_routes._buffer[0].moved_m.y = kNaN;
  EXPECT_THAT(force_estimation::FromCalibration(*message, &got).message(),
              HasSubstr("route of cable 'top'"));
  message = SomeMessage();
  message->gravity_m_s2.y = kNaN;
  EXPECT_THAT(force_estimation::FromCalibration(*message, &got).message(), HasSubstr("gravity"));
  message = SomeMessage();
  message->gravity_standard_error_m_s2.y = -1.0;
  EXPECT_THAT(force_estimation::FromCalibration(*message, &got).message(), HasSubstr("gravity"));
}

dds::Message<idl::palpate_msgs::MarkerArray3> Markers(const std::string& first, double x_m) {
  dds::Message<idl::palpate_msgs::MarkerArray3> message;
  dds::SetHeader(message->header, 7, "camera_depth_optical_frame");
  dds::Resize(message->markers, 2);
  dds::SetText(message->markers._buffer[0].name, first);
  dds::SetText(message->markers._buffer[1].name, "b");
  message->markers._buffer[0].position_m = {x_m, 0.2, 0.3};
  message->markers._buffer[0].valid = true;
  return message;
}

TEST(ConvertMarkers, KeepsThoseThatWereSeenWithTheNoiseOfTheSettingsWhereTheyHaveNone) {
  SeenMarkers seen;
  ASSERT_TRUE(FromMarkerArray(*Markers("c", 0.1), {"b", "c"}, 1e-3, &seen).ok());
  EXPECT_EQ(seen.stamp_ns, 7);
  ASSERT_EQ(seen.markers.size(), 1u);
  EXPECT_EQ(seen.markers[0].marker, 1);
  EXPECT_EQ(seen.markers[0].position_m, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_TRUE(seen.markers[0].covariance_m2.isApprox(1e-6 * Eigen::Matrix3d::Identity(), 1e-12));
}

TEST(ConvertMarkers, KeepsTheirCovarianceAndThoseWithoutANameAsNobody) {
  auto message = Markers("", 0.1);
  Eigen::Matrix3d covariance_m2;
  covariance_m2 << 4e-8, 1e-8, -2e-8, 1e-8, 9e-8, 3e-8, -2e-8, 3e-8, 25e-8;
  Eigen::Map<Eigen::Matrix3d>(message->markers._buffer[0].covariance_m2) = covariance_m2;
  SeenMarkers seen;
  ASSERT_TRUE(FromMarkerArray(*message, {"b", "c"}, 1e-3, &seen).ok());
  ASSERT_EQ(seen.markers.size(), 1u);
  EXPECT_EQ(seen.markers[0].marker, -1);
  EXPECT_EQ(seen.markers[0].covariance_m2, covariance_m2);
}

TEST(ConvertMarkers, RefusesThoseThatAreNotTheRobots) {
  SeenMarkers seen;
  const std::vector<std::string> names = {"b", "cc"};
  EXPECT_THAT(FromMarkerArray(*Markers("ccc", 0.1), names, 1e-3, &seen).message(),
              HasSubstr("did you mean 'cc'"));
}

}  // namespace
}  // namespace palpate::calibration
