// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "components/calibration/joint/joint_setup.hpp"
#include "components/calibration/joint/least_squares_problem.hpp"
#include "components/calibration/joint/solved_state.hpp"
#include "libs/core/status.hpp"
#include "libs/core/thread_team.hpp"
#include "libs/fem/equilibrium_step.hpp"
#include "libs/robot/robot_model.hpp"
#include "libs/robot/sensitivity/sensitivity_solver.hpp"

namespace palpate::calibration {

/// Shape of the body in each frame of a joint calibration, and its derivative with respect to the
/// variables: the equilibrium itself (Balance), or a Newton step towards it (Linearise, StepTo).
/// The setup's helpers share the frames, one thread each.
class BodyShapes {
 public:
  /// Both must outlive it. It changes moduli and gravity of the model. The setup's unknowns are the
  /// variables from `first_column` on.
  BodyShapes(robot::RobotModel& model, const JointSetup& setup, int first_column);

  /// Solves the equilibria of all frames, each from the last one that was kept; values and
  /// derivatives of the conditions go into `point`. Not ok where one is not reached.
  Status Balance(const Eigen::VectorXd& variables, LeastSquaresPoint* point);
  /// The present states() become the start of the next ones.
  void Keep();

  /// Moves states() near the equilibria of these variables, except in frames with an input without
  /// a prior.
  Status ComeNear(const Eigen::VectorXd& variables);
  /// Newton step of each frame from states() with the inputs of these variables. solved() is then
  /// the predicted state and its derivatives.
  Status Linearise(const Eigen::VectorXd& variables);
  /// Whether every frame has a factor of its own.
  bool KeepsFactors() const { return setup_.frames.size() <= workers_.size(); }
  /// The same with factors and derivatives of the last Linearise (a chord step), for shapes that
  /// have moved little. Requires KeepsFactors().
  Status LineariseKept(const Eigen::VectorXd& variables);
  /// Moves states() to the prediction of the last Linearise at these variables, shortened while an
  /// element is inverted. Returns the largest nodal displacement over the body's extent; infinite
  /// where a step was shortened.
  double StepTo(const Eigen::VectorXd& variables);
  /// Whether states() are equilibria at these variables: forces to 1e-9 of their size, cable
  /// lengths to the static solver's tolerance.
  bool AreBalanced(const Eigen::VectorXd& variables);
  /// states() become the last ones that were kept.
  void Return();

  const std::vector<fem::StaticState>& states() const { return states_; }
  const SolvedState& solved(std::size_t frame) const { return solved_[frame]; }

 private:
  /// Model and buffers of one thread.
  struct Worker {
    explicit Worker(robot::RobotModel& of) : model(of), sensitivity(of), step(of.linearisation()) {}

    robot::RobotModel& model;
    robot::SensitivitySolver sensitivity;
    fem::EquilibriumStep step;
    std::vector<robot::ParameterPtr> parameters;  ///< of this frame
    std::vector<Eigen::Index> column_of;          ///< [parameters]
    std::vector<double> factor_of;                ///< [parameters] per unit of the variable
  };

  template <typename Work>
  Status OnEachFrame(const Work& work);
  double ValueOf(std::size_t unknown, const Eigen::VectorXd& variables) const;
  FrameInputs InputsOf(int frame, const Eigen::VectorXd& variables) const;
  Status ApplyToModels(const Eigen::VectorXd& variables);
  Status BalanceFrame(int frame, const Eigen::VectorXd& variables, Worker* worker);
  bool IsGuessed(int frame, const Eigen::VectorXd& variables) const;
  Status FollowFrame(int frame, const Eigen::VectorXd& variables, Worker* worker);
  /// Puts what acts on the model, and its gravity, to it and to `state`.
  static void Load(const FrameInputs& acting, fem::StaticState* state, Worker* worker);
  Status LineariseFrame(int frame, const Eigen::VectorXd& variables, Worker* worker);
  Status LineariseKeptFrame(int frame, const Eigen::VectorXd& variables, Worker* worker);
  double StepFrame(int frame, const Eigen::VectorXd& variables, Worker* worker);
  Status CheckFrame(int frame, const Eigen::VectorXd& variables, Worker* worker);
  void DescribeInfluences(int frame, const FrameInputs& inputs, const Eigen::VectorXd& variables,
                          Worker* worker) const;
  bool HasCondition(int frame) const;
  void CheckConditions(int frame, const Worker& worker, LeastSquaresPoint* point) const;

  const JointSetup& setup_;
  const int first_column_;
  std::vector<std::unique_ptr<Worker>> workers_;  ///< frame f is that of worker f % workers
  ThreadTeam team_;
  std::vector<fem::StaticState> kept_, states_;
  std::vector<SolvedState> kept_solved_, solved_;  ///< [frames]
  const bool scales_;                              ///< the robot's size is an unknown
};

}  // namespace palpate::calibration
