// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <cmath>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "components/palpate/diagnose/force_gain.hpp"
#include "components/palpate/estimate/estimate_verb.hpp"
#include "components/palpate/simulate_verb.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/file.hpp"
#include "libs/experiment/csv_table.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/robot/robot_description.hpp"
#include "tests/components/palpate/test_robot.hpp"

/// A robot file with creep, softening, friction or play: `palpate simulate` makes data of it, and
/// `palpate estimate` feels as much with it as on a healthy robot.
namespace palpate::command {
namespace {

namespace fs = std::filesystem;

/// One deviation, as a hidden effect of the bench and as keys of the robot file.
struct Deviation {
  std::string effects;
  std::string material;  ///< more keys
  std::string cable;     ///< of both cables
};

const Deviation kNone;
const Deviation kCreep{"{id: viscoelastic_creep, g: 0.15, tau_s: 6}",
                       ", creep: [{share: 0.15, time_s: 6}]", ""};
const Deviation kSoftening{"{id: mullins, r: 3, m: 200}", ", softening: {r: 3, m_J_m3: 200}", ""};
const Deviation kFriction{
    "{id: cable_friction, where: cable:top, mu: 0.3}, "
    "{id: cable_friction, where: cable:bottom, mu: 0.3}",
    "", ", friction_coefficient: 0.3"};
const Deviation kPlay{
    "{id: backlash, where: cable:top, play_m: 0.0015}, "
    "{id: backlash, where: cable:bottom, play_m: 0.0015}",
    "", ", play_m: 0.0015"};

/// Both cables pull and let out, held in between; a weight of 20 g comes and goes at the tip.
const std::string kScenario = R"(body: {refine: 0}
motion: {mode: quasi_static, time_step_s: 0.1}
clutter: 0
rest_between_s: 0
markers: {sigma_m: 3.0e-4, rate_hz: 5}
recordings:
  - name: loaded
    kind: known_load
    duration_s: 36
    commands:
      - {t_s: 0, top.displacement_m: 0.002, bottom.displacement_m: 0.002}
      - {t_s: 2, top.displacement_m: 0.002, bottom.displacement_m: 0.002}
      - {t_s: 4, top.displacement_m: 0.01, bottom.displacement_m: -0.004}
      - {t_s: 12, top.displacement_m: 0.01, bottom.displacement_m: -0.004}
      - {t_s: 14, top.displacement_m: 0.006, bottom.displacement_m: 0}
      - {t_s: 20, top.displacement_m: 0.006, bottom.displacement_m: 0}
      - {t_s: 23, top.displacement_m: -0.002, bottom.displacement_m: 0.006}
      - {t_s: 30, top.displacement_m: -0.002, bottom.displacement_m: 0.006}
      - {t_s: 32, top.displacement_m: 0.004, bottom.displacement_m: 0.001}
      - {t_s: 36, top.displacement_m: 0.004, bottom.displacement_m: 0.001}
    weights:
)";

constexpr double kWeight_kg = 0.02;
constexpr double kWeightChanges_s[] = {5, 9, 15, 18, 21, 25, 31, 34};  // hung, taken off, ...

class ExtendedRobot : public testing::Test {
 protected:
  ExtendedRobot() { WriteBarRobot(folder_); }

  /// The bar with two cables through four eyelets each, and nine markers.
  fs::path Robot(const Deviation& deviation) const {
    std::string text =
        "name: bar\nmesh: {file: bar.vtk, unit: mm}\nelement: tet4\n"
        "material: {model: stable_neo_hookean, youngs_modulus_Pa: 150.0e3, "
        "poissons_ratio: 0.4" +
        deviation.material +
        "}\nmass: {density_kg_m3: 1000}\ngravity_m_s2: [0, 0, -9.81]\n"
        "fixed: [{box_m: [[-0.001, -0.001, -0.001], [0.001, 0.021, 0.021]]}]\n"
        "cables:\n";
    for (const auto& [name, z_m] : {std::pair{"top", "0.018"}, std::pair{"bottom", "0.002"}}) {
      text += "  - {name: " + std::string(name) + ", path_m: [";
      for (const char* x_m : {"-0.01", "0.01", "0.03", "0.05", "0.075"}) {
        text += (text.back() == '[' ? "[" : ", [") + std::string(x_m) + ", 0.01, " + z_m + "]";
      }
      text += "], max_tension_N: 20, guide_radius_m: 0" + deviation.cable + "}\n";
    }
    text += "markers:\n";
    int marker = 0;
    for (const char* x_m : {"0.03", "0.055", "0.08"}) {
      for (const char* across_m : {"0, 0.01", "0.02, 0.01", "0.01, 0.02"}) {
        text += "  - {name: m" + std::to_string(marker++) + ", position_m: [" + x_m + ", " +
                across_m + "]}\n";
      }
    }
    return folder_.Write("robot.yaml", text + "feature_points: {count: 3}\n");
  }

  /// The data of the robot of `file`, with hidden effects.
  void Simulate(const Deviation& file, const std::string& effects) const {
    fs::remove_all(folder_ / "exp");
    fs::remove(folder_ / "exp.answer.json");
    std::string text = "name: deviation\neffects: [" + effects + "]\n" + kScenario;
    double mass_kg = kWeight_kg;
    for (const double t_s : kWeightChanges_s) {
      text += "      - {t_s: " + std::to_string(t_s) + ", position_m: [0.075, 0.01, 0.02], " +
              "mass_kg: " + std::to_string(mass_kg) + ", patch_radius_m: 0.005}\n";
      mass_kg = kWeight_kg - mass_kg;
    }
    SimulateOptions options;
    options.robot = Robot(file);
    options.scenario = folder_.Write("s.yaml", text);
    options.out = folder_ / "exp";
    ASSERT_EQ(SimulateOrCheck(options), 0);
  }

