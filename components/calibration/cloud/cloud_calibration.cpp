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

/// The frames in which one camera sees the robot.
struct FramesOfCamera {
  std::string prefix;  ///< of messages, for a further camera
  geometry::RigidTransform start;
  std::vector<std::size_t> frames;  ///< ascending; the lists below are of these
  std::vector<SurfaceInView> surfaces = {};
  std::vector<ThinCloud> thin = {}, thinner = {};  ///< of the fit and of the search
  std::vector<CloudMatch> matches = {};
};

/// State of one calibration.
class Search {
 public:
  Search(robot::RobotModel& model, const std::vector<CloudFrame>& frames,
         const geometry::RigidTransform& start, const CloudSettings& settings)
      : model_(model),
        frames_(frames),
        settings_(settings),
        surface_errors_(model.body(), model.RestState().x_m, settings.surface_errors) {
    AddCamera("", start, [](const CloudFrame& frame) { return &frame.cloud; });
    for (std::size_t k = 0; k < settings.further_cameras.size(); ++k) {
      const CloudCamera& camera = settings.further_cameras[k];
      AddCamera("camera '" + camera.name + "': ", camera.T_robot_camera_start,
                [k](const CloudFrame& frame) {
                  return frame.further.empty() ? nullptr : &frame.further[k];
                });
    }
  }

  CloudCalibration Run() {
    result_.status = Prepare();
    if (!result_.status.ok()) return std::move(result_);
    for (std::size_t c = 0; c < cameras_.size() && result_.status.ok(); ++c)
      result_.status = FindRigid(c);
    if (result_.status.ok()) result_.status = FitTogether();
    if (result_.status.ok()) result_.status = CheckResult();
    if (!result_.status.ok() || LeastCovered() < settings_.search.good_cover) TestOtherSizes();
    ReportMatches();
    return std::move(result_);
  }

 private:
  template <typename CloudOf>
  void AddCamera(const std::string& prefix, const geometry::RigidTransform& start,
                 const CloudOf& cloud_of);
  Status Prepare();
  void AddDepthBiases();
  Status TakeShapes();
  void ShowShapes();
  geometry::RigidTransform& PoseOf(std::size_t camera) {
    return camera == 0 ? setup_.T_robot_camera : setup_.further_cameras[camera - 1].T_robot_camera;
  }
  const FittedCamera& FittedOf(std::size_t camera) const {
    return camera == 0 ? result_.joint : result_.joint.further_cameras[camera - 1];
  }
  Status FindRigid(std::size_t camera);
  bool IsSettled(const geometry::RigidTransform& last, std::size_t camera);
  bool TakePoses();
  Status FitTogether();
  ThinCloud UnbiasedOf(std::size_t camera, std::size_t number) const;
  void Match();
  Status CheckResult();
  Status CheckCamera(std::size_t camera);
  double LeastCovered() const;
  void TestOtherSizes();
  void ReportMatches();

  robot::RobotModel& model_;
  const std::vector<CloudFrame>& frames_;
  const CloudSettings& settings_;
  SurfaceErrors surface_errors_;
  std::vector<Eigen::VectorXd> shapes_m_;  ///< [frames] of [3n] nodes
  std::vector<FramesOfCamera> cameras_;    ///< the first, and those beside it
  JointSetup setup_;
  CloudCalibration result_;
};

template <typename CloudOf>
void Search::AddCamera(const std::string& prefix, const geometry::RigidTransform& start,
                       const CloudOf& cloud_of) {
  FramesOfCamera camera{.prefix = prefix, .start = start, .frames = {}};
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    const rgbd::SensedCloud* cloud = cloud_of(frames_[f]);
    if (cloud == nullptr || cloud->Count() == 0) continue;
    camera.frames.push_back(f);
    camera.surfaces.emplace_back(model_.body());
    camera.thin.push_back(Thin(*cloud, settings_.spacing_m));
    camera.thinner.push_back(Thin(*cloud, settings_.search_spacing_m));
  }
  camera.matches.resize(camera.frames.size());
  cameras_.push_back(std::move(camera));
}

Status Search::Prepare() {
  std::vector<CalibrationFrame> frames;
  for (const CloudFrame& frame : frames_) {
    frames.push_back({.name = frame.name,
                      .cables = frame.cables,
                      .loads = frame.loads,
                      .gravity_m_s2 = frame.gravity_m_s2});
  }
  frames.insert(frames.end(), settings_.marker_frames.begin(), settings_.marker_frames.end());
  if (Status status = MakeJointSetup(model_, std::move(frames), &cameras_.front().start,
                                     settings_.request, &setup_);
      !status.ok()) {
    return status;
  }
  setup_.fit_pose = true;
  if (settings_.marker_frames.empty()) setup_.marker_offset_sigma_m = 0.0;
  for (const CloudCamera& camera : settings_.further_cameras) {
    setup_.further_cameras.push_back({.name = camera.name,
                                      .T_robot_camera = camera.T_robot_camera_start,
                                      .pose_prior = camera.pose_prior});
  }
  if (settings_.depth_bias_sigma > 0.0) AddDepthBiases();
  return TakeShapes();
}

