// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/data/observed_experiment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "components/diagnosis/data/average_frames.hpp"
#include "components/diagnosis/data/pieces.hpp"
#include "components/diagnosis/data/scatter.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
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

template <typename Part>
std::vector<std::string> NamesOf(const std::vector<Part>& parts) {
  std::vector<std::string> names;
  for (const Part& part : parts) names.push_back(part.name);
  return names;
}

/// A soft body is held in its undeformed shape by hand.
constexpr double kReferenceSigma_m = 1e-3;

/// One that counts from an equilibrium is taken as it was measured.
bool CountsFromUndeformed(const Recording& recording) {
  return recording.reference &&
         recording.reference->shape == experiment::ReferenceShape::kUndeformed;
}

std::vector<DepthFrame> DepthFramesOf(const Recording& recording) {
  const auto& files = recording.depth_images.empty() ? recording.clouds : recording.depth_images;
  std::vector<DepthFrame> depth_frames;
  for (const experiment::StampedFile& file : files) {
    depth_frames.push_back({static_cast<int>(depth_frames.size()), file.t_s()});
  }
  return depth_frames;
}

Eigen::Matrix3Xd RestOf(const std::vector<robot::BodyMarker>& markers) {
  Eigen::Matrix3Xd rest_m(3, ToIndex(markers.size()));
  for (std::size_t m = 0; m < markers.size(); ++m) rest_m.col(ToIndex(m)) = markers[m].point.rest_m;
  return rest_m;
}

ObservedRecording DescribeRecording(const experiment::Experiment& experiment,
                                    const Recording& recording, const robot::RobotBody& body,
                                    bool with_depth_frames) {
  ObservedRecording seen{.name = recording.name, .kind = ToString(recording.kind)};
  seen.camera_frame = FrameOf(experiment, recording) == experiment::MeasurementFrame::kCamera;
  const auto pose = RobotFromMarkers(experiment, recording);
  if (const auto* T_robot_measurement = std::get_if<Eigen::Isometry3d>(&pose)) {
    seen.T_measurement_robot = T_robot_measurement->inverse();
    seen.pose_error =
        recording.T_robot_camera ? recording.T_robot_camera_error : experiment.T_robot_camera_error;
  } else {
    seen.knows_pose = false;
  }
  if (with_depth_frames && !DepthFramesOf(recording).empty()) {
    const auto camera = RobotFromCamera(experiment, recording);
    const auto* T_robot_camera = std::get_if<Eigen::Isometry3d>(&camera);
    if (T_robot_camera != nullptr) seen.T_camera_robot = T_robot_camera->inverse();
  }
  seen.base_rotation = experiment::BaseRotation(recording);
  if (CountsFromUndeformed(recording)) {
    seen.held_until_s = recording.reference->window_s.end_s;
    seen.counts_from_m = RestOf(body.markers);
  }
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
                             const ObservedRecording& seen) {
  if (seen.counts_from_m.size() == 0) return {};
  const auto means = MeanOver(*recording.markers, recording.reference->window_s);
  Eigen::Matrix3Xd off_m(3, ToIndex(columns.size()));
  for (std::size_t m = 0; m < columns.size(); ++m) {
    const auto column = ToIndex(m);
    off_m.col(column).setConstant(std::numeric_limits<double>::quiet_NaN());
    if (columns[m] < 0) continue;
    const auto& mean = means[At(columns[m])];
    if (mean.count == 0) continue;
    off_m.col(column) = mean.mean_m - seen.T_measurement_robot * seen.counts_from_m.col(column);
  }
  return off_m;
}

/// Frames at which a load comes or goes belong to neither side.
bool LoadsChangeAt(const Recording& recording, double t_s) {
  return std::any_of(recording.loads.begin(), recording.loads.end(), [&](const auto& load) {
    return load.t_s == t_s && t_s > recording.loads.front().t_s;
  });
}

bool IsInside(const Recording& recording, double t_s, const TimeWindow& window, bool first) {
  return !LoadsChangeAt(recording, t_s) && t_s <= window.end_s &&
         (t_s > window.begin_s || (first && t_s >= window.begin_s));
}

MarkerFrames FramesIn(const Recording& recording, const TimeWindow& window, bool first) {
  MarkerFrames frames;
  if (!recording.markers) return frames;
  for (const MarkerFrame& frame : recording.markers->frames) {
    if (IsInside(recording, frame.t_s, window, first)) frames.push_back(&frame);
  }
  return frames;
}

