// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/experiment/experiment_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "libs/core/check.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/experiment/recording_inputs.hpp"

namespace palpate::view {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
/// More samples a second are not seen.
constexpr double kMostShown_hz = 30.0;

std::vector<double> TimesOf(const std::vector<experiment::StampedFile>& files) {
  std::vector<double> t_s;
  for (const experiment::StampedFile& file : files) t_s.push_back(file.t_s());
  return t_s;
}

/// Of markers, else of images, else of clouds, else of commands.
std::vector<double> SampleTimes(const experiment::Recording& recording) {
  std::vector<double> t_s;
  if (recording.markers) {
    for (const experiment::MarkerFrame& frame : recording.markers->frames) {
      t_s.push_back(frame.t_s);
    }
  }
  if (t_s.empty()) t_s = TimesOf(recording.depth_images);
  if (t_s.empty()) t_s = TimesOf(recording.clouds);
  if (t_s.empty() && recording.actuation) t_s = recording.actuation->t_s;
  return t_s;
}

std::vector<double> Thinned(const std::vector<double>& t_s) {
  constexpr double kLeast_s = 0.9 / kMostShown_hz;  // jitter must not drop every other sample
  std::vector<double> kept_s;
  for (const double t : t_s) {
    if (kept_s.empty() || t - kept_s.back() >= kLeast_s) kept_s.push_back(t);
  }
  return kept_s;
}

const experiment::MarkerFrame* FrameNotAfter(const experiment::MarkerTracks& markers, double t_s) {
  const auto next = std::upper_bound(
      markers.frames.begin(), markers.frames.end(), t_s,
      [](double t, const experiment::MarkerFrame& frame) { return t < frame.t_s; });
  return next == markers.frames.begin() ? nullptr : &*std::prev(next);
}

}  // namespace

ExperimentFrames::ExperimentFrames(const experiment::Experiment& experiment, KnownRobot& robot,
                                   const EstimatedForces* estimated)
    : experiment_(experiment),
      robot_(robot),
      estimated_(estimated),
      gravity_m_s2_(robot.model().gravity_m_s2()),
      state_(robot.model().RestState()) {
  for (const experiment::Recording& recording : experiment.recordings) {
    experiment::CheckMarkers(recording, robot.model().MarkerNames());
    experiment::CheckActuators(recording, robot.model().CableNames(), robot.model().ChamberNames());
    if (recording.markers) experiment::RequireRobotFromMarkers(experiment, recording);
    for (const experiment::KnownLoad& load : recording.loads) {
      experiment::RequireOnBody(load, robot.model().locator().Distance_m(load.position_m));
    }
  }
  AddInstants();
  if (instants_.empty()) {
    throw InputError(experiment.folder.string() +
                     ": no recording has markers, images, clouds or cable inputs to show");
  }
}

void ExperimentFrames::AddInstants() {
  double begin_s = 0.0;
  for (std::size_t r = 0; r < experiment_.recordings.size(); ++r) {
    const std::vector<double> t_s = Thinned(SampleTimes(experiment_.recordings[r]));
    for (const double t : t_s) instants_.push_back({r, t, begin_s + t - t_s.front()});
    if (!t_s.empty()) begin_s = instants_.back().position_s + 1.0 / kMostShown_hz;
  }
}

std::optional<Eigen::Vector3d> ExperimentFrames::sigma_m(const ExperimentInstant& instant) const {
  if (!experiment_.markers_sigma_m) return std::nullopt;
  const auto pose = experiment::RobotFromMarkers(experiment_, RecordingOf(instant));
  const auto* T_robot_markers = std::get_if<Eigen::Isometry3d>(&pose);
  if (T_robot_markers == nullptr) return std::nullopt;
  const Eigen::Matrix3d R = T_robot_markers->linear();
  const Eigen::Matrix3d covariance_m2 =
      R * experiment_.markers_sigma_m->cwiseAbs2().asDiagonal() * R.transpose();
  return covariance_m2.diagonal().cwiseSqrt();
}

std::vector<robot::ActuatorCommand> ExperimentFrames::CommandsAt(
    const ExperimentInstant& instant) const {
  using experiment::ActuatorQuantity;
  const experiment::Recording& recording = RecordingOf(instant);
  std::vector<robot::ActuatorCommand> commands;
  const std::vector<std::string> names = robot_.model().ActuatorNames();
  for (std::size_t cable = 0; cable < names.size(); ++cable) {
    const auto at = [&](ActuatorQuantity quantity) {
      return experiment::ActuatorInputAt(recording, names[cable], quantity, instant.t_s);
    };
    commands.push_back(robot_.model().CommandFor(
        static_cast<int>(cable), at(ActuatorQuantity::kDisplacement),
        at(ActuatorQuantity::kTension), robot::CableInput::kDisplacement));
  }
  return commands;
}

