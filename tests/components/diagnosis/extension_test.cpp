// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <filesystem>
#include <set>

#include "components/diagnosis/faults/catalogue.hpp"
#include "components/diagnosis/forward/mesh_error.hpp"
#include "components/diagnosis/forward/simulator.hpp"
#include "libs/app/yaml.hpp"
#include "libs/robot/robot_description.hpp"
#include "tests/components/diagnosis/small_robot.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/test_folder.hpp"

/// A robot file that was extended by a fault makes the robot that the fault makes.
namespace palpate::diagnosis {
namespace {

const std::filesystem::path kSource = PALPATE_SOURCE_DIR;

class Extension : public testing::Test {
 protected:
  static robot::RobotDescription FourLeg() {
    robot::RobotDescription robot = test_support::LinearFourLegRobot();
    robot.mesh.file = test_support::CoarseFourLegMesh();
    return robot;
  }

  /// Cables pulled one after the other, each by another length.
  static ObservedExperiment Pulled(const robot::RobotBody& body) {
    experiment::Experiment experiment;
    experiment.markers_sigma_m = Eigen::Vector3d::Constant(3e-4);
    for (std::size_t c = 0; c < body.cables.size(); ++c) {
      const std::vector<double> before(body.cables.size(), 0.001);
      std::vector<double> command = before;
      command[c] = 0.008 + 0.002 * static_cast<double>(c);
      const double begin_s = 10.0 * static_cast<double>(c);
      experiment.recordings.push_back(MakeRecording(
          "r" + std::to_string(c), body,
          {{begin_s, before}, {begin_s + 0.5, command}, {begin_s + 1.0, command}}, 0.5));
    }
    return Observe(experiment, body, {});
  }

  Eigen::VectorXd SeenOf(const ModelHypothesis& hypothesis) const {
    const Simulation simulation = Simulator(observed_, 1).Run(hypothesis);
    EXPECT_TRUE(simulation.status.ok()) << simulation.status.message();
    std::vector<double> all;
    for (const SimulatedSample& sample : simulation.samples) {
      all.insert(all.end(), sample.seen_m.begin(), sample.seen_m.end());
    }
    return Eigen::Map<const Eigen::VectorXd>(all.data(), std::ssize(all));
  }

