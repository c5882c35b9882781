// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "libs/app/yaml.hpp"
#include "libs/core/file.hpp"
#include "libs/robot/robot_description.hpp"
#include "tests/system/blind/diagnose_fixture.hpp"

/// `palpate diagnose` as a person calls it, on robots of the virtual bench.
namespace palpate::blind {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// The cables of the rod are between slack and taut at rest, and turn with it by ten degrees.
class DiagnoseVerbOfARod : public DiagnoseVerb {
 protected:
  DiagnoseVerbOfARod() {
    robot_ = (Source() / "config/robots/rod.yaml").string();
    mesh_ = "rod_coarse.msh";
    recordings_ = {"R0_rest",   "RA_a_up", "RA_b_down", "RA_c_left", "RA_d_right",
                   "RB_repeat", "RH_hold", "RS_weight", "RZ_rest"};
  }
};

TEST_F(DiagnoseVerbOfARod, AcquitsAHealthyOne) {
  // Its creep, within the tolerance, is in the data of what follows a hold.
  seed_ = "11";
  Make("", "diagnose_rod.yaml");
  ASSERT_EQ(Diagnose({"--samples", "40"}), 0) << ReadFile(folder_ / "diagnose.log");
  const Json verdict = Verdict();
  EXPECT_EQ(verdict["verdict"], "no_fault") << verdict["reason"];
}

TEST_F(DiagnoseVerbOfARod, NamesItsCreep) {
  constexpr double kG = 0.2;
  seed_ = "24";
  Make("{id: viscoelastic_creep, g: 0.2, tau_s: 15}", "diagnose_rod.yaml");
  ASSERT_EQ(Diagnose({"--samples", "40"}), 0) << ReadFile(folder_ / "diagnose.log");
  const Json verdict = Verdict();
  ASSERT_EQ(verdict["causes"].size(), 1U) << verdict["reason"];
  EXPECT_EQ(verdict["causes"][0]["id"], "viscoelastic_creep");
  const Json& parameters = verdict["causes"][0]["parameters"];
  EXPECT_NEAR(parameters["g"]["value"].get<double>(), kG, 0.2 * kG);
}

/// Its mesh in cells of four nodes, which bend a quarter too little.
class DiagnoseVerbOfCoarseCells : public DiagnoseVerb {
 protected:
  DiagnoseVerbOfCoarseCells() {
    std::string robot = ReadFile(Source() / "config/robots/four_leg.yaml");
    Replace("element: tet10", "element: tet4", &robot);
    Replace("file: four_leg.msh", "file: " + file_mesh_, &robot);
    robot_ = (folder_ / "four_leg.yaml").string();
    WriteFile(robot_, robot);
    recordings_ = {"R0_rest", "RA_east",  "RA_north",  "RA_south",
                   "RA_west", "RC_pairs", "RS_weight", "RZ_rest"};
  }