std::vector<robot::DeadLoad> ExperimentFrames::LoadsAt(const ExperimentInstant& instant,
                                                       ExperimentFrame* frame) {
  const experiment::Recording& recording = RecordingOf(instant);
  std::vector<robot::DeadLoad> loads;
  for (const auto& load : experiment::LoadsAt(recording.loads, instant.t_s)) {
    loads.push_back(
        {robot_.model().Patch(load.position_m, load.patch_radius_m).weights, load.force_N});
    frame->known.push_back({.name = fmt::format("load {}", loads.size()),
                            .force_N = load.force_N,
                            .reason = "known load"});
  }
  if (estimated_ != nullptr) frame->estimated = estimated_->At(recording.name, instant.t_s);
  if (frame->estimated == nullptr || !recording.loads.empty()) return loads;
  for (const ShownForce& force : frame->estimated->forces) {
    if (force.status != "ok" || !force.force_N) continue;
    // Estimated on the deformed body: the point of it that was there in the last shape.
    loads.push_back({robot_.PlaceNear(force.position_m, state_.x_m), *force.force_N});
  }
  return loads;
}

/// Marker offsets of a reference window: its mean is the model in the window's shape.
Status ExperimentFrames::FindOffsets(const ExperimentInstant& instant) {
  const experiment::Recording& recording = RecordingOf(instant);
  if (!recording.reference || !recording.markers) return Status::Ok();
  fem::StaticState state = robot_.model().RestState();
  if (recording.reference->shape == experiment::ReferenceShape::kEquilibrium) {
    ExperimentInstant begin = instant;
    begin.t_s = recording.reference->window_s.begin_s;
    const Status solved = robot_.model().Solve(CommandsAt(begin), {}, &state).status;
    if (!solved.ok()) return solved;
  }
  const Eigen::Matrix3Xd model_m = robot_.MarkersAt(robot_.model().MarkerNames(), state.x_m);
  const auto means = experiment::MeanOver(*recording.markers, recording.reference->window_s);
  for (std::size_t m = 0; m < robot_.body().markers.size(); ++m) {
    const auto at = recording.markers->IndexOf(robot_.body().markers[m].name);
    const bool known = at && means[*at].count > 0;
    offsets_m_.col(ToIndex(m)) =
        known ? Eigen::Vector3d(model_m.col(ToIndex(m)) - T_robot_markers_ * means[*at].mean_m)
              : Eigen::Vector3d::Constant(kNaN);
  }
  return Status::Ok();
}

void ExperimentFrames::EnterRecording(const ExperimentInstant& instant) {
  const experiment::Recording& recording = RecordingOf(instant);
  entered_ = instant.recording;
  robot_.model().SetGravity(experiment::BaseRotation(recording).transpose() * gravity_m_s2_);
  state_ = robot_.model().RestState();
  offsets_m_.setZero(3, ToIndex(robot_.body().markers.size()));
  const auto pose = experiment::RobotFromMarkers(experiment_, recording);
  if (const auto* known = std::get_if<Eigen::Isometry3d>(&pose)) T_robot_markers_ = *known;
  if (!FindOffsets(instant).ok()) offsets_m_.setConstant(kNaN);
}

void ExperimentFrames::AddMarkers(const ExperimentInstant& instant, ExperimentFrame* frame) const {
  const auto& markers = robot_.body().markers;
  frame->model_m = robot_.MarkersAt(robot_.model().MarkerNames(), frame->x_m);
  if (!frame->status.ok()) frame->model_m.setConstant(kNaN);
  frame->measured_m.setConstant(3, ToIndex(markers.size()), kNaN);
  const experiment::Recording& recording = RecordingOf(instant);
  const experiment::MarkerFrame* measured =
      recording.markers ? FrameNotAfter(*recording.markers, instant.t_s) : nullptr;
  double squares_m2 = 0.0;
  for (std::size_t m = 0; measured != nullptr && m < markers.size(); ++m) {
    const auto at = recording.markers->IndexOf(markers[m].name);
    if (!at || !measured->positions_m[*at]) continue;
    const Eigen::Vector3d position_m =
        T_robot_markers_ * *measured->positions_m[*at] + offsets_m_.col(ToIndex(m));
    if (!position_m.allFinite()) continue;
    frame->measured_m.col(ToIndex(m)) = position_m;
    squares_m2 += (position_m - frame->model_m.col(ToIndex(m))).squaredNorm();
    ++frame->seen;
  }
  frame->residual_rms_m = frame->seen > 0 ? std::sqrt(squares_m2 / (3.0 * frame->seen)) : kNaN;
  const auto sigma_m = experiment_.markers_sigma_m;
  frame->noise_rms_m = sigma_m ? sigma_m->norm() / std::sqrt(3.0) : kNaN;
}

ExperimentFrame ExperimentFrames::FrameAt(const ExperimentInstant& instant) {
  if (entered_ != instant.recording) EnterRecording(instant);
  ExperimentFrame frame;
  const auto loads = LoadsAt(instant, &frame);
  frame.status = robot_.model().Solve(CommandsAt(instant), loads, &state_).status;
  frame.x_m = state_.x_m;
  for (std::size_t k = 0; k < frame.known.size(); ++k) {
    frame.known[k].position_m = loads[k].weights.Position(state_.x_m);
  }
  const std::vector<std::string> names = robot_.model().ActuatorNames();
  for (std::size_t cable = 0; cable < names.size(); ++cable) {
    frame.cables.push_back(frame.status.ok()
                               ? robot_.model().StateOfActuator(static_cast<int>(cable), state_)
                               : robot::ActuatorState{kNaN, kNaN, kNaN});
    frame.measured_tension_N.push_back(experiment::ActuatorInputAt(
        RecordingOf(instant), names[cable], experiment::ActuatorQuantity::kTension, instant.t_s));
  }
  AddMarkers(instant, &frame);
  return frame;
}

}  // namespace palpate::view