/// All of a piece, also at its ends, which belong to those beside it.
MarkerFrames FramesOfMotion(const Recording& recording, const Piece& piece) {
  MarkerFrames frames;
  if (piece.still || !recording.markers) return frames;
  for (const MarkerFrame& frame : recording.markers->frames) {
    const bool inside = frame.t_s >= piece.begin_s && frame.t_s <= piece.end_s;
    if (inside && !LoadsChangeAt(recording, frame.t_s)) frames.push_back(&frame);
  }
  return frames;
}

/// A few of those in a window: as many as a motion has parts (ActuatorChain::PartsAt).
std::vector<DepthFrame> Few(const Recording& recording, const std::vector<DepthFrame>& depth_frames,
                            const TimeWindow& window, bool first) {
  constexpr std::size_t kMost = 5;
  std::vector<DepthFrame> inside;
  for (const DepthFrame& frame : depth_frames) {
    if (IsInside(recording, frame.t_s, window, first)) inside.push_back(frame);
  }
  if (inside.size() <= kMost) return inside;
  std::vector<DepthFrame> few;
  for (std::size_t k = 0; k < kMost; ++k) {
    few.push_back(inside[(2 * k + 1) * inside.size() / (2 * kMost)]);
  }
  return few;
}

/// A sample that only depth frames were taken of.
void TakeStamps(const std::vector<DepthFrame>& depth_frames, Sample* sample) {
  for (const DepthFrame& frame : depth_frames) {
    sample->frame_t_s.push_back(frame.t_s);
    sample->t_s += frame.t_s / static_cast<double>(depth_frames.size());
  }
}

/// The samples of one recording.
class Sampler {
 public:
  Sampler(const Recording& recording, int index, const ObservedExperiment& observed)
      : recording_(recording),
        index_(index),
        timeline_(observed.timeline),
        columns_(observed.markers.size(), -1) {
    const auto& seen = observed.recordings[At(index)];
    if (seen.T_camera_robot) depth_frames_ = DepthFramesOf(recording);
    if (!recording.markers) return;
    columns_ = ColumnsOf(recording, observed.markers);
    reference_m_ = ReferenceOf(recording, columns_, seen);
  }

  bool HasSomething() const { return recording_.markers || !depth_frames_.empty(); }

