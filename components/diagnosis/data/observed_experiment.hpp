// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "components/diagnosis/data/surface_measurement.hpp"
#include "components/diagnosis/data/timeline.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/geometry/pose_text.hpp"
#include "libs/rgbd/camera_model.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::diagnosis {

/// Markers, and the surface as depth frames show it, averaged over a short time in which the
/// commands go one way, and what was done then. Mean positions go with mean commands: over a window
/// the body bends little.
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
  std::vector<DepthFrame> depth_frames;      ///< that were taken then
  std::vector<SurfaceMeasurement>
      surface;  ///< [features] what they show (surface/surface_matcher.hpp)
};

struct ObservedRecording {
  std::string name;
  std::string kind;
  Eigen::Isometry3d T_measurement_robot = Eigen::Isometry3d::Identity();
  bool knows_pose = true;  ///< else T_measurement_robot is estimated
  /// Of the pose that is given, about the camera; nothing: not stated.
  std::optional<geometry::PoseStandardError> pose_error = {};
  bool camera_frame = false;
  /// A depth camera saw the markers: they are in its frame, all before it, and do not count from a
  /// held shape, as those of motion capture do.
  bool by_depth_camera = false;
  /// fx, fy of that camera's data sheet; nothing: it is not given.
  std::optional<Eigen::Vector2d> focal_px = {};
  /// R of `base_tilt_deg`; gravity in the robot frame is R' g.
  Eigen::Matrix3d base_rotation = Eigen::Matrix3d::Identity();
  /// The depth camera whose depth frames show the surface: where it stood; nothing: none did.
  /// Markers that are in the camera's frame beside depth frames are a tracker's, which has that
  /// frame but none of the depth camera's errors.
  std::optional<Eigen::Isometry3d> T_camera_robot = {};
  double stereo_px_m =
      0.0;  ///< of that camera, focal length times baseline; 0: not known, or no stereo
  /// Positions count from the body in its undeformed shape, in which it was held until then.
  std::optional<double> held_until_s = {};
  /// [3 x markers] robot frame: where markers of a body that was held so are by the robot file.
  /// Their displacements from there were measured, so that of a pose only turns change them. Empty:
  /// positions were measured.
  Eigen::Matrix3Xd counts_from_m = {};
  int pose_of = -1;  ///< recording from the same place as which it is planned; -1: it was made

  /// From where it was seen, depth frames before markers.
  const Eigen::Isometry3d& T_view_robot() const {
    return T_camera_robot ? *T_camera_robot : T_measurement_robot;
  }
};

/// An experiment as samples and a command timeline.
struct ObservedExperiment {
  std::vector<std::string> markers;  ///< of the robot
  std::vector<ObservedRecording> recordings;
  std::vector<Sample> samples;  ///< by time
  Timeline timeline;
  Eigen::Vector3d sigma_m = Eigen::Vector3d::Zero();  ///< of one frame, measurement frame
  /// How well a reference window has the undeformed places of markers, one sigma of an axis.
  double reference_sigma_m = 0.0;
  Eigen::Matrix3Xd
      feature_rest_m;  ///< [3 x features] of the surface, undeformed; empty: no depth frames

  bool HasSurface() const { return feature_rest_m.cols() > 0; }
  /// Of a sample: x, y, z of each marker, then each feature of the surface along its normal.
  Eigen::Index CoordinateCount() const { return 3 * std::ssize(markers) + feature_rest_m.cols(); }
};

/// Numbers of `most` samples, or of all where these are fewer, spread evenly over `all`.
std::vector<std::size_t> SpreadOver(std::size_t all, std::size_t most);

/// One coordinate of those that a sample has.
bool IsMeasured(const Sample& sample, Eigen::Index coordinate);
/// m; NaN where it was not measured.
double Measured_m(const Sample& sample, Eigen::Index coordinate);
/// One sigma of its noise, m.
double Sigma_m(const ObservedExperiment& observed, const Sample& sample, Eigen::Index coordinate);

struct ObservationSettings {
  int most_samples = 120;  ///< samples of all recordings together
  /// By recording: what its camera.yaml says of the depth camera.
  std::map<std::string, rgbd::CameraModel> depth_cameras = {};
  bool with_depth_frames = false;  ///< depth images and clouds count, too
};

/// Whether a depth camera saw the markers, or the surface, of any recording.
bool HasDepthCamera(const ObservedExperiment& observed);

/// Cuts the recordings where commands or loads turn, and averages the markers over parts of these
/// pieces: of a motion up to four, of a hold over times that double. Of depth frames it takes a few
/// of each part; what they show is not evaluated yet. Depth frames without a camera pose are left
/// out. Throws InputError (file:line) where a marker or cable is not the robot's, or no recording
/// has markers or such depth frames.
ObservedExperiment Observe(const experiment::Experiment& experiment, const robot::RobotBody& body,
                           const ObservationSettings& settings = {});

}  // namespace palpate::diagnosis