  /// RMS error of the weight's force, N, as the robot of `file` feels it. A frame without contact
  /// has the force 0, and all others have one.
  double Error_N(const Deviation& file) const {
    EstimateOptions options;
    options.robot = Robot(file);
    options.data = folder_ / "exp";
    options.contacts = {"tip: 0.075, 0.01, 0.02, 0.005 along 0, 0, -1"};
    options.out = folder_ / "forces.csv";
    EXPECT_EQ(Estimate(options), 0);
    const auto forces = experiment::CsvTable::Read(options.out);
    double sum_N2 = 0.0;
    int frames = 0;
    for (std::size_t row = 0; row < forces.rows(); ++row) {
      const double t_s = forces.Number(row, 1);
      double weight_N = 0.0;
      bool changes = false;
      for (const double change_s : kWeightChanges_s) {
        changes = changes || std::abs(t_s - change_s) < 0.21;  // a step and a frame
        if (t_s > change_s) weight_N = 9.81 * kWeight_kg - weight_N;
      }
      if (changes) continue;
      const bool none = forces.Text(row, 11) == "no_contact";
      sum_N2 += std::pow((none ? 0.0 : forces.Number(row, 8)) + weight_N, 2);
      ++frames;
    }
    EXPECT_GT(frames, 150);
    return std::sqrt(sum_N2 / frames);
  }

  TestFolder folder_;
};

struct Case {
  std::string name;
  Deviation deviation;
  double most_with;      ///< error with the extended file over that of a healthy robot
  double worse_without;  ///< that without: at least
};

void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }

class ForcesOfExtendedRobot : public ExtendedRobot, public testing::WithParamInterface<Case> {};

TEST_P(ForcesOfExtendedRobot, AreAsGoodAsOnAHealthyRobot) {
  const auto& [name, deviation, most_with, worse_without] = GetParam();
  Simulate(kNone, "");
  const double healthy_N = Error_N(kNone);
  Simulate(kNone, deviation.effects);
  const double without_N = Error_N(kNone);
  const double extended_N = Error_N(deviation);
  RecordProperty("healthy_mN", std::to_string(1e3 * healthy_N));
  RecordProperty("without_mN", std::to_string(1e3 * without_N));
  RecordProperty("extended_mN", std::to_string(1e3 * extended_N));
  EXPECT_LE(extended_N, most_with * healthy_N);
  EXPECT_GE(without_N, worse_without * healthy_N);
}

/// Play of 1.5 mm moves cables between taut and slack, where single frames err more.
INSTANTIATE_TEST_SUITE_P(Each, ForcesOfExtendedRobot,
                         testing::Values(Case{"Creep", kCreep, 1.2, 2.0},
                                         Case{"Softening", kSoftening, 1.2, 2.0},
                                         Case{"Friction", kFriction, 1.2, 2.0},
                                         Case{"Play", kPlay, 1.5, 2.0}),
                         [](const auto& info) { return info.param.name; });

/// `palpate diagnose` says what its extended files gain in forces at known loads.
TEST_F(ExtendedRobot, GainsInForcesAtKnownLoads) {
  Simulate(kNone, kFriction.effects);
  const auto read = [](const fs::path& file) { return robot::ReadRobotFile(file, app::LoadYaml); };
  const robot::RobotDescription as_built = read(Robot(kNone));
  diagnosis::Diagnosis diagnosis;
  diagnosis.extended = read(Robot(kFriction));
  auto experiment = experiment::ReadExperiment(folder_ / "exp", app::LoadYaml);
  const auto none = MeasureForceError(as_built, diagnosis, experiment, 2, {});
  EXPECT_EQ(none.forces, 0) << "no cause was named";
  diagnosis.result.causes.resize(1);
  const auto error = MeasureForceError(as_built, diagnosis, experiment, 2, {});
  EXPECT_EQ(error.recordings, 1);
  EXPECT_GT(error.forces, 30);
  EXPECT_LT(error.after_N, 0.6 * error.before_N);
  diagnosis.not_in_files = {"a cause that no file holds"};
  EXPECT_EQ(MeasureForceError(as_built, diagnosis, experiment, 2, {}).forces, 0);
  diagnosis.not_in_files.clear();
  // A force on the clamp moves nothing.
  for (auto& load : experiment.recordings[0].loads) load.position_m = {0.0, 0.01, 0.01};
  EXPECT_EQ(MeasureForceError(as_built, diagnosis, experiment, 2, {}).forces, 0);
}

/// The keys of the robot file and the hidden effects of the same size make the same data.
TEST_F(ExtendedRobot, IsSimulatedAsTheEffectsAre) {
  const auto markers = [&] { return ReadFile(folder_ / "exp/recordings/loaded/markers.csv"); };
  for (const Deviation& deviation : {kCreep, kSoftening, kFriction, kPlay}) {
    Simulate(deviation, "");
    const std::string by_file = markers();
    Simulate(kNone, deviation.effects);
    EXPECT_TRUE(by_file == markers()) << deviation.effects;
    Simulate(kNone, "");
    EXPECT_FALSE(by_file == markers()) << deviation.effects;
  }
}

}  // namespace
}  // namespace palpate::command