void Search::AddDepthBiases() {
  const double sigma = settings_.depth_bias_sigma;
  const auto prior = [&](bool estimated) {
    return DepthBiasPrior{.coefficient = {.sigma = sigma, .plausible = sigma},
                          .estimated = estimated,
                          .basis = settings_.depth_bias};
  };
  setup_.depth_bias = prior(settings_.fit_depth_bias);
  for (std::size_t k = 0; k < setup_.further_cameras.size(); ++k)
    setup_.further_cameras[k].depth_bias = prior(settings_.further_cameras[k].fit_depth_bias);
}

/// Equilibria under the prior means of the inputs.
Status Search::TakeShapes() {
  const ModelSnapshot kept(model_);
  shapes_m_.resize(frames_.size());
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    if (settings_.request.stop.stop_requested()) return {StatusCode::kNotConverged, "stopped"};
    const CalibrationFrame& frame = setup_.frames[f];
    model_.SetGravity(frame.gravity_m_s2);
    fem::StaticState state = model_.RestState();
    const fem::StaticResult solved = model_.Solve(frame.cables, frame.loads, &state);
    kept.RestoreGravity();
    if (!solved.status.ok()) {
      return {solved.status.code(), frame.name + ": " + solved.status.message()};
    }
    shapes_m_[f] = state.x_m;
  }
  ShowShapes();
  return Status::Ok();
}

void Search::ShowShapes() {
  for (FramesOfCamera& camera : cameras_) {
    for (std::size_t k = 0; k < camera.frames.size(); ++k)
      camera.surfaces[k].TakeShape(shapes_m_[camera.frames[k]]);
  }
}

Status Search::FindRigid(std::size_t camera) {
  FramesOfCamera& seen = cameras_[camera];
  const PoseFit fit = SearchPose(seen.surfaces, seen.thinner, seen.start, settings_.search);
  PoseOf(camera) = fit.T_robot_camera;
  if (camera == 0) {
    result_.rigid_T_robot_camera = fit.T_robot_camera;
    result_.starts = fit.starts;
  }
  if (fit.surface_covered >= settings_.least_cover) return Status::Ok();
  return {StatusCode::kNotConverged,
          seen.prefix + "no pose near the initial one explains the clouds (at best " +
              FormatNumber(fit.surface_covered) +
              " of the visible surface is covered): the initial pose is too far off, or "
              "it is another robot"};
}

/// Of one of a camera's clouds, with the depth bias of the last round.
ThinCloud Search::UnbiasedOf(std::size_t camera, std::size_t number) const {
  ThinCloud unbiased = cameras_[camera].thin[number];
  if (result_.rounds == 0 || !FittedOf(camera).depth_bias) return unbiased;
  for (auto point_m : unbiased.points_m.colwise())
    point_m *= 1.0 + FittedOf(camera).depth_bias->At(point_m);
  return unbiased;
}

void Search::Match() {
  for (std::size_t f = 0; f < frames_.size(); ++f) setup_.frames[f].surface.clear();
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    FramesOfCamera& camera = cameras_[c];
    for (std::size_t k = 0; k < camera.frames.size(); ++k) {
      camera.surfaces[k].LookFrom(PoseOf(c));
      for (SurfaceSighting& sighting :
           MatchCloud(camera.surfaces[k], camera.thin[k], UnbiasedOf(c, k).points_m, PoseOf(c),
                      settings_, &camera.matches[k])) {
        sighting.camera = static_cast<int>(c);
        setup_.frames[camera.frames[k]].surface.push_back(std::move(sighting));
      }
    }
  }
  setup_.shared_errors = surface_errors_.Share(shapes_m_, &setup_.frames);
}

/// Whether the last round moved the centroid of a camera's first cloud (camera frame), and turned
/// it, by no more than the settings or a share of the standard error ask for: each round matches
/// other points.
bool Search::IsSettled(const geometry::RigidTransform& last, std::size_t camera) {
  constexpr double kShareOfError = kCloudCalibrationTuning.share_of_error;
  const geometry::RigidTransform& now = PoseOf(camera);
  const Eigen::Vector3d middle_m = cameras_[camera].thin.front().points_m.rowwise().mean();
  const double turned_rad = last.rotation().angularDistance(now.rotation());
  const double moved_m = (last * middle_m - now * middle_m).norm();
  Eigen::Matrix<double, 3, 6> motion;
  motion << -geometry::CrossMatrix(now * middle_m - now.translation_m()),
      Eigen::Matrix3d::Identity();
  const auto& covariance = FittedOf(camera).pose_covariance;
  const double turn_error_rad = std::sqrt(covariance.topLeftCorner<3, 3>().trace());
  const double error_m = std::sqrt((motion * covariance * motion.transpose()).trace());
  return moved_m < std::max(settings_.moved_m, kShareOfError * error_m) &&
         turned_rad < std::max(settings_.turned_rad, kShareOfError * turn_error_rad);
}

