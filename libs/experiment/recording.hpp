// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "libs/core/config_node.hpp"
#include "libs/core/seconds.hpp"
#include "libs/experiment/actuation.hpp"
#include "libs/experiment/loads.hpp"
#include "libs/experiment/markers.hpp"
#include "libs/geometry/pose_text.hpp"

namespace palpate::experiment {

/// Frame in which markers, depth and clouds were measured.
enum class MeasurementFrame {
  kRobot,
  kCamera,  ///< the depth camera's optical frame
};

/// What was done in a recording. All kinds but kFree are contact-free but for known loads
/// (docs/experiment.md).
enum class RecordingKind {
  kRest,
  kRamp,
  kHold,
  kKnownLoad,
  kCoContraction,
  kBaseTilted,
  kCameraMoved,
  kSecondSpeed,
  kRepeat,
  kFree,
};

/// The words of recording.yaml, e.g. "known_load", and "robot" | "camera".
std::string ToString(RecordingKind kind);
std::string ToString(MeasurementFrame frame);
std::vector<std::string> RecordingKindWords();
RecordingKind ParseRecordingKind(const std::string& word, const SourceLocation& where);
MeasurementFrame ParseMeasurementFrame(const std::string& word, const SourceLocation& where);

/// Shape of the body during a reference window.
enum class ReferenceShape {
  kUndeformed,   ///< held in its undeformed shape
  kEquilibrium,  ///< at rest under its own weight and cables, without contact
};

/// Marker displacements of this recording count from the mean over this window.
struct Reference {
  TimeWindow window_s;
  ReferenceShape shape = ReferenceShape::kUndeformed;
};

/// An image or cloud whose name is its time.
struct StampedFile {
  std::int64_t t_ns = 0;  ///< on the clock of t_s
  std::filesystem::path file;

  double t_s() const { return NsToSeconds(t_ns); }
};

/// What is known of a camera beside the first, in experiment.yaml or recording.yaml.
struct CameraSettings {
  std::string name;
  std::optional<Eigen::Isometry3d> T_robot_camera;
  std::optional<geometry::PoseStandardError> T_robot_camera_error;
  std::optional<double> clock_offset_s;  ///< its stamps less the clock of t_s
};

/// What a camera beside the first recorded: the folder cameras/<name>/ of a recording.
struct CameraFiles {
  std::string name;
  std::filesystem::path folder;
  std::vector<StampedFile> depth_images;  ///< by rising time on its own clock, as the next two
  std::vector<StampedFile> color_images;
  std::vector<StampedFile> clouds;
  std::optional<std::filesystem::path> camera_file;  ///< camera.yaml
};

/// One folder of recordings/: recording.yaml and the tables beside it. Missing tables are nullopt
/// or empty; whatever is there was read and checked as a whole.
struct Recording {
  std::string name;  ///< of the folder
  std::filesystem::path folder;
  RecordingKind kind = RecordingKind::kFree;
  std::optional<MeasurementFrame> frame;  ///< `frame`; overrides that of the experiment
  /// `base_tilt_deg: [a, b]`: the base was turned by R = Ry(b) Rx(a).
  std::optional<Eigen::Vector2d> base_tilt_deg;
  bool camera_on_base = true;                       ///< the camera moves with a tilted base
  std::optional<Eigen::Isometry3d> T_robot_camera;  ///< overrides that of the experiment
  std::optional<geometry::PoseStandardError> T_robot_camera_error;  ///< of it; see PoseErrorOf
  std::optional<Reference> reference;
  std::optional<TimeWindow> steady_window_s;  ///< the static phase; absent: the whole recording
  std::string notes;

  std::optional<Actuation> actuation;
  std::optional<MarkerTracks> markers;  ///< as measured: see RobotFromMarkers
  std::vector<KnownLoad> loads;
  std::vector<StampedFile> depth_images;  ///< by rising time, as the next two
  std::vector<StampedFile> color_images;
  std::vector<StampedFile> clouds;
  std::optional<std::filesystem::path> camera_file;  ///< camera.yaml
  std::vector<CameraFiles> cameras;                  ///< beside the first, by name
  std::vector<CameraSettings> camera_settings;       ///< `cameras`; wins over the experiment's
};

/// Rotation R = Ry(b) Rx(a) of the base, identity without a tilt. Gravity in the robot frame, which
/// is fixed to the base, is R' g.
Eigen::Matrix3d BaseRotation(const Recording& recording);

/// Refuses markers, or cables and chambers, that the robot does not have: InputError with file:line
/// and "did you mean". `names` are the robot's; points without a name (IsUnlabelled) are passed
/// over.
void CheckMarkers(const Recording& recording, const std::vector<std::string>& names);
void CheckActuators(const Recording& recording, const std::vector<std::string>& cables,
                    const std::vector<std::string>& chambers);

/// Reads one recording folder. Throws InputError (file:line:column) at the first thing that is
/// wrong, so that nothing is ever half-read.
Recording ReadRecording(const std::filesystem::path& folder, const ConfigLoader& load);

/// The .pcd and .ply files of a folder, whose names are their times; other files are left alone.
/// Throws InputError for another name, or two of one time.
std::vector<StampedFile> ListClouds(const std::filesystem::path& folder);

/// Writes one recording folder, images copied. Throws InputError where the folder holds one
/// already, RunError where it cannot be written.
void WriteRecording(const Recording& recording, const std::filesystem::path& folder);

}  // namespace palpate::experiment
