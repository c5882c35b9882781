// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "libs/robot/robot_model.hpp"

namespace palpate::robot {

struct HistoryTuning {
  /// Commands that move farther than this since the slides of the cables were computed have them
  /// computed again, which costs a factorisation. Larger: fewer; smaller: truer where it bends
  /// much.
  double renew_slides_m = 5e-4;
  double renew_slides_N = 0.1;  ///< the same of commanded tensions
  /// Change of a history variable by which a frame is solved again, as a share: of what friction
  /// can be, of the modulus, of the internal forces. Larger: faster; smaller: truer in motion.
  double settled = 1e-3;
};

/// History variables of a robot, followed from frame to frame: the play of its actuators, where
/// its cables stick and slide (sticking.hpp), creep (fem/viscosity.hpp) and softening
/// (fem/mullins.hpp) of its material, as its body has them (RobotBody). Between frames commands go
/// straight, and a frame that is left out is a longer step.
///
/// A sequence begins relaxed at its first posture, with the play in its middle and nothing slid
/// yet. The material is as soft as the sequences before it in time have left it
/// (RobotModel::strain_history). A sequence of an earlier time begins with one never strained.
class HistoryState {
 public:
  /// Brings `model`, which must outlive it, to that beginning. Does nothing where !active().
  explicit HistoryState(RobotModel& model, const HistoryTuning& tuning = {});
  ~HistoryState();

  /// Whether the robot has play, friction, creep or softening. Without, commands pass and the model
  /// stays as it is.
  bool active() const { return active_; }
  /// Back to the beginning of another sequence.
  void Restart();

  /// The commands as they reach the cables in a frame at `t_s`, s. Sets friction, cell factors and
  /// the history force of the model to what is left of the past then. Uses the model's
  /// linearisation. A time before the last one's begins a sequence.
  const std::vector<ActuatorCommand>& Prepare(double t_s,
                                              const std::vector<ActuatorCommand>& commands);
  /// Brings friction, cell factors and the history force to a solution `x_m` [3n] of the frame that
  /// was prepared. Returns whether they change enough for the frame to be solved again.
  bool Correct(const Eigen::VectorXd& x_m);
  /// The frame that was prepared has the shape `x_m` [3n] and the tensions `tension_N` [cables] at
  /// the actuators. Not called where a frame tells no shape: the next one takes the longer step.
  void Commit(const Eigen::VectorXd& x_m, const Eigen::VectorXd& tension_N);

 private:
  class Eyelets;
  class Material;

  RobotModel& model_;
  HistoryTuning tuning_;
  bool active_;
  double t_s_ = 0.0;
  bool began_ = false;
  std::vector<ActuatorCommand> commands_;  ///< as they reach the cables
  std::unique_ptr<Eyelets> eyelets_;       ///< or nothing: no cable rubs
  std::unique_ptr<Material> material_;     ///< or nothing: neither creep nor softening
};

}  // namespace palpate::robot
