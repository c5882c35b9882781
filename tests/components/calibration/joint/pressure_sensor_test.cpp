// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "components/calibration/joint/found_calibration.hpp"
#include "components/calibration/joint/joint_request.hpp"
#include "libs/robot/calibration_file.hpp"
#include "tests/components/calibration/joint/joint_scene.hpp"

namespace palpate::calibration {
namespace {

constexpr double kMarkerSigma_m = 1e-4;

/// Priors that tell next to nothing.
const JointRequest kByDataAlone{
    .pressure_zero_sigma_Pa = 1e5, .pressure_gain_sigma = 10.0, .modulus_relative_sigma = 10.0};

/// Zero and gain of a sensor.
struct Sensor {
  double zero_Pa = 0.0;
  double gain = 0.0;
};

/// The arm with three chambers, whose sensors read wrongly, seen by a camera at an unknown pose.
class PressureSensors : public testing::Test {
 protected:
  static robot::RobotDescription Arm() {
    robot::RobotDescription arm = test_support::QuickRobot("pneumatic_arm");
    arm.mesh.file =
        std::filesystem::path(PALPATE_SOURCE_DIR) / "config/scenarios/pneumatic_arm_coarse.msh";
    return arm;
  }

  geometry::RigidTransform TruePose() const {
    return {
        Eigen::Quaterniond(Eigen::AngleAxisd(2.0, Eigen::Vector3d(0.3, -0.8, 0.5).normalized())),
        {0.1, -0.2, 0.4}};
  }

  /// What is seen, and read, where the sensors read these pressures; none: all are open to the air.
  CalibrationFrame Frame(const std::string& name, const std::vector<double>& read_Pa,
                         const std::vector<robot::DeadLoad>& loads = {}) {
    std::vector<robot::ActuatorCommand> pressed(3), read(3);
    for (std::size_t c = 0; c < read_Pa.size(); ++c) {
      const robot::ActuatorTraits& piston = model_->traits(static_cast<int>(c));
      const double pressure_Pa = (1.0 + sensors_[c].gain) * read_Pa[c] + sensors_[c].zero_Pa;
      pressed[c] = {Kind::kTension, piston.Force_N(pressure_Pa)};
      read[c] = {Kind::kTension, piston.Force_N(read_Pa[c])};
    }
    CalibrationFrame frame =
        See(*model_, TruePose(), name, pressed, loads, kMarkerSigma_m, random_);
    frame.cables = read;
    return frame;
  }

  std::vector<CalibrationFrame> Frames(const std::vector<robot::DeadLoad>& loads = {}) {
    std::vector<CalibrationFrame> frames = {Frame("open", {})};
    for (std::size_t c = 0; c < 3; ++c) {
      std::vector<double> read_Pa(3, 2e3);
      for (const double high_Pa : {12e3, 25e3}) {
        read_Pa[c] = high_Pa;
        frames.push_back(Frame("chamber " + std::to_string(c), read_Pa, loads));
      }
    }
    return frames;
  }

  std::vector<robot::DeadLoad> Weight() const {
    return {force_estimation::LoadAt(*model_, model_->body().markers.back().point.rest_m, 0.004,
                                     {0.3, 0.2, 0.0})};
  }

  const FittedValue& Found(const JointCalibration& fit, const std::string& id, int chamber) const {
    return *ValueNamed(fit, id + ":" + model_->ChamberNames()[static_cast<std::size_t>(chamber)]);
  }

