// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "libs/app/yaml.hpp"
#include "libs/core/file.hpp"
#include "libs/robot/robot_description.hpp"
#include "tests/support/test_folder.hpp"
#include "tests/system/blind/palpate_command.hpp"
#include "tests/system/blind/generator.hpp"

/// `palpate diagnose` as a person calls it, on robots of the virtual bench.
namespace palpate::blind {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

const fs::path kSource = PALPATE_SOURCE_DIR;

class DiagnoseVerb : public testing::Test {
 protected:
  /// An experiment of this scenario of config/scenarios with this hidden in it.
  void Make(const std::string& effect, const std::string& of = "diagnose.yaml") {
    std::string scenario = ReadFile(kSource / "config/scenarios" / of);
    Replace(
        mesh_,
        mesh_of_truth_.empty() ? (kSource / "config/scenarios" / mesh_).string() : mesh_of_truth_,
        &scenario);
    if (!element_of_truth_.empty()) Replace("element: tet10", element_of_truth_, &scenario);
    Replace("effects: []", "effects: [" + effect + "]", &scenario);
    if (!recordings_.empty()) scenario = WithRecordings(scenario, recordings_);
    WriteFile(folder_ / "scenario.yaml", scenario);
    const auto made =
        Palpate({"simulate", robot_, "--scenario", (folder_ / "scenario.yaml").string(), "--seed",
                 seed_, "--out", (folder_ / "exp").string()},
                folder_ / "simulate.log");
    ASSERT_EQ(made, 0) << "seed " << seed_ << "\n" << ReadFile(folder_ / "simulate.log");
  }

  std::optional<int> Diagnose(const std::vector<std::string>& options = {}) {
    std::vector<std::string> words = {"diagnose", robot_,
                                      "--data",   (folder_ / "exp").string(),
                                      "--out",    (folder_ / "out").string()};
    words.insert(words.end(), options.begin(), options.end());
    return Palpate(words, folder_ / "diagnose.log");
  }
  Json Verdict() const { return Json::parse(ReadFile(folder_ / "out/verdict.json")); }

  test_support::TestFolder own_folder_;
  const fs::path folder_ = own_folder_.path();
  std::string robot_ = "four_leg";
  std::string mesh_ = "four_leg_coarse.msh";  ///< of the scenario
  std::string mesh_of_truth_;                 ///< in the place of that; empty: that
  std::string element_of_truth_;              ///< in the place of the scenario's, or empty
  std::set<std::string> recordings_;          ///< of the scenario; empty: all
  std::string seed_ = "7";
};

/// The cables of the rod are between slack and taut at rest, and turn with it by ten degrees.
class DiagnoseVerbOfARod : public DiagnoseVerb {
 protected:
  DiagnoseVerbOfARod() {
    robot_ = (kSource / "config/robots/rod.yaml").string();
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
    std::string robot = ReadFile(kSource / "config/robots/four_leg.yaml");
    Replace("element: tet10", "element: tet4", &robot);
    Replace("file: four_leg.msh", "file: " + file_mesh_, &robot);
    robot_ = (folder_ / "four_leg.yaml").string();
    WriteFile(robot_, robot);
    recordings_ = {"R0_rest", "RA_east",  "RA_north",  "RA_south",
                   "RA_west", "RC_pairs", "RS_weight", "RZ_rest"};
  }

  const std::string file_mesh_ = (kSource / "config/robots/four_leg.msh").string();
};

TEST_F(DiagnoseVerbOfCoarseCells, NamesThemAndWhatIsWrongBesideThem) {
  constexpr double kGain = 0.1;
  seed_ = "8";
  Make("{id: cable_gain, where: 'cable:north', g: 0.1}");
  ASSERT_EQ(Diagnose({"--samples", "40"}), 0) << ReadFile(folder_ / "diagnose.log");
  const Json verdict = Verdict();
  EXPECT_EQ(verdict["verdict"], "cause") << verdict["reason"];
  ASSERT_EQ(verdict["causes"].size(), 2U) << verdict["reason"];
  EXPECT_EQ(verdict["causes"][0]["id"], "discretisation");
  EXPECT_EQ(verdict["causes"][1]["id"], "cable_gain");
  EXPECT_EQ(verdict["causes"][1]["where"], "cable:north");
  EXPECT_NEAR(verdict["causes"][1]["parameters"]["g"]["value"].get<double>(), kGain, 0.4 * kGain);
  const Json& rms_m = verdict["residual_m_rms"];
  EXPECT_LT(rms_m["heldout_after"].get<double>(), 0.4 * rms_m["heldout_before"].get<double>());
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
  EXPECT_LT(rms_m["heldout_after"].get<double>(), 0.5 * rms_m["heldout_before"].get<double>());
  const robot::RobotDescription nominal =
      robot::ReadRobotFile(kSource / "config/robots/four_leg.yaml", app::LoadYaml);
  const robot::RobotDescription extended =
      robot::ReadRobotFile(folder_ / "out/robot.extended.yaml", app::LoadYaml);
  EXPECT_NEAR(extended.material.youngs_modulus_Pa, value * nominal.material.youngs_modulus_Pa, 1.0);
  EXPECT_EQ(Palpate({"info", (folder_ / "out/robot.extended.yaml").string()}, folder_ / "info.log"),
            0);
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

TEST_F(DiagnoseVerb, SaysNothingOfACameraThatStoodStill) {
  Make("");
  const fs::path file = folder_ / "exp/recordings/RA_north/markers.csv";
  std::vector<std::string> lines;
  std::string text = ReadFile(file);
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  const std::size_t first = 1;
  const std::string stamp = lines[first].substr(0, lines[first].find(','));
  std::size_t markers = 0;
  while (lines[first + markers].starts_with(stamp + ",")) ++markers;
  for (std::size_t k = first; k < lines.size(); ++k) {
    const std::string& shown = lines[first + (k - first) % markers];
    lines[k] = lines[k].substr(0, lines[k].find(',')) + shown.substr(shown.find(','));
  }
  text.clear();
  for (const std::string& line : lines) text += line + "\n";
  WriteFile(file, text);
  EXPECT_EQ(Diagnose(), 1);
  const Json verdict = Verdict();
  EXPECT_EQ(verdict["verdict"], "data_unfit");
  EXPECT_TRUE(verdict["causes"].empty());
  EXPECT_THAT(verdict["reason"].get<std::string>(), testing::HasSubstr("RA_north"));
  EXPECT_FALSE(fs::exists(folder_ / "out/robot.extended.yaml"));
}

TEST_F(DiagnoseVerb, RefusesACauseThatDoesNotExist) {
  EXPECT_EQ(Palpate({"diagnose", "four_leg", "--data", "x", "--out", (folder_ / "out").string(),
                     "--exclude", "cable_frictoin"},
                    folder_ / "log"),
            2);
  EXPECT_THAT(ReadFile(folder_ / "log"), testing::HasSubstr("cable_friction"));
}

}  // namespace
}  // namespace palpate::blind
