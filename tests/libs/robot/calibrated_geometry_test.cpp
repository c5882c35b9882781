// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/calibrated_geometry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "libs/app/yaml.hpp"
#include "libs/robot/calibration_file.hpp"
#include "libs/robot/eyelets.hpp"
#include "tests/libs/robot/calibration_file_fixture.hpp"

namespace palpate::robot {
namespace {

using testing::HasSubstr;

constexpr double kScale = 1.07;

class CalibratedGeometryTest : public CalibrationFileFixture {
 protected:
  CalibrationFile Example() const override {
    CalibrationFile calibration = DescribeForCalibration(*model_);
    calibration.date_utc = "2026-01-31T12:00:00Z";
    calibration.data = "some";
    calibration.data_hash = "sha256-00ff";
    calibration.geometry_scale = CalibratedScale{kScale, 1.25e-3};
    calibration.cable_routes = {{Cable(), 0, {1e-3, -2e-3, 0.5e-3}, {1e-4, 2e-4, 3e-4}},
                                {Cable(), 1, kEyeletMoved_m, {2e-4, 2e-4, 0.0}}};
    return calibration;
  }
  const Eigen::Vector3d kEyeletMoved_m{-1e-3, 0.5e-3, 2e-3};
  std::string Cable() const { return model_->ActuatorNames().front(); }

