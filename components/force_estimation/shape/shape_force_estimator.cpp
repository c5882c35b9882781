// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/shape_force_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "components/force_estimation/shape/camera_biases.hpp"
#include "components/force_estimation/shape/contact_report.hpp"
#include "components/force_estimation/shape/hidden_contacts.hpp"
#include "components/force_estimation/shape/shape_fitter.hpp"
#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/core/statistics.hpp"
#include "libs/robot/history_state.hpp"

namespace palpate::force_estimation {

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

}  // namespace

class ShapeForceEstimator::Impl {
 public:
  Impl(robot::RobotModel& model, const Config& config, const ShapeConfig& shape,
       double modulus_sigma, const ShapeForceEstimatorTuning& tuning)
      : model_(model),
        shape_(shape),
        tuning_(tuning),
        bias_(static_cast<int>(model.body().feature_points.size()), shape),
        history_(model),
        fit_(model, config, shape),
        hidden_(model, shape, fit_),
        report_(shape, std::hypot(modulus_sigma, shape.force_relative_sigma),
                hidden_.CandidateCount(), {.uncertain_share = config.uncertain_share}),
        free_state_(model.RestState()) {
    estimate_.cables.resize(static_cast<std::size_t>(model.ActuatorCount()));
    estimate_.x_m = free_state_.x_m;
    features_.resize(model.body().feature_points.size());
  }

  const ForceEstimate& Update(const ShapeFrame& frame) {
    estimate_.t_s = frame.t_s;
    estimate_.contacts.clear();
    published_ = fitted_ = false;
    estimate_.status = Process(frame);
    CommitHistory();
    estimate_.iterations = fit_.TakeIterations();
    estimate_.frame_error = fit_.fitter().fit().error;
    if (!published_) Withdraw();
    return estimate_;
  }

  void PrepareNext() {
    if (!std::exchange(fitted_, false)) return;
    if (!fit_.RenewAgedFactor()) hidden_.PrepareNext(cables_);
  }

  void TakeDepthBias(const geometry::DepthBiasMap& map, const Eigen::Isometry3d& T_robot_camera,
                     int camera) {
    bias_.StartFrom(camera, map, T_robot_camera);
    calibrates_ = true;  // until the first frame that may have contacts
  }

  const std::vector<FeatureReport>& features() const { return features_; }
  std::vector<BiasSequence> JudgeBiasFrames() const { return bias_.Judge(); }
  double SmallestForce_N(const Eigen::Vector3d& rest_position_m);

 private:
  Status Process(const ShapeFrame& frame);
  void CommitHistory();
  Status CheckFrame(const ShapeFrame& frame) const;
  Status Learn(const ShapeFrame& frame);
  Status Estimate(const ShapeFrame& frame);
  bool SeesByUnknownBias(const ShapeFrame& frame) const;
  ShapeFrame OfKnownBias(ShapeFrame frame) const;
  Status StartFromFreeState(const ShapeFrame& frame);
  Status FitFrame(const ShapeFrame& frame);
  Status FindAll(const ShapeFrame& frame, Status status);
  Status FindInRounds(const ShapeFrame& frame);
  Status FindContacts(const ShapeFrame& frame);
  Status DropUncertainHidden(const ShapeFrame& frame);
  Status CheckMisfit();
  void ForgetBefore(const ShapeFrame& frame);
  void Publish();
  void PublishState();
  void ReportFeatures();
  void Withdraw();

  robot::RobotModel& model_;
  ShapeConfig shape_;
  ShapeForceEstimatorTuning tuning_;
  CameraBiases bias_;
  robot::HistoryState history_;
  ShapeFitter fit_;
  HiddenContacts hidden_;
  ContactReport report_;
  fem::StaticState free_state_;
  ShapeFitter::Attempt before_;  ///< the frame
  std::uint32_t epoch_ = 0;      ///< of the last frame
  double last_t_s_ = kUnknown;
  double period_s_ = std::numeric_limits<double>::infinity();  ///< between the last two frames
  int frames_to_begin_ = tuning_.frames_to_begin;              ///< left
  bool begins_ = false;                                        ///< this frame is one of them
  int misfits_ = 0;                                            ///< frames in a row
  int frames_on_budget_ = 0;                                   ///< in a row
  bool calibrates_ = false;  ///< contact-free frames came since the bias was solved for
  std::vector<FeatureReport> features_;
  ForceEstimate estimate_;
  bool published_ = false;
  bool fitted_ = false;  ///< the last frame, and PrepareNext was not called since
  std::vector<robot::ActuatorCommand> cables_;  ///< its inputs
};

