// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "components/diagnosis/forward/marker_normals.hpp"
#include "components/diagnosis/forward/measured_points.hpp"
#include "components/diagnosis/forward/model_hypothesis.hpp"
#include "components/diagnosis/forward/obstacle_balance.hpp"
#include "components/diagnosis/forward/simulation.hpp"
#include "components/diagnosis/forward/tangent_state.hpp"
#include "libs/fem/interpolation_weights.hpp"
#include "libs/robot/robot_model.hpp"
#include "libs/robot/sensitivity/sensitivity_solver.hpp"

namespace palpate::diagnosis {

/// Equilibria of a hypothesis's robot at single samples. For one thread.
class SampleSolver {
 public:
  /// Both must outlive it.
  SampleSolver(const ModelHypothesis& hypothesis, const ObservedExperiment& observed);

  robot::RobotModel& model() { return model_; }
  const fem::PointStress& points() const { return points_; }
  /// [markers] points of the body that the markers sit at, offsets included.
  const std::vector<fem::InterpolationWeights>& markers() const { return markers_; }

  /// [3n] where the nodes would be on the finer mesh of which the hypothesis has the error, of a
  /// body with its nodes at `x_m` [3n].
  Eigen::VectorXd OnFinerMesh(const Eigen::VectorXd& x_m) const;
  /// What of the markers arrives where they are measured, with the nodes at `x_m` [3n].
  MeasuredPoints MeasuredPointsOf(const Sample& sample, const Eigen::VectorXd& x_m) const;
  /// The same of the surface; surface points that were not visible then are 0. A camera is there
  /// wherever the recording has depth frames.
  MeasuredPoints SurfacePointsOf(const Sample& sample, const Eigen::VectorXd& x_m) const;

  /// Brings `solved` from the state that it has (an empty one: from rest) to the balance at a
  /// sample with `taken_in` [actuators], a compliant base at what it yields by.
  void Solve(const Sample& sample, const Eigen::VectorXd& taken_in,
             const HistoryVariables& history_variables, SimulatedSample* solved);
  /// Whether the body is so near the hypothesis's obstacle that it may touch it elsewhere in the
  /// sample.
  bool IsNearObstacle(const fem::StaticState& state) const;
  /// What a body will remember of where it is in the middle of `solved`; nothing (0) of one that
  /// failed.
  HistoryInput HistoryInputAt(const HistoryVariables& history_variables,
                              const SimulatedSample& solved);
  /// The same at rest with every command at zero and nothing on the body. `shape`: of another robot
  /// at rest, from which this one's is sought, or none; then this one's, none where it failed.
  HistoryInput Rest(HeldShape* shape);
  /// Puts the model's moduli and gravity to what they are at a sample.
  void Prepare(const Sample& sample, const HistoryVariables& history_variables);
  /// [RubbingEyelets] CableFriction::sliding from now on; empty: everywhere towards the actuators.
  void SetSliding(const Eigen::VectorXd& sliding);
  /// [RubbingEyelets] friction coefficients.
  Eigen::VectorXd FrictionOfEyelets() const {
    return robot::FrictionAt(eyelets_, hypothesis_.body);
  }
  /// About `shape`, which was solved last.
  robot::EyeletSlides SlidesAboutShape(const HeldShape& shape);
  /// Of the sample that it was prepared for last, with what slides in it.
  TangentState TangentStateAt(const fem::StaticState& state) const;

 private:
  std::vector<robot::ActuatorCommand> Commands(const Eigen::VectorXd& taken_in) const;
  std::vector<robot::DeadLoad> LoadsAt(const Sample& sample) const;
  Status Balance(const fem::LoadState& loads, HeldShape* shape);
  Status BalanceOnBase(fem::LoadState loads, HeldShape* shape);
  Status TurnBase(const fem::LoadState& loads, const fem::StaticState& state, bool* moved);
  fem::LoadState LoadsOf(const Sample& sample,
                         const std::vector<robot::ActuatorCommand>& commands) const;
  void HoldBase(fem::LoadState* loads) const;
  void See(const Sample& sample, SimulatedSample* solved) const;
  Eigen::VectorXd MeshErrorAt(const Eigen::VectorXd& x_m) const;

  const ModelHypothesis& hypothesis_;
  const ObservedExperiment& observed_;
  fem::PointStress points_;
  KeptStress kept_;                            ///< the first constraint after the actuators
  std::unique_ptr<ObstacleContact> obstacle_;  ///< the hypothesis's, or none: the last
  robot::RobotModel model_;
  std::vector<robot::RubbingEyelet> eyelets_;
  std::unique_ptr<ObstacleBalance> at_obstacle_;  ///< with the obstacle
  robot::SensitivitySolver sensitivity_;
  std::vector<fem::InterpolationWeights> markers_;
  MarkerNormals skin_;
  Eigen::VectorXd cell_volume_m3_;
  Eigen::VectorXd zero_shift_m_;  ///< [actuators] of cables: of the shape that they were zeroed at
  TangentState prepared_;         ///< but its state
  /// The last slides, kept for a sample of the same shape.
  struct {
    TangentState at;
    std::vector<robot::ActuatorCommand> commands;
    robot::EyeletSlides slides;
  } known_slides_;
  Eigen::Vector3d base_turn_rad_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d base_middle_m_;
};

}  // namespace palpate::diagnosis
