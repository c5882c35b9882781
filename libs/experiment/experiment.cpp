// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/experiment.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "libs/core/config_reader.hpp"
#include "libs/core/file.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/cameras.hpp"
#include "libs/experiment/yaml_values.hpp"
#include "libs/geometry/pose_text.hpp"

namespace palpate::experiment {

namespace {

namespace fs = std::filesystem;

const KeyTable& DepthNoiseKeys() {
  static const KeyTable keys{
      .title = "depth noise",
      .about = "Noise of the depth camera.",
      .keys = {{"subpixel_px", value::Real(kNonNegative), kRequired,
                "Standard deviation of the disparity of a stereo camera. 0: unknown, or not a "
                "stereo camera."},
               {"unit_m", value::Real(kNonNegative), kRequired, "One step of the depth value."}}};
  return keys;
}

/// Of the catalogue of diagnosis.
constexpr const char* kCauses[] = {
    "youngs_modulus",
    "regional_stiffness",
    "poissons_ratio",
    "stiffening",
    "density",
    "viscoelastic_creep",
    "mullins",
    "plastic_set",
    "geometry_scale",
    "temperature",
    "rest_twist",
    "base_compliance",
    "gravity_direction",
    "payload",
    "permanent_force",
    "hidden_obstacle",
    "cable_friction",
    "cable_elasticity",
    "cable_cutting",
    "cable_gain",
    "cable_offset",
    "backlash",
    "cable_routing",
    "swapped_cables",
    "drive_coupling",
    "lag",
    "leak",
    "slow_valve",
    "blocked_valve",
    "pressure_gain",
    "pressure_zero",
    "swapped_tubes",
    "thin_wall",
    "camera_moved",
    "depth_scale",
    "depth_incidence_bias",
    "intrinsics",
    "lens_distortion",
    "flying_pixels",
    "warm_up_drift",
    "marker_misplacement",
    "discretisation",
};

/// The causes of the catalogue of diagnosis, and the tolerances that belong to no single cause.
const KeyTable& ToleranceKeys() {
  static const KeyTable keys = [] {
    KeyTable table{
        .title = "tolerances",
        .about =
            "Manufacturing tolerances (one standard deviation) that replace those of the "
            "catalogue of diagnosis. A value is for the first parameter of the cause that has a "
            "tolerance, in its unit; the other tolerances of the cause change in proportion."};
    for (const char* cause : kCauses) {
      table.keys.push_back(
          {cause, value::Real(kPositive), kOptional, "Tolerance of the cause of this name."});
    }
    table.keys.push_back({"extrinsics_m", value::Real(kPositive), kOptional,
                          "Standard error of the translation of `T_robot_camera`."});
    table.keys.push_back({"extrinsics_rad", value::Real(kPositive), kOptional,
                          "Standard error of the rotation of `T_robot_camera`."});
    table.keys.push_back(
        {"marker_bias_m", value::Real(kPositive), kOptional,
         "Standard deviation of each coordinate of the constant offset of a marker."});
    return table;
  }();
  return keys;
}

Eigen::Vector3d ReadSigma(const ConfigNode& node) {
  if (node.kind == ConfigNode::Kind::kList) return ReadVector3(node, kPositive);
  return Eigen::Vector3d::Constant(ReadNumber(node, kPositive));
}

DepthNoise ReadDepthNoise(const ConfigNode& node) {
  MapReader reader(node, DepthNoiseKeys());
  DepthNoise noise;
  reader.Read("subpixel_px", &noise.subpixel_px);
  reader.Read("unit_m", &noise.unit_m);
  reader.Finish();
  return noise;
}

std::map<std::string, double> ReadTolerances(const ConfigNode& node) {
  MapReader reader(node, ToleranceKeys());
  std::map<std::string, double> tolerances;
  for (const Key& key : ToleranceKeys().keys) {
    if (reader.Optional(key.name) != nullptr) reader.Read(key.name, &tolerances[key.name]);
  }
  reader.Finish();
  return tolerances;
}

std::string ReadSha256(const ConfigNode& node) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text = node.kind == ConfigNode::Kind::kScalar ? node.text : "";
  if (text.size() != 64 || text.find_first_not_of(kDigits) != std::string::npos) {
    Refuse(node, "must be a SHA-256: 64 digits of 0-9 and a-f");
  }
  return text;
}

std::string FormatTolerances(const std::map<std::string, double>& tolerances) {
  std::string text = "tolerances:\n";
  for (const auto& [key, value] : tolerances)
    text += "  " + key + ": " + FormatNumber(value) + "\n";
  return text;
}

}  // namespace

const KeyTable& ExperimentKeys() {
  static const KeyTable keys{
      .title = "experiment.yaml",
      .about = "What holds for all recordings of an experiment.",
      .keys = {
          {"robot", value::File(), kOptional, "Robot file of the robot that was measured."},
          {"frame", value::Choice({"robot", "camera"}), Default("robot"),
           "Measurement frame of markers: the robot frame, or the optical frame of the depth "
           "camera. Images and clouds are always in the camera's."},
          {"T_robot_camera", value::Map(geometry::MeasuredPoseKeys()), kOptional,
           "Pose of the depth camera: p_robot = T p_camera. Absent: unknown."},
          {"cameras", value::ListOfMaps(CameraSettingsKeys()), kOptional,
           "Depth cameras beside the first one, whose images lie in `cameras/<name>/`."},
          {"markers_sigma_m", value::Either({value::Real(kPositive), value::Vector3(kPositive)}),
           kOptional,
           "Standard deviation of the noise of a marker: one number, or `[x, y, z]` in the "
           "measurement frame."},
          {"depth_noise", value::Map(DepthNoiseKeys()), kOptional, "Noise of the depth camera."},
          {"tolerances", value::Map(ToleranceKeys()), kOptional,
           "Manufacturing tolerances that replace those of diagnosis."},
          {"rest_between_s", value::Real(kNonNegative), kOptional,
           "Rest before each recording, commands at zero. Absent: unknown."},
          {"notes", value::Text(), kOptional, "For people."},
          {"answer_sha256", value::Text(), kOptional,
           "SHA-256 of the answer file of a blind test (`palpate simulate`): 64 digits of 0-9 "
           "and a-f."}}};
  return keys;
}

