// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/calibration_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "tests/libs/robot/calibration_file_fixture.hpp"

namespace palpate::robot {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class CalibrationFileTest : public CalibrationFileFixture {
 protected:
  CalibrationFile Example() const override {
    CalibrationFile calibration = DescribeForCalibration(*model_);
    calibration.date_utc = "2026-01-31T12:00:00Z";
    calibration.data = "a \"quoted\" folder\\with: signs # of YAML";
    calibration.data_hash = "sha256-00ff";
    calibration.moduli = {{"body", 61234.56789012345, 321.0}, {"tip", 1.0 / 3e-5, 0.0}};
    calibration.residual_rms_m = 1.25e-4;
    calibration.chi_squared = 17.5;
    calibration.degrees_of_freedom = 19;
    return calibration;
  }

  std::string ApplyRefusal(const CalibrationFile& calibration) {
    try {
      ApplyCalibration(calibration, model_.get());
    } catch (const InputError& error) {
      return error.what();
    }
    ADD_FAILURE() << "nothing was refused";
    return {};
  }
};

TEST_F(CalibrationFileTest, IsReadAsItWasWritten) {
  const CalibrationFile written = Example();
  WriteCalibrationFile(written, file_);
  const CalibrationFile read = ReadCalibrationFile(file_, app::LoadYaml);
  EXPECT_EQ(read.robot, "test beam");
  EXPECT_EQ(read.mesh_hash, model_->body().mesh_hash);
  EXPECT_EQ(read.element, "tet10");
  EXPECT_EQ(read.model, "stable_neo_hookean");
  EXPECT_EQ(read.poissons_ratio, 0.45);
  EXPECT_EQ(read.volumetric, "pointwise");
  EXPECT_EQ(read.date_utc, written.date_utc);
  EXPECT_EQ(read.data, written.data);
  EXPECT_EQ(read.data_hash, written.data_hash);
  ASSERT_EQ(read.moduli.size(), 2U);
  for (size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(read.moduli[k].part, written.moduli[k].part);
    EXPECT_EQ(read.moduli[k].youngs_modulus_Pa, written.moduli[k].youngs_modulus_Pa);
    EXPECT_EQ(read.moduli[k].standard_error_Pa, written.moduli[k].standard_error_Pa);
  }
  EXPECT_EQ(read.residual_rms_m, written.residual_rms_m);
  EXPECT_EQ(read.chi_squared, written.chi_squared);
  EXPECT_EQ(read.degrees_of_freedom, written.degrees_of_freedom);
}

TEST_F(CalibrationFileTest, GivesTheModelItsModuli) {
  ApplyCalibration(Example(), model_.get());
  EXPECT_EQ(model_->body().materials[0].youngs_modulus_Pa, 61234.56789012345);
  EXPECT_EQ(model_->body().materials[1].youngs_modulus_Pa, 1.0 / 3e-5);
  EXPECT_EQ(model_->body().materials[2].youngs_modulus_Pa, 65e3);
  EXPECT_EQ(model_->elastic_body().materials()[0].youngs_modulus_Pa, 61234.56789012345);
}

TEST_F(CalibrationFileTest, RefusesWhatItWasNotMadeFor) {
  CalibrationFile other = Example();
  other.robot = "snake";
  EXPECT_THAT(ApplyRefusal(other), AllOf(HasSubstr("'snake'"), HasSubstr("'test beam'")));
  other = Example();
  other.mesh_hash = "fnv1a-0000000000000000";
  EXPECT_THAT(ApplyRefusal(other), AllOf(HasSubstr("mesh"), HasSubstr(other.mesh_hash),
                                         HasSubstr(model_->body().mesh_hash)));
  other = Example();
  other.element = "tet4";
  EXPECT_THAT(ApplyRefusal(other), AllOf(HasSubstr("element 'tet4'"), HasSubstr("'tet10'")));
  other = Example();
  other.model = "corotational";
  EXPECT_THAT(ApplyRefusal(other),
              AllOf(HasSubstr("'corotational'"), HasSubstr("'stable_neo_hookean'")));
  other = Example();
  other.poissons_ratio = 0.49;
  EXPECT_THAT(ApplyRefusal(other), AllOf(HasSubstr("0.49"), HasSubstr("0.45")));
  other = Example();
  other.volumetric = "mean_dilatation";
  EXPECT_THAT(ApplyRefusal(other), AllOf(HasSubstr("'mean_dilatation'"), HasSubstr("'pointwise'")));
  other = Example();
  other.c20_over_c10 = 0.1;
  EXPECT_THAT(ApplyRefusal(other), AllOf(HasSubstr("c20_over_c10"), HasSubstr("0.1")));
}

TEST_F(CalibrationFileTest, HoldsTheConstantsOfYeoh) {
  CalibrationFile written = Example();
  written.model = "yeoh";
  written.c20_over_c10 = 0.125;
  written.c30_over_c10 = 0.25;
  WriteCalibrationFile(written, file_);
  const CalibrationFile read = ReadCalibrationFile(file_, app::LoadYaml);
  EXPECT_EQ(read.c20_over_c10, 0.125);
  EXPECT_EQ(read.c30_over_c10, 0.25);
}

TEST_F(CalibrationFileTest, MayLeaveTheVolumetricTreatmentOut) {
  WriteFile(file_, Altered("volumetric: pointwise\n", ""));
  const CalibrationFile read = ReadCalibrationFile(file_, app::LoadYaml);
  EXPECT_EQ(read.volumetric, "");
  ApplyCalibration(read, model_.get());
}

TEST_F(CalibrationFileTest, ARefusedRegionLeavesTheModelAsItWas) {
  CalibrationFile other = Example();
  other.moduli.push_back({"tipp", 5e4, 0.0});
  EXPECT_THAT(ApplyRefusal(other), AllOf(HasSubstr("'tipp'"), HasSubstr("did you mean 'tip'")));
  EXPECT_EQ(model_->body().materials[0].youngs_modulus_Pa, 65e3);
}

TEST_F(CalibrationFileTest, RefusesAFileThatIsNoCalibration) {
  EXPECT_THAT(ReadRefusal(Altered("element:", "elements: 1\nelement:")),
              AllOf(HasSubstr(file_.string() + ":4:1"), HasSubstr("elements")));
  EXPECT_THAT(ReadRefusal(Altered("element: tet10", "element: hex8")), HasSubstr("hex8"));
  EXPECT_THAT(ReadRefusal(Altered("model: stable", "model: unstable")), HasSubstr("unstable"));
  EXPECT_THAT(ReadRefusal(Altered("poissons_ratio: 0.45", "poissons_ratio: 0.5")),
              HasSubstr("0.5"));
  EXPECT_THAT(ReadRefusal(Altered("residual_rms_m: ", "residual_rms_m: .nan #")),
              HasSubstr("residual_rms_m"));
  EXPECT_THAT(ReadRefusal(Altered("chi_squared", "#chi_squared")), HasSubstr("chi_squared"));
  EXPECT_THAT(ReadRefusal(Altered("youngs_modulus_Pa: 6", "youngs_modulus_Pa: -6")),
              HasSubstr("youngs_modulus_Pa"));
  EXPECT_THAT(ReadRefusal("robot: x\n"), HasSubstr("mesh_hash"));
  std::string text = Altered("moduli:\n", "moduli: []\n#");
  for (size_t at = 0; (at = text.find("\n  - ", at)) != std::string::npos;) text[at + 1] = '#';
  EXPECT_THAT(ReadRefusal(text), HasSubstr("must hold moduli, poissons_ratios, gravity_m_s2"));
}

TEST_F(CalibrationFileTest, HoldsPoseAndDrivesAndWhatIsNotDetermined) {
  CalibrationFile written = Example();
  written.moduli.clear();
  CalibratedPose pose;
  pose.T_robot_camera = Eigen::Translation3d(-0.265, 0.264, 0.0128) *
                        Eigen::AngleAxisd(1.1, Eigen::Vector3d(1.0, 2.0, 3.0).normalized());
  pose.rotation_error_rad = {1e-3, 2e-3, 3e-3};
  pose.translation_error_m = {1e-4, 2e-4, 3e-4};
  written.pose = pose;
  written.drives = {{"pull", {7e-4, 0.05}, {1e-5, 0.01}}};
  written.undetermined = {{"cable_offset:west", "a recording with: it \"pulled\"", 2e-3, 1e-3}};
  WriteCalibrationFile(written, file_);
  const CalibrationFile read = ReadCalibrationFile(file_, app::LoadYaml);
  EXPECT_TRUE(read.moduli.empty());
  ASSERT_TRUE(read.pose);
  EXPECT_TRUE(read.pose->T_robot_camera.isApprox(pose.T_robot_camera, 1e-15));
  EXPECT_EQ(read.pose->rotation_error_rad, pose.rotation_error_rad);
  EXPECT_EQ(read.pose->translation_error_m, pose.translation_error_m);
  ASSERT_EQ(read.drives.size(), 1U);
  EXPECT_EQ(read.drives[0].cable, "pull");
  EXPECT_EQ(read.drives[0].drive.offset_m, 7e-4);
  EXPECT_EQ(read.drives[0].drive.gain, 0.05);
  EXPECT_EQ(read.drives[0].standard_error.offset_m, 1e-5);
  EXPECT_EQ(read.drives[0].standard_error.gain, 0.01);
  ASSERT_EQ(read.undetermined.size(), 1U);
  EXPECT_EQ(read.undetermined[0].name, "cable_offset:west");
  EXPECT_EQ(read.undetermined[0].what_would_tell, "a recording with: it \"pulled\"");
  EXPECT_EQ(read.undetermined[0].standard_error, 2e-3);
  EXPECT_EQ(read.undetermined[0].limit, 1e-3);
}

TEST_F(CalibrationFileTest, HoldsAndGivesGravityAndPoissonsRatios) {
  CalibrationFile written = Example();
  written.moduli.clear();
  written.poissons_ratios = {{"body", 0.41, 0.02}};
  written.gravity = CalibratedGravity{{0.3, -0.2, -9.7}, {0.1, 0.2, 0.01}};
  WriteCalibrationFile(written, file_);
  const CalibrationFile read = ReadCalibrationFile(file_, app::LoadYaml);
  ASSERT_EQ(read.poissons_ratios.size(), 1U);
  EXPECT_EQ(read.poissons_ratios[0].standard_error, 0.02);
  ASSERT_TRUE(read.gravity);
  EXPECT_EQ(read.gravity->standard_error_m_s2, written.gravity->standard_error_m_s2);
  ApplyCalibration(read, model_.get());
  EXPECT_EQ(model_->body().materials[0].poissons_ratio, 0.41);
  EXPECT_EQ(model_->gravity_m_s2(), written.gravity->gravity_m_s2);

  written.poissons_ratios[0].part = "nowhere";
  written.gravity->gravity_m_s2.setZero();
  EXPECT_THAT(ApplyRefusal(written), HasSubstr("nowhere"));
  EXPECT_EQ(model_->gravity_m_s2(), read.gravity->gravity_m_s2);

  std::string text = ReadFile(file_);
  const std::string key = "gravity_standard_error_m_s2";
  text.replace(text.find(key), key.size(), "# ");
  EXPECT_THAT(ReadRefusal(text), HasSubstr(key));
}

TEST_F(CalibrationFileTest, DrivesReadWhatIsMeasured) {
  CalibrationFile calibration = Example();
  calibration.moduli.clear();
  const std::string cable = model_->ActuatorNames().front();
  calibration.drives = {{cable, {7e-4, 0.05}, {}}};
  ApplyCalibration(calibration, model_.get());
  const ActuatorCommand command = model_->CommandFor(0, 0.01, {}, CableInput::kDisplacement);
  EXPECT_EQ(command.kind, ActuatorCommand::Kind::kDisplacement);
  EXPECT_DOUBLE_EQ(command.value, 1.05 * 0.01 + 7e-4);
  EXPECT_EQ(model_->CommandFor(0, {}, 2.0, CableInput::kDisplacement).value, 2.0);
  calibration.drives[0].cable = cable + "x";
  EXPECT_THAT(ApplyRefusal(calibration), HasSubstr(cable + "x"));
}

/// The pose carries its largest errors, so that it can be copied into experiment.yaml.
TEST_F(CalibrationFileTest, APoseWithoutErrorsOfEachAxisHasItsOwn) {
  CalibrationFile written = Example();
  written.pose = CalibratedPose{.T_robot_camera = Eigen::Isometry3d::Identity(),
                                .rotation_error_rad = {1e-3, 3e-3, 2e-3},
                                .translation_error_m = {4e-4, 2e-4, 3e-4}};
  WriteCalibrationFile(written, file_);
  std::string text = ReadFile(file_);
  const std::string key = "T_robot_camera_standard_error";
  text.replace(text.find(key), key.size(), "# ");
  folder_.Write("c.yaml", text);
  const CalibrationFile read = ReadCalibrationFile(folder_ / "c.yaml", app::LoadYaml);
  EXPECT_EQ(read.pose->rotation_error_rad, Eigen::Vector3d::Constant(3e-3));
  EXPECT_EQ(read.pose->translation_error_m, Eigen::Vector3d::Constant(4e-4));
}

TEST_F(CalibrationFileTest, APoseWithoutErrorsIsNotExact) {
  CalibrationFile written = Example();
  written.pose = CalibratedPose{};
  WriteCalibrationFile(written, file_);
  std::string text = ReadFile(file_);
  const std::string key = "T_robot_camera_standard_error";
  text.replace(text.find(key), key.size(), "# ");
  folder_.Write("c.yaml", text);
  const CalibrationFile read = ReadCalibrationFile(folder_ / "c.yaml", app::LoadYaml);
  EXPECT_EQ(read.pose->rotation_error_rad, Eigen::Vector3d::Constant(0.01));
  EXPECT_EQ(read.pose->translation_error_m, Eigen::Vector3d::Constant(0.005));
}

TEST_F(CalibrationFileTest, RefusesAFileThatIsNotThere) {
  EXPECT_THROW(ReadCalibrationFile(folder_ / "none.yaml", app::LoadYaml), InputError);
  EXPECT_THROW(WriteCalibrationFile(Example(), folder_ / "none" / "c.yaml"), RunError);
}

TEST_F(CalibrationFileTest, TellsTheLargestRelativeError) {
  CalibrationFile calibration;
  EXPECT_EQ(RelativeModulusError(calibration), 0.0);
  calibration.moduli = {{"body", 100e3, 1e3}, {"tip", 50e3, 2e3}};
  EXPECT_DOUBLE_EQ(RelativeModulusError(calibration), 0.04);
}

}  // namespace
}  // namespace palpate::robot
