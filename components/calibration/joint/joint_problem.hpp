// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/calibration/joint/calibration_frame.hpp"
#include "components/calibration/joint/camera_view.hpp"
#include "components/calibration/joint/condition.hpp"
#include "components/calibration/joint/depth_bias_belief.hpp"
#include "components/calibration/joint/least_squares_problem.hpp"
#include "components/calibration/joint/solved_state.hpp"
#include "components/calibration/joint/unknown.hpp"
#include "libs/core/thread_team.hpp"
#include "libs/fem/static_solver.hpp"
#include "libs/geometry/rigid_transform.hpp"
#include "libs/robot/robot_model.hpp"
#include "libs/robot/sensitivity/sensitivity_solver.hpp"

namespace palpate::calibration {

/// Everything that one joint calibration is about.
struct JointSetup {
  std::vector<CalibrationFrame> frames;
  std::vector<UnknownPtr> unknowns;
  std::vector<ConditionPtr> conditions;  ///< none beside an unknown scale
  std::vector<fem::StaticState> states;  ///< [frames] to start from; empty: from rest
  /// Models like the one that is calibrated (ModelsLike): each takes a share of the frames, on a
  /// thread of its own.
  std::vector<std::unique_ptr<robot::RobotModel>> helpers = {};
  geometry::RigidTransform T_robot_camera;  ///< to start from, or known
  bool fit_pose = true;
  std::optional<DepthBiasBelief> depth_bias;  ///< nothing: the depth is right
  /// How far the body may move by more or less than the model says, all of it alike, as a share
  /// (one sigma): counts in the errors of all that is estimated. 0: the model is right.
  double motion_relative_sigma = 0.0;
  /// How far a marker may lie from its place in the robot file, m, each axis (one sigma); 0: it
  /// lies there. Where it is not estimated it counts in the errors of all that is.
  double marker_offset_sigma_m = 0.0;
  bool estimate_marker_offsets = true;
};

/// One column of the problem.
struct Variable {
  std::string name;
  std::string unit;
  Belief belief;
  std::string what_would_tell;
  const Unknown* unknown = nullptr;  ///< of the pose and other parts of the view: none
  bool considered = false;           ///< held at its mean, for its part in the errors of the others
};

/// Camera pose, cable inputs, material and more from what was seen of the body in several frames
/// (the paper's eq. (7) over all of them at once): residuals of equilibria, with exact derivatives
/// by their sensitivities. Variables are scaled: value = mean + plausible change * variable.
/// Rows: frame by frame markers (3 each), then surface points, then a row for each belief.
class JointProblem final : public LeastSquaresProblem {
 public:
  /// Both must outlive it; the model's moduli and gravity are changed along the way.
  JointProblem(robot::RobotModel& model, const JointSetup& setup);

  const std::vector<Variable>& variables() const { return variables_; }
  /// Held variables stay at their mean.
  void Hold(int variable) { held_[static_cast<size_t>(variable)] = true; }
  bool IsHeld(int variable) const { return held_[static_cast<size_t>(variable)]; }
  /// Where the search starts: the means, unless another start is given.
  void StartAt(const Eigen::VectorXd& variables) { start_ = variables; }

  Eigen::Index DataRows() const { return data_rows_; }
  double Scale(int variable) const;
  double ValueOf(int variable, const Eigen::VectorXd& variables) const;
  geometry::RigidTransform PoseAt(const Eigen::VectorXd& variables) const;
  /// Columns of pose (6) and other parts of the view; -1: not fitted.
  int pose_column() const { return pose_column_; }
  int depth_bias_column() const { return depth_bias_column_; }
  const std::optional<DepthBiasBelief>& depth_bias() const { return setup_.depth_bias; }
  /// [frames] equilibria of the model in the last point: of a robot of scale 1 (ToModel).
  const std::vector<fem::StaticState>& states() const { return states_; }
  /// [frames] nodes [3n] of the robot in the last point, which is at `variables`.
  std::vector<Eigen::VectorXd> ShapesAt(const Eigen::VectorXd& variables) const;
  /// m, [frames] of the last point: RMS distance over its markers, or points along the normal.
  const std::vector<double>& residual_rms_m() const { return residual_rms_m_; }
  /// m, of all frames, at each point that was accepted.
  const std::vector<double>& residual_rms_after_m() const { return residual_rms_after_m_; }

