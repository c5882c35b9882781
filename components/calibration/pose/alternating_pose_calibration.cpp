// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/pose/alternating_pose_calibration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>

#include "components/calibration/pose/marker_follower.hpp"
#include "components/calibration/pose/pose_information.hpp"
#include "components/calibration/pose/sighting_check.hpp"
#include "components/calibration/size_comparison.hpp"
#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/geometry/rigid_registration.hpp"

namespace palpate::calibration {

namespace {

using Eigen::Index;

struct AlternationTuning {
  /// Remaining change, as a share of that at the last tangent, that renews the tangent: a larger
  /// share costs factorisations, a smaller one iterations.
  double shrunk = 0.1;
  double moving_N = 0.01;  ///< change of an iteration above which the tangent is renewed each time
  double far_N = 1.0;      ///< the same of the remaining change
  double current = 10.0;   ///< tolerances by which inputs may have moved since the tangent
  double far_better = 1.0 / 9.0;  ///< chi-squared of a reflection that means mirrored markers
  double moved_sigmas = 2.0;      ///< by which an input must exceed zero
};
constexpr AlternationTuning kAlternationTuning;

/// The alternation from the undeformed body to its fixed point.
class Alternation {
 public:
  Alternation(robot::RobotModel& model, const std::vector<MarkerSighting>& sightings,
              const Algorithm1Settings& settings);

  PoseAndInputs Run();

 private:
  bool Start();
  bool Iterate();
  bool RegisterPose();
  bool FitInputs(bool new_tangent);
  bool NeedsNewTangent() const;
  bool IsWithinTolerance() const;
  bool IsTangentCurrent() const;
  bool HasConverged() const;
  bool Conclude();
  bool CheckInputsAreSeen();
  void JudgeResult();
  bool Fail(PoseFinding finding, StatusCode code, const std::string& message);
  void UpdateResidual();
  void EstimateRemainingChange(double change_N);
  std::string UndeterminedCables() const;