Status ShapeForceEstimator::Impl::Process(const ShapeFrame& frame) {
  if (Status status = CheckFrame(frame); !status.ok()) return status;
  ForgetBefore(frame);
  bias_.HaveCameras(frame.views.size());
  if (!history_.active()) return frame.untouched ? Learn(frame) : Estimate(frame);
  ShapeFrame as_driven = frame;
  as_driven.cables = history_.Prepare(frame.t_s, frame.cables);
  fit_.ForgetFactor();
  return frame.untouched ? Learn(as_driven) : Estimate(as_driven);
}

/// Frames that only have a predicted shape are left out: their forces are unknown.
void ShapeForceEstimator::Impl::CommitHistory() {
  const StatusCode code = estimate_.status.code();
  const bool balanced = code == StatusCode::kOk || code == StatusCode::kNoContact ||
                        code == StatusCode::kUnobservable || code == StatusCode::kNoCalibration;
  if (!history_.active() || !published_ || !balanced) return;
  history_.Commit(fit_.state().x_m, fit_.state().lambda_a_N);
}

Status ShapeForceEstimator::Impl::CheckFrame(const ShapeFrame& frame) const {
  PALPATE_CHECK(static_cast<int>(frame.cables.size()) == model_.ActuatorCount(),
                frame.cables.size());
  for (const robot::ActuatorCommand& command : frame.cables) {
    if (!std::isfinite(command.value)) {
      return {StatusCode::kInvalidInput, "an input of an actuator is not a finite number"};
    }
  }
  for (const auto& [cloud, T_robot_camera, texture] : frame.views) {
    if (!T_robot_camera.matrix().allFinite()) {
      return {StatusCode::kNoCalibration, "the camera's pose is not known"};
    }
    if (!cloud.points_m.allFinite() || !cloud.sigma_m.allFinite()) {
      return {StatusCode::kInvalidInput, "the robot cloud holds NaN"};
    }
    if (!texture.directions.allFinite() || !texture.sigma_rad.allFinite()) {
      return {StatusCode::kInvalidInput, "a point of texture holds NaN"};
    }
  }
  return Status::Ok();
}

Status ShapeForceEstimator::Impl::Learn(const ShapeFrame& frame) {
  calibrates_ = true;
  if (Status status = StartFromFreeState(frame); !status.ok()) return status;
  PublishState();
  if (Status status = fit_.Match(frame); !status.ok()) return status;
  if (bias_.frames() == 0) fit_.SetBiasShape(fit_.state().x_m);
  bias_.Learn(fit_.matches(), fit_.state().x_m, frame.Poses(), frame.epoch);
  fit_.LearnTexture(frame);
  return {StatusCode::kNoCalibration, "the depth bias is being estimated: frame " +
                                          std::to_string(bias_.frames()) + " without contact"};
}

/// The model without contact forces under the frame's cable inputs.
Status ShapeForceEstimator::Impl::StartFromFreeState(const ShapeFrame& frame) {
  Status status = model_.Solve(frame.cables, {}, &free_state_).status;
  if (status.ok()) fit_.StartAt(free_state_);
  return status;
}

/// Beside a camera of known bias, one of unknown bias would bend the shape by its bias.
bool ShapeForceEstimator::Impl::SeesByUnknownBias(const ShapeFrame& frame) const {
  if (!bias_.known()) return false;
  for (std::size_t k = 0; k < frame.views.size(); ++k) {
    if (frame.views[k].cloud.Count() > 0 && !bias_.IsKnown(k)) return true;
  }
  return false;
}

/// The frame without what such cameras see.
ShapeFrame ShapeForceEstimator::Impl::OfKnownBias(ShapeFrame frame) const {
  for (std::size_t k = 0; k < frame.views.size(); ++k) {
    if (bias_.IsKnown(k)) continue;
    frame.views[k].cloud = {};
    frame.views[k].texture = {};
  }
  return frame;
}

