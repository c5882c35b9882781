// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/libs/robot/robot_files.hpp"

namespace palpate::robot {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string WithMaterial(const std::string& model, const std::string& more) {
  return Changed(
      "{model: stable_neo_hookean, youngs_modulus_Pa: 65.0e3, poissons_ratio: 0.45}",
      "{model: " + model + ", youngs_modulus_Pa: 65.0e3, poissons_ratio: 0.49" + more + "}");
}

TEST(YeohMaterial, IsReadWrittenAndReadBack) {
  const std::string text = WithMaterial("yeoh", ", c20_over_c10: -0.065, c30_over_c10: 0.003");
  const RobotDescription robot = ReadText(text, "here/robot.yaml");
  EXPECT_EQ(robot.material.model, fem::MaterialModel::kYeoh);
  EXPECT_EQ(robot.material.volumetric, fem::Volumetric::kMeanDilatation);
  EXPECT_EQ(robot.material.c20_over_c10, -0.065);
  EXPECT_EQ(robot.material.c30_over_c10, 0.003);
  const RobotDescription again = ReadText(FormatRobotFile(robot, "there"), "there/robot.yaml");
  EXPECT_EQ(again.material.model, fem::MaterialModel::kYeoh);
  EXPECT_EQ(again.material.c20_over_c10, -0.065);
  EXPECT_EQ(again.material.c30_over_c10, 0.003);
}

TEST(YeohMaterial, NeedsBothRatios) {
  EXPECT_THAT(RefusalOf(WithMaterial("yeoh", ", c20_over_c10: 0.1")), HasSubstr("c30_over_c10"));
  EXPECT_THAT(RefusalOf(WithMaterial("yeoh", ", c30_over_c10: 0.1")), HasSubstr("c20_over_c10"));
}

TEST(YeohMaterial, RefusesRatiosThatSoftenToNothing) {
  EXPECT_THAT(RefusalOf(WithMaterial("yeoh", ", c20_over_c10: -0.1, c30_over_c10: 0.003")),
              AllOf(HasSubstr("robot.yaml:4:"), HasSubstr("c30_over_c10"),
                    HasSubstr("lose its stiffness")));
  EXPECT_THAT(RefusalOf(WithMaterial("yeoh", ", c20_over_c10: 0.1, c30_over_c10: -0.003")),
              HasSubstr("c30_over_c10"));
  EXPECT_THAT(RefusalOf(WithMaterial("yeoh", ", c20_over_c10: .nan, c30_over_c10: 0.003")),
              HasSubstr("c20_over_c10"));
}

TEST(YeohMaterial, RatiosBelongToNoOtherMaterial) {
  for (const std::string key : {"c20_over_c10", "c30_over_c10"}) {
    EXPECT_THAT(RefusalOf(WithMaterial("stable_neo_hookean", ", " + key + ": 0.1")),
                AllOf(HasSubstr(key), HasSubstr("belongs to the material 'yeoh'")));
  }
}

}  // namespace
}  // namespace palpate::robot
