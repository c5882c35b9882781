// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/data/observed_experiment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "components/diagnosis/data/pieces.hpp"
#include "components/diagnosis/data/scatter.hpp"
#include "libs/core/error.hpp"
#include "libs/experiment/recording_inputs.hpp"

namespace palpate::diagnosis {

namespace {

using experiment::MarkerFrame;
using experiment::Recording;
using experiment::TimeWindow;

/// How finely pieces are cut.
struct Cut {
  int of_motion = 4;
  int of_hold = 5;
};

/// The first window of a hold, each of the others being twice as long as the one before.
constexpr double kShortest_s = 0.3;

int WindowCount(const Piece& piece, const Cut& cut) {
  if (!piece.still) return cut.of_motion;
  const double windows = std::log2(1.0 + (piece.end_s - piece.begin_s) / kShortest_s);
  return std::clamp(static_cast<int>(windows), 1, cut.of_hold);
}

std::vector<std::string> NamesOf(const std::vector<robot::BodyCable>& cables) {
  std::vector<std::string> names;
  for (const robot::BodyCable& cable : cables) names.push_back(cable.name);
  return names;
}

/// A soft body is held in its undeformed shape by hand.
constexpr double kReferenceSigma_m = 1e-3;

/// One that counts from an equilibrium is taken as it was measured.
bool CountsFromUndeformed(const Recording& recording) {
  return recording.reference &&
         recording.reference->shape == experiment::ReferenceShape::kUndeformed;
}

ObservedRecording Describe(const experiment::Experiment& experiment, const Recording& recording) {
  ObservedRecording seen{.name = recording.name, .kind = ToString(recording.kind)};
  seen.camera_frame = FrameOf(experiment, recording) == experiment::MeasurementFrame::kCamera;
  const auto pose = RobotFromMarkers(experiment, recording);
  if (const auto* T_robot_measurement = std::get_if<Eigen::Isometry3d>(&pose)) {
    seen.T_measurement_robot = T_robot_measurement->inverse();
  } else {
    seen.knows_pose = false;
  }
  seen.base_rotation = experiment::BaseRotation(recording);
  if (CountsFromUndeformed(recording)) seen.held_until_s = recording.reference->window_s.end_s;
  return seen;
}

/// [markers] which column of the recording's table; -1: not there.
std::vector<int> ColumnsOf(const Recording& recording, const std::vector<std::string>& markers) {
  std::vector<int> columns;
  for (const std::string& marker : markers) {
    const auto column = recording.markers->IndexOf(marker);
    columns.push_back(column ? static_cast<int>(*column) : -1);
  }
  return columns;
}

/// Where the reference window has each marker, from where it is at rest: to take off; empty without
/// one.
Eigen::Matrix3Xd ReferenceOf(const Recording& recording, const std::vector<int>& columns,
                             const robot::RobotBody& body,
                             const Eigen::Isometry3d& T_measurement_robot) {
  if (!CountsFromUndeformed(recording)) return {};
  const auto means = MeanOver(*recording.markers, recording.reference->window_s);
  Eigen::Matrix3Xd off_m(3, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t m = 0; m < columns.size(); ++m) {
    const auto column = static_cast<Eigen::Index>(m);
    off_m.col(column).setConstant(std::numeric_limits<double>::quiet_NaN());
    if (columns[m] < 0) continue;
    const auto& mean = means[static_cast<std::size_t>(columns[m])];
    if (mean.count == 0) continue;
    off_m.col(column) = mean.mean_m - T_measurement_robot * body.markers[m].point.rest_m;
  }
  return off_m;
}

/// The frames of a window; those at which a load comes or goes belong to neither side.
std::vector<const MarkerFrame*> FramesIn(const Recording& recording, const TimeWindow& window,
                                         bool first) {
  std::vector<const MarkerFrame*> frames;
  for (const MarkerFrame& frame : recording.markers->frames) {
    const bool inside = frame.t_s <= window.end_s &&
                        (frame.t_s > window.begin_s || (first && frame.t_s >= window.begin_s));
    bool turns = false;
    for (const auto& load : recording.loads) {
      turns = turns || (load.t_s == frame.t_s && frame.t_s > recording.loads.front().t_s);
    }
    if (inside && !turns) frames.push_back(&frame);
  }
  return frames;
}

Sample Average(const std::vector<const MarkerFrame*>& frames, const std::vector<int>& columns) {
  Sample sample;
  const auto markers = static_cast<Eigen::Index>(columns.size());
  sample.position_m = Eigen::Matrix3Xd::Zero(3, markers);
  sample.count = Eigen::VectorXi::Zero(markers);
  for (const MarkerFrame* frame : frames) {
    sample.frame_t_s.push_back(frame->t_s);
    sample.t_s += frame->t_s / static_cast<double>(frames.size());
    for (Eigen::Index m = 0; m < markers; ++m) {
      const int column = columns[static_cast<std::size_t>(m)];
      if (column < 0) continue;
      const auto& seen = frame->positions_m[static_cast<std::size_t>(column)];
      if (!seen) continue;
      sample.position_m.col(m) += *seen;
      ++sample.count[m];
    }
  }
  for (Eigen::Index m = 0; m < markers; ++m) {
    sample.position_m.col(m) /=
        sample.count[m] > 0 ? sample.count[m] : std::numeric_limits<double>::quiet_NaN();
  }
  return sample;
}

/// The samples of one recording.
class Sampler {
 public:
  Sampler(const Recording& recording, int index, const robot::RobotBody& body,
          const ObservedExperiment& observed)
      : recording_(recording),
        index_(index),
        timeline_(observed.timeline),
        columns_(ColumnsOf(recording, observed.markers)),
        reference_m_(ReferenceOf(
            recording, columns_, body,
            observed.recordings[static_cast<std::size_t>(index)].T_measurement_robot)) {}

