// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "components/calibration/joint/body_shapes.hpp"
#include "components/calibration/joint/calibration_frame.hpp"
#include "components/calibration/joint/camera_view.hpp"
#include "components/calibration/joint/joint_setup.hpp"
#include "components/calibration/joint/least_squares_problem.hpp"
#include "components/calibration/joint/solved_state.hpp"
#include "components/calibration/joint/unknown.hpp"
#include "libs/geometry/rigid_transform.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// One column of the problem.
struct Variable {
  std::string name;
  std::string unit;
  Belief belief;
  std::string what_would_tell;
  const Unknown* unknown = nullptr;  ///< of the pose and other parts of the view: none
  bool considered = false;           ///< held at its mean, for its part in the errors of the others
  bool models_own = false;           ///< of an error that the model always has
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
  /// Whether derivatives say enough of it for SolveLiftedGaussNewton.
  bool CanBeLifted() const { return setup_.conditions.empty(); }
  /// Columns of pose (6) and other parts of the view; -1: not fitted.
  int pose_column() const { return pose_column_; }
  int depth_bias_column() const { return depth_bias_column_; }
  const std::optional<DepthBiasPrior>& depth_bias() const { return setup_.depth_bias; }
  /// [frames] equilibria of the model in the last point: of a robot of scale 1 (ToModel).
  const std::vector<fem::StaticState>& states() const { return shapes_.states(); }
  BodyShapes& shapes() { return shapes_; }
  /// [frames] nodes [3n] of the robot in the last point, which is at `variables`.
  std::vector<Eigen::VectorXd> ShapesAt(const Eigen::VectorXd& variables) const;
  /// m, [frames] of the last point: RMS distance over its markers, or points along the normal.
  const std::vector<double>& residual_rms_m() const { return residual_rms_m_; }
  double ResidualRms_m() const;  ///< of all frames, of the last point
  /// m, of all frames, at each point that was accepted.
  const std::vector<double>& residual_rms_after_m() const { return residual_rms_after_m_; }

  Eigen::VectorXd Start() const override { return start_; }
  Eigen::MatrixX2d Bounds() const override;
  Eigen::MatrixX2d ConstraintBounds() const override;
  std::vector<RobustBlock> RobustBlocks() const override;
  Status Evaluate(const Eigen::VectorXd& variables, LeastSquaresPoint* point) override;
  void Accept() override;
  /// As Evaluate, with the bodies where shapes() says by the derivatives that it has.
  void See(const Eigen::VectorXd& variables, LeastSquaresPoint* point);

 private:
  int AddVariables();
  void AddPoseVariables();
  void AddMarkerOffsets();
  CameraView ViewAt(const Eigen::VectorXd& variables) const;
  Eigen::VectorXd DepthBasisAt(const Eigen::Vector3d& p_camera_m) const;
  double DepthScaleAt(const Eigen::VectorXd& basis, const Eigen::VectorXd& variables) const;
  Eigen::Vector3d OffsetOf(int marker, const Eigen::VectorXd& variables) const;
  void Clear(LeastSquaresPoint* point) const;
  void SeeAll(const Eigen::VectorXd& variables, LeastSquaresPoint* point);
  void SeeMarkers(const CalibrationFrame& frame, const CameraView& view,
                  const Eigen::VectorXd& variables, Eigen::Index* row, LeastSquaresPoint* point);
  void SeeSurface(const CalibrationFrame& frame, const CameraView& view,
                  const Eigen::VectorXd& variables, Eigen::Index* row, LeastSquaresPoint* point);
  /// A point of the body in a frame.
  struct PlaceInFrame {
    const fem::InterpolationWeights& point;
    const std::vector<Eigen::Index>& column;  ///< of what it moves with
    SolvedState::Place place;
  };
  PlaceInFrame PlaceOf(std::size_t frame, const fem::InterpolationWeights& point,
                       const Eigen::VectorXd& variables) const;
  void PutSharedErrors(const SurfaceSighting& sighting, Eigen::Index row,
                       LeastSquaresPoint* point) const;
  template <int Rows>
  void PutRows(const SightingRows<Rows>& rows, const Eigen::VectorXd& depth_basis,
               const PlaceInFrame& seen, Eigen::Index row, LeastSquaresPoint* point) const;
  void AddBeliefs(const Eigen::VectorXd& variables, LeastSquaresPoint* point) const;

  robot::RobotModel& model_;
  const JointSetup& setup_;
  std::vector<Variable> variables_;
  std::vector<bool> held_;
  Eigen::VectorXd start_;
  int pose_column_ = -1;
  int depth_bias_column_ = -1;
  int marker_offset_column_ = -1;
  int shared_error_column_ = -1;
  int scale_column_ = -1;
  double scale_ = 1.0;  ///< of the robot, at the present variables
  Eigen::Index data_rows_ = 0;
  BodyShapes shapes_;  ///< after the variables, of which some are its
  std::vector<double> residual_rms_m_;
  std::vector<double> residual_rms_after_m_;
};

}  // namespace palpate::calibration