  void AddTo(const Cut& cut, std::vector<Sample>* samples, Scatter* scatter) const {
    const auto i = static_cast<std::size_t>(index_);
    const TimeWindow span =
        recording_.steady_window_s.value_or(TimeWindow{timeline_.begin_s[i], timeline_.end_s[i]});
    bool first = true;
    for (const Piece& piece : PiecesOf(recording_, timeline_, span.begin_s, span.end_s)) {
      bool begins_piece = true;
      const MarkerFrames of_motion = FramesOfMotion(recording_, piece);
      for (const TimeWindow& window : WindowsOf(piece, WindowCount(piece, cut))) {
        const bool is_first = std::exchange(first, false);
        const auto frames = FramesIn(recording_, window, is_first);
        const std::vector<DepthFrame> depth_frames =
            Few(recording_, depth_frames_, window, is_first);
        if (frames.empty() && depth_frames.empty()) continue;
        scatter->Add(frames);
        Sample sample = AverageFrames(frames, of_motion, columns_);
        if (frames.empty()) TakeStamps(depth_frames, &sample);
        if (reference_m_.size() > 0) sample.position_m -= reference_m_;
        sample.depth_frames = depth_frames;
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
  std::vector<int> columns_;  ///< [markers] -1: the recording does not have it
  Eigen::Matrix3Xd reference_m_;
  std::vector<DepthFrame> depth_frames_;
};

/// A depth camera measures nothing behind itself.
void FindDepthCameras(const std::map<std::string, rgbd::CameraModel>& cameras,
                      ObservedExperiment* observed) {
  for (ObservedRecording& recording : observed->recordings) {
    recording.by_depth_camera =
        recording.camera_frame && !recording.held_until_s && !recording.T_camera_robot;
    const auto camera = cameras.find(recording.name);
    if (camera == cameras.end()) continue;
    recording.focal_px = Eigen::Vector2d(camera->second.fx_px, camera->second.fy_px);
  }
  for (const Sample& sample : observed->samples) {
    auto& recording = observed->recordings[At(sample.recording)];
    const bool behind = (sample.position_m.row(2).array() <= 0.0).any();  // NaN is not
    recording.by_depth_camera = recording.by_depth_camera && !behind;
  }
}

std::string WhatIsMissing(const experiment::Experiment& experiment,
                          const ObservationSettings& settings) {
  const bool depth_frames =
      std::any_of(experiment.recordings.begin(), experiment.recordings.end(),
                  [](const Recording& recording) { return !DepthFramesOf(recording).empty(); });
  if (!settings.with_depth_frames) return ": no recording has markers.csv";
  if (!depth_frames) return ": no recording has markers.csv, depth/ or clouds/";
  return ": the camera pose of its depth frames is missing: set T_robot_camera in experiment.yaml "
         "(palpate calibrate estimates it)";
}

}  // namespace

bool HasDepthCamera(const ObservedExperiment& observed) {
  return std::any_of(observed.recordings.begin(), observed.recordings.end(),
                     [](const ObservedRecording& recording) {
                       return recording.by_depth_camera || recording.T_camera_robot;
                     });
}

std::vector<std::size_t> SpreadOver(std::size_t all, std::size_t most) {
  const std::size_t count = std::min(all, most);
  std::vector<std::size_t> some;
  for (std::size_t k = 0; k < count; ++k) some.push_back(k * all / count);
  return some;
}

bool IsMeasured(const Sample& sample, Eigen::Index coordinate) {
  const Eigen::Index of_markers = 3 * sample.count.size();
  if (coordinate < of_markers) return sample.count[coordinate / 3] > 0;
  const auto feature = static_cast<std::size_t>(coordinate - of_markers);
  return feature < sample.surface.size() && sample.surface[feature].count > 0;
}

double Measured_m(const Sample& sample, Eigen::Index coordinate) {
  if (!IsMeasured(sample, coordinate)) return std::numeric_limits<double>::quiet_NaN();
  const Eigen::Index of_markers = 3 * sample.count.size();
  if (coordinate < of_markers) return sample.position_m.reshaped()[coordinate];
  return sample.surface[At(coordinate - of_markers)].measured_m;
}

double Sigma_m(const ObservedExperiment& observed, const Sample& sample, Eigen::Index coordinate) {
  const Eigen::Index of_markers = 3 * sample.count.size();
  if (coordinate >= of_markers) {
    return sample.surface[At(coordinate - of_markers)].sigma_m;
  }
  return observed.sigma_m[coordinate % 3] / std::sqrt(sample.count[coordinate / 3]);
}

ObservedExperiment Observe(const experiment::Experiment& experiment, const robot::RobotBody& body,
                           const ObservationSettings& settings) {
  ObservedExperiment observed;
  for (const robot::BodyMarker& marker : body.markers) observed.markers.push_back(marker.name);
  observed.timeline = ReadTimeline(experiment, robot::ActuatorsOf(body));
  std::vector<Sampler> samplers;
  for (std::size_t i = 0; i < experiment.recordings.size(); ++i) {
    const Recording& recording = experiment.recordings[i];
    CheckActuators(recording, NamesOf(body.cables), NamesOf(body.chambers));
    observed.recordings.push_back(
        DescribeRecording(experiment, recording, body, settings.with_depth_frames));
    if (recording.markers) CheckMarkers(recording, observed.markers);
    const Sampler sampler(recording, static_cast<int>(i), observed);
    if (sampler.HasSomething()) samplers.push_back(sampler);
  }
  if (samplers.empty()) {
    throw InputError(experiment.folder.string() + WhatIsMissing(experiment, settings));
  }
  Scatter scatter;
  for (Cut cut; cut.of_motion > 0; --cut.of_motion, cut.of_hold = std::max(1, cut.of_hold - 1)) {
    observed.samples.clear();
    scatter = {};
    for (const Sampler& sampler : samplers) sampler.AddTo(cut, &observed.samples, &scatter);
    if (static_cast<int>(observed.samples.size()) <= settings.most_samples) break;
  }
  const auto given = experiment.tolerances.find("marker_bias_m");
  observed.reference_sigma_m =
      given != experiment.tolerances.end() ? given->second : kReferenceSigma_m;
  observed.sigma_m = scatter.Sigma_m(experiment.markers_sigma_m);
  FindDepthCameras(settings.depth_cameras, &observed);
  return observed;
}

}  // namespace palpate::diagnosis