  robot::RobotModel& model_;
  const std::vector<MarkerSighting>& sightings_;
  Algorithm1Settings settings_;
  SightingWhitener whitener_;
  MarkerFollower follower_;
  Eigen::Matrix3Xd camera_m_;                   ///< [3 x n]
  std::vector<Eigen::Matrix3d> covariance_m2_;  ///< [n]
  CableInputProblem problem_;
  double last_change_N_ = std::numeric_limits<double>::infinity();
  double remaining_at_tangent_N_ = std::numeric_limits<double>::infinity();
  PoseAndInputs result_;
};

/// Three digits, for messages.
std::string Short(double value) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.3g", value);
  return text.data();
}

std::vector<CableLimits> LimitsOf(const robot::RobotModel& model,
                                  const std::vector<CableLimits>& asked) {
  std::vector<CableLimits> limits = asked;
  if (limits.empty()) limits.resize(static_cast<size_t>(model.ActuatorCount()));
  PALPATE_CHECK(static_cast<int>(limits.size()) == model.ActuatorCount(), limits.size());
  for (size_t c = 0; c < limits.size(); ++c) {
    limits[c].most_tension_N = std::min(limits[c].most_tension_N, model.traits()[c].most_force_N);
  }
  return limits;
}

Alternation::Alternation(robot::RobotModel& model, const std::vector<MarkerSighting>& sightings,
                         const Algorithm1Settings& settings)
    : model_(model),
      sightings_(sightings),
      settings_(settings),
      whitener_(sightings),
      follower_(model, sightings),
      camera_m_(3, static_cast<Index>(sightings.size())) {
  for (size_t k = 0; k < sightings.size(); ++k) {
    camera_m_.col(static_cast<Index>(k)) = sightings[k].position_m;
    covariance_m2_.push_back(sightings[k].covariance_m2);
  }
  problem_.limits = LimitsOf(model, settings.limits);
  result_.degrees_of_freedom = static_cast<int>(3 * sightings.size()) - 6 - model.ActuatorCount();
}

PoseAndInputs Alternation::Run() {
  if (Start() && CheckInputsAreSeen() && Iterate() && Conclude()) JudgeResult();
  return result_;
}

bool Alternation::Fail(PoseFinding finding, StatusCode code, const std::string& message) {
  result_.finding = finding;
  result_.status = Status(code, message);
  result_.T_robot_camera = geometry::RigidTransform();
  result_.lambda_a_N = result_.displacement_m = Eigen::VectorXd::Zero(model_.ActuatorCount());
  return false;
}

/// Equilibrium with the smallest tensions of Omega: zero, as in the paper, unless Omega excludes
/// it.
bool Alternation::Start() {
  Eigen::VectorXd least_N(model_.ActuatorCount());
  for (Index c = 0; c < least_N.size(); ++c) {
    least_N[c] = problem_.limits[At(c)].least_tension_N;
  }
  Status status = follower_.Start(least_N);
  if (status.ok()) status = follower_.Linearise();
  if (status.ok()) return true;
  return Fail(PoseFinding::kFailedEquilibrium, status.code(),
              "no equilibrium to start from: " + status.message());
}

/// Cables that move no marker are not observable at any pose.
bool Alternation::CheckInputsAreSeen() {
  Eigen::MatrixXd W = follower_.compliance().W_ea();
  whitener_.Apply(Eigen::Matrix3d::Identity(), W);
  result_.standard_error_N = W.colwise().norm().transpose().cwiseInverse();
  const std::string cables = UndeterminedCables();
  if (cables.empty()) return true;
  return Fail(PoseFinding::kUnknownInputs, StatusCode::kUnobservable,
              "no marker moves with the input of " + cables);
}

std::string Alternation::UndeterminedCables() const {
  std::string names;
  for (Index c = 0; c < result_.standard_error_N.size(); ++c) {
    if (result_.standard_error_N[c] <= settings_.undetermined_sigma_N) continue;
    names += (names.empty() ? "" : ", ") + model_.traits()[At(c)].Title();
  }
  return names;
}

bool Alternation::Iterate() {
  while (result_.outer_iterations < settings_.max_outer_iterations) {
    ++result_.outer_iterations;
    if (!RegisterPose()) return false;
    const bool new_tangent = NeedsNewTangent();
    const Eigen::VectorXd before_N = follower_.lambda_a_N();
    for (int inner = 0; inner < settings_.inner_iterations; ++inner) {
      if (!FitInputs(new_tangent)) return false;
    }
    EstimateRemainingChange((follower_.lambda_a_N() - before_N).lpNorm<Eigen::Infinity>());
    if (new_tangent) remaining_at_tangent_N_ = result_.remaining_change_N;
    if (HasConverged()) break;
  }
  return true;
}

/// The tangent is renewed each time that the remaining change has shrunk tenfold: its error is then
/// as small, and the many iterations of a slow convergence are cheap.
bool Alternation::NeedsNewTangent() const {
  constexpr double kShrunk = kAlternationTuning.shrunk;
  const double remaining_N = result_.remaining_change_N;
  const bool moves =
      !(last_change_N_ < kAlternationTuning.moving_N) || !(remaining_N < kAlternationTuning.far_N);
  const bool stale = IsWithinTolerance() && !IsTangentCurrent();
  return moves || stale || remaining_N < kShrunk * remaining_at_tangent_N_ ||
         remaining_N > remaining_at_tangent_N_ / kShrunk;
}

bool Alternation::IsWithinTolerance() const {
  return result_.remaining_change_N <= settings_.tolerance_N;
}

bool Alternation::IsTangentCurrent() const {
  const double moved_N =
      (follower_.lambda_a_N() - follower_.tangent_lambda_a_N()).lpNorm<Eigen::Infinity>();
  return moved_N <= kAlternationTuning.current * settings_.tolerance_N;
}

bool Alternation::HasConverged() const {
  return settings_.tolerance_N > 0.0 && IsWithinTolerance() && IsTangentCurrent() &&
         follower_.balance_error() <= settings_.balance_tolerance;
}

/// Eq. (7) for the present inputs.
bool Alternation::RegisterPose() {
  const geometry::Registration pose =
      geometry::RegisterRigid(camera_m_, follower_.Markers_m(), covariance_m2_);
  if (pose.status.ok()) {
    result_.T_robot_camera = pose.T_target_source;
    return true;
  }
  const PoseFinding finding =
      pose.mirrored ? PoseFinding::kMirroredMarkers : PoseFinding::kDegenerateMarkers;
  return Fail(finding, pose.status.code(), pose.status.message());
}

/// Eqs. (8), (9) for the present pose, and (6).
bool Alternation::FitInputs(bool new_tangent) {
  Status status = Status::Ok();
  if (new_tangent) {
    status = follower_.Linearise();
    ++result_.tangents;
  } else {
    follower_.KeepTangent();
  }
  if (!status.ok()) {
    return Fail(PoseFinding::kFailedEquilibrium, status.code(),
                "no equilibrium on the way: " + status.message());
  }
  const robot::Compliance& compliance = follower_.compliance();
  const Eigen::Matrix3d R = result_.T_robot_camera.rotation().toRotationMatrix();
  Eigen::MatrixXd W = compliance.W_ea();
  Eigen::VectorXd short_m =
      compliance.delta_e_free_m() - result_.T_robot_camera.Apply(camera_m_).reshaped();
  whitener_.Apply(R, W);
  whitener_.Apply(R, short_m);
  problem_.Q = W.transpose() * W;
  problem_.c = W.transpose() * short_m;
  problem_.W_aa = compliance.W_aa();
  problem_.delta_a_free_m = compliance.delta_a_free_m();
  Eigen::VectorXd lambda_a_N = follower_.lambda_a_N();
  status = SolveCableInputs(problem_, &lambda_a_N);
  if (!status.ok()) {
    return Fail(PoseFinding::kInvalidInput, status.code(), "cable inputs: " + status.message());
  }
  status = follower_.MoveTo(lambda_a_N);
  if (!status.ok()) {
    return Fail(PoseFinding::kFailedEquilibrium, status.code(),
                "no equilibrium under the inputs: " + status.message());
  }
  UpdateResidual();
  result_.residual_rms_after_m.push_back(result_.residual_rms_m);
  return true;
}

void Alternation::UpdateResidual() {
  result_.residual_m = result_.T_robot_camera.Apply(camera_m_) - follower_.Markers_m();
  result_.residual_rms_m =
      std::sqrt(result_.residual_m.squaredNorm() / static_cast<double>(camera_m_.cols()));
  Eigen::VectorXd whitened = result_.residual_m.reshaped();
  whitener_.Apply(result_.T_robot_camera.rotation().toRotationMatrix(), whitened);
  result_.chi_squared = whitened.squaredNorm();
}

/// Changes that shrink by q from one iteration to the next add up to change * q / (1 - q).
void Alternation::EstimateRemainingChange(double change_N) {
  const double ratio = change_N / last_change_N_;
  last_change_N_ = change_N;
  if (change_N == 0.0) {
    result_.remaining_change_N = 0.0;
  } else if (ratio < 1.0 && std::isfinite(ratio) && ratio > 0.0) {
    result_.remaining_change_N = change_N * ratio / (1.0 - ratio);
  } else {
    result_.remaining_change_N = std::numeric_limits<double>::infinity();
  }
}

/// Pose and equilibrium of the last inputs, and the covariance.
bool Alternation::Conclude() {
  Status status = follower_.Balance();
  if (status.ok()) status = follower_.Linearise();
  result_.continuation_steps = follower_.continuation_steps();
  if (!status.ok()) {
    return Fail(PoseFinding::kFailedEquilibrium, status.code(),
                "no equilibrium under the inputs found: " + status.message());
  }
  if (!RegisterPose()) return false;
  UpdateResidual();
  result_.state = follower_.state();
  result_.lambda_a_N = follower_.lambda_a_N();
  result_.displacement_m.resize(model_.ActuatorCount());
  for (int c = 0; c < model_.ActuatorCount(); ++c) {
    result_.displacement_m[c] = model_.actuator(c).Displacement_m(result_.state.x_m);
  }
  result_.covariance =
      JointCovariance(sightings_, whitener_, result_.T_robot_camera, follower_.compliance().W_ea());
  result_.standard_error_N = result_.covariance.diagonal().tail(model_.ActuatorCount()).cwiseSqrt();
  return true;
}

void Alternation::JudgeResult() {
  const double expected = std::max(1, result_.degrees_of_freedom);
  const double ratio = std::sqrt(result_.chi_squared / expected);
  if (const std::string cables = UndeterminedCables(); !cables.empty()) {
    Fail(PoseFinding::kUnknownInputs, StatusCode::kUnobservable,
         "the markers do not distinguish from a camera motion the input of " + cables);
    return;
  }
  if (!(ratio <= settings_.wrong_robot_ratio)) {
    const double rms_m = result_.residual_rms_m;
    SizeComparison sizes;
    sizes.Add(camera_m_, follower_.Markers_m());
    Fail(PoseFinding::kWrongRobot, StatusCode::kInvalidInput,
         "the residual of " + Short(1e3 * rms_m) + " mm RMS is " + Short(ratio) +
             " times what the marker errors explain" +
             (sizes.Explains(rms_m) ? "; " + sizes.Text()
                                    : ": another robot, or markers assigned wrongly"));
    return;
  }
  if (!IsWithinTolerance()) {
    result_.finding = PoseFinding::kNotConverged;
    result_.status = Status(StatusCode::kNotConverged,
                            std::to_string(result_.outer_iterations) +
                                " iterations used up; the inputs would still change by " +
                                Short(result_.remaining_change_N) + " N");
    return;
  }
  const bool moved = (result_.lambda_a_N.array() >
                      kAlternationTuning.moved_sigmas * result_.standard_error_N.array())
                         .any();
  result_.finding = moved ? PoseFinding::kSolved : PoseFinding::kZeroMotion;
  result_.status = Status::Ok();
}

PoseAndInputs PoseRefusal(const robot::RobotModel& model, const Status& status) {
  PoseAndInputs refused;
  refused.finding = status.code() == StatusCode::kUnobservable ? PoseFinding::kDegenerateMarkers
                                                               : PoseFinding::kInvalidInput;
  refused.status = status;
  refused.lambda_a_N = refused.displacement_m = Eigen::VectorXd::Zero(model.ActuatorCount());
  return refused;
}

/// Whether a mirrored assignment explains the markers.
bool FitsMirrored(robot::RobotModel& model, const std::vector<MarkerSighting>& sightings,
                  const Algorithm1Settings& settings, double chi_squared) {
  const std::vector<MarkerSighting> mirrored = Mirrored(sightings);
  const PoseAndInputs result = Alternation(model, mirrored, settings).Run();
  const bool fits = result.status.ok() || result.finding == PoseFinding::kNotConverged;
  return fits && result.chi_squared < kAlternationTuning.far_better * chi_squared;
}

}  // namespace

