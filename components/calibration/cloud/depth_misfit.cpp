// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/cloud/depth_misfit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "components/calibration/cloud/surface_in_view.hpp"
#include "components/calibration/joint/solved_state.hpp"
#include "components/calibration/model_tolerance.hpp"

namespace palpate::calibration {

namespace {

using geometry::RigidTransform;
using Reason = MisfitReason::Kind;

struct DepthMisfitTuning {
  double explains = 0.5;       ///< misfit over that of the data as they are: MisfitTuning::explains
  double most = 0.5;           ///< misfit of images that fit: occlusions and edges stay below it
  double sigmas = 3.0;         ///< of the pose, within which it is not off
  double depth_bias = 0.005;   ///< share of the distance by which a depth camera moves the robot
  double hopeless = 0.97;      ///< misfit before a search, above which none is made
  double other_factor = 1.15;  ///< ratio of lengths that no sound pose or size is off by
  double round_within = 0.3;   ///< of a round factor, where it is tried as well
  double near_round = 0.05;    ///< misfit by which a round factor may be worse
  double size_step = 1.1;      ///< ratio of neighbouring sizes: half a step moves ends by 5 %
  int size_steps = 5;          ///< in each direction
  double same_pose = 1e-6;     ///< norm of the difference from the identity
};
constexpr DepthMisfitTuning kDepthMisfitTuning;

/// PoseSearchSettings are those of a robot of this extent.
constexpr double kSearchExtent_m = 0.2;
constexpr double kSearchSpacing_m = 0.008;

PoseSearchSettings SearchOf(double extent_m) {
  PoseSearchSettings settings;
  const double scale = extent_m / kSearchExtent_m;
  for (double* length_m : {&settings.widest_m, &settings.narrowest_m, &settings.at_rest_m,
                           &settings.near_m, &settings.around_m, &settings.farthest_m}) {
    *length_m *= scale;
  }
  return settings;
}

/// A pose, and how the images fit there once a mistake is mended.
struct Place {
  RigidTransform T_robot_camera;
  double misfit = 1.0;
};

/// A factor, and how the images fit once it is mended.
struct Scaled {
  double factor = 1.0;
  double misfit = 1.0;
};

/// A wrong reading of a pose, mended.
struct Convention {
  RigidTransform T_robot_camera;
  std::string text;
};

class DepthSearch {
 public:
  DepthSearch(const robot::RobotModel& model, const std::vector<DepthSight>& sights,
              const DepthMisfitRequest& request)
      : model_(model),
        request_(request),
        extent_m_(ExtentOf(model.RestState().x_m)),
        rest_m_(model.RestState().x_m),
        settings_(SearchOf(extent_m_)) {
    for (const DepthSight& sight : sights) {
      comparisons_.emplace_back(model.body(), rest_m_, sight);
      surfaces_.emplace_back(model.body());
    }
    middle_camera_m_ = request.T_robot_camera.Inverse() *
                       Eigen::Vector3d(rest_m_.reshaped(3, rest_m_.size() / 3).rowwise().mean());
  }

  DepthMisfit Run();

 private:
  double MisfitAt(const RigidTransform& T_robot_camera, const Mend& mend = {}) const;
  double InView() const;
  bool IsAllowed(const RigidTransform& T_robot_camera) const;
  Place FitFrom(const RigidTransform& start, const Mend& mend, bool restart);
  Place FitNear(const Mend& mend);
  Place FindPose(std::string* convention);
  std::vector<Convention> Conventions() const;
  void Take(Reason kind, double misfit, const std::string& text);
  bool Explains(double misfit) const;
  std::string PoseName() const;
  void TakePose(const Place& place, const std::string& convention);
  Scaled BestOf(const std::vector<double>& factors, double Mend::*part);
  void TryDepthUnit();
  void TryBodyUnit();
  void TrySize();
  void TryLens();
  void TryStiffness();
  void SayRobot(const Place& best);