Experiment ReadExperimentSettings(const fs::path& file, const ConfigLoader& load) {
  const ConfigNode root = load(file);
  MapReader reader(root, ExperimentKeys());
  Experiment experiment;
  experiment.folder = file.parent_path();
  if (reader.Optional("robot") != nullptr) reader.Read("robot", &experiment.robot.emplace());
  if (const ConfigNode* node = reader.Optional("frame")) {
    experiment.frame = ParseMeasurementFrame(ReadText(*node), node->where);
  }
  if (const ConfigNode* node = reader.Optional("T_robot_camera")) {
    experiment.T_robot_camera = geometry::ReadMeasuredPose(*node, &experiment.T_robot_camera_error);
  }
  if (const ConfigNode* node = reader.Optional("cameras")) {
    experiment.cameras = ReadCameraSettings(*node);
  }
  if (const ConfigNode* node = reader.Optional("markers_sigma_m")) {
    experiment.markers_sigma_m = ReadSigma(*node);
  }
  if (const ConfigNode* node = reader.Optional("depth_noise")) {
    experiment.depth_noise = ReadDepthNoise(*node);
  }
  if (const ConfigNode* node = reader.Optional("tolerances")) {
    experiment.tolerances = ReadTolerances(*node);
  }
  reader.Read("rest_between_s", &experiment.rest_between_s);
  reader.Read("notes", &experiment.notes);
  if (const ConfigNode* node = reader.Optional("answer_sha256")) {
    experiment.answer_sha256 = ReadSha256(*node);
  }
  reader.Finish();
  return experiment;
}

void WriteExperimentSettings(const Experiment& experiment, const fs::path& file) {
  std::string text;
  if (experiment.robot) {
    const fs::path base = fs::absolute(file).parent_path();
    const fs::path robot = fs::absolute(*experiment.robot).lexically_proximate(base);
    text += "robot: " + QuoteText(robot.generic_string()) + "\n";
  }
  text += "frame: " + ToString(experiment.frame) + "\n";
  if (experiment.T_robot_camera) {
    text += "T_robot_camera: " +
            geometry::FormatPose(*experiment.T_robot_camera, experiment.T_robot_camera_error) +
            "\n";
  }
  text += FormatCameraSettings(experiment.cameras);
  if (experiment.markers_sigma_m) {
    text += "markers_sigma_m: " + geometry::FormatVector(*experiment.markers_sigma_m) + "\n";
  }
  if (experiment.depth_noise) {
    text += "depth_noise: {subpixel_px: " + FormatNumber(experiment.depth_noise->subpixel_px) +
            ", unit_m: " + FormatNumber(experiment.depth_noise->unit_m) + "}\n";
  }
  if (!experiment.tolerances.empty()) text += FormatTolerances(experiment.tolerances);
  if (experiment.rest_between_s) {
    text += "rest_between_s: " + FormatNumber(*experiment.rest_between_s) + "\n";
  }
  if (!experiment.notes.empty()) text += "notes: " + QuoteText(experiment.notes) + "\n";
  if (experiment.answer_sha256) {
    text += "answer_sha256: " + QuoteText(*experiment.answer_sha256) + "\n";
  }
  WriteFile(file, text);
}

MeasurementFrame FrameOf(const Experiment& experiment, const Recording& recording) {
  return recording.frame.value_or(experiment.frame);
}

std::variant<Eigen::Isometry3d, NeedsCalibration> RobotFromMarkers(const Experiment& experiment,
                                                                   const Recording& recording) {
  if (FrameOf(experiment, recording) == MeasurementFrame::kRobot) {
    return Eigen::Isometry3d::Identity();
  }
  return RobotFromCamera(experiment, recording);
}

std::variant<Eigen::Isometry3d, NeedsCalibration> RobotFromCamera(const Experiment& experiment,
                                                                  const Recording& recording) {
  if (recording.T_robot_camera) return *recording.T_robot_camera;
  const std::string what = "recording '" + recording.name + "' is in the camera's frame";
  if (recording.kind == RecordingKind::kCameraMoved) {
    return NeedsCalibration{what + ", the camera was moved, and its T_robot_camera is not given"};
  }
  if (!experiment.T_robot_camera) {
    return NeedsCalibration{what +
                            " and no T_robot_camera is given; run palpate calibrate and give its "
                            "file, or import markers with --register"};
  }
  if (recording.camera_on_base) return *experiment.T_robot_camera;
  return Eigen::Isometry3d(BaseRotation(recording).transpose()) * *experiment.T_robot_camera;
}

geometry::PoseStandardError PoseErrorOf(const Experiment& experiment, const Recording& recording) {
  const auto& stated =
      recording.T_robot_camera ? recording.T_robot_camera_error : experiment.T_robot_camera_error;
  return stated.value_or(geometry::PoseStandardError{});
}

}  // namespace palpate::experiment
