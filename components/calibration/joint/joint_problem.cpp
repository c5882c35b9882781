// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/joint/joint_problem.hpp"

#include <algorithm>
#include <cmath>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"

namespace palpate::calibration {

namespace {

/// Scales of the pose, which has no prior: smaller ones demand more of the data.
struct JointProblemTuning {
  double plausible_turn_rad = 0.1;
  double plausible_shift_m = 0.02;
};
constexpr JointProblemTuning kProblemTuning;

}  // namespace

JointProblem::JointProblem(robot::RobotModel& model, const JointSetup& setup)
    : model_(model),
      setup_(setup),
      shapes_(model, setup, AddVariables()),
      residual_rms_m_(setup.frames.size(), 0.0) {
  for (const Variable& variable : variables_) held_.push_back(variable.considered);
  reached_.assign(variables_.size(), 0.0);
  start_ = Eigen::VectorXd::Zero(ToIndex(variables_.size()));
  // A pose is searched from where it starts, not from its prior mean.
  for (int v = 0; v < static_cast<int>(variables_.size()); ++v) {
    if (variables_[At(v)].of_pose) start_[v] = -variables_[At(v)].prior.mean / Scale(v);
  }
  for (const CalibrationFrame& frame : setup.frames) {
    marker_residuals_m_.emplace_back(3, ToIndex(frame.markers.size()));
    data_rows_ += ToIndex(3 * frame.markers.size() + frame.surface.size());
  }
}

/// Returns the column of the first unknown.
int JointProblem::AddVariables() {
  CameraColumns& first = camera_columns_.emplace_back();
  if (setup_.fit_pose) {
    const PosePrior* prior = setup_.pose_prior ? &*setup_.pose_prior : nullptr;
    first.pose = AddPoseVariables("camera", setup_.T_robot_camera, prior);
  }
  for (const PosePrior& pose : setup_.own_poses) {
    own_pose_columns_.push_back(AddPoseVariables(pose.name, pose.T_robot_camera, &pose));
  }
  if (setup_.depth_bias) first.depth_bias = AddDepthBias(*setup_.depth_bias, "");
  AddFurtherCameras();
  if (setup_.marker_offset_sigma_m > 0.0) AddMarkerOffsets();
  shared_error_column_ = static_cast<int>(variables_.size());
  for (const bool models_own : setup_.shared_errors) {
    variables_.push_back({"shared_error", "", {.sigma = 1.0}, "", nullptr, true, models_own});
  }
  const int first_unknown = static_cast<int>(variables_.size());
  for (const UnknownPtr& unknown : setup_.unknowns) {
    if (unknown->ScalesTheRobot()) {
      PALPATE_CHECK(setup_.conditions.empty(), setup_.conditions.size());
      scale_column_ = static_cast<int>(variables_.size());
    }
    variables_.push_back({unknown->name(), unknown->unit(), unknown->prior(),
                          unknown->what_would_tell(), unknown.get()});
  }
  return first_unknown;
}

void JointProblem::AddFurtherCameras() {
  for (const FurtherCamera& camera : setup_.further_cameras) {
    CameraColumns columns;
    columns.pose = AddPoseVariables("camera:" + camera.name, camera.T_robot_camera,
                                    camera.pose_prior ? &*camera.pose_prior : nullptr);
    if (camera.depth_bias) columns.depth_bias = AddDepthBias(*camera.depth_bias, ":" + camera.name);
    camera_columns_.push_back(columns);
  }
}

int JointProblem::AddDepthBias(const DepthBiasPrior& prior, const std::string& of_camera) {
  const auto column = static_cast<int>(variables_.size());
  for (const std::string& name : geometry::NamesOf(prior.basis)) {
    variables_.push_back(
        {.name = name + of_camera,
         .unit = "",
         .prior = prior.coefficient,
         .what_would_tell = "recordings of the robot at several distances, all over the image",
         .considered = !prior.estimated,
         .of_depth_bias = true});
  }
  return column;
}

int JointProblem::AddPoseVariables(const std::string& name, const geometry::RigidTransform& start,
                                   const PosePrior* prior) {
  const auto column = static_cast<int>(variables_.size());
  const std::string needed = "three or more markers that are not collinear";
  const PoseChange mean =
      prior != nullptr ? ChangeBetween(start, prior->T_robot_camera) : PoseChange::Zero().eval();
  for (int i = 0; i < 6; ++i) {
    const bool turns = i < 3;
    GaussianPrior one{
        .mean = mean[i],
        .plausible = turns ? kProblemTuning.plausible_turn_rad : kProblemTuning.plausible_shift_m};
    if (prior != nullptr) {
      one.sigma = turns ? prior->rotation_sigma_rad : prior->translation_sigma_m;
    }
    variables_.push_back({.name = name + (turns ? "_rotation_" : "_translation_") + "xyz"[i % 3],
                          .unit = turns ? "rad" : "m",
                          .prior = one,
                          .what_would_tell = needed,
                          .of_pose = true});
  }
  return column;
}

void JointProblem::AddMarkerOffsets() {
  marker_offset_column_ = static_cast<int>(variables_.size());
  const double sigma_m = setup_.marker_offset_sigma_m;
  for (const std::string& marker : model_.MarkerNames()) {
    for (const char* axis : {"x", "y", "z"}) {
      variables_.push_back({"marker_offset:" + marker + ":" + axis,
                            "m",
                            {.sigma = sigma_m, .plausible = sigma_m},
                            "a recording in which the marker moves by more than its offset",
                            nullptr,
                            !setup_.estimate_marker_offsets});
    }
  }
}

double JointProblem::Scale(int variable) const { return ScaleOf(variables_[At(variable)].prior); }

double JointProblem::ValueOf(int variable, const Eigen::VectorXd& variables) const {
  return variables_[At(variable)].prior.mean + Scale(variable) * variables[variable];
}

JointProblem::CameraColumns JointProblem::ColumnsOf(const CalibrationFrame& frame) const {
  CameraColumns columns = camera_columns_.front();
  if (frame.own_pose >= 0) columns.pose = own_pose_columns_.at(At(frame.own_pose));
  return columns;
}

CameraView JointProblem::ViewAt(const Eigen::VectorXd& variables, int pose_column,
                                const geometry::RigidTransform& T_robot_camera_start) const {
  PoseChange change = PoseChange::Zero();
  if (pose_column >= 0) {
    for (int i = 0; i < 6; ++i) change[i] = ValueOf(pose_column + i, variables);
  }
  return {T_robot_camera_start, change};
}

CameraView JointProblem::ViewOf(const CalibrationFrame& frame,
                                const Eigen::VectorXd& variables) const {
  if (frame.own_pose < 0) return ViewOfCamera(0, variables);
  return ViewAt(variables, ColumnsOf(frame).pose,
                setup_.own_poses[At(frame.own_pose)].T_robot_camera);
}

CameraView JointProblem::ViewOfCamera(int camera, const Eigen::VectorXd& variables) const {
  return ViewAt(
      variables, pose_column(camera),
      camera == 0 ? setup_.T_robot_camera : setup_.further_cameras[At(camera - 1)].T_robot_camera);
}

AdjustedPose JointProblem::Adjusted(const CameraView& view, const PosePrior& prior) {
  AdjustedPose pose{.name = prior.name, .T_robot_camera = view.T_robot_camera()};
  pose.from_prior = ChangeBetween(prior.T_robot_camera, pose.T_robot_camera);
  pose.chi_squared =
      pose.from_prior.head<3>().squaredNorm() / std::pow(prior.rotation_sigma_rad, 2) +
      pose.from_prior.tail<3>().squaredNorm() / std::pow(prior.translation_sigma_m, 2);
  return pose;
}

std::vector<AdjustedPose> JointProblem::AdjustedPosesAt(const Eigen::VectorXd& variables) const {
  std::vector<AdjustedPose> poses;
  if (setup_.fit_pose && setup_.pose_prior) {
    poses.push_back(Adjusted(ViewOfCamera(0, variables), *setup_.pose_prior));
  }
  for (std::size_t p = 0; p < setup_.own_poses.size(); ++p) {
    const PosePrior& prior = setup_.own_poses[p];
    poses.push_back(Adjusted(ViewAt(variables, own_pose_columns_[p], prior.T_robot_camera), prior));
  }
  for (int camera = 1; camera < CameraCount(); ++camera) {
    const auto& prior = setup_.further_cameras[At(camera - 1)].pose_prior;
    if (prior) poses.push_back(Adjusted(ViewOfCamera(camera, variables), *prior));
  }
  return poses;
}

Eigen::VectorXd JointProblem::DepthBasisAt(int camera, const Eigen::Vector3d& p_camera_m) const {
  if (!depth_bias(camera)) return {};
  return geometry::ValuesAt(depth_bias(camera)->basis, p_camera_m);
}

double JointProblem::DepthScaleAt(int camera, const Eigen::VectorXd& basis,
                                  const Eigen::VectorXd& variables) const {
  double scale = 0.0;
  for (Eigen::Index k = 0; k < basis.size(); ++k) {
    scale += basis[k] * ValueOf(depth_bias_column(camera) + static_cast<int>(k), variables);
  }
  return scale;
}

std::vector<Eigen::VectorXd> JointProblem::ShapesAt(const Eigen::VectorXd& variables) const {
  const double scale = scale_column_ >= 0 ? ValueOf(scale_column_, variables) : 1.0;
  std::vector<Eigen::VectorXd> shapes_m;
  for (const fem::StaticState& state : states()) shapes_m.emplace_back(scale * state.x_m);
  return shapes_m;
}

geometry::RigidTransform JointProblem::PoseAt(const Eigen::VectorXd& variables, int camera) const {
  return ViewOfCamera(camera, variables).T_robot_camera();
}

Eigen::Vector3d JointProblem::OffsetOf(int marker, const Eigen::VectorXd& variables) const {
  if (marker_offset_column_ < 0) return Eigen::Vector3d::Zero();
  Eigen::Vector3d offset_m;
  for (int i = 0; i < 3; ++i) {
    offset_m[i] = ValueOf(marker_offset_column_ + 3 * marker + i, variables);
  }
  return offset_m;
}

void JointProblem::Accept() {
  shapes_.Keep();
  residual_rms_after_m_.push_back(ResidualRms_m());
}

double JointProblem::ResidualRms_m() const {
  double squares_m2 = 0.0;
  for (const double rms_m : residual_rms_m_) squares_m2 += rms_m * rms_m;
  return std::sqrt(squares_m2 / static_cast<double>(residual_rms_m_.size()));
}

Eigen::MatrixX2d JointProblem::Bounds() const {
  Eigen::MatrixX2d bounds(start_.size(), 2);
  for (int v = 0; v < static_cast<int>(variables_.size()); ++v) {
    const GaussianPrior& prior = variables_[At(v)].prior;
    bounds(v, 0) = IsHeld(v) ? 0.0 : (prior.lower - prior.mean) / Scale(v);
    bounds(v, 1) = IsHeld(v) ? 0.0 : (prior.upper - prior.mean) / Scale(v);
  }
  return bounds;
}

Eigen::MatrixX2d JointProblem::ConstraintBounds() const {
  Eigen::MatrixX2d bounds(ToIndex(setup_.conditions.size()), 2);
  for (std::size_t c = 0; c < setup_.conditions.size(); ++c) {
    bounds.row(ToIndex(c)) << setup_.conditions[c]->lower(), setup_.conditions[c]->upper();
  }
  return bounds;
}

std::vector<RobustBlock> JointProblem::RobustBlocks() const {
  std::vector<RobustBlock> blocks;
  Eigen::Index row = 0;
  for (const CalibrationFrame& frame : setup_.frames) {
    for (std::size_t k = 0; k < frame.markers.size(); ++k, row += 3) blocks.push_back({row, 3});
    for (std::size_t k = 0; k < frame.surface.size(); ++k, ++row) blocks.push_back({row, 1});
  }
  return blocks;
}

Status JointProblem::Evaluate(const Eigen::VectorXd& variables, LeastSquaresPoint* point) {
  Clear(point);
  if (Status status = shapes_.Balance(variables, point); !status.ok()) return status;
  SeeAll(variables, point);
  return Status::Ok();
}

void JointProblem::See(const Eigen::VectorXd& variables, LeastSquaresPoint* point) {
  Clear(point);
  SeeAll(variables, point);
}

void JointProblem::Clear(LeastSquaresPoint* point) const {
  const auto columns = ToIndex(variables_.size());
  const auto priors = std::count_if(variables_.begin(), variables_.end(),
                                    [](const Variable& v) { return std::isfinite(v.prior.sigma); });
  point->residual.setZero(data_rows_ + priors);
  point->jacobian.setZero(data_rows_ + priors, columns);
  point->constraint.setZero(ToIndex(setup_.conditions.size()));
  point->constraint_jacobian.setZero(ToIndex(setup_.conditions.size()), columns);
}

void JointProblem::SeeAll(const Eigen::VectorXd& variables, LeastSquaresPoint* point) {
  scale_ = scale_column_ >= 0 ? ValueOf(scale_column_, variables) : 1.0;
  Eigen::Index row = 0;
  for (const CalibrationFrame& frame : setup_.frames) {
    SeeMarkers(frame, variables, &row, point);
    SeeSurface(frame, variables, &row, point);
  }
  AddPriors(variables, point);
}

JointProblem::PlaceInFrame JointProblem::PlaceOf(const CalibrationFrame& frame,
                                                 const CameraColumns& camera,
                                                 const fem::InterpolationWeights& point,
                                                 const Eigen::VectorXd& variables) const {
  const auto index = static_cast<std::size_t>(&frame - setup_.frames.data());
  const SolvedState& solved = shapes_.solved(index);
  return {camera, solved.column(), solved.PlaceOf(point, variables)};
}

void JointProblem::SeeMarkers(const CalibrationFrame& frame, const Eigen::VectorXd& variables,
                              Eigen::Index* row, LeastSquaresPoint* point) {
  const auto index = static_cast<size_t>(&frame - setup_.frames.data());
  const CameraView view = ViewOf(frame, variables);
  Eigen::Matrix3Xd& residuals_m = marker_residuals_m_[index];
  for (std::size_t k = 0; k < frame.markers.size(); ++k) {
    const MarkerSighting& sighting = frame.markers[k];
    const fem::InterpolationWeights& weights =
        model_.body().markers.at(At(sighting.marker)).point.weights;
    const PlaceInFrame seen = PlaceOf(frame, ColumnsOf(frame), weights, variables);
    const Eigen::Vector3d place_m =
        scale_ * seen.place.position_m + OffsetOf(sighting.marker, variables);
    const Eigen::VectorXd basis =
        frame.by_depth_camera ? DepthBasisAt(0, sighting.position_m) : Eigen::VectorXd();
    const double depth_scale = DepthScaleAt(0, basis, variables);
    const SightingRows<3> rows = view.Rows(sighting, place_m, depth_scale);
    PutRows(rows, basis, seen, *row, point);
    if (marker_offset_column_ >= 0) {
      const int column = marker_offset_column_ + 3 * sighting.marker;
      point->jacobian.block<3, 3>(*row, column) = Scale(column) * rows.per_point_m;
    }
    const Eigen::Vector3d seen_m = (1.0 + depth_scale) * sighting.position_m;
    residuals_m.col(ToIndex(k)) = view.T_robot_camera() * seen_m - place_m;
    *row += 3;
  }
  const double count = std::max<double>(1.0, static_cast<double>(frame.markers.size()));
  residual_rms_m_[index] = residuals_m.norm() / std::sqrt(count);
}

void JointProblem::SeeSurface(const CalibrationFrame& frame, const Eigen::VectorXd& variables,
                              Eigen::Index* row, LeastSquaresPoint* point) {
  if (frame.surface.empty()) return;
  const auto index = static_cast<size_t>(&frame - setup_.frames.data());
  std::vector<CameraView> views = {ViewOf(frame, variables)};
  std::vector<CameraColumns> columns = camera_columns_;
  columns.front() = ColumnsOf(frame);
  for (int camera = 1; camera < CameraCount(); ++camera)
    views.push_back(ViewOfCamera(camera, variables));
  double squares_m2 = 0.0;
  for (const SurfaceSighting& sighting : frame.surface) {
    const int camera = sighting.camera;
    const Eigen::VectorXd basis = DepthBasisAt(camera, sighting.position_m);
    const PlaceInFrame seen = PlaceOf(frame, columns[At(camera)], sighting.point, variables);
    const SightingRows<1> rows = views[At(camera)].Rows(sighting, scale_ * seen.place.position_m,
                                                        DepthScaleAt(camera, basis, variables));
    PutRows(rows, basis, seen, *row, point);
    PutSharedErrors(sighting, *row, point);
    const double off_m = rows.residual[0] * sighting.sigma_m;
    squares_m2 += off_m * off_m;
    ++*row;
  }
  if (frame.markers.empty()) {
    residual_rms_m_[index] = std::sqrt(squares_m2 / static_cast<double>(frame.surface.size()));
  }
}

/// Considered parameters, at 0.
void JointProblem::PutSharedErrors(const SurfaceSighting& sighting, Eigen::Index row,
                                   LeastSquaresPoint* point) const {
  for (const SharedError& error : sighting.shared) {
    const int column = shared_error_column_ + error.number;
    point->jacobian(row, column) = -Scale(column) * error.per_unit_m / sighting.sigma_m;
  }
}

template <int Rows>
void JointProblem::PutRows(const SightingRows<Rows>& rows, const Eigen::VectorXd& depth_basis,
                           const PlaceInFrame& seen, Eigen::Index row,
                           LeastSquaresPoint* point) const {
  point->residual.segment<Rows>(row) = rows.residual;
  for (int i = 0; i < 6 && seen.camera.pose >= 0; ++i) {
    const int column = seen.camera.pose + i;
    point->jacobian.block<Rows, 1>(row, column) = Scale(column) * rows.per_pose.col(i);
  }
  for (Eigen::Index k = 0; k < depth_basis.size(); ++k) {
    const int column = seen.camera.depth_bias + static_cast<int>(k);
    point->jacobian.block<Rows, 1>(row, column) =
        Scale(column) * depth_basis[k] * rows.per_depth_scale;
  }
  for (std::size_t p = 0; p < seen.column.size(); ++p) {
    point->jacobian.block<Rows, 1>(row, seen.column[p]) +=
        scale_ * rows.per_point_m * seen.place.motion_m.col(ToIndex(p));
  }
  if (scale_column_ >= 0) {
    point->jacobian.block<Rows, 1>(row, scale_column_) +=
        Scale(scale_column_) * rows.per_point_m * seen.place.position_m;
  }
}

void JointProblem::AddPriors(const Eigen::VectorXd& variables, LeastSquaresPoint* point) const {
  Eigen::Index row = data_rows_;
  for (int v = 0; v < static_cast<int>(variables_.size()); ++v) {
    const double sigma = variables_[At(v)].prior.sigma;
    if (!std::isfinite(sigma)) continue;
    point->residual[row] = Scale(v) * variables[v] / sigma;
    point->jacobian(row, v) = Scale(v) / sigma;
    ++row;
  }
}

}  // namespace palpate::calibration
