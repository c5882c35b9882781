// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "components/diagnosis/prepare/nearest_robot.hpp"
#include "libs/app/yaml.hpp"
#include "libs/experiment/recording_inputs.hpp"
#include "libs/robot/robot_description.hpp"
#include "libs/robot/wall_thinning.hpp"
#include "tests/components/diagnosis/fault_derivatives.hpp"

namespace palpate::diagnosis {
namespace {

const std::set<std::string> kOfChambers = {"leak",          "slow_valve",    "blocked_valve",
                                           "pressure_gain", "pressure_zero", "swapped_tubes",
                                           "thin_wall"};

/// A pneumatic robot in linear elements, which are computed in milliseconds.
robot::RobotBody QuickRobot(const std::string& name) {
  const std::filesystem::path config = std::filesystem::path(PALPATE_SOURCE_DIR) / "config";
  robot::RobotDescription robot =
      robot::ReadRobotFile(config / "robots" / (name + ".yaml"), app::LoadYaml);
  robot.mesh.file = config / "scenarios" / (name + "_coarse.msh");
  robot.element = fem::ElementType::kTet4;
  return robot::BuildRobotBody(robot);
}

/// Pressures of the chambers, Pa, at a time.
struct PressureKnot {
  double t_s;
  std::vector<double> pressure_Pa;
};

experiment::Recording PressureRecording(const std::string& name, const robot::RobotBody& body,
                                        const std::vector<PressureKnot>& knots, double frame_s) {
  std::vector<Knot> none;
  for (const PressureKnot& knot : knots) none.push_back({knot.t_s, {}});
  experiment::Recording recording = MakeRecording(name, body, none, frame_s);
  experiment::Actuation& actuation = *recording.actuation;
  actuation.columns.clear();
  for (std::size_t c = 0; c < body.chambers.size(); ++c) {
    experiment::ActuatorColumn column{.cable = body.chambers[c].name,
                                      .quantity = experiment::ActuatorQuantity::kTension,
                                      .samples = {},
                                      .where = {},
                                      .of_chamber = true};
    for (const PressureKnot& knot : knots) column.samples.emplace_back(knot.pressure_Pa[c]);
    actuation.columns.push_back(std::move(column));
  }
  return recording;
}

experiment::Experiment ArmExperiment(const robot::RobotBody& body) {
  const std::vector<double> low{1e3, 2e3, 3e3};
  experiment::Experiment experiment;
  experiment.markers_sigma_m = Eigen::Vector3d::Constant(3e-4);
  experiment.rest_between_s = 4.0;
  experiment.recordings.push_back(
      PressureRecording("a_ramp", body, {{0.0, low}, {2.0, {20e3, 5e3, 9e3}}, {4.0, low}}, 0.25));
  experiment.recordings.push_back(PressureRecording(
      "b_fast", body, {{8.0, low}, {8.5, {6e3, 15e3, 12e3}}, {9.5, {6e3, 15e3, 12e3}}}, 0.25));
  return experiment;
}

class ChamberFaults : public FaultDerivatives {
 protected:
  ChamberFaults() : ChamberFaults(QuickRobot("pneumatic_arm"), ArmExperiment) {}
  ChamberFaults(const robot::RobotBody& body,
                const std::function<experiment::Experiment(const robot::RobotBody&)>& experiment)
      : FaultDerivatives(body, experiment(body), nullptr, /*with_mesh_error=*/false) {}