/// The poses of the last fit. Whether all cameras are settled there.
bool Search::TakePoses() {
  bool settled = true;
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    const geometry::RigidTransform last = PoseOf(c);
    PoseOf(c) = FittedOf(c).T_robot_camera;
    settled = IsSettled(last, c) && settled;
  }
  return settled;
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
    ShowShapes();
    if (TakePoses()) return Status::Ok();
  }
  return {StatusCode::kNotConverged, "the camera still moves after " +
                                         std::to_string(result_.rounds) +
                                         " rounds of matching and fitting"};
}

Status Search::CheckResult() {
  Match();
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    if (Status status = CheckCamera(c); !status.ok()) return status;
  }
  return Status::Ok();
}

Status Search::CheckCamera(std::size_t camera) {
  FramesOfCamera& seen = cameras_[camera];
  for (std::size_t k = 0; k < seen.frames.size(); ++k) {
    CloudMatch& match = seen.matches[k];
    match.surface_covered = ShareCovered(seen.surfaces[k], UnbiasedOf(camera, k), PoseOf(camera),
                                         settings_.search.near_m);
    if (match.surface_covered < settings_.least_cover || match.rms_m > settings_.most_rms_m) {
      return {StatusCode::kInvalidInput, seen.prefix + frames_[seen.frames[k]].name + ": " +
                                             FormatNumber(match.surface_covered) +
                                             " of the visible surface is covered, by points " +
                                             FormatNumber(match.rms_m) +
                                             " m off it (RMS): another robot"};
    }
  }
  if (!IsNear(PoseOf(camera), seen.start, seen.thinner, settings_.search)) {
    return {StatusCode::kNotConverged,
            seen.prefix +
                "the clouds fit too far from the initial pose: another initial pose is needed"};
  }
  return Status::Ok();
}

/// Of the first camera, after CheckResult.
double Search::LeastCovered() const {
  double least = 1.0;
  for (const CloudMatch& match : cameras_.front().matches)
    least = std::min(least, match.surface_covered);
  return least;
}

/// A failed fit is explained by a robot of another size where that fits the clouds. A fit with low
/// coverage is replaced where another size fits better: a small robot lies inside a large one.
void Search::TestOtherSizes() {
  if (settings_.request.stop.stop_requested() || !TakeShapes().ok()) return;
  FramesOfCamera& first = cameras_.front();
  SizeDemands demands{.most_rms_m = settings_.most_rms_m};
  if (result_.status.ok()) {
    demands.least_cover = LeastCovered();
    for (const CloudMatch& match : first.matches) {
      demands.most_rms_m = std::min(demands.most_rms_m, match.rms_m);
    }
  }
  const auto sizes =
      FindOtherSize(first.surfaces, first.thinner, first.start, settings_.search, demands);
  if (!sizes) return;
  const std::string before = result_.status.ok() ? "" : result_.status.message() + "; ";
  result_.status = Status(StatusCode::kInvalidInput, before + sizes->Text("points of the surface"));
}

void Search::ReportMatches() {
  for (const FramesOfCamera& camera : cameras_) {
    std::vector<CloudMatch> all(frames_.size());
    for (std::size_t k = 0; k < camera.frames.size(); ++k)
      all[camera.frames[k]] = camera.matches[k];
    if (&camera == &cameras_.front()) {
      result_.matches = std::move(all);
    } else {
      result_.further_matches.push_back(std::move(all));
    }
  }
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
  CloudCalibration result = Search(model, frames, T_robot_camera_start, settings).Run();
  if (!result.status.ok()) kept.Restore();
  return result;
}

bool IsPossible(const JointCalibration& fit) {
  constexpr double kMostChiSquared = 4.0;
  return fit.chi_squared <= kMostChiSquared * std::max(1, fit.degrees_of_freedom);
}

bool AgreesWith(const JointCalibration& first, const JointCalibration& all) {
  constexpr double kMostRatio = 2.0;
  return all.chi_squared * std::max(1, first.degrees_of_freedom) <=
         kMostRatio * first.chi_squared * std::max(1, all.degrees_of_freedom);
}

}  // namespace palpate::calibration
