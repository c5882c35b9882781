// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/player/experiment_player.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/cameras.hpp"

namespace palpate::player {

namespace {

using experiment::ActuatorQuantity;
using experiment::MeasurementFrame;
using experiment::Recording;

constexpr double kNsPerSecond = 1e9;

/// Times of all frames and actuation rows, each once. Rows before the first or after the last frame
/// are left out: no reader can use them.
std::vector<double> EventTimes(std::vector<double> times_s, const Recording& recording) {
  if (!recording.actuation) return times_s;
  const double first_s = times_s.front(), last_s = times_s.back();
  for (const double t_s : recording.actuation->t_s) {
    if (t_s >= first_s && t_s <= last_s) times_s.push_back(t_s);
  }
  std::sort(times_s.begin(), times_s.end());
  times_s.erase(std::unique(times_s.begin(), times_s.end()), times_s.end());
  return times_s;
}

std::vector<double> TimesOfMarkers(const Recording& recording) {
  std::vector<double> times_s;
  for (const auto& frame : recording.markers->frames) times_s.push_back(frame.t_s);
  return times_s;
}

double SecondsOf(std::int64_t t_ns) { return static_cast<double>(t_ns) / kNsPerSecond; }

std::vector<CableInput> CablesAt(const Recording& recording, double t_s) {
  std::vector<CableInput> cables;
  if (!recording.actuation) return cables;
  for (const experiment::ActuatorColumn& column : recording.actuation->columns) {
    auto input = std::find_if(cables.begin(), cables.end(),
                              [&](const CableInput& known) { return known.cable == column.cable; });
    if (input == cables.end()) input = cables.insert(input, {column.cable, {}, {}});
    auto& value = column.quantity == ActuatorQuantity::kDisplacement ? input->displacement_m
                                                                     : input->tension_N;
    value = recording.actuation->ValueAt(column, t_s);
  }
  return cables;
}

MarkerReference ReferenceAt(const Recording& recording, double t_s) {
  if (!recording.reference || !recording.reference->window_s.Contains(t_s)) {
    return MarkerReference::kNone;
  }
  return recording.reference->shape == experiment::ReferenceShape::kUndeformed
             ? MarkerReference::kUndeformed
             : MarkerReference::kEquilibrium;
}

/// Standard deviations along the axes of a frame turned by R, of noise that is independent along
/// the axes of the measured frame.
Eigen::Vector3d TurnedSigma(const Eigen::Matrix3d& R, const Eigen::Vector3d& sigma_m) {
  return (R.cwiseAbs2() * sigma_m.cwiseAbs2()).cwiseSqrt();
}

/// Refuses a name that no recording has.
void CheckRecordingName(const experiment::Experiment& experiment, const std::string& name) {
  std::vector<std::string> names;
  for (const Recording& recording : experiment.recordings) names.push_back(recording.name);
  if (name.empty() || std::find(names.begin(), names.end(), name) != names.end()) return;
  throw InputError("no recording '" + name + "' in " + experiment.folder.string() +
                   DidYouMean(name, names));
}

}  // namespace

ExperimentPlayer::ExperimentPlayer(experiment::Experiment experiment)
    : experiment_(std::move(experiment)) {}

ExperimentPlayer::ExperimentPlayer(experiment::Experiment experiment, const std::string& recording,
                                   bool in_robot_frame)
    : ExperimentPlayer(std::move(experiment)) {
  CheckRecordingName(experiment_, recording);
  for (const Recording& candidate : experiment_.recordings) {
    if (!candidate.markers || (!recording.empty() && candidate.name != recording)) continue;
    tracks_.push_back(MakeTrack(candidate, in_robot_frame));
  }
  CheckTracks(recording, "markers.csv");
}

ExperimentPlayer ExperimentPlayer::OfImages(experiment::Experiment experiment,
                                            const std::string& recording,
                                            const ConfigLoader& load) {
  ExperimentPlayer player(std::move(experiment));
  player.plays_images_ = true;
  player.further_cameras_ = experiment::FurtherCameras(player.experiment_);
  CheckRecordingName(player.experiment_, recording);
  for (const Recording& candidate : player.experiment_.recordings) {
    if (recording.empty() || candidate.name == recording) player.AddTrackOfImages(candidate, load);
  }
  player.CheckTracks(recording, "images");
  return player;
}

ExperimentPlayer::CameraTrack ExperimentPlayer::OpenCamera(const experiment::Experiment& experiment,
                                                           const Recording& recording,
                                                           const ConfigLoader& load) const {
  CameraTrack track;
  if (recording.depth_images.empty() && recording.clouds.empty()) return track;
  track.images =
      std::make_unique<experiment::RgbdSequence>(experiment::OpenRecordingImages(recording, load));
  const auto pose = experiment::RobotFromCamera(experiment, recording);
  if (const auto* known = std::get_if<Eigen::Isometry3d>(&pose)) track.T_robot_camera = *known;
  return track;
}

void ExperimentPlayer::AddTrackOfImages(const Recording& recording, const ConfigLoader& load) {
  Track track{&recording,
              Eigen::Isometry3d::Identity(),
              MeasurementFrame::kCamera,
              Eigen::Vector3d::Zero(),
              {}};
  track.cameras.push_back(OpenCamera(experiment_, recording, load));
  for (const std::string& name : further_cameras_) {
    track.cameras.push_back(OpenCamera(experiment::OfCamera(experiment_, name),
                                       experiment::OfCamera(experiment_, recording, name), load));
  }
  std::vector<std::vector<std::int64_t>> t_ns(track.cameras.size());
  for (std::size_t k = 0; k < track.cameras.size(); ++k) {
    if (!track.cameras[k].images) continue;
    for (const auto& frame : track.cameras[k].images->frames) t_ns[k].push_back(frame.t_ns);
  }
  track.frames = experiment::JoinFrames(t_ns);
  if (track.frames.empty()) return;
  std::vector<double> times_s;
  for (const experiment::JointFrame& frame : track.frames) times_s.push_back(SecondsOf(frame.t_ns));
  track.times_s = EventTimes(std::move(times_s), recording);
  tracks_.push_back(std::move(track));
}

void ExperimentPlayer::CheckTracks(const std::string& recording, const std::string& what) const {
  if (!tracks_.empty()) return;
  throw InputError((recording.empty() ? "no recording in " + experiment_.folder.string() + " has "
                                      : "recording '" + recording + "' has no ") +
                   what + ": nothing to play");
}

ExperimentPlayer::Track ExperimentPlayer::MakeTrack(const Recording& recording,
                                                    bool in_robot_frame) const {
  Track track{&recording, Eigen::Isometry3d::Identity(), FrameOf(experiment_, recording),
              experiment_.markers_sigma_m.value_or(Eigen::Vector3d::Zero()),
              EventTimes(TimesOfMarkers(recording), recording)};
  if (!in_robot_frame || track.frame == MeasurementFrame::kRobot) return track;
  const auto pose = experiment::RobotFromMarkers(experiment_, recording);
  if (const auto* missing = std::get_if<experiment::NeedsCalibration>(&pose)) {
    throw InputError("recording '" + recording.name + "': " + missing->reason +
                     " (or set frame=measured)");
  }
  track.T_frame_measured = std::get<Eigen::Isometry3d>(pose);
  track.frame = MeasurementFrame::kRobot;
  track.sigma_m = TurnedSigma(track.T_frame_measured.linear(), track.sigma_m);
  track.pose_error = experiment::PoseErrorOf(experiment_, recording);
  return track;
}

std::optional<Event> ExperimentPlayer::Next() {
  if (track_ < tracks_.size() && event_ == tracks_[track_].times_s.size()) {
    ++track_;
    RewindRecording();
  }
  if (track_ == tracks_.size()) return std::nullopt;
  const Track& track = tracks_[track_];
  const double t_s = track.times_s[event_++];
  Event event{track.recording->name, t_s, CablesAt(*track.recording, t_s)};
  if (plays_images_) {
    AddImages(track, t_s, &event);
    return event;
  }
  const auto& frames = track.recording->markers->frames;
  if (frame_ < frames.size() && frames[frame_].t_s == t_s) {
    event.markers = MarkersOf(track, frames[frame_]);
    event.markers->counter = frame_++;
  }
  return event;
}

void ExperimentPlayer::AddImages(const Track& track, double t_s, Event* event) {
  if (frame_ == track.frames.size() || SecondsOf(track.frames[frame_].t_ns) != t_s) return;
  const experiment::JointFrame& frame = track.frames[frame_++];
  event->t_ns = frame.t_ns;
  for (std::size_t k = 0; k < frame.frames.size(); ++k) {
    if (!frame.frames[k]) continue;
    const CameraTrack& camera = track.cameras[k];
    const std::size_t index = *frame.frames[k];
    const ImageSet set{camera.images.get(), index, camera.images->frames[index].t_ns,
                       camera.T_robot_camera};
    if (k == 0) event->images = set;
    if (k > 0) event->further.push_back({further_cameras_[k - 1], set});
  }
}

MarkerSet ExperimentPlayer::MarkersOf(const Track& track,
                                      const experiment::MarkerFrame& frame) const {
  MarkerSet set;
  set.reference = ReferenceAt(*track.recording, frame.t_s);
  set.frame = track.frame;
  set.pose_error = track.pose_error;
  set.pose_about_m = track.T_frame_measured.translation();
  const auto& names = track.recording->markers->names;
  for (size_t i = 0; i < names.size(); ++i) {
    Marker marker{names[i], std::nullopt, track.sigma_m};
    if (frame.positions_m[i]) marker.position_m = track.T_frame_measured * *frame.positions_m[i];
    set.markers.push_back(std::move(marker));
  }
  return set;
}

void ExperimentPlayer::RewindRecording() {
  event_ = 0;
  frame_ = 0;
}

void ExperimentPlayer::RewindAll() {
  track_ = 0;
  RewindRecording();
}

bool ExperimentPlayer::has_cables() const {
  return std::any_of(tracks_.begin(), tracks_.end(),
                     [](const Track& track) { return track.recording->actuation.has_value(); });
}

}  // namespace palpate::player
