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
#include "libs/core/index.hpp"
#include "libs/geometry/rigid_transform.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// One column of the problem.
struct Variable {
  std::string name;
  std::string unit;
  GaussianPrior prior;
  std::string what_would_tell;
  const Unknown* unknown = nullptr;  ///< nullptr: of the pose or the measurement
  bool considered = false;           ///< never estimated: held at its mean for the covariance
  bool models_own = false;           ///< an error of the model itself (Against::kThisModel)
  bool of_pose = false;
  bool of_depth_bias = false;
};

/// The least-squares problem of a joint calibration (eq. (7) of the paper over all frames):
/// residuals of the equilibria, with exact derivatives by their sensitivities. Variables are
/// scaled: value = mean + ScaleOf(prior) * variable. Rows: per frame markers (3 each) and surface
/// points (1 each), then one for each prior. Cameras are numbered as by SurfaceSighting.
class JointProblem final : public LeastSquaresProblem {
 public:
  /// Both must outlive it. It changes moduli and gravity of the model.
  JointProblem(robot::RobotModel& model, const JointSetup& setup);

  const std::vector<Variable>& variables() const { return variables_; }
  /// Held variables stay at their mean.
  /// `reached`: standard deviation that the data leave, scaled.
  void Hold(int variable, double reached) {
    held_[At(variable)] = true;
    reached_[At(variable)] = reached;
  }
  double ReachedWhenHeld(int variable) const { return reached_[At(variable)]; }
  bool IsHeld(int variable) const { return held_[At(variable)]; }
  /// Start of the search; by default the prior means.
  void StartAt(const Eigen::VectorXd& variables) { start_ = variables; }

  Eigen::Index DataRows() const { return data_rows_; }
  double Scale(int variable) const;
  double ValueOf(int variable, const Eigen::VectorXd& variables) const;
  int CameraCount() const { return static_cast<int>(camera_columns_.size()); }
  geometry::RigidTransform PoseAt(const Eigen::VectorXd& variables, int camera = 0) const;
  /// The poses that have a prior, that of the first camera first.
  std::vector<AdjustedPose> AdjustedPosesAt(const Eigen::VectorXd& variables) const;
  /// Whether SolveLiftedGaussNewton can solve it.
  bool CanBeLifted() const { return setup_.conditions.empty(); }
  /// First columns of pose (6) and depth bias; -1: not estimated.
  int pose_column(int camera = 0) const { return camera_columns_[At(camera)].pose; }
  int depth_bias_column(int camera = 0) const { return camera_columns_[At(camera)].depth_bias; }
  const std::optional<DepthBiasPrior>& depth_bias(int camera = 0) const {
    return camera == 0 ? setup_.depth_bias : setup_.further_cameras[At(camera - 1)].depth_bias;
  }
  bool EstimatesDepthBias(int camera) const {
    return depth_bias(camera) && depth_bias(camera)->estimated;
  }
  /// [frames] equilibria of the model at the last point: of a robot of scale 1 (ToModel).
  const std::vector<fem::StaticState>& states() const { return shapes_.states(); }
  BodyShapes& shapes() { return shapes_; }
  /// [frames] nodes [3n] of the robot at the last point, which is at `variables`.
  std::vector<Eigen::VectorXd> ShapesAt(const Eigen::VectorXd& variables) const;
  /// m, [frames] at the last point: RMS distance of markers, or of surface points along the normal.
  const std::vector<double>& residual_rms_m() const { return residual_rms_m_; }
  /// m, [frames] of [3 x markers] at the last point: measured minus model, robot frame.
  const std::vector<Eigen::Matrix3Xd>& marker_residuals_m() const { return marker_residuals_m_; }
  double ResidualRms_m() const;  ///< of all frames, at the last point
  /// m, of all frames, at each accepted point.
  const std::vector<double>& residual_rms_after_m() const { return residual_rms_after_m_; }