  const robot::RobotModel& model_;
  const DepthMisfitRequest& request_;
  double extent_m_;
  Eigen::VectorXd rest_m_;
  PoseSearchSettings settings_;
  std::vector<DepthComparison> comparisons_;
  std::vector<SurfaceInView> surfaces_;
  Eigen::Vector3d middle_camera_m_;  ///< of the robot, where it is said to be
  MisfitReasons result_;
};

double DepthSearch::MisfitAt(const RigidTransform& T_robot_camera, const Mend& mend) const {
  double sum = 0.0;
  for (const DepthComparison& comparison : comparisons_) {
    sum += comparison.Compare(T_robot_camera, mend).Misfit();
  }
  return sum / static_cast<double>(comparisons_.size());
}

double DepthSearch::InView() const {
  return comparisons_.front().Compare(request_.T_robot_camera, {}).in_view;
}

/// Whether a pose is the given one, as nearly as that, the model and the camera are known.
bool DepthSearch::IsAllowed(const RigidTransform& T_robot_camera) const {
  const PoseDifference off =
      DifferenceOf(request_.T_robot_camera, T_robot_camera, middle_camera_m_);
  const double model_m = std::sqrt(ModelVariance_m2(extent_m_, 0.0));
  const double bias_m = kDepthMisfitTuning.depth_bias * middle_camera_m_.norm();
  const double most_m =
      kDepthMisfitTuning.sigmas * std::hypot(request_.translation_sigma_m, model_m, bias_m);
  const double most_rad = kDepthMisfitTuning.sigmas *
                          std::hypot(request_.rotation_sigma_rad, 4.0 * model_m / extent_m_);
  return off.off_m <= most_m && off.turned_rad() <= most_rad;
}

/// The pose near `start`; `restart`: also from poses around it.
Place DepthSearch::FitFrom(const RigidTransform& start, const Mend& mend, bool restart) {
  Place place{start, MisfitAt(start, mend)};
  std::vector<ThinCloud> clouds;
  for (std::size_t k = 0; k < comparisons_.size(); ++k) {
    const double spacing_m = kSearchSpacing_m / kSearchExtent_m * extent_m_ * mend.body;
    clouds.push_back(
        comparisons_[k].CloudNear(start, mend, settings_.farthest_m * mend.body, spacing_m));
    if (clouds.back().Count() == 0) return place;
    clouds.back().points_m /= mend.body;
    surfaces_[k].TakeShape(comparisons_[k].ShapeOf({.motion = mend.motion}));
  }
  PoseSearchSettings settings = settings_;
  if (!restart) settings.good_cover = 0.0;
  const RigidTransform sized(start.rotation(), start.translation_m() / mend.body);
  const RigidTransform found = SearchPose(surfaces_, clouds, sized, settings).T_robot_camera;
  const RigidTransform T_robot_camera(found.rotation(), found.translation_m() * mend.body);
  const double misfit = MisfitAt(T_robot_camera, mend);
  if (misfit < place.misfit) place = {T_robot_camera, misfit};
  return place;
}

/// At the given pose, as nearly as it is known.
Place DepthSearch::FitNear(const Mend& mend) {
  const Place given{request_.T_robot_camera, MisfitAt(request_.T_robot_camera, mend)};
  if (given.misfit > kDepthMisfitTuning.hopeless) return given;
  const Place found = FitFrom(request_.T_robot_camera, mend, /*restart=*/false);
  return IsAllowed(found.T_robot_camera) ? found : given;
}

std::vector<Convention> DepthSearch::Conventions() const {
  const RigidTransform& given = request_.T_robot_camera;
  Eigen::Matrix3d optical_of_body, optical_of_gl;
  optical_of_body << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  optical_of_gl << 1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, -1.0;
  std::vector<Convention> conventions = {
      {given.Inverse(), "it is the inverse, T_camera_robot"},
      {given * RigidTransform(optical_of_body, Eigen::Vector3d::Zero()),
       "its axes are those of the camera's body (x forward, z up), not of its image (z forward, y "
       "down)"},
      {given * RigidTransform(optical_of_gl, Eigen::Vector3d::Zero()),
       "its axes are those of OpenGL (z backward, y up), not of the image (z forward, y down)"}};
  for (const auto& [factor, unit] : {std::pair{1e-3, "millimetres"}, {1e-2, "centimetres"}}) {
    conventions.push_back({RigidTransform(given.rotation(), factor * given.translation_m()),
                           std::string("its translation is in ") + unit});
  }
  return conventions;
}

/// The best pose anywhere, and the wrong reading of the given one that it mends; empty: none.
Place DepthSearch::FindPose(std::string* convention) {
  Place best = FitFrom(request_.T_robot_camera, {}, /*restart=*/true);
  for (const Convention& other : Conventions()) {
    if (best.misfit <= kDepthMisfitTuning.explains * result_.residual) break;
    if (MisfitAt(other.T_robot_camera) > kDepthMisfitTuning.hopeless) continue;
    const Place place = FitFrom(other.T_robot_camera, {}, /*restart=*/true);
    if (place.misfit >= best.misfit) continue;
    best = place;
    *convention = other.text;
  }
  return best;
}

bool DepthSearch::Explains(double misfit) const {
  return misfit <= kDepthMisfitTuning.explains * result_.residual;
}

void DepthSearch::Take(Reason kind, double misfit, const std::string& text) {
  const std::string then = FormatReason(" (misfit then %.0f %%)", 100.0 * misfit);
  result_.reasons.push_back({kind, text + then, misfit});
}

/// With what catches the eye.
std::string DepthSearch::PoseName() const {
  const RigidTransform& given = request_.T_robot_camera;
  const double from_identity =
      given.translation_m().norm() + Eigen::AngleAxisd(given.rotation()).angle();
  if (from_identity > kDepthMisfitTuning.same_pose) return request_.pose_name;
  return request_.pose_name + " is the identity: was the camera's pose forgotten? It";
}

void DepthSearch::TakePose(const Place& place, const std::string& convention) {
  std::string text =
      "pose: " + PoseName() + " puts the robot " +
      DifferenceOf(request_.T_robot_camera, place.T_robot_camera, middle_camera_m_).Text();
  if (!convention.empty()) text += ": " + convention;
  Take(Reason::kPose, place.misfit, text + "; calibrate the camera, or correct its pose");
}

/// Factors near this one: itself, and a round one.
std::vector<double> FactorsNear(double factor) {
  std::vector<double> factors = {factor};
  for (const double round : {2.0, 2.5, 4.0, 5.0, 10.0, 25.4, 100.0, 1000.0}) {
    for (const double value : {round, 1.0 / round}) {
      if (std::abs(factor / value - 1.0) < kDepthMisfitTuning.round_within)
        factors.push_back(value);
    }
  }
  return factors;
}

bool IsOther(double factor) {
  return std::abs(std::log(factor)) > std::log(kDepthMisfitTuning.other_factor);
}

void DepthSearch::TryDepthUnit() {
  const double ratio = comparisons_.front().DepthRatio(request_.T_robot_camera);
  if (!std::isfinite(ratio) || !IsOther(ratio)) return;
  Place best;
  double best_factor = 1.0;
  for (const double factor : FactorsNear(1.0 / ratio)) {
    const Place place = FitNear({.depth = factor});
    if (place.misfit >= best.misfit + kDepthMisfitTuning.near_round) continue;
    best = place;
    best_factor = factor;
  }
  if (!Explains(best.misfit)) return;
  const bool small = best_factor > 1.0;
  const double times = small ? best_factor : 1.0 / best_factor;
  Take(Reason::kUnit, best.misfit,
       FormatReason("unit of depth: the depths are %.4g times too %s: %s unit_m of camera.yaml by "
                    "%.4g",
                    times, small ? "small" : "large", small ? "multiply" : "divide", times));
}

/// The best of the factors by which a length or motion may be wrong.
Scaled DepthSearch::BestOf(const std::vector<double>& factors, double Mend::*part) {
  Scaled best;
  for (const double factor : factors) {
    Mend mend;
    mend.*part = factor;
    const double misfit = FitNear(mend).misfit;
    if (misfit < best.misfit) best = {factor, misfit};
  }
  return best;
}

void DepthSearch::TryBodyUnit() {
  const Scaled best = BestOf({1e3, 1e2, 25.4, 10.0, 0.1, 1.0 / 25.4, 1e-2, 1e-3}, &Mend::body);
  if (!Explains(best.misfit)) return;
  const bool small = best.factor > 1.0;
  Take(Reason::kUnit, best.misfit,
       FormatReason("unit of the mesh: the robot file's robot is %.4g times too %s: is mesh: unit: "
                    "of the robot file right?",
                    small ? best.factor : 1.0 / best.factor, small ? "small" : "large"));
}

void DepthSearch::TrySize() {
  std::vector<double> sizes;
  for (int step = -kDepthMisfitTuning.size_steps; step <= kDepthMisfitTuning.size_steps; ++step) {
    if (step != 0) sizes.push_back(std::pow(kDepthMisfitTuning.size_step, step));
  }
  const Scaled best = BestOf(sizes, &Mend::body);
  if (!Explains(best.misfit)) return;
  Take(Reason::kSize, best.misfit,
       FormatReason("size: the robot in the image is %.2g times as large as its file says: another "
                    "robot, or correct the mesh",
                    best.factor));
}

/// Intrinsics belong to one resolution.
void DepthSearch::TryLens() {
  const Scaled best =
      BestOf({0.25, 1.0 / 3.0, 0.5, 2.0 / 3.0, 0.75, 4.0 / 3.0, 1.5, 2.0, 3.0, 4.0}, &Mend::lens);
  if (!Explains(best.misfit)) return;
  const rgbd::CameraModel& lens = comparisons_.front().camera().depth;
  Take(Reason::kIntrinsics, best.misfit,
       FormatReason("intrinsics: fx, fy, cx and cy of camera.yaml are those of an image %.3g times "
                    "as wide as its %d pixels: give those of this resolution (fx_px %.5g)",
                    1.0 / best.factor, lens.width_px, best.factor * lens.fx_px));
}

void DepthSearch::TryStiffness() {
  const Scaled best = BestOf({0.0, 0.5, 0.7, 1.4, 2.0}, &Mend::motion);
  if (!Explains(best.misfit)) return;
  Take(Reason::kModulus, best.misfit,
       FormatReason("stiffness: the robot in the image bends %.1f times as far as the model: is "
                    "youngs_modulus_Pa of the robot file right, and are the cable inputs those of "
                    "the images?",
                    best.factor));
}

void DepthSearch::SayRobot(const Place& best) {
  const double in_view = InView();
  if (in_view < kDepthMisfitTuning.most) {
    result_.reasons.push_back(
        {Reason::kPose,
         FormatReason(
             "pose: %s puts %.0f %% of the robot out of the image: calibrate the camera, or "
             "correct its pose",
             PoseName().c_str(), 100.0 * (1.0 - in_view)),
         result_.residual});
    return;
  }
  result_.reasons.push_back(
      {Reason::kRobot,
       FormatReason("robot: no pose within %.0f mm, and no other unit, size or resolution, brings "
                    "the misfit of %s below %.0f %%: give the file of the robot that the images "
                    "show, or a pose that is nearer",
                    1e3 * settings_.farthest_m, model_.body().name.c_str(), 100.0 * best.misfit),
       best.misfit});
}

DepthMisfit DepthSearch::Run() {
  Place base = FitNear({});
  result_.residual = base.misfit;
  const bool is_bad = base.misfit > kDepthMisfitTuning.most;
  if (!is_bad && request_.may_be_touched) return {.fits = true, .reasons = {}};
  std::string convention;
  const Place pose = FindPose(&convention);
  const bool moved = Explains(pose.misfit) && !IsAllowed(pose.T_robot_camera);
  if (!is_bad && !moved) return {.fits = true, .reasons = {}};
  if (moved && (!request_.may_be_touched || !convention.empty())) TakePose(pose, convention);
  TryDepthUnit();
  TryBodyUnit();
  TryLens();
  if (!request_.may_be_touched) {  // contacts turn, stretch and bend a robot, too
    TrySize();
    TryStiffness();
  }
  result_.SortBestFirst();
  if (result_.reasons.empty() && request_.may_be_touched) return {.fits = true, .reasons = {}};
  if (result_.reasons.empty()) SayRobot(pose);
  return {.fits = false, .reasons = std::move(result_)};
}

}  // namespace

DepthMisfit FindDepthMisfit(const robot::RobotModel& model, const std::vector<DepthSight>& sights,
                            const DepthMisfitRequest& request) {
  return DepthSearch(model, sights, request).Run();
}

}  // namespace palpate::calibration
