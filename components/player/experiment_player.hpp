// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "libs/core/config_node.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/experiment/images/joint_frames.hpp"
#include "libs/experiment/images/rgbd_sequence.hpp"
#include "libs/geometry/pose_text.hpp"

namespace palpate::player {

/// Inputs of one cable at one time; what was not recorded is absent.
struct CableInput {
  std::string cable;
  std::optional<double> displacement_m;
  std::optional<double> tension_N;
};

struct Marker {
  std::string name;
  std::optional<Eigen::Vector3d> position_m;          ///< absent: not seen
  Eigen::Vector3d sigma_m = Eigen::Vector3d::Zero();  ///< along the frame's axes; 0: unknown
};

enum class MarkerReference { kNone, kUndeformed, kEquilibrium };

struct MarkerSet {
  uint64_t counter = 0;  ///< from 0 in each recording
  MarkerReference reference = MarkerReference::kNone;
  experiment::MeasurementFrame frame = experiment::MeasurementFrame::kRobot;
  std::vector<Marker> markers;
  /// Of the pose by which they came into the robot frame; nullopt: they are as measured.
  std::optional<geometry::PoseStandardError> pose_error = {};
  Eigen::Vector3d pose_about_m = Eigen::Vector3d::Zero();  ///< the origin of what measured, there
};

/// Where a frame set of images stands on disk.
struct ImageSet {
  const experiment::RgbdSequence* sequence = nullptr;  ///< of the player
  std::size_t index = 0;
  std::int64_t t_ns = 0;
  std::optional<Eigen::Isometry3d> T_robot_camera = {};  ///< nullopt: the experiment has none
};

/// The same of a camera beside the first.
struct FurtherImages {
  std::string camera;
  ImageSet images;
};

/// What happened at one time of a recording: cable inputs (linear between the rows of
/// actuation.csv), and the markers, or images, where they were taken at that time.
struct Event {
  std::string recording;
  double t_s = 0.0;
  std::vector<CableInput> cables;  ///< empty: the recording has no actuation.csv
  std::optional<MarkerSet> markers = {};
  std::optional<ImageSet> images = {};      ///< of the first camera
  std::vector<FurtherImages> further = {};  ///< of the others that belong to the same frame
  std::optional<std::int64_t> t_ns = {};    ///< of the frame, where it has images

  bool has_frame() const { return markers || t_ns; }
};

/// Turns an experiment into events: recording after recording in the order of their names, each in
/// the order of time, with one event for each frame (of markers, or of images) and each row of
/// actuation.csv. Images of several cameras are one frame where their times are (JoinFrames).
class ExperimentPlayer {
 public:
  /// `recording`: the only one to play; empty: all that have markers. `in_robot_frame`: markers are
  /// mapped to the robot frame; else they stay as measured. Throws InputError where there is no
  /// such recording (with "did you mean"), none has markers, or the mapping is unknown.
  ExperimentPlayer(experiment::Experiment experiment, const std::string& recording,
                   bool in_robot_frame);

  /// The same of depth and colour images instead of markers. Throws InputError where there is no
  /// such recording, or none has images, or a camera.yaml cannot be read.
  static ExperimentPlayer OfImages(experiment::Experiment experiment, const std::string& recording,
                                   const ConfigLoader& load);

  ExperimentPlayer(ExperimentPlayer&&) = default;
  ExperimentPlayer(const ExperimentPlayer&) = delete;  // tracks point into the experiment

  /// The next event; nullopt at the end of the last recording.
  std::optional<Event> Next();
  /// Goes back to the first event of the recording that Next() is in.
  void RewindRecording();
  /// Goes back to the first event of all.
  void RewindAll();

  bool has_cables() const;
  bool plays_images() const { return plays_images_; }
  /// Names of the cameras beside the first whose images are played.
  const std::vector<std::string>& further_cameras() const { return further_cameras_; }
  /// Name of the folder, and the properties of its camera.
  const experiment::Experiment& experiment() const { return experiment_; }

 private:
  /// The images of one camera in a recording.
  struct CameraTrack {
    std::unique_ptr<experiment::RgbdSequence> images;  ///< stays where it is: events point to it;
                                                       ///< nullptr: it has none there
    std::optional<Eigen::Isometry3d> T_robot_camera = {};
  };

  /// A recording as it is played.
  struct Track {
    const experiment::Recording* recording;
    Eigen::Isometry3d T_frame_measured;
    experiment::MeasurementFrame frame;
    Eigen::Vector3d sigma_m;
    std::vector<double> times_s;                      ///< of all events, rising
    std::vector<CameraTrack> cameras = {};            ///< of the images, the first camera in front
    std::vector<experiment::JointFrame> frames = {};  ///< of these cameras
    std::optional<geometry::PoseStandardError> pose_error = {};  ///< of T_frame_measured
  };

  explicit ExperimentPlayer(experiment::Experiment experiment);
  /// Throws InputError where there is nothing to play.
  void CheckTracks(const std::string& recording, const std::string& what) const;
  Track MakeTrack(const experiment::Recording& recording, bool in_robot_frame) const;
  MarkerSet MarkersOf(const Track& track, const experiment::MarkerFrame& frame) const;

  CameraTrack OpenCamera(const experiment::Experiment& experiment,
                         const experiment::Recording& recording, const ConfigLoader& load) const;
  void AddTrackOfImages(const experiment::Recording& recording, const ConfigLoader& load);
  void AddImages(const Track& track, double t_s, Event* event);

  experiment::Experiment experiment_;
  bool plays_images_ = false;
  std::vector<std::string> further_cameras_;
  std::vector<Track> tracks_;
  size_t track_ = 0;
  size_t event_ = 0;
  uint64_t frame_ = 0;  ///< the next one of the track
};

}  // namespace palpate::player