  Eigen::VectorXd Start() const override { return start_; }
  Eigen::MatrixX2d Bounds() const override;
  Eigen::MatrixX2d ConstraintBounds() const override;
  std::vector<RobustBlock> RobustBlocks() const override;
  Status Evaluate(const Eigen::VectorXd& variables, LeastSquaresPoint* point) override;
  void Accept() override;
  /// As Evaluate, with the shapes that the derivatives of shapes() predict.
  void See(const Eigen::VectorXd& variables, LeastSquaresPoint* point);

 private:
  int AddVariables();
  /// `prior`: nullptr: none. Returns the first column.
  int AddPoseVariables(const std::string& name, const geometry::RigidTransform& start,
                       const PosePrior* prior);
  void AddFurtherCameras();
  /// `of_camera`: appended to names. Returns the first column.
  int AddDepthBias(const DepthBiasPrior& prior, const std::string& of_camera);
  void AddMarkerOffsets();
  /// Variables that say what a camera sees of a given shape.
  struct CameraColumns {
    int pose = -1;        ///< first of 6; -1: the pose is given
    int depth_bias = -1;  ///< first; -1: no bias
  };
  /// Of the camera that sees a frame's markers, and its surface where no further one is named.
  CameraColumns ColumnsOf(const CalibrationFrame& frame) const;
  CameraView ViewAt(const Eigen::VectorXd& variables, int pose_column,
                    const geometry::RigidTransform& T_robot_camera_start) const;
  CameraView ViewOf(const CalibrationFrame& frame, const Eigen::VectorXd& variables) const;
  CameraView ViewOfCamera(int camera, const Eigen::VectorXd& variables) const;
  static AdjustedPose Adjusted(const CameraView& view, const PosePrior& prior);
  /// Empty without a depth bias.
  Eigen::VectorXd DepthBasisAt(int camera, const Eigen::Vector3d& p_camera_m) const;
  double DepthScaleAt(int camera, const Eigen::VectorXd& basis,
                      const Eigen::VectorXd& variables) const;
  Eigen::Vector3d OffsetOf(int marker, const Eigen::VectorXd& variables) const;
  void Clear(LeastSquaresPoint* point) const;
  void SeeAll(const Eigen::VectorXd& variables, LeastSquaresPoint* point);
  void SeeMarkers(const CalibrationFrame& frame, const Eigen::VectorXd& variables,
                  Eigen::Index* row, LeastSquaresPoint* point);
  void SeeSurface(const CalibrationFrame& frame, const Eigen::VectorXd& variables,
                  Eigen::Index* row, LeastSquaresPoint* point);
  /// A point of the body in a frame, and the camera that sees it there.
  struct PlaceInFrame {
    CameraColumns camera;
    const std::vector<Eigen::Index>& column;  ///< variables that move it
    SolvedState::Place place;
  };
  PlaceInFrame PlaceOf(const CalibrationFrame& frame, const CameraColumns& camera,
                       const fem::InterpolationWeights& point,
                       const Eigen::VectorXd& variables) const;
  void PutSharedErrors(const SurfaceSighting& sighting, Eigen::Index row,
                       LeastSquaresPoint* point) const;
  template <int Rows>
  void PutRows(const SightingRows<Rows>& rows, const Eigen::VectorXd& depth_basis,
               const PlaceInFrame& seen, Eigen::Index row, LeastSquaresPoint* point) const;
  void AddPriors(const Eigen::VectorXd& variables, LeastSquaresPoint* point) const;

  robot::RobotModel& model_;
  const JointSetup& setup_;
  std::vector<Variable> variables_;
  std::vector<bool> held_;
  std::vector<double> reached_;
  Eigen::VectorXd start_;
  std::vector<CameraColumns> camera_columns_;  ///< [CameraCount()]
  std::vector<int> own_pose_columns_;
  int marker_offset_column_ = -1;
  int shared_error_column_ = -1;
  int scale_column_ = -1;
  double scale_ = 1.0;  ///< of the robot, at the present variables
  Eigen::Index data_rows_ = 0;
  BodyShapes shapes_;  ///< initialised after variables_
  std::vector<double> residual_rms_m_;
  std::vector<Eigen::Matrix3Xd> marker_residuals_m_;
  std::vector<double> residual_rms_after_m_;
};

}  // namespace palpate::calibration
