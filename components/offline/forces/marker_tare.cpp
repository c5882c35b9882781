// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/forces/marker_tare.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "components/force_estimation/marker_force_estimator.hpp"
#include "components/force_estimation/recording_frames.hpp"
#include "components/offline/forces/estimate_plan.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"

namespace palpate::offline {

namespace {

using experiment::Recording;
using force_estimation::MarkerFrame;
using force_estimation::ReferenceShape;

struct MarkerTareTuning {
  /// Frames of a recording that are tested, evenly spread. More: smaller shares of frames with a
  /// force are found.
  int tested_frames = 24;
  /// Tested frames with a force from which the recording is not used.
  int most_with_force = 2;
};
constexpr MarkerTareTuning kMarkerTareTuning;

bool MayTare(const Recording& recording) {
  const bool held = recording.reference && !recording.steady_window_s &&
                    recording.reference->shape == experiment::ReferenceShape::kUndeformed;
  return recording.kind == experiment::RecordingKind::kRest && IsContactFree(recording) &&
         recording.markers && !held;
}

bool SamePose(const experiment::Experiment& experiment, const Recording& a, const Recording& b) {
  const auto pose_a = experiment::RobotFromMarkers(experiment, a);
  const auto pose_b = experiment::RobotFromMarkers(experiment, b);
  const auto* T_a = std::get_if<Eigen::Isometry3d>(&pose_a);
  const auto* T_b = std::get_if<Eigen::Isometry3d>(&pose_b);
  return T_a != nullptr && T_b != nullptr && T_a->isApprox(*T_b, 1e-9) &&
         experiment::BaseRotation(a).isApprox(experiment::BaseRotation(b), 1e-9);
}

}  // namespace

MarkerTare::MarkerTare(const experiment::Experiment& experiment, robot::RobotModel* model,
                       robot::CableInput cable_input, const force_estimation::Config& config)
    : experiment_(experiment), model_(model), cable_input_(cable_input), config_(config) {
  config_.contacts.clear();
}

std::vector<std::string> MarkerTare::Choose() {
  std::vector<std::string> notes;
  std::vector<std::string> used;
  for (const Recording& recording : experiment_.recordings) {
    if (!MayTare(recording)) continue;
    if (!std::holds_alternative<Eigen::Isometry3d>(
            experiment::RobotFromMarkers(experiment_, recording))) {
      continue;
    }
    Frames frames = StaticFrames(recording);
    if (frames.size() < 2) continue;
    const auto half = frames.begin() + std::ssize(frames) / 2;
    bool touched = FindsForce({frames.begin(), half}, {half, frames.end()});
    if (!touched && !sources_.empty() && SamePose(experiment_, *sources_[0].recording, recording)) {
      touched = FindsForce(sources_[0].frames, frames);
    }
    if (touched) {
      notes.push_back(
          "recording " + recording.name +
          " is not used for the marker offsets: a force is found in it, though its kind "
          "is contact-free");
      continue;
    }
    used.push_back(recording.name);
    sources_.push_back({&recording, std::move(frames)});
  }
  if (!used.empty()) {
    notes.push_back("marker offsets of recordings without a rest window: from " + Listed(used));
  }
  return notes;
}

std::vector<MarkerFrame> MarkerTare::FramesFor(const Recording& recording) const {
  Frames frames;
  const Source* own = nullptr;
  for (const Source& source : sources_) {
    if (source.recording == &recording) own = &source;
    if (source.recording == &recording || !SamePose(experiment_, *source.recording, recording)) {
      continue;
    }
    frames.insert(frames.end(), source.frames.begin(), source.frames.end());
  }
  return frames.empty() && own != nullptr ? own->frames : frames;
}

MarkerTare::Frames MarkerTare::StaticFrames(const Recording& recording) const {
  Frames frames =
      force_estimation::FramesOfRecording(experiment_, recording, *model_, cable_input_);
  const auto window = recording.steady_window_s ? recording.steady_window_s
                      : recording.reference     ? std::optional(recording.reference->window_s)
                                                : std::nullopt;
  std::erase_if(frames,
                [&](const MarkerFrame& frame) { return window && !window->Contains(frame.t_s); });
  for (MarkerFrame& frame : frames) frame.reference = ReferenceShape::kEquilibrium;
  return frames;
}

bool MarkerTare::FindsForce(const Frames& reference, const Frames& frames) const {
  force_estimation::MarkerForceEstimator estimator(*model_, config_);
  for (const MarkerFrame& frame : reference) static_cast<void>(estimator.Update(frame));
  const auto step =
      std::max<std::ptrdiff_t>(1, std::ssize(frames) / kMarkerTareTuning.tested_frames);
  int with_force = 0;
  for (std::ptrdiff_t k = 0; k < std::ssize(frames); k += step) {
    MarkerFrame frame = frames[At(k)];
    frame.reference = ReferenceShape::kNone;
    with_force += estimator.Update(frame).status.ok() ? 1 : 0;
  }
  return with_force > kMarkerTareTuning.most_with_force;
}

}  // namespace palpate::offline
