// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "components/calibration/load_place.hpp"
#include "libs/core/status.hpp"
#include "libs/robot/robot_model.hpp"
#include "libs/robot/sensitivity/parameter.hpp"

namespace palpate::calibration {

/// Gaussian prior of a parameter, with bounds.
struct GaussianPrior {
  static constexpr double kUnbounded = std::numeric_limits<double>::infinity();

  double mean = 0.0;          ///< start of the search, and value where undetermined
  double sigma = kUnbounded;  ///< standard deviation; infinite: no prior
  double lower = -kUnbounded;
  double upper = kUnbounded;
  /// Plausible change, > 0: scales the search. Data that leave a standard deviation above half of
  /// min(sigma, plausible) do not determine the parameter (JointSettings::undetermined_share).
  double plausible = 1.0;
};

/// Change of the parameter per unit of its variable.
inline double ScaleOf(const GaussianPrior& prior) { return std::min(prior.plausible, prior.sigma); }

/// Inputs of a frame after all unknowns were applied.
struct FrameInputs {
  std::vector<robot::ActuatorCommand> cables;
  std::vector<robot::DeadLoad> loads = {};
  /// [loads] derivative of the nodal weights of each load to `scale`; empty: 0.
  std::vector<fem::InterpolationWeights> hold_per_scale = {};
  Eigen::Vector3d nominal_gravity_m_s2 = Eigen::Vector3d::Zero();  ///< of the frame
  Eigen::Vector3d gravity_m_s2 = Eigen::Vector3d::Zero();          ///< with the unknown tilt
  double mass_factor = 1.0;                                        ///< factor on the weight
  /// Size of the robot with all its eyelets over that of the model, about the robot frame's origin,
  /// at the same density. Its shape is that of the model under ToModel of these inputs times the
  /// scale: stresses are equal where forces grow with the square.
  double scale = 1.0;
};

/// Inputs of a model of scale 1 whose shape is the robot's over its scale s: displacements over s,
/// tensions and loads over s^2, weights times s. Limits of tensions are not scaled.
FrameInputs ToModel(const FrameInputs& robot);

/// Sets the nodal weights of the robot's loads at `places` [loads] in a model of scale 1, so that
/// they stay there as the size changes.
void HoldLoadsAt(const std::vector<LoadPlace>& places, const robot::RobotModel& model,
                 FrameInputs* robot);

/// Dependence of an equilibrium on an unknown: the derivative to `parameter` times `per_value`.
struct Influence {
  robot::ParameterPtr parameter;
  double per_value = 1.0;

  /// On this parameter alone.
  static std::vector<Influence> One(robot::ParameterPtr parameter, double per_value) {
    std::vector<Influence> influences;
    influences.push_back({std::move(parameter), per_value});
    return influences;
  }
};

/// A parameter of the body's shape that is estimated. Its kinds are in unknowns.hpp.
class Unknown {
 public:
  /// `name`: e.g. "youngs_modulus:body"; `what_would_tell`: the recording that determines it.
  Unknown(std::string name, std::string unit, GaussianPrior prior, std::string what_would_tell)
      : name_(std::move(name)),
        unit_(std::move(unit)),
        prior_(prior),
        what_would_tell_(std::move(what_would_tell)) {}
  virtual ~Unknown() = default;

  const std::string& name() const { return name_; }
  const std::string& unit() const { return unit_; }  ///< of Quantity
  const GaussianPrior& prior() const { return prior_; }
  const std::string& what_would_tell() const { return what_would_tell_; }

  /// Not ok where the model cannot have this value.
  virtual Status ApplyToModel(double value, robot::RobotModel* model) const;
  virtual void ApplyToFrame(double value, int frame, FrameInputs* inputs) const;
  /// On the model of scale 1 (ToModel) with all unknowns applied, at the robot's inputs of a frame.
  /// The influences add up; empty: none.
  virtual std::vector<Influence> InfluencesOn(const robot::RobotModel& model, double value,
                                              int frame, const FrameInputs& inputs) const = 0;
  /// Whether its value is FrameInputs::scale.
  virtual bool ScalesTheRobot() const { return false; }
  /// Whether it is a Young's modulus.
  virtual bool IsModulus() const { return false; }

  /// The reported quantity and its derivative: the modulus where the value is ln E.
  virtual double Quantity(double value) const { return value; }
  virtual double QuantityPerValue(double) const { return 1.0; }

 private:
  std::string name_;
  std::string unit_;
  GaussianPrior prior_;
  std::string what_would_tell_;
};

using UnknownPtr = std::unique_ptr<const Unknown>;

}  // namespace palpate::calibration
