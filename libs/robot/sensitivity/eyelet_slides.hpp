// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/fem/load_state.hpp"
#include "libs/robot/robot_model.hpp"
#include "libs/robot/sensitivity/sensitivity_solver.hpp"

namespace palpate::robot {

/// An eyelet that a cable runs through, where it may rub: all but the last, where it is attached.
struct RubbingEyelet {
  int cable = 0;
  int eyelet = 0;  ///< 0: next to the actuator
};

/// Cable by cable, from the actuator on.
std::vector<RubbingEyelet> RubbingEyelets(const RobotBody& body);

/// [eyelets] the friction coefficients of their cables.
Eigen::VectorXd FrictionAt(const std::vector<RubbingEyelet>& eyelets, const RobotBody& body);

/// How far cables slide in their rubbing eyelets about an equilibrium, to first order: by how much
/// the length from each eyelet to the end of its cable grows, m.
struct EyeletSlides {
  double t_s = 0.0;             ///< when the body is there
  Eigen::MatrixXd by_command;   ///< [eyelets x cables] per m, or N, that an actuator takes in
  Eigen::MatrixXd by_friction;  ///< [eyelets x eyelets] per CableFriction::Signed of each

  bool IsKnown() const { return by_command.size() > 0; }
};

/// Of the equilibrium `state`, which `solver`'s model has with `commands`; not known, where there
/// are no derivatives.
EyeletSlides SlidesAbout(const std::vector<RubbingEyelet>& eyelets,
                         const std::vector<ActuatorCommand>& commands,
                         const fem::StaticState& state, const RobotModel& model,
                         SensitivitySolver* solver);

}  // namespace palpate::robot