  const FaultModel& First(const std::string& id) const {
    const auto found = std::find_if(causes_.begin(), causes_.end(),
                                    [&](const auto& cause) { return cause->name().id == id; });
    EXPECT_NE(found, causes_.end()) << id;
    return **found;
  }
  /// [actuators x samples] N
  Eigen::MatrixXd Thrust_N(const std::string& id, double z) const {
    ModelHypothesis hypothesis = nominal_;
    if (!id.empty()) First(id).Apply(Eigen::VectorXd::Constant(1, z), &hypothesis);
    return ActuatorChain(observed_).At(hypothesis.actuators);
  }
  /// Before the fit, of markers without noise of a robot.
  std::optional<LikelyFault> FoundBeforeTheFit(const ModelHypothesis& hypothesis) const {
    const Simulation truth = Simulator(observed_, 1).Run(hypothesis);
    EXPECT_TRUE(truth.status.ok());
    ObservedExperiment seen = observed_;
    for (std::size_t s = 0; s < seen.samples.size(); ++s) {
      seen.samples[s].position_m = truth.samples[s].markers_m();
    }
    return FindNearestRobot(body_, seen, 1, nullptr).fault;
  }
};

TEST_F(ChamberFaults, AreOfEveryKind) {
  std::set<std::string> found;
  for (const FaultModelPtr& cause : causes_) {
    if (kOfChambers.contains(cause->name().id)) found.insert(cause->name().id);
    EXPECT_FALSE(cause->name().id.starts_with("cable_")) << cause->words();
  }
  EXPECT_EQ(found, kOfChambers);
}

TEST_F(ChamberFaults, AreWhatTheyAreDefinedAs) {
  const double area_m2 = observed_.timeline.actuators[0].area_m2;
  const Eigen::MatrixXd healthy_N = Thrust_N("", 0.0);
  const auto first = healthy_N.row(0);
  EXPECT_NEAR(healthy_N.maxCoeff(), 20e3 * area_m2, 0.2 * 20e3 * area_m2);
  EXPECT_TRUE(Thrust_N("pressure_gain", 0.1).row(0).isApprox(1.1 * first, 1e-12));
  EXPECT_TRUE((Thrust_N("pressure_zero", 500.0).row(0).array() - first.array())
                  .isApproxToConstant(500.0 * area_m2, 1e-9));
  EXPECT_TRUE(Thrust_N("leak", 0.25).row(0).isApprox(first / 1.25, 1e-12));
  // Of the first recording on: at the pressure with which that begins.
  EXPECT_TRUE(Thrust_N("blocked_valve", 1.0).row(0).isApproxToConstant(1e3 * area_m2, 1e-9));
  for (const char* id : {"pressure_gain", "pressure_zero", "leak", "slow_valve", "blocked_valve"}) {
    EXPECT_TRUE(Thrust_N(id, 0.05).bottomRows(2).isApprox(healthy_N.bottomRows(2), 1e-14)) << id;
  }
  const double area_of_other_m2 = observed_.timeline.actuators[1].area_m2;
  EXPECT_TRUE(
      (Thrust_N("swapped_tubes", 1.0).row(1) / area_of_other_m2).isApprox(first / area_m2, 1e-12));
}

/// A calibration that was extended by a fault of a sensor corrects readings to what the fault has.
TEST_F(ChamberFaults, OfSensorsAreInTheCalibration) {
  const double area_m2 = observed_.timeline.actuators[0].area_m2;
  const Eigen::RowVectorXd read_Pa = Thrust_N("", 0.0).row(0) / area_m2;
  for (const auto& [id, z] :
       {std::pair("pressure_gain", 0.1), std::pair("pressure_zero", -500.0)}) {
    robot::RobotDescription robot;
    robot::CalibrationFile calibration;
    ASSERT_TRUE(First(id).Extend(Eigen::VectorXd::Constant(1, z), &robot, &calibration)) << id;
    ASSERT_EQ(calibration.pressure_sensors.size(), 1U);
    const robot::CalibratedPressureSensor& sensor = calibration.pressure_sensors.front();
    EXPECT_EQ(sensor.chamber, body_.chambers.front().name);
    const Eigen::RowVectorXd has_Pa = Thrust_N(id, z).row(0) / area_m2;
    for (Eigen::Index s = 0; s < read_Pa.size(); ++s) {
      EXPECT_NEAR(sensor.Pressure_Pa(read_Pa[s]), has_Pa[s], 1e-6) << id;
    }
  }
}

/// A linear model about the nominal robot is too far from these to find them.
TEST_F(ChamberFaults, AreFoundBeforeTheFitWhereTheyBendTheRobotFar) {
  int tried = 0;
  for (const FaultModelPtr& cause : causes_) {
    const std::string& id = cause->name().id;
    if (id != "blocked_valve" && id != "swapped_tubes") continue;
    ModelHypothesis hypothesis = nominal_;
    cause->Apply(Eigen::VectorXd::Ones(1), &hypothesis);
    const std::optional<LikelyFault> fault = FoundBeforeTheFit(hypothesis);
    ASSERT_TRUE(fault) << cause->words();
    EXPECT_TRUE(fault->Is(*cause)) << cause->words() << " of start " << cause->Start().value_or(-1);
    ++tried;
  }
  EXPECT_GE(tried, 6);
}

TEST_F(ChamberFaults, OfOtherKindsAreNotTakenForThose) {
  for (const char* id : {"leak", "pressure_gain", "slow_valve"}) {
    ModelHypothesis hypothesis = nominal_;
    First(id).Apply(Eigen::VectorXd::Constant(1, 0.3), &hypothesis);
    EXPECT_FALSE(FoundBeforeTheFit(hypothesis)) << id;
  }
}

/// The same bend in each of five recordings.
experiment::Experiment FingerExperiment(const robot::RobotBody& body) {
  experiment::Experiment experiment;
  experiment.markers_sigma_m = Eigen::Vector3d::Constant(3e-4);
  experiment.rest_between_s = 4.0;
  for (int r = 0; r < 5; ++r) {
    const double begin_s = 8.0 * r;
    experiment.recordings.push_back(PressureRecording(
        "bend_" + std::to_string(r), body,
        {{begin_s, {0.0}}, {begin_s + 2.0, {20e3}}, {begin_s + 4.0, {0.0}}}, 0.25));
  }
  return experiment;
}

class FaultsOfTheOnlyChamber : public ChamberFaults {
 protected:
  FaultsOfTheOnlyChamber() : ChamberFaults(QuickRobot("pneumatic_finger"), FingerExperiment) {}
};

/// Also where most recordings are those of a free valve.
TEST_F(FaultsOfTheOnlyChamber, BlockItsValveFromAnyRecordingOn) {
  int tried = 0;
  for (const FaultModelPtr& cause : causes_) {
    if (cause->name().id != "blocked_valve") continue;
    ModelHypothesis hypothesis = nominal_;
    First("youngs_modulus").Apply(Eigen::VectorXd::Constant(1, -0.1), &hypothesis);
    cause->Apply(Eigen::VectorXd::Ones(1), &hypothesis);
    const std::optional<LikelyFault> fault = FoundBeforeTheFit(hypothesis);
    ASSERT_TRUE(fault) << cause->Start().value_or(-1);
    EXPECT_TRUE(fault->Is(*cause)) << cause->Start().value_or(-1);
    ++tried;
  }
  EXPECT_EQ(tried, 5);
}

TEST_F(FaultsOfTheOnlyChamber, AreNoBlockedValveWhereItMovesTheBody) {
  EXPECT_FALSE(FoundBeforeTheFit(nominal_));
  for (const char* id : {"leak", "pressure_gain", "slow_valve"}) {
    ModelHypothesis hypothesis = nominal_;
    First(id).Apply(Eigen::VectorXd::Constant(1, 0.3), &hypothesis);
    EXPECT_FALSE(FoundBeforeTheFit(hypothesis)) << id;
  }
}

/// A ramp of the rate r is followed later by tau, that is by r tau.
TEST_F(ChamberFaults, ASlowValveIsBehindARampByItsTimeConstant) {
  constexpr double kTau_s = 0.05;
  const double rate_N_s = (20e3 - 1e3) / 2.0 * observed_.timeline.actuators[0].area_m2;
  const Eigen::MatrixXd behind_N = Thrust_N("", 0.0) - Thrust_N("slow_valve", kTau_s);
  for (std::size_t s = 0; s < observed_.samples.size(); ++s) {
    const double t_s = observed_.samples[s].t_s;
    if (t_s < 0.6 || t_s > 1.9) continue;  // the start has been forgotten
    EXPECT_NEAR(behind_N(0, ToIndex(s)), rate_N_s * kTau_s, 1e-3 * rate_N_s * kTau_s);
  }
}

TEST_F(ChamberFaults, HaveTheDerivativesOfApply) {
  ASSERT_TRUE(at_rest_.status.ok()) << at_rest_.status.message();
  for (const std::string& id : kOfChambers) {
    const FaultModel& fault = First(id);
    ExpectDerivative(fault, Eigen::VectorXd::Zero(std::ssize(fault.parameters())), 2e-3);
  }
}

/// Its volume grows by the area of its wall, and nothing outside moves.
TEST_F(ChamberFaults, AThinWallIsALargerChamber) {
  constexpr double kThinner_m = 1e-5;
  const robot::BodyChamber& chamber = body_.chambers.front();
  const Eigen::VectorXd mode_m = robot::WallThinning(body_.mesh, body_.boundary, chamber.wall);
  const fem::EnclosedVolume volume(chamber.wall);
  const Eigen::VectorXd rest_m = body_.mesh.nodes_m.reshaped();
  double area_m2 = 0.0;
  for (const auto& face : chamber.wall.faces.colwise()) {
    const auto at = [&](int k) -> Eigen::Vector3d {
      return chamber.wall.points[static_cast<std::size_t>(face[k])].Position(rest_m);
    };
    area_m2 += 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
  }
  const double grown_m3 = volume.Volume_m3(rest_m + kThinner_m * mode_m) - volume.Volume_m3(rest_m);
  EXPECT_NEAR(grown_m3, kThinner_m * area_m2, 0.1 * kThinner_m * area_m2);
  for (const robot::BodyMarker& marker : body_.markers) {
    EXPECT_LT(marker.point.weights.Position(mode_m).norm(), 0.05) << marker.name;
  }
  EXPECT_LE(mode_m.reshaped(3, body_.mesh.NodeCount()).colwise().norm().maxCoeff(), 1.0 + 1e-12);
}

TEST_F(ChamberFaults, PressureCountsWhereAChamberHasBothColumns) {
  experiment::Experiment experiment = ArmExperiment(body_);
  for (experiment::Recording& recording : experiment.recordings) {
    experiment::ActuatorColumn volume = recording.actuation->columns.front();
    volume.quantity = experiment::ActuatorQuantity::kDisplacement;
    for (std::optional<double>& sample : volume.samples) sample = 1e-6;
    recording.actuation->columns.insert(recording.actuation->columns.begin(), volume);
  }
  const ObservedExperiment both = Observe(experiment, body_, {.most_samples = 14});
  EXPECT_TRUE(both.timeline.by_tension.front());
  EXPECT_EQ(both.timeline.CommandAt(2.0), observed_.timeline.CommandAt(2.0));
}

}  // namespace
}  // namespace palpate::diagnosis