  const robot::RobotDescription robot_ = FourLeg();
  const robot::RobotBody body_ = robot::BuildRobotBody(robot_);
  const ObservedExperiment observed_ = Pulled(body_);
};

/// As large as a fault is.
Eigen::VectorXd FaultOf(const FaultModel& cause) {
  Eigen::VectorXd z(std::ssize(cause.parameters()));
  for (Eigen::Index p = 0; p < z.size(); ++p) {
    const FaultParameter& parameter = cause.parameters()[static_cast<std::size_t>(p)];
    z[p] = parameter.fault_at > 0.0 ? parameter.fault_at : 0.5 * parameter.fault;
  }
  return z;
}

TEST_F(Extension, OfTheRobotFileIsTheRobotOfTheCause) {
  constexpr double kOfEffect = 1e-3;  // weights of a marker that moved are those of its new place
  const Eigen::VectorXd null_model_m = SeenOf(NominalHypothesis(body_, observed_));
  std::set<std::string> extended;
  const Simulation as_built = Simulator(observed_, 1).Run(NominalHypothesis(body_, observed_));
  const CatalogueInputs world{
      .body = body_,
      .observed = observed_,
      .mesh_error = CompareWithFinerMesh(robot_, body_, observed_, as_built, 1)};
  for (const FaultModelPtr& cause : MakeFaultModels(world, {})) {
    robot::RobotDescription robot = robot_;
    robot::CalibrationFile calibration;
    const Eigen::VectorXd z = FaultOf(*cause);
    if (!cause->Extend(z, &robot, &calibration) || !calibration.drives.empty()) continue;
    if (!extended.insert(cause->name().id).second) continue;  // one of its places
    ModelHypothesis hypothesis = NominalHypothesis(body_, observed_);
    cause->Apply(z, &hypothesis);
    const Eigen::VectorXd caused_m = SeenOf(hypothesis);
    const double effect_m = (caused_m - null_model_m).cwiseAbs().maxCoeff();
    EXPECT_GT(effect_m, 1e-5) << cause->words();
    const robot::RobotBody body = robot::BuildRobotBody(robot);
    EXPECT_LT((SeenOf(NominalHypothesis(body, observed_)) - caused_m).cwiseAbs().maxCoeff(),
              kOfEffect * effect_m)
        << cause->words();
  }
  EXPECT_THAT(extended,
              testing::IsSupersetOf(
                  {"youngs_modulus", "regional_stiffness", "density", "gravity_direction",
                   "cable_routing", "marker_misplacement", "poissons_ratio", "swapped_cables",
                   "stiffening", "discretisation", "viscoelastic_creep", "mullins", "backlash"}));
}

/// The file holds creep, softening and play as they were found.
TEST_F(Extension, ReadsBackWithTheSameValues) {
  robot::RobotDescription robot = robot_;
  robot::CalibrationFile calibration;
  const Simulation as_built = Simulator(observed_, 1).Run(NominalHypothesis(body_, observed_));
  const CatalogueInputs world{
      .body = body_,
      .observed = observed_,
      .mesh_error = CompareWithFinerMesh(robot_, body_, observed_, as_built, 1)};
  int creeps = 0;
  int softens = 0;
  int plays = 0;
  for (const FaultModelPtr& cause : MakeFaultModels(world, {})) {
    const std::string& id = cause->name().id;
    const bool first = (id == "viscoelastic_creep" && creeps++ == 0) ||
                       (id == "mullins" && softens++ == 0) || (id == "backlash" && plays++ == 0);
    if (first) {
      ASSERT_TRUE(cause->Extend(FaultOf(*cause), &robot, &calibration)) << id;
    }
  }
  ASSERT_EQ(robot.creep.size(), 1U);
  ASSERT_TRUE(robot.softening);
  ASSERT_GT(robot.cables[0].play_m, 0.0);
  const test_support::TestFolder folder;
  const auto file =
      folder.Write("robot.extended.yaml", robot::FormatRobotFile(robot, folder.path()));
  const robot::RobotDescription again = robot::ReadRobotFile(file, app::LoadYaml);
  EXPECT_EQ(again.creep, robot.creep);
  EXPECT_EQ(again.softening, robot.softening);
  EXPECT_EQ(again.cables[0].play_m, robot.cables[0].play_m);
  EXPECT_EQ(robot::FormatRobotFile(again, folder.path()),
            robot::FormatRobotFile(robot, folder.path()));
}

/// Faults add to what a file has, and one of size zero leaves it.
TEST_F(Extension, AddsToTheSofteningOfTheFile) {
  robot::RobotDescription robot = robot_;
  robot.softening = fem::MullinsLaw{.r = 4.0, .m_J_m3 = 250.0};
  const robot::RobotBody body = robot::BuildRobotBody(robot);
  const Simulation as_built = Simulator(observed_, 1).Run(NominalHypothesis(body, observed_));
  const CatalogueInputs world{
      .body = body,
      .observed = observed_,
      .mesh_error = CompareWithFinerMesh(robot, body, observed_, as_built, 1)};
  int softens = 0;
  for (const FaultModelPtr& cause : MakeFaultModels(world, {})) {
    if (cause->name().id != "mullins") continue;
    ++softens;
    robot::CalibrationFile calibration;
    robot::RobotDescription extended = robot;
    cause->Extend(Eigen::Vector2d::Zero(), &extended, &calibration);
    EXPECT_EQ(extended.softening, robot.softening);
    cause->Extend(Eigen::Vector2d(0.1, 0.0), &extended, &calibration);
    EXPECT_LT(extended.softening->r, 4.0);
    EXPECT_EQ(extended.softening->m_J_m3, 250.0);
    ModelHypothesis hypothesis = NominalHypothesis(body, observed_);
    cause->Apply(Eigen::Vector2d(0.1, 0.0), &hypothesis);
    EXPECT_NEAR(1.0 / hypothesis.mullins->inverse_r, extended.softening->r, 1e-12);
  }
  EXPECT_EQ(softens, 1);
}

}  // namespace
}  // namespace palpate::diagnosis