  void AddTo(const Cut& cut, std::vector<Sample>* samples, Scatter* scatter) const {
    const auto i = static_cast<std::size_t>(index_);
    const TimeWindow span =
        recording_.steady_window_s.value_or(TimeWindow{timeline_.begin_s[i], timeline_.end_s[i]});
    bool first = true;
    for (const Piece& piece : PiecesOf(recording_, timeline_, span.begin_s, span.end_s)) {
      bool begins_piece = true;
      for (const TimeWindow& window : WindowsOf(piece, WindowCount(piece, cut))) {
        const auto frames = FramesIn(recording_, window, std::exchange(first, false));
        if (frames.empty()) continue;
        scatter->Add(frames);
        Sample sample = Average(frames, columns_);
        if (reference_m_.size() > 0) sample.position_m -= reference_m_;
        sample.recording = index_;
        sample.piece_begin_s = piece.begin_s;
        sample.piece_end_s = piece.end_s;
        sample.begins_piece = std::exchange(begins_piece, false);
        if (!sample.begins_piece) samples->back().ends_piece = false;
        sample.still = piece.still;
        sample.loads = experiment::LoadsAt(recording_.loads, sample.t_s);
        samples->push_back(std::move(sample));
      }
    }
  }

 private:
  const Recording& recording_;
  int index_;
  const Timeline& timeline_;
  std::vector<int> columns_;
  Eigen::Matrix3Xd reference_m_;
};

/// A depth camera measures nothing behind itself.
void FindDepthCameras(const std::map<std::string, rgbd::CameraModel>& cameras,
                      ObservedExperiment* observed) {
  for (ObservedRecording& recording : observed->recordings) {
    recording.by_depth_camera = recording.camera_frame && !recording.held_until_s;
    const auto camera = cameras.find(recording.name);
    if (camera == cameras.end()) continue;
    recording.focal_px = Eigen::Vector2d(camera->second.fx_px, camera->second.fy_px);
  }
  for (const Sample& sample : observed->samples) {
    auto& recording = observed->recordings[static_cast<std::size_t>(sample.recording)];
    const bool behind = (sample.position_m.row(2).array() <= 0.0).any();  // NaN is not
    recording.by_depth_camera = recording.by_depth_camera && !behind;
  }
}

}  // namespace

bool HasDepthCamera(const ObservedExperiment& observed) {
  return std::any_of(observed.recordings.begin(), observed.recordings.end(),
                     [](const ObservedRecording& recording) { return recording.by_depth_camera; });
}

ObservedExperiment Observe(const experiment::Experiment& experiment, const robot::RobotBody& body,
                           const ObservationSettings& settings) {
  ObservedExperiment observed;
  const std::vector<std::string> cables = NamesOf(body.cables);
  for (const robot::BodyMarker& marker : body.markers) observed.markers.push_back(marker.name);
  observed.timeline = ReadTimeline(experiment, cables);
  std::vector<Sampler> samplers;
  for (std::size_t i = 0; i < experiment.recordings.size(); ++i) {
    const Recording& recording = experiment.recordings[i];
    CheckCables(recording, cables);
    observed.recordings.push_back(Describe(experiment, recording));
    if (!recording.markers) continue;
    CheckMarkers(recording, observed.markers);
    samplers.emplace_back(recording, static_cast<int>(i), body, observed);
  }
  if (samplers.empty()) {
    throw InputError(experiment.folder.string() + ": no recording has markers.csv");
  }
  Scatter scatter;
  for (Cut cut; cut.of_motion > 0; --cut.of_motion, cut.of_hold = std::max(1, cut.of_hold - 1)) {
    observed.samples.clear();
    scatter = {};
    for (const Sampler& sampler : samplers) sampler.AddTo(cut, &observed.samples, &scatter);
    if (static_cast<int>(observed.samples.size()) <= settings.most_samples) break;
  }
  const auto told = experiment.tolerances.find("marker_bias_m");
  observed.reference_sigma_m =
      told != experiment.tolerances.end() ? told->second : kReferenceSigma_m;
  observed.sigma_m = scatter.Sigma_m(experiment.markers_sigma_m);
  FindDepthCameras(settings.depth_cameras, &observed);
  return observed;
}

}  // namespace palpate::diagnosis
