// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <filesystem>
#include <set>

#include "components/diagnosis/faults/catalogue.hpp"
#include "components/diagnosis/forward/mesh_error.hpp"
#include "components/diagnosis/forward/simulator.hpp"
#include "libs/robot/robot_description.hpp"
#include "tests/components/diagnosis/small_robot.hpp"
#include "tests/support/robots.hpp"

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
      std::vector<double> command(body.cables.size(), 0.001);
      command[c] = 0.008 + 0.002 * static_cast<double>(c);
      const double begin_s = 10.0 * static_cast<double>(c);
      experiment.recordings.push_back(MakeRecording(
          "r" + std::to_string(c), body, {{begin_s, command}, {begin_s + 1.0, command}}, 0.5));
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
    std::vector<robot::CalibratedDrive> drives;
    const Eigen::VectorXd z = FaultOf(*cause);
    if (!cause->Extend(z, &robot, &drives) || !drives.empty()) continue;
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
  EXPECT_THAT(extended, testing::IsSupersetOf({"youngs_modulus", "regional_stiffness", "density",
                                               "gravity_direction", "cable_routing",
                                               "marker_misplacement", "poissons_ratio",
                                               "swapped_cables", "stiffening", "discretisation"}));
}

}  // namespace
}  // namespace palpate::diagnosis