Status ShapeForceEstimator::Impl::Estimate(const ShapeFrame& frame) {
  if (!fit_.started()) {
    if (Status status = StartFromFreeState(frame); !status.ok()) return status;
  }
  if (frame.PointCount() < tuning_.fewest_points) {
    PublishState();
    return {StatusCode::kNoRobotSeen,
            "only " + std::to_string(frame.PointCount()) + " points of the robot are seen"};
  }
  if (std::exchange(calibrates_, false)) {
    if (Status status = bias_.Finish(); !status.ok()) return status;
  }
  if (SeesByUnknownBias(frame)) return Estimate(OfKnownBias(frame));
  if (!bias_.known()) bias_.SetShared(bias_.Shared());
  fit_.FitAlong(bias_.known() ? nullptr : &bias_);
  begins_ = frames_to_begin_ > 0;
  frames_to_begin_ -= begins_ ? 1 : 0;
  fit_.BeginFrame(begins_);
  Status status = FitFrame(frame);
  frames_on_budget_ = status.code() == StatusCode::kBudgetReached ? frames_on_budget_ + 1 : 0;
  const bool goes_on = frames_on_budget_ < tuning_.most_frames_on_budget;
  if (status.code() == StatusCode::kNoRobotSeen || (frames_on_budget_ > 0 && goes_on)) {
    PublishState();  // perception needs the predicted shape
    return status;
  }
  if (!status.ok()) {
    // The last state does not converge: again from the equilibrium without contact.
    hidden_.Forget();
    if (fit_.IsWorkUsedUp()) {
      fit_.Stop();
      frames_on_budget_ = 0;
      return {goes_on ? StatusCode::kBudgetReached : StatusCode::kNotConverged,
              "shape fit did not converge to the observed point cloud: the model is reset"};
    }
    status = StartFromFreeState(frame);
    if (status.ok()) status = FitFrame(frame);
  }
  if (!status.ok()) {
    fit_.Stop();
    if (!status.message().empty()) return status;
    return {status.code(), "shape fit did not converge to the observed point cloud"};
  }
  frames_to_begin_ = 0;
  fitted_ = true;
  cables_ = frame.cables;
  Publish();
  return estimate_.contacts.empty() ? report_.WithoutContacts(fit_) : Status::Ok();
}

Status ShapeForceEstimator::Impl::FitFrame(const ShapeFrame& frame) {
  fit_.KeepIn(&before_);
  fit_.tracks().ForgetQuiet();
  fit_.See(frame);
  Status status = fit_.MatchAndFit(frame, bias_);
  if (begins_) {
    status = FindAll(frame, status);
  } else if (status.ok()) {
    status = FindContacts(frame);
  }
  if (status.ok()) status = DropUncertainHidden(frame);
  if (status.ok()) status = CheckMisfit();
  if (status.ok()) report_.Judge(frame.t_s, begins_, &fit_);
  return status;
}

/// In the first frames contacts are unknown. Visible ones may be mapped wrongly while the model is
/// far from the robot's shape: then a fit without them is compared.
Status ShapeForceEstimator::Impl::FindAll(const ShapeFrame& frame, Status status) {
  if (status.ok()) status = FindInRounds(frame);
  if (status.ok() && fit_.Misfit() < tuning_.good_misfit) return status;
  ShapeFitter::Attempt with_seen;
  const double misfit = status.ok() ? fit_.Misfit() : std::numeric_limits<double>::infinity();
  fit_.KeepIn(&with_seen);
  fit_.GoBackWithoutContacts(before_);
  status = fit_.MatchAndFit(frame, bias_);
  if (status.ok()) status = hidden_.Find(frame, bias_);
  if (status.ok()) status = FindInRounds(frame);
  if (misfit == std::numeric_limits<double>::infinity()) return status;
  if (status.ok() && fit_.Misfit() < misfit) return status;
  fit_.GoBack(with_seen);
  return fit_.MatchAndFit(frame, bias_);
}

/// Until the misfit falls no more. Where it is good before and after, the difference is noise, and
/// the later round has mapped the contacts about the fitted shape.
Status ShapeForceEstimator::Impl::FindInRounds(const ShapeFrame& frame) {
  ShapeFitter::Attempt best;
  for (int round = 0; round < tuning_.rounds_to_begin; ++round) {
    const double misfit = fit_.Misfit();
    fit_.KeepIn(&best);
    const Status status = FindContacts(frame);
    if (!status.ok() || fit_.Misfit() > std::max(misfit, tuning_.good_misfit)) {
      fit_.GoBack(best);
      return fit_.MatchAndFit(frame, bias_);
    }
    if (fit_.Misfit() > tuning_.falling_misfit * misfit) break;
  }
  return Status::Ok();
}