  std::unique_ptr<robot::RobotModel> model_ = force_estimation::Build(Arm());
  std::vector<Sensor> sensors_ = {{-1500.0, 0.12}, {800.0, -0.2}, {2500.0, 0.05}};
  std::mt19937_64* random_ = nullptr;  ///< of the noise; nullptr: there is none
};

TEST_F(PressureSensors, AreFoundExactlyWithoutNoise) {
  const JointCalibration fit = CalibrateFrames(*model_, Frames(), nullptr, kByDataAlone);
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  for (int c = 0; c < 3; ++c) {
    const Sensor& hidden = sensors_[static_cast<std::size_t>(c)];
    EXPECT_NEAR(Found(fit, "pressure_zero", c).value, hidden.zero_Pa, 0.5);
    EXPECT_NEAR(Found(fit, "pressure_gain", c).value, hidden.gain, 1e-4);
  }
}

/// Of the noise alone. The errors of 18 draws, in their standard errors: with more than 4 of one of
/// them, or a mean square beyond 2, the standard errors would be too small.
TEST_F(PressureSensors, AreFoundWithinTheirStandardErrors) {
  double squares = 0.0;
  int count = 0;
  for (const unsigned seed : {1U, 2U, 3U}) {
    std::mt19937_64 random(seed);
    random_ = &random;
    JointRequest request = kByDataAlone;
    request.marker_placement_sigma_m = 0.0;
    const JointCalibration fit = CalibrateFrames(*model_, Frames(), nullptr, request);
    ASSERT_TRUE(fit.status.ok()) << fit.status.message();
    for (int c = 0; c < 3; ++c) {
      const Sensor& hidden = sensors_[static_cast<std::size_t>(c)];
      for (const auto& [id, truth] :
           {std::pair("pressure_zero", hidden.zero_Pa), std::pair("pressure_gain", hidden.gain)}) {
        const FittedValue& found = Found(fit, id, c);
        ASSERT_TRUE(found.determined) << found.name;
        const double sigmas = (found.value - truth) / found.standard_error;
        EXPECT_LT(std::abs(sigmas), 4.0) << found.name << ", seed " << seed;
        squares += sigmas * sigmas;
        ++count;
      }
    }
  }
  EXPECT_LT(squares / count, 2.0);
  EXPECT_GT(squares / count, 0.3);
}

TEST_F(PressureSensors, HaveTheEffectOfTheModulusWithoutAKnownForce) {
  JointRequest request;
  request.moduli = {0};
  model_->SetGravity(Eigen::Vector3d::Zero());
  const JointCalibration fit = CalibrateFrames(*model_, Frames(), nullptr, request);
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  int held = 0;
  for (int c = 0; c < 3; ++c) {
    const FittedValue& gain = Found(fit, "pressure_gain", c);
    if (gain.determined) continue;
    ++held;
    EXPECT_EQ(gain.value, 0.0) << "its prior mean";
    EXPECT_GT(gain.reached_error, gain.error_limit);
    EXPECT_THAT(gain.what_would_tell, testing::HasSubstr("known load"));
    EXPECT_THAT(gain.what_would_tell, testing::HasSubstr("same effect"));
  }
  EXPECT_GT(held, 0);
  robot::CalibrationFile file;
  TakeFit(fit, *model_, &file);
  for (const robot::CalibratedPressureSensor& sensor : file.pressure_sensors) {
    const bool is_held = std::any_of(
        file.undetermined.begin(), file.undetermined.end(),
        [&](const auto& number) { return number.name == "pressure_gain:" + sensor.chamber; });
    EXPECT_EQ(sensor.gain.has_value(), !is_held) << sensor.chamber;
  }
}

TEST_F(PressureSensors, AreToldFromTheModulusByAKnownForce) {
  JointRequest request = kByDataAlone;
  request.moduli = {0};
  const double truth_Pa = model_->body().materials[0].youngs_modulus_Pa;
  std::vector<CalibrationFrame> frames = Frames();
  const std::vector<CalibrationFrame> loaded = Frames(Weight());
  frames.insert(frames.end(), loaded.begin(), loaded.end());
  model_->SetYoungsModulus(0, 0.8 * truth_Pa);
  const JointCalibration fit = CalibrateFrames(*model_, frames, nullptr, request);
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  const FittedValue* modulus = ValueNamed(fit, "youngs_modulus:body");
  EXPECT_TRUE(modulus->determined);
  EXPECT_NEAR(modulus->value, truth_Pa, 1e-3 * truth_Pa);
  for (int c = 0; c < 3; ++c) {
    EXPECT_TRUE(Found(fit, "pressure_gain", c).determined);
    EXPECT_NEAR(Found(fit, "pressure_gain", c).value, sensors_[static_cast<std::size_t>(c)].gain,
                1e-3);
  }
}

/// An open chamber has no reading, and no pressure that would have to be found.
TEST_F(PressureSensors, AreNotReadWhereAllChambersAreOpen) {
  const JointCalibration fit =
      CalibrateFrames(*model_, {Frame("open", {}), Frame("again", {})}, nullptr, {});
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  EXPECT_TRUE(fit.values.empty());
  EXPECT_LT(fit.residual_rms_m, 1e-8);
}

TEST_F(PressureSensors, AreNotEstimatedWithTheSizeOfTheRobot) {
  const JointCalibration fit =
      CalibrateFrames(*model_, Frames(), nullptr, {.geometry_scale_sigma = 0.01});
  EXPECT_EQ(fit.status.code(), StatusCode::kInvalidInput);
  EXPECT_THAT(fit.status.message(), testing::HasSubstr("chambers"));
}

}  // namespace
}  // namespace palpate::calibration
