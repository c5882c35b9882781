// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/calibrated_depth_bias.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/robot/calibration_file.hpp"
#include "tests/libs/robot/beam_model.hpp"

namespace palpate::robot {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class CalibratedDepthBiasTest : public BeamModelTest {
 protected:
  static CalibratedDepthBias Bias() {
    CalibratedDepthBias bias;
    bias.picture = {848, 480, 425.1, 424.9, 423.5, 239.25};
    bias.map.basis = {.order = 1, .span = 0.3};
    bias.map.coefficients = Eigen::Vector3d(1.0 / 3e3, -2e-3, 1e-19);
    Eigen::MatrixXd root = Eigen::MatrixXd::Zero(9, 4);
    for (Eigen::Index i = 0; i < root.size(); ++i) {
      root(i % 9, i / 9) = 1e-3 / (1.0 + static_cast<double>(7 * i % 11));
    }
    bias.map.covariance = root * root.transpose();  // singular: four things are unknown
    return bias;
  }

  CalibrationFile Example() const {
    CalibrationFile calibration = DescribeForCalibration(*model_);
    calibration.date_utc = "2026-01-31T12:00:00Z";
    calibration.data_hash = "sha256-00ff";
    calibration.pose.emplace();
    calibration.depth_bias = Bias();
    return calibration;
  }

  /// What is said of the example's file with one text replaced.
  std::string RefusalWith(const std::string& old_text, const std::string& new_text) {
    WriteCalibrationFile(Example(), file_);
    std::string text = ReadFile(file_);
    const std::size_t at = text.find(old_text);
    EXPECT_NE(at, std::string::npos) << old_text;
    WriteFile(file_, text.replace(at, old_text.size(), new_text));
    try {
      ReadCalibrationFile(file_, app::LoadYaml);
    } catch (const InputError& error) {
      return error.what();
    }
    ADD_FAILURE() << "nothing was refused: " << new_text;
    return {};
  }