/// About the shape of the last fit: visible contacts, hidden ones, and their locations.
Status ShapeForceEstimator::Impl::FindContacts(const ShapeFrame& frame) {
  Status status = Status::Ok();
  if (fit_.SeeAgain(frame)) status = fit_.MatchAndFitFromFar(frame, bias_);
  if (status.ok() && fit_.FlipAdhesiveContacts()) status = fit_.MatchAndFitFromFar(frame, bias_);
  if (status.ok()) status = hidden_.Find(frame, bias_);
  if (status.ok()) status = fit_.Locate(frame, bias_);
  return status;
}

/// A hidden contact that is found in this frame, and of which it tells no force, would take its
/// share from the visible ones. Beside none it stays: the next frames tell its location.
Status ShapeForceEstimator::Impl::DropUncertainHidden(const ShapeFrame& frame) {
  const auto& sites = fit_.sites();
  const auto is_hidden = [](const ShapeSite& site) { return site.hidden; };
  if (std::all_of(sites.begin(), sites.end(), is_hidden)) return Status::Ok();
  std::vector<std::size_t> uncertain;
  for (std::size_t s = fit_.sites().size(); s-- > 0;) {
    const ShapeSite& site = fit_.sites()[s];
    if (site.hidden && site.frames == 0 && report_.HoldsZero(fit_, s)) uncertain.push_back(s);
  }
  if (uncertain.empty()) return Status::Ok();
  for (const std::size_t s : uncertain) fit_.Remove(s);
  hidden_.CountAsFailed();
  return fit_.MatchAndFit(frame, bias_);
}

/// A shape that neither contacts nor noise explain is not the robot's, or the camera pose is wrong:
/// the model keeps its state from before the frame.
Status ShapeForceEstimator::Impl::CheckMisfit() {
  const double misfit = fit_.Misfit();
  if (misfit <= tuning_.worst_misfit) {
    misfits_ = 0;
    return Status::Ok();
  }
  fit_.GoBack(before_);
  if (++misfits_ % tuning_.misfits_to_restart == 0) {
    hidden_.Forget();
    fit_.StartAt(free_state_);
  }
  return {StatusCode::kNoRobotSeen, "no forces explain the shape that is seen, " +
                                        std::to_string(std::lround(std::sqrt(misfit))) +
                                        " sigmas off: camera pose, intrinsics, or not the robot"};
}

/// Another recording, or a gap: contacts may have changed in between.
void ShapeForceEstimator::Impl::ForgetBefore(const ShapeFrame& frame) {
  const double passed_s = frame.t_s - last_t_s_;
  last_t_s_ = frame.t_s;
  const bool opened = std::exchange(epoch_, frame.epoch) != frame.epoch;
  if (history_.active() && opened) history_.Restart();
  const double longest_s = std::max(tuning_.least_gap_s, tuning_.gap_frames * period_s_);
  if (opened || passed_s < 0.0 || passed_s > longest_s) {
    frames_to_begin_ = tuning_.frames_to_begin;
    hidden_.Begin();
    fit_.tracks().Forget();
    fit_.Stop();
  }
  // After a gap, too: where frames take as long to estimate, the next one is no gap.
  if (!opened && passed_s > 0.0) period_s_ = passed_s;
}

void ShapeForceEstimator::Impl::Publish() {
  PublishState();
  const ForceFit& fit = fit_.fitter().fit();
  const double rows = std::max(1, fit_.targets().Count());
  estimate_.chi_squared = fit.chi_squared;
  estimate_.degrees_of_freedom = DegreesOfFreedom(fit_);
  estimate_.residual_rms_m = fit.residual_m.norm() / std::sqrt(rows);
  estimate_.noise_rms_m = fit_.targets().sigma_m().norm() / std::sqrt(rows);
  estimate_.contacts = report_.Contacts(fit_);
  ReportFeatures();
}

