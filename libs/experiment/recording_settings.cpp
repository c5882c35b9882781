// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/recording_settings.hpp"

#include "libs/core/config_reader.hpp"
#include "libs/experiment/cameras.hpp"
#include "libs/experiment/yaml_values.hpp"
#include "libs/geometry/pose_text.hpp"

namespace palpate::experiment {

namespace {

constexpr double kLargestTilt_deg = 180.0;
constexpr NumberRule kTiltRule{.min = -kLargestTilt_deg, .max = kLargestTilt_deg};

Eigen::Vector2d ReadTilt(const ConfigNode& node) {
  const std::vector<double> angles_deg = ReadNumbers(node, kTiltRule);
  if (angles_deg.size() != 2) Refuse(node, "must be [about x, about y] in degrees");
  return {angles_deg[0], angles_deg[1]};
}

const KeyTable& ReferenceKeys() {
  static const KeyTable keys{
      .title = "reference",
      .about = "Marker displacements of the recording count from their mean over this window.",
      .keys = {{"window_s", value::Numbers({}, 2, 2), kRequired, "`[begin, end]`, begin < end."},
               {"shape", value::Choice({"undeformed", "equilibrium"}), kRequired,
                "Shape of the body during the window. `undeformed`: held in its undeformed shape. "
                "`equilibrium`: at rest under its weight and cables, without contact."}}};
  return keys;
}

Reference ReadReference(const ConfigNode& node) {
  MapReader reader(node, ReferenceKeys());
  Reference reference;
  reference.window_s = ReadWindow(reader.Require("window_s"));
  std::string shape;
  reader.Read("shape", &shape);
  reference.shape =
      shape == "undeformed" ? ReferenceShape::kUndeformed : ReferenceShape::kEquilibrium;
  reader.Finish();
  return reference;
}

}  // namespace

const KeyTable& RecordingKeys() {
  static const KeyTable keys{
      .title = "recording.yaml",
      .about = "What was done in one recording, and what differs from experiment.yaml.",
      .keys = {
          {"kind", value::Choice(RecordingKindWords()), kRequired,
           "What was done, see the kinds of recordings."},
          {"frame", value::Choice({"robot", "camera"}), kOptional,
           "Measurement frame of markers. Absent: that of experiment.yaml."},
          {"base_tilt_deg", value::Numbers(kTiltRule, 2, 2), kOptional,
           "`[a, b]`: the base was turned by R = Ry(b) Rx(a). The robot frame is fixed to the "
           "base, so that gravity in it becomes R' g. Absent: not tilted."},
          {"camera_on_base", value::Boolean(), Default(Recording{}.camera_on_base),
           "The camera moves with a tilted base."},
          {"T_robot_camera", value::Map(geometry::MeasuredPoseKeys()), kOptional,
           "Pose of the depth camera during this recording. Absent: that of experiment.yaml, "
           "or unknown for `kind: camera_moved`."},
          {"cameras", value::ListOfMaps(CameraSettingsKeys()), kOptional,
           "What differs in this recording of cameras beside the first one."},
          {"reference", value::Map(ReferenceKeys()), kOptional,
           "Window from which marker displacements count. Absent: markers are positions."},
          {"steady_window_s", value::Numbers({}, 2, 2), kOptional,
           "`[begin, end]`: the static phase, begin < end. Absent: the whole recording."},
          {"frame_rate_Hz", value::Real(kPositive), kOptional,
           "Names in depth/, color/ and clouds/ end in the number of the frame, t_s = number / "
           "frame_rate_Hz. Absent: names are times."},
          {"notes", value::Text(), kOptional, "For people."}}};
  return keys;
}

std::optional<double> ReadRecordingSettings(const std::filesystem::path& file,
                                            const ConfigLoader& load, Recording& recording) {
  const ConfigNode root = load(file);
  MapReader reader(root, RecordingKeys());
  const ConfigNode& kind = reader.Require("kind");
  recording.kind = ParseRecordingKind(ReadText(kind), kind.where);
  if (const ConfigNode* node = reader.Optional("frame")) {
    recording.frame = ParseMeasurementFrame(ReadText(*node), node->where);
  }
  if (const ConfigNode* node = reader.Optional("base_tilt_deg")) {
    recording.base_tilt_deg = ReadTilt(*node);
  }
  reader.Read("camera_on_base", &recording.camera_on_base);
  if (const ConfigNode* node = reader.Optional("T_robot_camera")) {
    recording.T_robot_camera = geometry::ReadMeasuredPose(*node, &recording.T_robot_camera_error);
  }
  if (const ConfigNode* node = reader.Optional("cameras")) {
    recording.camera_settings = ReadCameraSettings(*node);
  }
  if (const ConfigNode* node = reader.Optional("reference")) {
    recording.reference = ReadReference(*node);
  }
  if (const ConfigNode* node = reader.Optional("steady_window_s")) {
    recording.steady_window_s = ReadWindow(*node);
  }
  std::optional<double> frame_rate_Hz;
  reader.Read("frame_rate_Hz", &frame_rate_Hz);
  reader.Read("notes", &recording.notes);
  reader.Finish();
  return frame_rate_Hz;
}

std::string FormatRecordingSettings(const Recording& recording) {
  std::string text = "kind: " + ToString(recording.kind) + "\n";
  if (recording.frame) text += "frame: " + ToString(*recording.frame) + "\n";
  if (recording.base_tilt_deg) {
    text += "base_tilt_deg: " + geometry::FormatVector(*recording.base_tilt_deg) + "\n";
  }
  if (!recording.camera_on_base) text += "camera_on_base: false\n";
  if (recording.T_robot_camera) {
    text += "T_robot_camera: " +
            geometry::FormatPose(*recording.T_robot_camera, recording.T_robot_camera_error) + "\n";
  }
  text += FormatCameraSettings(recording.camera_settings);
  if (recording.reference) {
    const bool undeformed = recording.reference->shape == ReferenceShape::kUndeformed;
    text += "reference: {window_s: " + FormatWindow(recording.reference->window_s) +
            ", shape: " + (undeformed ? "undeformed" : "equilibrium") + "}\n";
  }
  if (recording.steady_window_s) {
    text += "steady_window_s: " + FormatWindow(*recording.steady_window_s) + "\n";
  }
  if (!recording.notes.empty()) text += "notes: " + QuoteText(recording.notes) + "\n";
  return text;
}

}  // namespace palpate::experiment