  std::unique_ptr<RobotModel> model_ = Build(FullRobotText());
  std::filesystem::path file_ = folder_ / "calibration.yaml";
};

TEST_F(CalibratedDepthBiasTest, IsReadAsItWasWritten) {
  WriteCalibrationFile(Example(), file_);
  const CalibrationFile read = ReadCalibrationFile(file_, app::LoadYaml);
  ASSERT_TRUE(read.depth_bias);
  const CalibratedDepthBias written = Bias();
  EXPECT_EQ(read.depth_bias->picture, written.picture);
  EXPECT_EQ(read.depth_bias->map.basis, written.map.basis);
  EXPECT_EQ(read.depth_bias->map.coefficients, written.map.coefficients);
  EXPECT_EQ(read.depth_bias->map.covariance, written.map.covariance);
}

TEST_F(CalibratedDepthBiasTest, OfFurtherCamerasIsReadAsItWasWritten) {
  CalibrationFile written = Example();
  written.cameras.resize(2);
  written.cameras[0].name = "back";
  written.cameras[0].pose.T_robot_camera.translation() = Eigen::Vector3d(0.1, -0.2, 1.0 / 3.0);
  written.cameras[0].pose.translation_error_m = Eigen::Vector3d(1e-3, 2e-3, 3e-3);
  written.cameras[0].pose.rotation_error_rad = Eigen::Vector3d(4e-3, 5e-3, 6e-3);
  written.cameras[0].depth_bias = Bias();
  written.cameras[1].name = "left";
  WriteCalibrationFile(written, file_);
  const CalibrationFile read = ReadCalibrationFile(file_, app::LoadYaml);
  ASSERT_EQ(read.cameras.size(), 2u);
  EXPECT_EQ(read.cameras[0].name, "back");
  EXPECT_EQ(read.cameras[0].pose.T_robot_camera.translation(),
            written.cameras[0].pose.T_robot_camera.translation());
  EXPECT_EQ(read.cameras[0].pose.translation_error_m, Eigen::Vector3d(1e-3, 2e-3, 3e-3));
  ASSERT_TRUE(read.cameras[0].depth_bias);
  EXPECT_EQ(read.cameras[0].depth_bias->map.covariance, Bias().map.covariance);
  EXPECT_FALSE(read.cameras[1].depth_bias);
}

TEST_F(CalibratedDepthBiasTest, RefusesFurtherCamerasThatAreNone) {
  CalibrationFile written = Example();
  written.cameras.resize(2);
  const auto refusal = [&](const std::string& one, const std::string& other) {
    written.cameras[0].name = one;
    written.cameras[1].name = other;
    WriteCalibrationFile(written, file_);
    try {
      ReadCalibrationFile(file_, app::LoadYaml);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refusal("back", "left_2"), "accepted");
  EXPECT_THAT(refusal("back", "back"),
              AllOf(testing::ContainsRegex("calibration.yaml:[0-9]+:[0-9]+"),
                    HasSubstr("camera 'back' again"), HasSubstr("remove one")));
  for (const std::string name : {"", "2nd", "back/left", "_back", "back left"}) {
    EXPECT_THAT(refusal("back", name),
                AllOf(testing::ContainsRegex("calibration.yaml:[0-9]+:[0-9]+"),
                      HasSubstr("'" + name + "'"), HasSubstr("a letter first")));
  }
}

TEST_F(CalibratedDepthBiasTest, RefusesABlockThatIsNone) {
  EXPECT_THAT(RefusalWith("width_px: 848", "width_px: 0"), HasSubstr("width_px"));
  EXPECT_THAT(RefusalWith("fx_px: 425.1", "fx_px: -425.1"), HasSubstr("fx_px"));
  EXPECT_THAT(RefusalWith("span: 0.3", "span: 0"), HasSubstr("span"));
  EXPECT_THAT(RefusalWith("order: 1", "order: 5"), HasSubstr("order"));
  EXPECT_THAT(RefusalWith("order: 1", "order: 2"),
              AllOf(HasSubstr("coefficients"), HasSubstr("the 6 of this order")));
  EXPECT_THAT(RefusalWith("coefficients: [", "coefficients: [.inf, "), HasSubstr("coefficients"));
  EXPECT_THAT(RefusalWith("  covariance:\n", "  covariance:\n    - [1]\n"),
              HasSubstr("lower triangle of a covariance of 9 numbers"));
  EXPECT_THAT(RefusalWith("  covariance:\n    - [", "  covariance:\n    - [0, "),
              HasSubstr("lower triangle"));
  EXPECT_THAT(RefusalWith("  covariance:\n    - [", "  covariance:\n    - [-"),
              HasSubstr("a variance below 0"));
  EXPECT_THAT(RefusalWith("  span:", "  spam: 1\n  span:"), HasSubstr("spam"));
}

TEST_F(CalibratedDepthBiasTest, BelongsToAPose) {
  WriteCalibrationFile(Example(), file_);
  std::string text = ReadFile(file_);
  const std::size_t at = text.find("T_robot_camera:");
  const std::size_t end = text.find("\n# A point that is measured", at);
  text.erase(at, end - at);
  WriteFile(file_, text);
  EXPECT_THROW(ReadCalibrationFile(file_, app::LoadYaml), InputError);
}

TEST_F(CalibratedDepthBiasTest, IsForImagesOfOneSizeAndLens) {
  const CalibratedDepthBias bias = Bias();
  EXPECT_TRUE(CheckDepthPicture(bias, bias.picture).ok());
  geometry::DepthPicture other = bias.picture;
  other.width_px = 640;
  const Status status = CheckDepthPicture(bias, other);
  EXPECT_EQ(status.code(), StatusCode::kInvalidInput);
  EXPECT_THAT(status.message(), AllOf(HasSubstr("848"), HasSubstr("640")));
  other = bias.picture;
  other.cy_px += 1.0;
  EXPECT_EQ(CheckDepthPicture(bias, other).code(), StatusCode::kInvalidInput);
}

TEST_F(CalibratedDepthBiasTest, IsCheckedWhereItComesFromElsewhere) {
  EXPECT_TRUE(CheckDepthBias(Bias()).ok());
  const auto refusal = [](const CalibratedDepthBias& bias) {
    const Status status = CheckDepthBias(bias);
    EXPECT_EQ(status.code(), StatusCode::kInvalidInput);
    return status.message();
  };
  CalibratedDepthBias bias = Bias();
  bias.picture.height_px = 0;
  EXPECT_THAT(refusal(bias), HasSubstr("no image"));
  bias = Bias();
  bias.map.basis.span = 0.0;
  EXPECT_THAT(refusal(bias), HasSubstr("span 0"));
  bias = Bias();
  bias.map.coefficients[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(bias), HasSubstr("coefficients"));
  bias = Bias();
  bias.map.covariance.diagonal()[3] = -1.0;
  EXPECT_THAT(refusal(bias), HasSubstr("covariance"));
}

}  // namespace
}  // namespace palpate::robot
