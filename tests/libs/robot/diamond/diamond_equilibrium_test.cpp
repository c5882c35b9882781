// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "libs/app/yaml.hpp"
#include "libs/robot/robot_model.hpp"
#include "tests/support/measured_data.hpp"

namespace palpate::robot {
namespace {

std::filesystem::path DiamondFolder() { return test_support::MeasuredDataFolder() / "diamond"; }

/// The robot file that a user writes after the data's README.
std::string RobotText(const std::string& model, const std::string& element) {
  return "name: diamond\nelement: " + element +
         "\nmesh: {file: diamond.vtu, unit: mm, rotate_xyz_deg: [90, 0, 0], "
         "translate_mm: [0, 0, 35]}\nmaterial: {model: " +
         model + R"(, youngs_modulus_Pa: 180e3, poissons_ratio: 0.45}
mass: {total_kg: 0.5, distribution: per_node}
gravity_m_s2: [0, 0, -9.81]
fixed: [{box_m: [[-0.015, -0.015, -0.040], [0.015, 0.015, 0.010]]}]
cables:
  - {name: north, path_m: [[0, 0.010, 0.030], [0, 0.097, 0.045]], guide_radius_m: 0}
  - {name: west, path_m: [[-0.010, 0, 0.030], [-0.097, 0, 0.045]], guide_radius_m: 0}
  - {name: south, path_m: [[0, -0.010, 0.030], [0, -0.097, 0.045]], guide_radius_m: 0}
  - {name: east, path_m: [[0.010, 0, 0.030], [0.097, 0, 0.045]], guide_radius_m: 0}
)";
}

RobotModel BuildDiamond(const std::string& model, const std::string& element) {
  const std::string text = RobotText(model, element);
  return RobotModel(BuildRobotBody(ReadRobotFile(
      DiamondFolder() / "robot.yaml",
      [&](const std::filesystem::path& path) { return app::ParseYaml(text, path.string()); })));
}

/// One equilibrium of SOFA's: see the README of the data.
struct SofaCase {
  Eigen::Matrix3Xd rest_mm{3, 0};
  Eigen::Matrix3Xd deformed_mm{3, 0};
  std::vector<std::string> cables;
  std::vector<std::optional<double>> displacement_mm;
  std::vector<double> tension_mN;
};

std::string Field(const std::string& line, const std::string& key) {
  const size_t at = line.find(key + "=");
  EXPECT_NE(at, std::string::npos) << key << " in: " << line;
  const size_t start = at + key.size() + 1;
  return line.substr(start, line.find(' ', start) - start);
}

void ReadCable(const std::string& line, SofaCase* sofa) {
  std::istringstream words(line);
  std::string hash, word, name;
  words >> hash >> word >> name;
  sofa->cables.push_back(name);
  sofa->tension_mN.push_back(std::stod(Field(line, "force_mN")));
  sofa->displacement_mm.emplace_back();
  if (Field(line, "mode") == "displacement") {
    sofa->displacement_mm.back() = std::stod(Field(line, "displacement_mm"));
  }
}

SofaCase ReadSofa(const std::string& name) {
  std::ifstream file(DiamondFolder() / "sofa" / (name + ".csv"));
  SofaCase sofa;
  std::vector<double> values;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("# cable")) ReadCable(line, &sofa);
    if (line.empty() || line[0] == '#' || line[0] == 'i') continue;
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream numbers(line);
    int index = 0;
    Eigen::Vector3d rest, deformed;
    numbers >> index >> rest[0] >> rest[1] >> rest[2] >> deformed[0] >> deformed[1] >> deformed[2];
    EXPECT_TRUE(static_cast<bool>(numbers)) << line;
    values.insert(values.end(), rest.begin(), rest.end());
    values.insert(values.end(), deformed.begin(), deformed.end());
  }
  const Eigen::Map<const Eigen::Matrix<double, 6, Eigen::Dynamic>> all(
      values.data(), 6, static_cast<Eigen::Index>(values.size() / 6));
  sofa.rest_mm = all.topRows<3>();
  sofa.deformed_mm = all.bottomRows<3>();
  return sofa;
}

struct DiamondCase {
  const char* csv;
  const char* model;
};

class DiamondAgainstSofa : public testing::TestWithParam<DiamondCase> {};

TEST_P(DiamondAgainstSofa, EveryNodeWithinAMicrometreAndTensionsWithinATenThousandth) {
  if (!std::filesystem::exists(DiamondFolder() / "sofa")) {
    GTEST_SKIP() << "no " << DiamondFolder() << " (set PALPATE_DATA_DIR)";
  }
  const SofaCase sofa = ReadSofa(GetParam().csv);
  ASSERT_EQ(sofa.deformed_mm.cols(), 1628);
  RobotModel model = BuildDiamond(GetParam().model, "tet4");
  ASSERT_EQ(model.ActuatorNames(), sofa.cables);
  const Eigen::Matrix3Xd rest_mm = 1e3 * model.body().mesh.nodes_m;
  EXPECT_LE((rest_mm - sofa.rest_mm).cwiseAbs().maxCoeff(), 1e-5);
  std::vector<ActuatorCommand> commands(sofa.cables.size());
  for (size_t c = 0; c < commands.size(); ++c) {
    if (!sofa.displacement_mm[c]) continue;
    commands[c] = {ActuatorCommand::Kind::kDisplacement, 1e-3 * *sofa.displacement_mm[c]};
  }
  fem::StaticState state = model.RestState();
  const fem::StaticResult result = model.Solve(commands, {}, &state);
  ASSERT_TRUE(result.status.ok()) << result.status.message();
  const Eigen::Matrix3Xd deformed_mm = 1e3 * state.x_m.reshaped(3, 1628);
  EXPECT_LE((deformed_mm - sofa.deformed_mm).colwise().norm().maxCoeff(), 1e-3);
  for (size_t c = 0; c < commands.size(); ++c) {
    const ActuatorState cable = model.StateOfActuator(static_cast<int>(c), state);
    EXPECT_NEAR(1e3 * cable.tension_N, sofa.tension_mN[c], 1e-4 * sofa.tension_mN[c]);
    EXPECT_NEAR(model.cable(static_cast<int>(c)).rest_length_m(), 0.0882836338174, 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Equilibria, DiamondAgainstSofa,
    testing::Values(DiamondCase{"NeoHookean_a_gravity", "neo_hookean"},
                    DiamondCase{"StableNeoHookean_a_gravity", "stable_neo_hookean"},
                    DiamondCase{"StableNeoHookean_b_north10", "stable_neo_hookean"},
                    DiamondCase{"StVenantKirchhoff_b_north10", "st_venant_kirchhoff"}),
    [](const auto& diamond_case) { return std::string(diamond_case.param.csv); });

TEST(Diamond, AsTet10ReachesTwentyMillimetresOfCableInOneGo) {
  if (!std::filesystem::exists(DiamondFolder() / "diamond.vtu")) {
    GTEST_SKIP() << "no " << DiamondFolder() << " (set PALPATE_DATA_DIR)";
  }
  RobotModel model = BuildDiamond("stable_neo_hookean", "tet10");
  fem::StaticState state = model.RestState();
  const fem::StaticResult result =
      model.Solve({{ActuatorCommand::Kind::kDisplacement, 0.020}, {}, {}, {}}, {}, &state);
  ASSERT_TRUE(result.status.ok()) << result.status.message();
  EXPECT_NEAR(model.StateOfActuator(0, state).displacement_m, 0.020, 1e-9);
  EXPECT_GT(model.StateOfActuator(0, state).tension_N, 0.5);
}

}  // namespace
}  // namespace palpate::robot