  Eigen::VectorXd Start() const override { return start_; }
  Eigen::MatrixX2d Bounds() const override;
  Eigen::MatrixX2d ConstraintBounds() const override;
  std::vector<RobustBlock> RobustBlocks() const override;
  Status Evaluate(const Eigen::VectorXd& variables, LeastSquaresPoint* point) override;
  void Accept() override;

 private:
  void AddVariables();
  void AddPoseVariables();
  void AddMarkerOffsets();
  CameraView ViewAt(const Eigen::VectorXd& variables) const;
  Eigen::VectorXd DepthBasisAt(const Eigen::Vector3d& p_camera_m) const;
  double DepthScaleAt(const Eigen::VectorXd& basis, const Eigen::VectorXd& variables) const;
  Eigen::Vector3d OffsetOf(int marker, const Eigen::VectorXd& variables) const;
  FrameInputs InputsOf(int frame, const Eigen::VectorXd& variables) const;
  /// Who works on frames, one thread each.
  struct Worker {
    explicit Worker(robot::RobotModel& of) : model(of), sensitivity(of) {}

    robot::RobotModel& model;
    robot::SensitivitySolver sensitivity;
    std::vector<robot::ParameterPtr> parameters;  ///< of this frame
    std::vector<Eigen::Index> column_of;          ///< [parameters]
    std::vector<double> factor_of;                ///< [parameters] per unit of the variable
  };
  void ApplyToModels(const Eigen::VectorXd& variables);
  Status BalanceAll(const Eigen::VectorXd& variables, LeastSquaresPoint* point);
  Status Balance(int frame, const Eigen::VectorXd& variables, Worker* worker);
  void DescribeInfluences(int frame, const FrameInputs& inputs, const Eigen::VectorXd& variables,
                          Worker* worker) const;
  void SeeMarkers(const CalibrationFrame& frame, const CameraView& view,
                  const Eigen::VectorXd& variables, Eigen::Index* row, LeastSquaresPoint* point);
  void SeeSurface(const CalibrationFrame& frame, const CameraView& view,
                  const Eigen::VectorXd& variables, Eigen::Index* row, LeastSquaresPoint* point);
  /// A point of the body in a frame.
  struct PlaceOfState {
    const SolvedState& solved;
    const fem::NodeWeights& point;
    const Eigen::VectorXd& x_m;
  };
  template <int Rows>
  void PutRows(const SightingRows<Rows>& rows, const Eigen::VectorXd& depth_basis,
               const PlaceOfState& place, Eigen::Index row, LeastSquaresPoint* point) const;
  bool HasCondition(int frame) const;
  void CheckConditions(int frame, const Worker& worker, LeastSquaresPoint* point) const;
  void AddBeliefs(const Eigen::VectorXd& variables, LeastSquaresPoint* point) const;

  robot::RobotModel& model_;
  const JointSetup& setup_;
  std::vector<std::unique_ptr<Worker>> workers_;  ///< frame f is that of worker f % workers
  ThreadTeam team_;
  std::vector<Variable> variables_;
  std::vector<bool> held_;
  Eigen::VectorXd start_;
  int pose_column_ = -1;
  int depth_bias_column_ = -1;
  int marker_offset_column_ = -1;
  int motion_column_ = -1;
  int unknown_column_ = 0;  ///< of the first unknown
  int scale_column_ = -1;
  Eigen::VectorXd rest_m_ = model_.RestState().x_m;  ///< [3n]
  double scale_ = 1.0;                               ///< of the robot, at the present variables
  Eigen::Index data_rows_ = 0;
  std::vector<fem::StaticState> accepted_, states_;
  std::vector<SolvedState> accepted_solved_, solved_;  ///< [frames]
  std::vector<double> residual_rms_m_;
  std::vector<double> residual_rms_after_m_;
};

}  // namespace palpate::calibration
