// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "libs/core/error.hpp"
#include "tests/libs/robot/robot_files.hpp"

namespace palpate::robot {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

TEST(RobotFile, HoldsWhatIsWritten) {
  const RobotDescription robot = ReadText(FullRobotText(), "folder/robot.yaml");
  EXPECT_EQ(robot.name, "test beam");
  EXPECT_EQ(robot.mesh.file, std::filesystem::path("folder/beam.vtk"));
  EXPECT_EQ(robot.mesh.metres_per_unit, 1e-3);
  EXPECT_EQ(robot.mesh.rotate_xyz_deg, Eigen::Vector3d(0, 0, 90));
  EXPECT_EQ(robot.mesh.translate_m, Eigen::Vector3d(0, 0.1, 0));
  EXPECT_EQ(robot.element, fem::ElementType::kTet10);
  EXPECT_EQ(robot.material.model, fem::MaterialModel::kStableNeoHookean);
  EXPECT_EQ(robot.material.youngs_modulus_Pa, 65e3);
  EXPECT_EQ(robot.material.poissons_ratio, 0.45);
  EXPECT_EQ(robot.mass.total_kg, 0.5);
  EXPECT_FALSE(robot.mass.density_kg_m3);
  EXPECT_EQ(robot.gravity_m_s2, Eigen::Vector3d(0, 0, -9.81));
  ASSERT_EQ(robot.fixed.size(), 1U);
  EXPECT_EQ(robot.fixed[0].upper_m, Eigen::Vector3d(0.011, 0.001, 0.011));
  EXPECT_EQ(robot.feature_point_count, 12);
}

TEST(RobotFile, HoldsCablesRegionsAndMarkersInTheirOrder) {
  const RobotDescription robot = ReadText(FullRobotText());
  ASSERT_EQ(robot.cables.size(), 2U);
  EXPECT_EQ(robot.cables[0].name, "north");
  EXPECT_EQ(robot.cables[0].path_m.cols(), 3);
  EXPECT_EQ(robot.cables[0].path_m.col(2), Eigen::Vector3d(0, 0.09, 0.009));
  EXPECT_EQ(robot.cables[0].max_tension_N, 20.0);
  EXPECT_EQ(robot.cables[0].guide_radius_m, 0.0);
  EXPECT_EQ(robot.cables[1].guide_radius_m, 0.0015);
  ASSERT_EQ(robot.regions.size(), 2U);
  EXPECT_EQ(robot.regions[0].youngs_modulus_Pa, 30e3);
  EXPECT_FALSE(robot.regions[1].youngs_modulus_Pa);
  ASSERT_EQ(robot.markers.size(), 2U);
  EXPECT_EQ(robot.markers[1].name, "2");
}

TEST(RobotFile, HasDefaults) {
  const RobotDescription robot = ReadText(R"(
name: bare
mesh: {file: beam.vtk, unit: m}
material: {model: corotational, youngs_modulus_Pa: 1e5, poissons_ratio: 0.3}
mass: {density_kg_m3: 1070}
fixed: [{box_m: [[0, 0, 0], [1, 1, 1]]}]
)");
  EXPECT_EQ(robot.element, fem::ElementType::kTet10);
  EXPECT_EQ(robot.gravity_m_s2, Eigen::Vector3d(0, 0, -9.81));
  EXPECT_EQ(robot.mass.density_kg_m3, 1070.0);
  EXPECT_EQ(robot.mass.distribution, MassDistribution::kVolume);
  EXPECT_EQ(robot.feature_point_count, 51);
  EXPECT_EQ(robot.material.volumetric, fem::Volumetric::kPointwise);
  EXPECT_TRUE(robot.cables.empty());
}

TEST(RobotFile, NearlyIncompressibleTet10AveragesItsDilatationUnlessToldOtherwise) {
  const auto volumetric = [](const std::string& ratio) {
    return ReadText(Changed("poissons_ratio: 0.45", "poissons_ratio: " + ratio))
        .material.volumetric;
  };
  EXPECT_EQ(volumetric("0.479"), fem::Volumetric::kPointwise);
  EXPECT_EQ(volumetric("0.48"), fem::Volumetric::kMeanDilatation);
  EXPECT_EQ(volumetric("0.499, volumetric: pointwise"), fem::Volumetric::kPointwise);
  EXPECT_EQ(volumetric("0.3, volumetric: mean_dilatation"), fem::Volumetric::kMeanDilatation);
}

TEST(RobotFile, AMaterialWithoutVolumetricEnergyStaysPointwise) {
  for (const std::string model : {"corotational", "st_venant_kirchhoff"}) {
    const auto with = [&](const std::string& end) {
      return Changed(
          "{model: stable_neo_hookean, youngs_modulus_Pa: 65.0e3, poissons_ratio: 0.45}",
          "{model: " + model + ", youngs_modulus_Pa: 65.0e3, poissons_ratio: 0.499" + end + "}");
    };
    EXPECT_EQ(ReadText(with("")).material.volumetric, fem::Volumetric::kPointwise);
    EXPECT_THAT(RefusalOf(with(", volumetric: mean_dilatation")),
                AllOf(StartsWith("robot.yaml:4:"), HasSubstr("material.volumetric"),
                      HasSubstr("material '" + model + "' has no volumetric energy")));
  }
}

TEST(RobotFile, PoissonsRatioGoesUpTo4999AndTheRefusalSaysWhatToGiveInstead) {
  EXPECT_EQ(
      ReadText(Changed("poissons_ratio: 0.45", "poissons_ratio: 0.4999")).material.poissons_ratio,
      0.4999);
  for (const std::string ratio : {"0.49991", "0.5", "0.6"}) {
    EXPECT_THAT(
        RefusalOf(Changed("poissons_ratio: 0.45", "poissons_ratio: " + ratio)),
        AllOf(StartsWith("robot.yaml:4:"), HasSubstr("material.poissons_ratio"),
              HasSubstr("must be > -1 and <= 0.4999, not " + ratio), HasSubstr("give 0.4999")));
  }
}

TEST(RobotFile, FeaturePointsMayBeGiven) {
  for (const char* given : {"feature_points: [[0, 0.1, 0], [0, 0.05, 0.01]]",
                            "feature_points: {positions_m: [[0, 0.1, 0], [0, 0.05, 0.01]]}"}) {
    const RobotDescription robot = ReadText(Changed("feature_points: {count: 12}", given));
    EXPECT_EQ(robot.feature_point_count, 2);
    EXPECT_EQ(robot.feature_points_m.col(1), Eigen::Vector3d(0, 0.05, 0.01));
  }
}

TEST(RobotFile, FeaturePointsMayBeOfOneRegion) {
  const std::string count = "feature_points: {count: 12}";
  const RobotDescription tip = ReadText(Changed(count, "feature_points: {region: tip}"));
  EXPECT_EQ(tip.feature_point_region, "tip");
  EXPECT_EQ(tip.feature_point_count, RobotDescription().feature_point_count);
  EXPECT_EQ(ReadText(Changed(count, "feature_points: {count: 5, region: tip}")).feature_point_count,
            5);
  EXPECT_THAT(RefusalOf(Changed(count, "feature_points: {region: tpi}")),
              AllOf(HasSubstr("did you mean 'tip'"), HasSubstr("tip, root")));
  EXPECT_THAT(RefusalOf(Changed(count, "feature_points: {region: tip, positions_m: [[0, 0, 0]]}")),
              HasSubstr("positions_m"));
  EXPECT_THAT(RefusalOf(Changed(count, "feature_points: {}")), HasSubstr("region"));
}

TEST(RobotFile, TranslationMayBeInMetres) {
  const RobotDescription robot =
      ReadText(Changed("translate_mm: [0, 100, 0]", "translate_m: [0, 0.1, 0]"));
  EXPECT_EQ(robot.mesh.translate_m, Eigen::Vector3d(0, 0.1, 0));
  EXPECT_THAT(RefusalOf(Changed("translate_mm: [0, 100, 0]",
                                "translate_m: [0, 0.1, 0], translate_mm: [0, 0, 0]")),
              HasSubstr("translate_m is given too"));
}

TEST(RobotFile, RefusesAnUnknownKeyAndSaysWhichWasMeant) {
  EXPECT_THAT(RefusalOf(Changed("max_tension_N: 20", "max_tensoin_N: 20")),
              AllOf(StartsWith("robot.yaml:9:"), HasSubstr("max_tensoin_N"),
                    HasSubstr("did you mean 'max_tension_N'?"),
                    HasSubstr("allowed: name, path_m, max_tension_N, guide_radius_m, "
                              "friction_coefficient, play_m")));
  EXPECT_THAT(RefusalOf(FullRobotText() + "colour: red\n"),
              AllOf(StartsWith("robot.yaml:16:"), HasSubstr("colour")));
  EXPECT_THAT(RefusalOf(Changed("element: tet10", "elemnt: tet10")),
              HasSubstr("did you mean 'element'?"));
}

TEST(RobotFile, MayRememberCreepSofteningAndPlay) {
  const std::string ratio = "poissons_ratio: 0.45";
  const RobotDescription robot = ReadText(
      Changed(ratio, ratio + ", creep: [{share: 0.15, time_s: 5}, {share: 0.1, time_s: 60}], "
                             "softening: {r: 2.5, m_J_m3: 300}"));
  EXPECT_THAT(robot.creep,
              testing::ElementsAre(fem::PronyTerm{0.15, 5.0}, fem::PronyTerm{0.1, 60.0}));
  EXPECT_EQ(robot.softening, (fem::MullinsLaw{2.5, 300.0}));
  EXPECT_EQ(ReadText(Changed("max_tension_N: 20", "play_m: 0.001")).cables[0].play_m, 0.001);
  EXPECT_TRUE(ReadText(FullRobotText()).creep.empty());
  EXPECT_FALSE(ReadText(FullRobotText()).softening);
}

TEST(RobotFile, RefusesAMemoryThatCannotBe) {
  const std::string ratio = "poissons_ratio: 0.45";
  const std::pair<const char*, const char*> cases[] = {
      {"creep: [{share: 0, time_s: 5}]", "share"},
      {"creep: [{share: 0.1, time_s: -1}]", "time_s"},
      {"creep: [{share: 0.1}]", "time_s"},
      {"creep: {share: 0.1, time_s: 5}", "must be a list of creep terms"},
      {"creep: [{share: .nan, time_s: 5}]", "share"},
      {"softening: {r: 1, m_J_m3: 300}", "must be > 1"},
      {"softening: {r: 2, m_J_m3: 0}", "m_J_m3"},
      {"softening: {r: 2, m_kJ_m3: 0.3}", "m_J_m3"}};
  for (const auto& [given, says] : cases) {
    EXPECT_THAT(RefusalOf(Changed(ratio, ratio + ", " + given)),
                AllOf(StartsWith("robot.yaml:4:"), HasSubstr(says)))
        << given;
  }
  EXPECT_THAT(RefusalOf(Changed("max_tension_N: 20", "play_m: -0.001")),
              AllOf(StartsWith("robot.yaml:9:"), HasSubstr("play_m")));
}

TEST(RobotFile, RefusesAUnitThatDoesNotFit) {
  const std::pair<const char*, const char*> cases[] = {
      {"youngs_modulus_Pa: 65.0e3", "youngs_modulus_kPa: 65"},
      {"total_kg: 0.5", "total_g: 500"},
      {"guide_radius_m: 0", "guide_radius_mm: 0"},
      {"max_tension_N: 20", "max_tension_kN: 0.02"},
      {"gravity_m_s2: [0, 0, -9.81]", "gravity_mm_s2: [0, 0, -9810]"},
      {"translate_mm: [0, 100, 0]", "translate_cm: [0, 10, 0]"},
      {"rotate_xyz_deg: [0, 0, 90]", "rotate_xyz_rad: [0, 0, 1.57]"},
      {"position_m: [0, 0.1, 0.016]", "position_mm: [0, 100, 16]"}};
  for (const auto& [right, wrong] : cases) {
    EXPECT_THAT(RefusalOf(Changed(right, wrong)),
                AllOf(StartsWith("robot.yaml:"), HasSubstr("does not fit")))
        << wrong;
  }
  EXPECT_THAT(RefusalOf(Changed("total_kg: 0.5", "total: 0.5")), HasSubstr("the unit is missing"));
  EXPECT_THAT(RefusalOf(Changed("unit: mm", "unit: inch")), HasSubstr("m, cm, mm"));
}

TEST(RobotFile, RefusesNumbersThatAreNotFinite) {
  const std::pair<const char*, const char*> cases[] = {
      {"youngs_modulus_Pa: 65.0e3", "youngs_modulus_Pa: .nan"},
      {"[0, 0.09, 0.009]", "[0, .nan, 0.009]"},
      {"[0, 0, -9.81]", "[0, 0, -.inf]"},
      {"[0, 0.1, 0.016]", "[0, nan, 0.016]"},
      {"total_kg: 0.5", "total_kg: .NaN"},
      {"[0, 100, 0]", "[0, .inf, 0]"}};
  for (const auto& [right, wrong] : cases) {
    EXPECT_THAT(RefusalOf(Changed(right, wrong)), HasSubstr("must be finite")) << wrong;
  }
}

TEST(RobotFile, RefusesNumbersOutOfRange) {
  const std::pair<const char*, const char*> cases[] = {
      {"poissons_ratio: 0.45", "poissons_ratio: 0.5"},
      {"poissons_ratio: 0.45", "poissons_ratio: -1"},
      {"youngs_modulus_Pa: 65.0e3", "youngs_modulus_Pa: 0"},
      {"youngs_modulus_Pa: 30e3", "youngs_modulus_Pa: -30e3"},
      {"total_kg: 0.5", "total_kg: 0"},
      {"max_tension_N: 20", "max_tension_N: 0"},
      {"guide_radius_m: 0", "guide_radius_m: -0.001"},
      {"count: 12", "count: 0"}};
  for (const auto& [right, wrong] : cases) {
    EXPECT_THAT(RefusalOf(Changed(right, wrong)),
                AllOf(StartsWith("robot.yaml:"), HasSubstr("must be ")))
        << wrong;
  }
}

TEST(RobotFile, RefusesACableWithOnePoint) {
  EXPECT_THAT(
      RefusalOf(Changed("path_m: [[0, 0, -0.02], [0, 0.095, -0.009]]", "path_m: [[0, 0, -0.02]]")),
      AllOf(StartsWith("robot.yaml:10:"), HasSubstr("cables[1].path_m"),
            HasSubstr("at least 2 points")));
  EXPECT_THAT(RefusalOf(Changed("[0, 0.095, -0.009]", "[0, 0, -0.02]")),
              HasSubstr("the same point as the one before it"));
}

TEST(RobotFile, RefusesANameGivenTwice) {
  EXPECT_THAT(RefusalOf(Changed("name: south", "name: north")),
              AllOf(StartsWith("robot.yaml:10:"), HasSubstr("'north' is given twice")));
  EXPECT_THAT(RefusalOf(Changed("name: root", "name: tip")), HasSubstr("'tip' is given twice"));
  EXPECT_THAT(RefusalOf(Changed("name: \"2\"", "name: m1")), HasSubstr("'m1' is given twice"));
}

TEST(RobotFile, RefusesANameThatWouldBreakATable) {
  EXPECT_THAT(RefusalOf(Changed("name: south", "name: \"so,uth\"")), HasSubstr("without commas"));
  EXPECT_THAT(RefusalOf(Changed("name: south", "name: \" south\"")), HasSubstr("blanks"));
  EXPECT_THAT(RefusalOf(Changed("name: south", "name: \"\"")), HasSubstr("must be a name"));
}

TEST(RobotFile, RefusesBothMassesAndNone) {
  EXPECT_THAT(RefusalOf(Changed("total_kg: 0.5", "total_kg: 0.5, density_kg_m3: 1070")),
              HasSubstr("give one of them"));
  EXPECT_THAT(RefusalOf(Changed("total_kg: 0.5, ", "")),
              HasSubstr("needs total_kg or density_kg_m3"));
}

TEST(RobotFile, RefusesAModelThatIsNotThereAndNamesThoseThatAre) {
  EXPECT_THAT(RefusalOf(Changed("model: stable_neo_hookean", "model: ogden")),
              AllOf(StartsWith("robot.yaml:4:"), HasSubstr("corotational"),
                    HasSubstr("st_venant_kirchhoff"), HasSubstr("stable_neo_hookean")));
}

TEST(RobotFile, RefusesBoxesThatAreNone) {
  const std::string box = "[[-0.011, -0.001, -0.011], [0.011, 0.001, 0.011]]";
  EXPECT_THAT(RefusalOf(Changed(box, "[[0, 0, 0], [1, -1, 1]]")), HasSubstr("lower one"));
  EXPECT_THAT(RefusalOf(Changed(box, "[[0, 0, 0]]")), HasSubstr("two corners"));
  EXPECT_THAT(RefusalOf(Changed("[{box_m: " + box + "}]", "[]")), HasSubstr("that nothing holds"));
}

TEST(RobotFile, RefusesMissingKeysAndWrongTypes) {
  EXPECT_THAT(RefusalOf(Changed("mass: {total_kg: 0.5, distribution: volume}\n", "")),
              HasSubstr("'mass' is missing"));
  EXPECT_THAT(RefusalOf(Changed("feature_points: {count: 12}", "feature_points: 12")),
              StartsWith("robot.yaml:15:"));
  EXPECT_THAT(RefusalOf(Changed("feature_points: {count: 12}", "feature_points: []")),
              HasSubstr("at least one point"));
  EXPECT_THAT(RefusalOf(Changed("element: tet10", "element: hex8")), HasSubstr("tet4, tet10"));
  EXPECT_THAT(RefusalOf(Changed("[0, 0.1, 0.016]", "[0, 0.1]")), HasSubstr("3 numbers"));
}

}  // namespace
}  // namespace palpate::robot