std::string_view ToString(PoseFinding finding) {
  switch (finding) {
    case PoseFinding::kNotRun: return "not_run";
    case PoseFinding::kSolved: return "solved";
    case PoseFinding::kZeroMotion: return "zero_motion";
    case PoseFinding::kNotConverged: return "not_converged";
    case PoseFinding::kFailedEquilibrium: return "failed_equilibrium";
    case PoseFinding::kDegenerateMarkers: return "degenerate_markers";
    case PoseFinding::kMirroredMarkers: return "mirrored_markers";
    case PoseFinding::kUnknownInputs: return "unknown_inputs";
    case PoseFinding::kWrongRobot: return "wrong_robot";
    case PoseFinding::kInvalidInput: return "invalid_input";
  }
  return "not_run";
}

PoseAndInputs RunAlgorithm1(robot::RobotModel& model, const std::vector<MarkerSighting>& sightings,
                            const Algorithm1Settings& settings) {
  PALPATE_CHECK(settings.max_outer_iterations >= 1 && settings.inner_iterations >= 1,
                settings.max_outer_iterations, settings.inner_iterations);
  const Status sound = CheckSightings(sightings, static_cast<int>(model.body().markers.size()));
  if (!sound.ok()) return PoseRefusal(model, sound);
  PoseAndInputs result = Alternation(model, sightings, settings).Run();
  if (result.finding == PoseFinding::kWrongRobot &&
      FitsMirrored(model, sightings, settings, result.chi_squared)) {
    result.finding = PoseFinding::kMirroredMarkers;
    result.status =
        Status(StatusCode::kInvalidInput, "the markers are mirrored: a reflection fits them");
  }
  return result;
}

}  // namespace palpate::calibration
