// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "components/diagnosis/forward/history.hpp"
#include "components/diagnosis/forward/measured_points.hpp"
#include "components/diagnosis/forward/model_hypothesis.hpp"
#include "components/diagnosis/forward/simulation.hpp"
#include "components/diagnosis/forward/sum_of_parameters.hpp"
#include "components/diagnosis/vocabulary/diagnosis_result.hpp"
#include "libs/core/index.hpp"
#include "libs/robot/calibration_file.hpp"
#include "libs/robot/robot_description.hpp"
#include "libs/robot/sensitivity/parameter.hpp"

namespace palpate::diagnosis {

/// Nuisance parameters with one common deviation, which is not assumed: it is inferred from the
/// data (inference/group_scale.hpp). Their tolerances count in units of it.
enum class DiscrepancyGroup { kNone = -1, kCables, kStiffness };
inline constexpr int kDiscrepancyGroups = 2;

/// One number of a fault. Inside, it is counted as z, 0 for the robot as its file has it, so that
/// every prior is a normal distribution of z about 0.
struct FaultParameter {
  /// How the value that people see follows from z.
  enum class Scale {
    kLinear,   ///< nominal + z
    kFactor,   ///< nominal exp(z)
    kInverse,  ///< 1 / z
  };
  std::string name;  ///< of verdict.json (docs/diagnosis.md), with its unit
  double nominal = 0.0;
  double tolerance = 0.0;  ///< prior deviation of z in the null model; 0: none
  double fault = 0.0;      ///< prior deviation of z as a fault, > tolerance,
  double fault_at = 0.0;   ///< about this
  double least = -std::numeric_limits<double>::infinity();  ///< of z: what can be
  double most = std::numeric_limits<double>::infinity();
  Scale scale = Scale::kLinear;
  /// It says where or how the fault's other parameters act: without these it is of no effect.
  bool qualifies = false;
  /// It is one of the vector that the fault's parameters so marked make up together: how large the
  /// fault is, and which tolerance it has, is said of the length of that.
  bool component = false;
  /// Of |z|: a larger one is not plausible, another fault has its effect
  /// (docs/theory/model_selection.md, Forward selection).
  double plausible = std::numeric_limits<double>::infinity();
  DiscrepancyGroup group = DiscrepancyGroup::kNone;

  double ValueOf(double z) const {
    switch (scale) {
      case Scale::kFactor: return nominal * std::exp(z);
      case Scale::kInverse: return 1.0 / z;
      case Scale::kLinear: break;
    }
    return nominal + z;
  }
};

/// A sample about which a fault is asked what it does.
struct FaultContext {
  const ObservedExperiment& observed;
  const ModelHypothesis& hypothesis;
  const Simulation& simulation;
  const HistoryOperator& history;
  int sample = 0;
  const HeldShape& shape;    ///< one of the sample's
  robot::RobotModel& model;  ///< its linearisation is at that shape
  const fem::PointStress& points;
  /// Of that shape, where a fault is asked what it shows.
  Target target = Target::kMarkers;
  MeasuredPoints measured_points = {};

  const Sample& seen() const { return observed.samples[At(sample)]; }
  const SimulatedSample& simulated() const { return simulation.samples[At(sample)]; }
  const ObservedRecording& recording() const { return observed.recordings[At(seen().recording)]; }
  /// From where the target is measured.
  const Eigen::Isometry3d& T_measurement_robot() const {
    return target == Target::kSurface ? *recording().T_camera_robot
                                      : recording().T_measurement_robot;
  }
};

/// What something in the body's way does to it as a whole: a force on the body as it is without
/// what the hypothesis has in its way. Per z of each of a fault's parameters
struct Push {
  Eigen::VectorXd force_N;  ///< [3n]
  Eigen::VectorXd times;    ///< [parameters] so many times that force, and
  Eigen::VectorXd
      displacement_m;  ///< [parameters] as often as makes force' x (in N) grow by so much
};

/// A model error of one kind, at one place of the robot (docs/diagnosis.md). What
/// it does is said twice: Apply changes a hypothesis by any z; the other functions give what a
/// small z does at a sample of a simulation, to first order, which a test holds against Apply.
class FaultModel {
 public:
  FaultModel(CauseName name, std::string words, std::vector<FaultParameter> parameters)
      : name_(std::move(name)), words_(std::move(words)), parameters_(std::move(parameters)) {}
  virtual ~FaultModel() = default;
  FaultModel(const FaultModel&) = delete;
  FaultModel& operator=(const FaultModel&) = delete;