  const std::string file_mesh_ = (Source() / "config/robots/four_leg.msh").string();
};

TEST_F(DiagnoseVerbOfCoarseCells, NamesThemAndWhatIsWrongBesideThem) {
  constexpr double kGain = 0.2;  // the model discrepancy takes up 0.1
  seed_ = "8";
  Make("{id: cable_gain, where: 'cable:north', g: 0.2}");
  ASSERT_EQ(Diagnose({"--samples", "40"}), 0) << ReadFile(folder_ / "diagnose.log");
  const Json verdict = Verdict();
  EXPECT_EQ(verdict["verdict"], "cause") << verdict["reason"];
  ASSERT_EQ(verdict["causes"].size(), 2U) << verdict["reason"];
  EXPECT_EQ(verdict["causes"][0]["id"], "discretisation");
  EXPECT_EQ(verdict["causes"][1]["id"], "cable_gain");
  EXPECT_EQ(verdict["causes"][1]["where"], "cable:north");
  EXPECT_NEAR(verdict["causes"][1]["parameters"]["g"]["value"].get<double>(), kGain, 0.4 * kGain);
  const Json& rms_m = verdict["residual_m_rms"];
  EXPECT_LT(rms_m["heldout_after"].get<double>(), 0.4 * rms_m["before"].get<double>());
  const robot::RobotDescription extended =
      robot::ReadRobotFile(folder_ / "out/robot.extended.yaml", app::LoadYaml);
  EXPECT_EQ(extended.element, fem::ElementType::kTet10);
}

/// The robot's own body errs as much there.
TEST_F(DiagnoseVerbOfCoarseCells, AcquitsThemWhereTheDataAreOfSuch) {
  seed_ = "9";
  mesh_of_truth_ = file_mesh_;
  element_of_truth_ = "element: tet4";
  Make("");
  ASSERT_EQ(Diagnose({"--samples", "40"}), 0) << ReadFile(folder_ / "diagnose.log");
  const Json verdict = Verdict();
  EXPECT_EQ(verdict["verdict"], "no_fault") << verdict["reason"];
}

TEST_F(DiagnoseVerb, NamesASoftBodyAndWritesARobotFileThatOthersTake) {
  constexpr double kFactor = 0.7;
  Make("{id: youngs_modulus, factor: 0.7}");
  ASSERT_EQ(Diagnose({"--samples", "40"}), 0) << ReadFile(folder_ / "diagnose.log");
  const Json verdict = Verdict();
  EXPECT_EQ(verdict["verdict"], "cause") << verdict["reason"];
  ASSERT_EQ(verdict["causes"].size(), 1U);
  EXPECT_EQ(verdict["causes"][0]["id"], "youngs_modulus");
  const Json& ci95 = verdict["causes"][0]["parameters"]["factor"]["ci95"];
  const double half = 0.5 * (ci95[1].get<double>() - ci95[0].get<double>());
  const double value = verdict["causes"][0]["parameters"]["factor"]["value"].get<double>();
  EXPECT_LT(half, 0.1 * kFactor);
  EXPECT_NEAR(value, kFactor, 2.0 * half);  // four sigma
  const Json& rms_m = verdict["residual_m_rms"];
  EXPECT_LT(rms_m["heldout_after"].get<double>(), 0.5 * rms_m["before"].get<double>());
  const robot::RobotDescription nominal =
      robot::ReadRobotFile(Source() / "config/robots/four_leg.yaml", app::LoadYaml);
  const robot::RobotDescription extended =
      robot::ReadRobotFile(folder_ / "out/robot.extended.yaml", app::LoadYaml);
  EXPECT_NEAR(extended.material.youngs_modulus_Pa, value * nominal.material.youngs_modulus_Pa, 1.0);
  EXPECT_EQ(Palpate({"info", (folder_ / "out/robot.extended.yaml").string()}, folder_ / "info.log"),
            0);
  EXPECT_THAT(ReadFile(folder_ / "out/robot.extended.yaml"),
              testing::AllOf(testing::StartsWith("# Written by palpate diagnose"),
                             testing::HasSubstr("E of ")));
  EXPECT_THAT(ReadFile(folder_ / "out/report.html"), testing::HasSubstr("<svg"));
}

TEST_F(DiagnoseVerb, NamesTheDepthScaleOfTheCameraThatMeasuredTheMarkers) {
  constexpr double kScale = -0.019;
  recordings_ = {"R0_rest",   "RA_east",  "RA_north",  "RA_south",  "RA_west",
                 "RB_repeat", "RM_moved", "RS_weight", "RT_tilt_x", "RZ_rest"};
  Make("{id: depth_scale, s: -0.019}", "diagnose_camera.yaml");
  ASSERT_EQ(Diagnose({"--samples", "40"}), 0) << ReadFile(folder_ / "diagnose.log");
  const Json verdict = Verdict();
  ASSERT_EQ(verdict["causes"].size(), 1U) << verdict["reason"];
  EXPECT_EQ(verdict["causes"][0]["id"], "depth_scale");
  EXPECT_EQ(verdict["causes"][0]["where"], "camera");
  const Json& s = verdict["causes"][0]["parameters"]["s"];
  const double half = 0.5 * (s["ci95"][1].get<double>() - s["ci95"][0].get<double>());
  EXPECT_LT(half, 0.1 * std::abs(kScale));
  EXPECT_NEAR(s["value"].get<double>(), kScale, 2.0 * half);  // four sigma
}

}  // namespace
}  // namespace palpate::blind