  RobotBody Scaled() const {
    RobotBody body = model_->body();
    ApplyGeometry(Example(), &body);
    return body;
  }
};

TEST_F(CalibratedGeometryTest, IsReadAsItWasWritten) {
  const CalibrationFile written = Example();
  WriteCalibrationFile(written, file_);
  const CalibrationFile read = ReadCalibrationFile(file_, app::LoadYaml);
  ASSERT_TRUE(read.geometry_scale);
  EXPECT_EQ(read.geometry_scale->scale, kScale);
  EXPECT_EQ(read.geometry_scale->standard_error, 1.25e-3);
  ASSERT_EQ(read.cable_routes.size(), 2u);
  EXPECT_EQ(read.cable_routes[0].point, 0);
  EXPECT_EQ(read.cable_routes[1].point, 1);
  EXPECT_EQ(read.cable_routes[1].moved_m, kEyeletMoved_m);
  EXPECT_EQ(read.cable_routes[0].cable, Cable());
  EXPECT_EQ(read.cable_routes[0].moved_m, written.cable_routes[0].moved_m);
  EXPECT_EQ(read.cable_routes[0].standard_error_m, written.cable_routes[0].standard_error_m);
}

TEST_F(CalibratedGeometryTest, IsRefusedWithItsPlaceInTheFile) {
  const std::string scale = "geometry_scale: {scale: 1.07, ";
  EXPECT_THAT(ReadRefusal(Altered(scale, "geometry_scale: {scale: 2.5, ")),
              AllOf(HasSubstr(file_.string() + ":11:25"), HasSubstr("2.5")));
  EXPECT_THAT(ReadRefusal(Altered(scale, "geometry_scale: {scale: .nan, ")), HasSubstr("scale"));
  EXPECT_THAT(ReadRefusal(Altered(scale, "geometry_scale: {scales: 1.07, ")), HasSubstr(":11:"));
  EXPECT_THAT(ReadRefusal(Altered("standard_error: 0.00125", "standard_error: -1")),
              HasSubstr("standard_error"));
  EXPECT_THAT(ReadRefusal(Altered("moved_m: [", "moved_m: [.inf, ")), HasSubstr(":13:"))
      << "four numbers";
  EXPECT_THAT(ReadRefusal(Altered("standard_error_m", "standard_errors_m")), HasSubstr(":13:"));
  EXPECT_THAT(ReadRefusal(Altered("point: 0", "point: -1")), HasSubstr(":13:"));
  EXPECT_THAT(ReadRefusal(Altered("moved_m: [0.001", "moved_m: [0.501")),
              AllOf(HasSubstr(":13:"), HasSubstr("0.501")));
}

/// ToModel of the calibration says what a robot of another size does: at the same stress, its
/// tensions are as the square of the size, its weight in the robot's frame as the cube.
TEST_F(CalibratedGeometryTest, ARobotOfThatSizeIsTheModelEnlarged) {
  RobotBody body = model_->body();
  ScaleBody(kScale, &body);
  RobotModel large(body);
  EXPECT_EQ(large.body().scale, kScale);
  EXPECT_NEAR(large.body().node_mass_kg.sum(),
              std::pow(kScale, 3) * model_->body().node_mass_kg.sum(), 1e-12);
  model_->SetGravity(kScale * large.gravity_m_s2());
  const double tension_N = 0.5;
  fem::StaticState small_state = model_->RestState(), large_state = large.RestState();
  std::vector<ActuatorCommand> commands(static_cast<std::size_t>(model_->ActuatorCount()));
  commands[0] = {ActuatorCommand::Kind::kTension, tension_N};
  const Status solved = model_->Solve(commands, {}, &small_state).status;
  ASSERT_TRUE(solved.ok()) << solved.message();
  commands[0].value *= kScale * kScale;
  ASSERT_TRUE(large.Solve(commands, {}, &large_state).status.ok());
  EXPECT_GT((small_state.x_m - model_->RestState().x_m).norm(), 1e-3);
  EXPECT_LT((large_state.x_m - kScale * small_state.x_m).lpNorm<Eigen::Infinity>(), 1e-8);
  EXPECT_NEAR(large.StateOfActuator(0, large_state).displacement_m,
              kScale * model_->StateOfActuator(0, small_state).displacement_m, 1e-9);
  for (std::size_t m = 0; m < large.body().markers.size(); ++m) {
    const fem::BodyPoint& marker = large.body().markers[m].point;
    EXPECT_TRUE(marker.weights.Position(large.RestState().x_m).isApprox(marker.rest_m, 1e-9));
  }
}

TEST_F(CalibratedGeometryTest, GuidesAreMovedAsMuchAsTheRobotIsLarger) {
  const Eigen::Vector3d guide_m = model_->cable(0).pull_point_m();
  RobotModel large(Scaled());
  ApplyCalibration(Example(), &large);
  EXPECT_TRUE(large.cable(0).pull_point_m().isApprox(
      kScale * (guide_m + Eigen::Vector3d(1e-3, -2e-3, 0.5e-3)), 1e-12));
  EXPECT_NEAR(large.actuator_rest_m()[0], large.cable(0).rest_length_m(), 1e-15);
}

TEST_F(CalibratedGeometryTest, EyeletsAreMovedAsMuchAsTheRobotIsLarger) {
  const fem::BodyPoint before = model_->body().cables[0].eyelets[0];
  RobotModel large(Scaled());
  const BodyCable& cable = large.body().cables[0];
  EXPECT_LT((cable.eyelets[0].rest_m - kScale * (before.rest_m + kEyeletMoved_m)).norm(), 1e-15);
  EXPECT_EQ(EyeletMoved_m(cable, 0), kEyeletMoved_m);
  EXPECT_LT((EyeletPlace_m(cable, kScale, 0) - kScale * before.rest_m).norm(), 1e-15);
  EXPECT_LT((large.cable(0).eyelets()[0].Position(large.RestState().x_m) - cable.eyelets[0].rest_m)
                .norm(),
            1e-12);
  ApplyCalibration(Example(), &large);
  EXPECT_EQ(cable.eyelets[0].rest_m, large.body().cables[0].eyelets[0].rest_m);
}

TEST_F(CalibratedGeometryTest, AModelWithEyeletsElsewhereOrWithoutThemRefusesIt) {
  CalibrationFile other = Example();
  other.cable_routes[1].moved_m.z() += 1e-6;
  const RobotModel large(Scaled());
  EXPECT_THAT(CheckCalibration(other, large).message(),
              HasSubstr("eyelet 1 of cable '" + Cable() + "' elsewhere than the model"));
  other.cable_routes.pop_back();
  EXPECT_THAT(CheckCalibration(other, large).message(), HasSubstr("elsewhere than the model"));
  other = Example();
  other.cable_routes[1].point = 3;
  EXPECT_THAT(CheckCalibration(other, large).message(),
              AllOf(HasSubstr("holds point 3"), HasSubstr("path has 3 points")));
}

TEST_F(CalibratedGeometryTest, AModelOfAnotherSizeOrWithoutTheCableRefusesIt) {
  EXPECT_THAT(CheckCalibration(Example(), *model_).message(),
              AllOf(HasSubstr("1.07 times as large"), HasSubstr("the model is 1 times")));
  RobotModel large(Scaled());
  EXPECT_TRUE(CheckCalibration(Example(), large).ok());
  CalibrationFile other = Example();
  other.geometry_scale.reset();
  EXPECT_THAT(CheckCalibration(other, large).message(), HasSubstr("the model is 1.07 times"));
  other = Example();
  other.cable_routes[0].cable += "x";
  EXPECT_THAT(CheckCalibration(other, large).message(), HasSubstr("did you mean '" + Cable()));
}

TEST_F(CalibratedGeometryTest, NumbersThatAreNoneAreRefused) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const CalibrationFile good = Example();
  EXPECT_TRUE(CheckGeometry(good.geometry_scale, good.cable_routes).ok());
  for (const double scale : {kNaN, 0.0, 0.49, 2.01}) {
    EXPECT_FALSE(CheckGeometry(CalibratedScale{scale, 0.0}, {}).ok()) << scale;
  }
  EXPECT_FALSE(CheckGeometry(CalibratedScale{1.0, -1.0}, {}).ok());
  std::vector<CalibratedRoute> routes = good.cable_routes;
  routes[0].moved_m.y() = kNaN;
  EXPECT_THAT(CheckGeometry({}, routes).message(), HasSubstr("'" + Cable() + "'"));
  routes = good.cable_routes;
  routes[0].standard_error_m.z() = -1e-9;
  EXPECT_FALSE(CheckGeometry({}, routes).ok());
  routes = good.cable_routes;
  routes[1].moved_m.x() = -0.051;
  EXPECT_THAT(CheckGeometry({}, routes).message(), HasSubstr("point 1 of cable '" + Cable()));
  routes = good.cable_routes;
  routes[0].point = -1;
  EXPECT_FALSE(CheckGeometry({}, routes).ok());
}

}  // namespace
}  // namespace palpate::robot