void ShapeForceEstimator::Impl::PublishState() {
  published_ = true;
  const ModelState& state = fit_.state();
  estimate_.x_m = state.x_m;
  for (int c = 0; c < model_.ActuatorCount(); ++c) {
    const robot::Actuator& actuator = model_.actuator(c);
    const double length_m = actuator.Value(state.x_m);
    const double least_N = model_.traits(c).least_force_N;
    estimate_.cables[At(c)] = {.length_m = length_m,
                               .displacement_m = actuator.rest_value_m() - length_m,
                               .tension_N = std::max(least_N, state.lambda_a_N[c])};
  }
}

void ShapeForceEstimator::Impl::ReportFeatures() {
  for (std::size_t f = 0; f < features_.size(); ++f) {
    features_[f] = {
        .state = fit_.matches()[f].state,
        .position_m = fit_.features().point(static_cast<int>(f)).Position(fit_.state().x_m)};
  }
  const ShapeTargets& targets = fit_.targets();
  for (int r = 0; r < targets.AlongNormals(); ++r) {
    const auto row = ToIndex(At(r));
    FeatureReport& feature = features_[At(targets.features()[At(r)])];
    if (feature.sigma_m > 0.0 && feature.sigma_m <= targets.sigma_m()[row]) continue;
    feature.state = correspondence::MatchState::kMatched;
    feature.residual_m = fit_.fitter().fit().residual_m[row];
    feature.sigma_m = targets.sigma_m()[row];
  }
}

/// No result of an earlier frame may stand for this one.
void ShapeForceEstimator::Impl::Withdraw() {
  estimate_.residual_rms_m = estimate_.noise_rms_m = estimate_.chi_squared = kUnknown;
  estimate_.degrees_of_freedom = 0;
  estimate_.x_m.setConstant(kUnknown);
  for (robot::ActuatorState& cable : estimate_.cables) cable = {kUnknown, kUnknown, kUnknown};
  for (FeatureReport& feature : features_) feature = {};
}

double ShapeForceEstimator::Impl::SmallestForce_N(const Eigen::Vector3d& rest_position_m) {
  if (!fit_.started() || fit_.targets().Count() == 0 || !bias_.known()) return kUnknown;
  if (!fit_.fitter().has_factor()) return kUnknown;
  const fem::SurfacePatch patch = model_.Patch(rest_position_m, shape_.contact_radius_m);
  Eigen::VectorXd force_N = Eigen::VectorXd::Zero(fit_.state().x_m.size());
  robot::ForceDirection{patch.weights, -patch.normal}.AddForce(1.0, force_N);
  Eigen::MatrixXd motion_m;
  fit_.fitter().RespondTo(force_N, fit_.state().x_m, &motion_m);
  const Eigen::VectorXd& weight = fit_.targets().targets().weight;
  const double information = (motion_m.col(0).array().square() * weight.array()).sum();
  return NormalQuantile(1.0 - shape_.significance) / std::sqrt(information);
}

ShapeForceEstimator::ShapeForceEstimator(robot::RobotModel& model, const Config& config,
                                         const ShapeConfig& shape,
                                         double youngs_modulus_relative_sigma,
                                         const ShapeForceEstimatorTuning& tuning)
    : impl_(std::make_unique<Impl>(model, config, shape, youngs_modulus_relative_sigma, tuning)) {}

ShapeForceEstimator::~ShapeForceEstimator() = default;

const ForceEstimate& ShapeForceEstimator::Update(const ShapeFrame& frame) {
  return impl_->Update(frame);
}

void ShapeForceEstimator::TakeDepthBias(const geometry::DepthBiasMap& map,
                                        const Eigen::Isometry3d& T_robot_camera, int camera) {
  impl_->TakeDepthBias(map, T_robot_camera, camera);
}

void ShapeForceEstimator::PrepareNext() { impl_->PrepareNext(); }

const std::vector<FeatureReport>& ShapeForceEstimator::features() const {
  return impl_->features();
}

std::vector<BiasSequence> ShapeForceEstimator::JudgeBiasFrames() const {
  return impl_->JudgeBiasFrames();
}

double ShapeForceEstimator::SmallestForce_N(const Eigen::Vector3d& rest_position_m) const {
  return impl_->SmallestForce_N(rest_position_m);
}

}  // namespace palpate::force_estimation
