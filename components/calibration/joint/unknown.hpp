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

/// What is known of a number before the data are looked at.
struct Belief {
  static constexpr double kUnbounded = std::numeric_limits<double>::infinity();

  double mean = 0.0;          ///< where the search starts, and where it stays undetermined
  double sigma = kUnbounded;  ///< of a data sheet or a measurement; infinite: nothing is known
  double lower = -kUnbounded;
  double upper = kUnbounded;
  /// A change worth speaking of, > 0: scales the search. Data that leave the number more uncertain
  /// than half of min(sigma, plausible) do not determine it.
  double plausible = 1.0;
};

/// The change of a number that goes with a variable's change by 1.
inline double ScaleOf(const Belief& belief) { return std::min(belief.plausible, belief.sigma); }

/// What acts on the model in a frame, as unknowns put it together.
struct FrameInputs {
  std::vector<robot::CableCommand> cables;
  std::vector<robot::DeadLoad> loads = {};
  /// [loads] what the hold of each on the body changes by per unit of `scale`; none: nothing.
  std::vector<fem::InterpolationWeights> hold_per_scale = {};
  Eigen::Vector3d nominal_gravity_m_s2 = Eigen::Vector3d::Zero();  ///< of the frame
  Eigen::Vector3d gravity_m_s2 = Eigen::Vector3d::Zero();          ///< as unknowns turn it
  double mass_factor = 1.0;  ///< a mass counts by its weight alone
  /// Size of the robot, guides of its cables and all, over the model's, about the robot frame's
  /// origin, at the model's density. Its shape is that of the model under ToModel of these, so many
  /// times as large: stresses are the same where forces grow with the square.
  double scale = 1.0;
};

/// What acts on a model of scale 1 whose shape is the robot's over its scale: displacements over
/// s, tensions and loads over s^2, weights times s. (Limits of tensions are not scaled.)
FrameInputs ToModel(const FrameInputs& robot);

/// Sets what the robot's loads at `places` [loads] hold on to in a model of scale 1: where a load
/// is stays as the size changes.
void HoldLoadsAt(const std::vector<LoadPlace>& places, const robot::RobotModel& model,
                 FrameInputs* robot);

/// How an equilibrium depends on an unknown: the parameter's derivative times `per_value`.
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

/// A number that calibration is to find, which the shape of the body depends on. The kinds there
/// are: unknowns.hpp.
class Unknown {
 public:
  /// `name`: e.g. "youngs_modulus:body"; `what_would_tell`: the recording that determines it.
  Unknown(std::string name, std::string unit, Belief belief, std::string what_would_tell)
      : name_(std::move(name)),
        unit_(std::move(unit)),
        belief_(belief),
        what_would_tell_(std::move(what_would_tell)) {}
  virtual ~Unknown() = default;

  const std::string& name() const { return name_; }
  const std::string& unit() const { return unit_; }  ///< of Quantity
  const Belief& belief() const { return belief_; }
  const std::string& what_would_tell() const { return what_would_tell_; }

  /// Not ok where the model cannot be so.
  virtual Status ApplyToModel(double value, robot::RobotModel* model) const;
  virtual void ApplyToFrame(double value, int frame, FrameInputs* inputs) const;
  /// On the model of scale 1 (ToModel), as it is with all unknowns applied, at the robot's inputs
  /// of a frame; their sum counts; none where it has no part.
  virtual std::vector<Influence> InfluencesOn(const robot::RobotModel& model, double value,
                                              int frame, const FrameInputs& inputs) const = 0;
  /// Whether its value is FrameInputs::scale.
  virtual bool ScalesTheRobot() const { return false; }

  /// The value as people read it, and its derivative: for E the modulus where the value is its
  /// logarithm.
  virtual double Quantity(double value) const { return value; }
  virtual double QuantityPerValue(double) const { return 1.0; }

 private:
  std::string name_;
  std::string unit_;
  Belief belief_;
  std::string what_would_tell_;
};

using UnknownPtr = std::unique_ptr<const Unknown>;

}  // namespace palpate::calibration
