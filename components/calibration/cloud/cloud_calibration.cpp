// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/cloud/cloud_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "components/calibration/cloud/cloud_matching.hpp"
#include "components/calibration/cloud/cloud_size.hpp"
#include "components/calibration/joint/model_snapshot.hpp"
#include "libs/core/text.hpp"
#include "libs/geometry/rigid_registration.hpp"

namespace palpate::calibration {

namespace {

/// Larger values end earlier, with a pose that still moves within its standard error.
struct CloudCalibrationTuning {
  double share_of_error = 0.1;  ///< of the standard error, motion of a settled camera
  double step_tolerance =
      1e-6;  ///< of a joint fit: far below the noise, and points are matched again
};
constexpr CloudCalibrationTuning kCloudCalibrationTuning;

/// State of one calibration.
class Search {
 public:
  Search(robot::RobotModel& model, const std::vector<CloudFrame>& frames,
         const CloudSettings& settings)
      : model_(model),
        frames_(frames),
        settings_(settings),
        surface_errors_(model.body(), model.RestState().x_m, settings.surface_errors) {
    for (const CloudFrame& frame : frames) {
      surfaces_.emplace_back(model.body());
      thin_.push_back(Thin(frame.cloud, settings.spacing_m));
      thinner_.push_back(Thin(frame.cloud, settings.search_spacing_m));
    }
  }

  CloudCalibration Run(const geometry::RigidTransform& start) {
    result_.status = Prepare(start);
    if (!result_.status.ok()) return std::move(result_);
    result_.status = FindRigid(start);
    if (result_.status.ok()) result_.status = FitTogether();
    if (result_.status.ok()) result_.status = CheckResult(start);
    if (!result_.status.ok() || LeastCovered() < settings_.search.good_cover) {
      TestOtherSizes(start);
    }
    return std::move(result_);
  }

 private:
  Status Prepare(const geometry::RigidTransform& start);
  Status TakeShapes();
  Status FindRigid(const geometry::RigidTransform& start);
  bool IsSettled(const geometry::RigidTransform& last, const Eigen::Vector3d& middle_m) const;
  Status FitTogether();
  ThinCloud UnbiasedOf(const ThinCloud& cloud) const;
  void Match();
  Status CheckResult(const geometry::RigidTransform& start);
  double LeastCovered() const;
  void TestOtherSizes(const geometry::RigidTransform& start);

