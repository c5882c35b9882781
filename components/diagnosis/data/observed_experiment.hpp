// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "components/diagnosis/data/timeline.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/rgbd/camera_model.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::diagnosis {

/// Markers averaged over a short time in which the commands go one way, and what was done then.
/// Mean positions go with mean commands: over a window the body bends little.
struct Sample {
  int recording = 0;              ///< index into the experiment's
  double t_s = 0.0;               ///< mean of the frames' stamps
  std::vector<double> frame_t_s;  ///< that were averaged
  double piece_begin_s = 0.0;     ///< of the piece that it is cut from
  double piece_end_s = 0.0;
  bool begins_piece = true;                  ///< no other sample of it is before this one
  bool ends_piece = true;                    ///< none is after it
  bool still = true;                         ///< the commands stay in that piece
  Eigen::Matrix3Xd position_m;               ///< [3 x markers] measurement frame; NaN: not seen
  Eigen::VectorXi count;                     ///< [markers] frames that saw it
  std::vector<experiment::KnownLoad> loads;  ///< robot frame
};

struct ObservedRecording {
  std::string name;
  std::string kind;
  Eigen::Isometry3d T_measurement_robot = Eigen::Isometry3d::Identity();
  bool knows_pose = true;  ///< else the data have to tell T_measurement_robot
  bool camera_frame = false;
  /// A depth camera saw the markers: they are in its frame, all before it, and do not count from a
  /// held shape, as those of motion capture do.
  bool by_depth_camera = false;
  /// fx, fy of that camera's data sheet; nothing: nobody says.
  std::optional<Eigen::Vector2d> focal_px = {};
  /// R of `base_tilt_deg`; gravity in the robot frame is R' g.
  Eigen::Matrix3d base_rotation = Eigen::Matrix3d::Identity();
  /// Positions count from the body in its undeformed shape, in which it was held until then.
  std::optional<double> held_until_s = {};
  int pose_of = -1;  ///< recording from the same place as which it is planned; -1: it was made
};

/// An experiment as diagnosis looks at it.
struct ObservedExperiment {
  std::vector<std::string> markers;  ///< of the robot
  std::vector<ObservedRecording> recordings;
  std::vector<Sample> samples;  ///< by time
  Timeline timeline;
  Eigen::Vector3d sigma_m = Eigen::Vector3d::Zero();  ///< of one frame, measurement frame
  /// How well a reference window has the undeformed places of markers, one sigma of an axis.
  double reference_sigma_m = 0.0;
};

struct ObservationSettings {
  int most_samples = 120;  ///< moments of all recordings together
  /// By recording: what its camera.yaml says of the depth camera.
  std::map<std::string, rgbd::CameraModel> depth_cameras = {};
};

/// Whether a depth camera saw the markers of any recording.
bool HasDepthCamera(const ObservedExperiment& observed);

/// Cuts the recordings where commands or loads turn, and averages the markers over parts of these
/// pieces: of a motion up to four, of a hold over times that double. Throws InputError (file:line)
/// where a marker or cable is not the robot's, or no recording has markers.
ObservedExperiment Observe(const experiment::Experiment& experiment, const robot::RobotBody& body,
                           const ObservationSettings& settings = {});

}  // namespace palpate::diagnosis
