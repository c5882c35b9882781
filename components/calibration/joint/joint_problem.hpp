// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "components/calibration/joint/calibration_frame.hpp"
#include "components/calibration/joint/camera_view.hpp"
#include "components/calibration/joint/condition.hpp"
#include "components/calibration/joint/depth_bias_map.hpp"
#include "components/calibration/joint/least_squares_problem.hpp"
#include "components/calibration/joint/solved_state.hpp"
#include "components/calibration/joint/unknown.hpp"
#include "libs/fem/static_solver.hpp"
#include "libs/geometry/rigid_transform.hpp"
#include "libs/robot/robot_model.hpp"
#include "libs/robot/sensitivity/sensitivity_solver.hpp"

namespace palpate::calibration {

/// Everything that one joint calibration is about.
struct JointSetup {
  std::vector<CalibrationFrame> frames;
  std::vector<UnknownPtr> unknowns;
  std::vector<ConditionPtr> conditions;
  std::vector<fem::StaticState> states;     ///< [frames] to start from; empty: from rest
  geometry::RigidTransform T_robot_camera;  ///< to start from, or known
  bool fit_pose = true;
  std::optional<DepthBiasBelief> depth_bias;  ///< nothing: the depth is right
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
  const std::vector<fem::StaticState>& states() const { return states_; }
  /// m, [frames] of the last point: RMS distance over its markers, or points along the normal.
  const std::vector<double>& residual_rms_m() const { return residual_rms_m_; }
  /// m, of all frames, at each point that was accepted.
  const std::vector<double>& residual_rms_after_m() const { return residual_rms_after_m_; }

  Eigen::VectorXd Start() const override;
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
  Status Balance(int frame, const FrameInputs& inputs, const Eigen::VectorXd& variables);
  void SeeMarkers(const CalibrationFrame& frame, const CameraView& view,
                  const Eigen::VectorXd& variables, Eigen::Index* row, LeastSquaresPoint* point);
  void SeeSurface(const CalibrationFrame& frame, const CameraView& view,
                  const Eigen::VectorXd& variables, Eigen::Index* row, LeastSquaresPoint* point);
  /// A point of the body in a frame.
  struct PlaceOfState {
    const SolvedState& solved;
    const fem::NodeWeights& point;
  };
  template <int Rows>
  void PutRows(const SightingRows<Rows>& rows, const Eigen::VectorXd& depth_basis,
               const PlaceOfState& place, Eigen::Index row, LeastSquaresPoint* point) const;
  bool HasCondition(int frame) const;
  void CheckConditions(int frame, LeastSquaresPoint* point) const;
  void AddBeliefs(const Eigen::VectorXd& variables, LeastSquaresPoint* point) const;

  robot::RobotModel& model_;
  const JointSetup& setup_;
  robot::SensitivitySolver sensitivity_;
  std::vector<Variable> variables_;
  std::vector<bool> held_;
  Eigen::VectorXd start_;
  int pose_column_ = -1;
  int depth_bias_column_ = -1;
  int marker_offset_column_ = -1;
  int unknown_column_ = 0;  ///< of the first unknown
  Eigen::Index data_rows_ = 0;
  std::vector<fem::StaticState> accepted_, states_;
  std::vector<SolvedState> accepted_solved_, solved_;  ///< [frames]
  std::vector<robot::ParameterPtr> parameters_;        ///< of this frame
  std::vector<Eigen::Index> column_of_;                ///< [parameters_]
  std::vector<double> factor_of_;                      ///< [parameters_] per unit of the variable
  std::vector<double> residual_rms_m_;
  std::vector<double> residual_rms_after_m_;
};

}  // namespace palpate::calibration