  robot::RobotModel& model_;
  const std::vector<CloudFrame>& frames_;
  const CloudSettings& settings_;
  SurfaceErrors surface_errors_;
  std::vector<Eigen::VectorXd> shapes_m_;  ///< [frames] of [3n] nodes
  std::vector<SurfaceInView> surfaces_;
  std::vector<ThinCloud> thin_, thinner_;  ///< of the fit and of the search
  JointSetup setup_;
  CloudCalibration result_;
};

Status Search::Prepare(const geometry::RigidTransform& start) {
  std::vector<CalibrationFrame> frames;
  for (const CloudFrame& frame : frames_) {
    frames.push_back({.name = frame.name,
                      .cables = frame.cables,
                      .loads = frame.loads,
                      .gravity_m_s2 = frame.gravity_m_s2});
  }
  frames.insert(frames.end(), settings_.marker_frames.begin(), settings_.marker_frames.end());
  if (Status status = MakeJointSetup(model_, std::move(frames), &start, settings_.request, &setup_);
      !status.ok()) {
    return status;
  }
  setup_.fit_pose = true;
  if (settings_.marker_frames.empty()) setup_.marker_offset_sigma_m = 0.0;
  if (settings_.depth_bias_sigma > 0.0) {
    const double sigma = settings_.depth_bias_sigma;
    setup_.depth_bias = DepthBiasPrior{.coefficient = {.sigma = sigma, .plausible = sigma},
                                       .estimated = settings_.fit_depth_bias,
                                       .basis = settings_.depth_bias};
  }
  return TakeShapes();
}

/// Equilibria under the prior means of the inputs.
Status Search::TakeShapes() {
  const ModelSnapshot kept(model_);
  shapes_m_.resize(surfaces_.size());
  for (std::size_t f = 0; f < surfaces_.size(); ++f) {
    if (settings_.request.stop.stop_requested()) return {StatusCode::kNotConverged, "stopped"};
    const CalibrationFrame& frame = setup_.frames[f];
    model_.SetGravity(frame.gravity_m_s2);
    fem::StaticState state = model_.RestState();
    const fem::StaticResult solved = model_.Solve(frame.cables, frame.loads, &state);
    kept.RestoreGravity();
    if (!solved.status.ok()) {
      return {solved.status.code(), frame.name + ": " + solved.status.message()};
    }
    surfaces_[f].TakeShape(state.x_m);
    shapes_m_[f] = state.x_m;
  }
  return Status::Ok();
}

Status Search::FindRigid(const geometry::RigidTransform& start) {
  const PoseFit fit = SearchPose(surfaces_, thinner_, start, settings_.search);
  result_.rigid_T_robot_camera = fit.T_robot_camera;
  result_.starts = fit.starts;
  setup_.T_robot_camera = fit.T_robot_camera;
  if (fit.surface_covered >= settings_.least_cover) return Status::Ok();
  return {StatusCode::kNotConverged,
          "no pose near the initial one explains the clouds (at best " +
              FormatNumber(fit.surface_covered) +
              " of the visible surface is covered): the initial pose is too far off, or "
              "it is another robot"};
}

/// With the depth bias of the last round.
ThinCloud Search::UnbiasedOf(const ThinCloud& cloud) const {
  ThinCloud unbiased = cloud;
  if (!result_.joint.depth_bias) return unbiased;
  for (auto point_m : unbiased.points_m.colwise())
    point_m *= 1.0 + result_.joint.depth_bias->At(point_m);
  return unbiased;
}

void Search::Match() {
  result_.matches.resize(surfaces_.size());
  for (std::size_t f = 0; f < surfaces_.size(); ++f) {
    surfaces_[f].LookFrom(setup_.T_robot_camera);
    setup_.frames[f].surface = MatchCloud(surfaces_[f], thin_[f], UnbiasedOf(thin_[f]).points_m,
                                          setup_.T_robot_camera, settings_, &result_.matches[f]);
  }
  setup_.shared_errors = surface_errors_.Share(shapes_m_, &setup_.frames);
}

/// Whether the last round moved the cloud's centroid (camera frame), and turned it, by no more than
/// the settings or a share of the standard error ask for: each round matches other points.
bool Search::IsSettled(const geometry::RigidTransform& last,
                       const Eigen::Vector3d& middle_m) const {
  constexpr double kShareOfError = kCloudCalibrationTuning.share_of_error;
  const geometry::RigidTransform& now = setup_.T_robot_camera;
  const double turned_rad = last.rotation().angularDistance(now.rotation());
  const double moved_m = (last * middle_m - now * middle_m).norm();
  Eigen::Matrix<double, 3, 6> motion;
  motion << -geometry::CrossMatrix(now * middle_m - now.translation_m()),
      Eigen::Matrix3d::Identity();
  const auto& covariance = result_.joint.pose_covariance;
  const double turn_error_rad = std::sqrt(covariance.topLeftCorner<3, 3>().trace());
  const double error_m = std::sqrt((motion * covariance * motion.transpose()).trace());
  return moved_m < std::max(settings_.moved_m, kShareOfError * error_m) &&
         turned_rad < std::max(settings_.turned_rad, kShareOfError * turn_error_rad);
}

Status Search::FitTogether() {
  JointSettings joint_settings;
  joint_settings.solver.huber_threshold = settings_.huber_threshold;
  joint_settings.solver.step_tolerance = kCloudCalibrationTuning.step_tolerance;
  joint_settings.solver.stop = settings_.request.stop;
  while (result_.rounds < settings_.max_rounds && !settings_.request.stop.stop_requested()) {
    Match();
    ++result_.rounds;
    result_.joint = CalibrateJointly(model_, setup_, joint_settings);
    if (!result_.joint.status.ok()) return result_.joint.status;
    shapes_m_ = result_.joint.x_m;
    for (std::size_t f = 0; f < surfaces_.size(); ++f) surfaces_[f].TakeShape(shapes_m_[f]);
    const geometry::RigidTransform last = setup_.T_robot_camera;
    setup_.T_robot_camera = result_.joint.T_robot_camera;
    if (IsSettled(last, thin_.front().points_m.rowwise().mean())) return Status::Ok();
  }
  return {StatusCode::kNotConverged, "the camera still moves after " +
                                         std::to_string(result_.rounds) +
                                         " rounds of matching and fitting"};
}

Status Search::CheckResult(const geometry::RigidTransform& start) {
  Match();
  const geometry::RigidTransform& found = setup_.T_robot_camera;
  for (std::size_t f = 0; f < surfaces_.size(); ++f) {
    CloudMatch& match = result_.matches[f];
    match.surface_covered =
        ShareCovered(surfaces_[f], UnbiasedOf(thin_[f]), found, settings_.search.near_m);
    if (match.surface_covered < settings_.least_cover || match.rms_m > settings_.most_rms_m) {
      return {StatusCode::kInvalidInput,
              frames_[f].name + ": " + FormatNumber(match.surface_covered) +
                  " of the visible surface is covered, by points " + FormatNumber(match.rms_m) +
                  " m off it (RMS): another robot"};
    }
  }
  if (!IsNear(found, start, thinner_, settings_.search)) {
    return {StatusCode::kNotConverged,
            "the clouds fit too far from the initial pose: another initial pose is needed"};
  }
  return Status::Ok();
}

/// After CheckResult.
double Search::LeastCovered() const {
  double least = 1.0;
  for (const CloudMatch& match : result_.matches) least = std::min(least, match.surface_covered);
  return least;
}

/// A failed fit is explained by a robot of another size where that fits the clouds. A fit with low
/// coverage is replaced where another size fits better: a small robot lies inside a large one.
void Search::TestOtherSizes(const geometry::RigidTransform& start) {
  if (settings_.request.stop.stop_requested() || !TakeShapes().ok()) return;
  SizeDemands demands{.most_rms_m = settings_.most_rms_m};
  if (result_.status.ok()) {
    demands.least_cover = LeastCovered();
    for (const CloudMatch& match : result_.matches) {
      demands.most_rms_m = std::min(demands.most_rms_m, match.rms_m);
    }
  }
  const auto sizes = FindOtherSize(surfaces_, thinner_, start, settings_.search, demands);
  if (!sizes) return;
  const std::string before = result_.status.ok() ? "" : result_.status.message() + "; ";
  result_.status = Status(StatusCode::kInvalidInput, before + sizes->Text("points of the surface"));
}

}  // namespace

CloudCalibration CalibrateFromClouds(robot::RobotModel& model,
                                     const std::vector<CloudFrame>& frames,
                                     const geometry::RigidTransform& T_robot_camera_start,
                                     const CloudSettings& settings) {
  CloudCalibration refused;
  refused.status = CheckClouds(model, frames, settings);
  if (!refused.status.ok()) return refused;
  const ModelSnapshot kept(model);
  CloudCalibration result = Search(model, frames, settings).Run(T_robot_camera_start);
  if (!result.status.ok()) kept.Restore();
  return result;
}

}  // namespace palpate::calibration