  const CauseName& name() const { return name_; }
  const std::string& words() const { return words_; }  ///< "friction of cable north"
  const std::vector<FaultParameter>& parameters() const { return parameters_; }

  /// What is reported of `z` [parameters] with its covariance; by default each parameter with
  /// its 95 % interval. `undeformed_m` [3n]: the body that the fit has, which need not have the
  /// size that the robot file says.
  virtual std::vector<FittedParameter> Report(const Eigen::VectorXd& z,
                                              const Eigen::MatrixXd& covariance,
                                              const Eigen::VectorXd& undeformed_m) const;

  /// `z` [parameters].
  virtual void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const = 0;
  /// Writes `z` into the robot file, or the actuators and pressure sensors of a calibration; false
  /// where neither can say it.
  virtual bool Extend(const Eigen::VectorXd& z, robot::RobotDescription* robot,
                      robot::CalibrationFile* calibration) const;
  /// Where what it does has kinks a linear model says little: then the most probable faults of its
  /// name are simulated before one stands for all, of those with the same number here only one.
  virtual std::optional<int> Start() const { return std::nullopt; }
  /// Id of a simpler fault that is a special case of this one: what that does this one does, too,
  /// with parameters that it has no need of; empty: there is none.
  virtual std::string SpecialCase() const { return {}; }
  /// Whether more is known of the robot file that it extends than what Apply makes: once it is
  /// named, the search begins again with that.
  virtual bool RestartsSearch() const { return false; }
  /// Whether Apply does nothing, and what the others say is added to what is simulated: it is
  /// linear at any size.
  virtual bool AddsToPrediction() const { return false; }
  /// Whether Apply changes the actuators: their derivative is a difference of two of their runs.
  virtual bool OnActuators() const { return false; }
  /// Whether OnBody leaves out at `z` what matters, as of a body that answers to its own past: then
  /// differences of simulations tell it (Simulator::DifferentiateBySimulation).
  virtual bool NeedsSimulation(const Eigen::VectorXd& /*z*/) const { return false; }
  /// What dz of one parameter does to the body where this fault is at `z` [parameters]; nullptr:
  /// nothing.
  virtual robot::ParameterPtr OnBody(int parameter, const Eigen::VectorXd& z,
                                     const FaultContext& at) const;
  /// What it does that no small z can say; none: nothing.
  virtual std::optional<Push> PushOf(const Eigen::VectorXd& z, const FaultContext& at) const;
  /// Adds what it does to where markers, or features of the surface, are seen with the body where
  /// it is, [3 x markers or features], m, frame of the robot as it is seen
  /// (ModelHypothesis::T_seen, T_surface_seen).
  virtual void OnView(int parameter, const Eigen::VectorXd& z, const FaultContext& at,
                      Eigen::Matrix3Xd* motion_m) const;
  /// Adds what it does to where a depth camera measures them (FaultContext::sight has one) while
  /// they stay where they are, [3 x markers or features], m, that camera's frame.
  virtual void OnMeasurement(int parameter, const Eigen::VectorXd& z, const FaultContext& at,
                             Eigen::Matrix3Xd* motion_m) const;

 private:
  CauseName name_;
  std::string words_;
  std::vector<FaultParameter> parameters_;
};

/// The actuator of a cable in a calibration, added where it is not there.
robot::CalibratedDrive& DriveOf(const std::string& cable, robot::CalibrationFile* calibration);
/// The same of the pressure sensor of a chamber.
robot::CalibratedPressureSensor& PressureSensorOf(const std::string& chamber,
                                                  robot::CalibrationFile* calibration);

/// Of parameters that are the components of a vector, its length.
FittedParameter SizeOf(const std::string& name, const Eigen::VectorXd& z,
                       const Eigen::MatrixXd& covariance);

using FaultModelPtr = std::unique_ptr<const FaultModel>;

/// A fault that may be there: of this name, and of those that have starts with this one.
struct LikelyFault {
  CauseName name;
  std::optional<int> start = {};

  bool Is(const FaultModel& fault) const { return fault.name() == name && fault.Start() == start; }
};

/// Faults together; their parameters follow each other in this order.
using FaultModelList = std::vector<const FaultModel*>;

}  // namespace palpate::diagnosis
