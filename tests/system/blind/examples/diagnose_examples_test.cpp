// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "libs/core/file.hpp"
#include "tests/system/blind/diagnose_fixture.hpp"

/// One robot of each kind through `palpate diagnose`, with fixed seeds and few cells. The night
/// draws others (nightly/).
namespace palpate::blind {
namespace {

/// The robot's body has 1293 linear cells, and so has the one that made the data: a diagnosis takes
/// seconds, and the mesh is no fault.
class DiagnoseExamples : public DiagnoseVerb {
 protected:
  DiagnoseExamples() {
    std::string robot = ReadFile(Source() / "config/robots/four_leg.yaml");
    Replace("element: tet10", "element: tet4", &robot);
    Replace("file: four_leg.msh", "file: " + (Source() / "config/scenarios" / mesh_).string(),
            &robot);
    robot_ = (folder_ / "four_leg.yaml").string();
    WriteFile(robot_, robot);
    element_of_truth_ = "element: tet4";
    recordings_ = {"R0_rest", "RA_east", "RA_north", "RC_pairs", "RS_weight"};
  }

  nlohmann::json DiagnoseQuickly(std::vector<std::string> options = {}) {
    options.insert(options.end(), {"--samples", "20"});
    EXPECT_EQ(Diagnose(options), 0) << ReadFile(folder_ / "diagnose.log");
    return Verdict();
  }
};

TEST_F(DiagnoseExamples, FindASoftBody) {
  constexpr double kFactor = 0.7;
  Make("{id: youngs_modulus, factor: 0.7}");
  const nlohmann::json verdict = DiagnoseQuickly();
  EXPECT_EQ(verdict["verdict"], "cause") << verdict["reason"];
  ASSERT_EQ(verdict["causes"].size(), 1U) << verdict["reason"];
  EXPECT_EQ(verdict["causes"][0]["id"], "youngs_modulus");
  const nlohmann::json& ci95 = verdict["causes"][0]["parameters"]["factor"]["ci95"];
  EXPECT_LT(ci95[0].get<double>(), kFactor);
  EXPECT_GT(ci95[1].get<double>(), kFactor);
  EXPECT_LT(ci95[1].get<double>() - ci95[0].get<double>(), 0.2 * kFactor);
}

TEST_F(DiagnoseExamples, AcquitAHealthyRobot) {
  Make("");
  const nlohmann::json verdict = DiagnoseQuickly();
  EXPECT_EQ(verdict["verdict"], "no_fault") << verdict["reason"];
  EXPECT_TRUE(verdict["causes"].empty()) << verdict.dump(1);
}

/// The body follows its cables late, and the catalogue must do without that.
TEST_F(DiagnoseExamples, FlagAnEffectThatIsNotInTheCatalogue) {
  Make("{id: lag, delay_s: 0.4}");
  const nlohmann::json verdict = DiagnoseQuickly({"--exclude", "lag"});
  EXPECT_EQ(verdict["verdict"], "unexplained") << verdict["reason"];
  EXPECT_TRUE(verdict["causes"].empty()) << verdict.dump(1);
}

TEST_F(DiagnoseExamples, SaysNothingOfACameraThatStoodStill) {
  Make("");
  const std::filesystem::path file = folder_ / "exp/recordings/RA_north/markers.csv";
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
  const nlohmann::json verdict = Verdict();
  EXPECT_EQ(verdict["verdict"], "data_unfit");
  EXPECT_TRUE(verdict["causes"].empty());
  EXPECT_THAT(verdict["reason"].get<std::string>(), testing::HasSubstr("RA_north"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/robot.extended.yaml"));
}

TEST_F(DiagnoseExamples, RefusesACauseThatDoesNotExist) {
  EXPECT_EQ(Palpate({"diagnose", "four_leg", "--data", "x", "--out", (folder_ / "out").string(),
                     "--exclude", "cable_frictoin"},
                    folder_ / "log"),
            2);
  EXPECT_THAT(ReadFile(folder_ / "log"), testing::HasSubstr("cable_friction"));
}

}  // namespace
}  // namespace palpate::blind
