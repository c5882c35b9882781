// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/calibration/joint/calibration_frame.hpp"
#include "components/calibration/joint/pose_prior.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// The markers of a recording for a joint calibration, in the measurement frame. A recording with a
/// steady window, or with still cables, gives one frame: the mean over it. A moving one gives up to
/// `most_frames` single times, spread over the recording. Covariances are the noise variance
/// (measured, at least markers_sigma_m) over the number averaged, plus `marker_bias_m` squared.
/// Throws InputError (file:line) as ObserveRecording does.
std::vector<CalibrationFrame> FramesOfRecording(const experiment::Experiment& experiment,
                                                const experiment::Recording& recording,
                                                const robot::RobotModel& model,
                                                robot::CableInput preferred, double marker_bias_m,
                                                int most_frames = 6);

/// Frames of several recordings, and the poses from which they were measured.
class RecordedFrames {
 public:
  /// `experiment` and `model` must outlive it.
  RecordedFrames(const experiment::Experiment& experiment, const robot::RobotModel& model,
                 robot::CableInput preferred, double marker_bias_m)
      : experiment_(experiment),
        model_(model),
        preferred_(preferred),
        marker_bias_m_(marker_bias_m) {}

  /// Adds FramesOfRecording. The reference window is a further frame: the undeformed body without
  /// weight, or the equilibrium without loads; `marker_bias_m` is an error between both and counts
  /// in the other frames only. `of_camera`: seen from the camera to calibrate; otherwise from a
  /// pose of its own (RobotFromMarkers), which is known to PoseErrorOf, or that of the measurement
  /// frame.
  void Add(const experiment::Recording& recording, bool of_camera);

  const std::vector<CalibrationFrame>& frames() const { return frames_; }
  const std::vector<PosePrior>& own_poses() const { return own_poses_; }  ///< JointSetup's
  bool has_reference() const { return has_reference_; }
  bool has_camera() const { return has_camera_; }  ///< a frame is seen from the camera to calibrate

 private:
  int OwnPoseOf(const experiment::Recording& recording);

  const experiment::Experiment& experiment_;
  const robot::RobotModel& model_;
  robot::CableInput preferred_;
  double marker_bias_m_;
  std::vector<CalibrationFrame> frames_;
  std::vector<PosePrior> own_poses_;
  bool has_reference_ = false;
  bool has_camera_ = false;
};

/// Whether its markers are seen from the camera whose pose is to be calibrated, as it stands in the
/// whole experiment.
bool IsOfTheCamera(const experiment::Experiment& experiment,
                   const experiment::Recording& recording);

/// Prior standard deviation of marker offsets, m, where displacements count from a reference
/// window, which tells the places of markers.
double OffsetOfMarkers_m(const robot::RobotModel& model);

}  // namespace palpate::calibration
