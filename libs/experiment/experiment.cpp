// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/experiment.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "libs/core/config_reader.hpp"
#include "libs/core/file.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/yaml_values.hpp"
#include "libs/geometry/pose_text.hpp"

namespace palpate::experiment {

namespace {

namespace fs = std::filesystem;

// The causes of DIAGNOSIS.md, and the tolerances that belong to no single cause.
const std::vector<std::string> kToleranceKeys = {"youngs_modulus",
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
                                                 "camera_moved",
                                                 "depth_scale",
                                                 "depth_incidence_bias",
                                                 "intrinsics",
                                                 "lens_distortion",
                                                 "flying_pixels",
                                                 "warm_up_drift",
                                                 "marker_misplacement",
                                                 "discretisation",
                                                 "extrinsics_m",
                                                 "extrinsics_rad",
                                                 "marker_bias_m"};

Eigen::Vector3d ReadSigma(const ConfigNode& node) {
  if (node.kind == ConfigNode::Kind::kList) return ReadVector3(node, kPositive);
  return Eigen::Vector3d::Constant(ReadNumber(node, kPositive));
}

DepthNoise ReadDepthNoise(const ConfigNode& node) {
  MapReader reader(node);
  DepthNoise noise;
  noise.subpixel_px = ReadNumber(reader.Require("subpixel_px"), kNonNegative);
  noise.unit_m = ReadNumber(reader.Require("unit_m"), kNonNegative);
  reader.Finish();
  return noise;
}

std::map<std::string, double> ReadTolerances(const ConfigNode& node) {
  MapReader reader(node);
  std::map<std::string, double> tolerances;
  for (const std::string& key : kToleranceKeys) {
    if (const ConfigNode* entry = reader.Optional(key)) {
      tolerances[key] = ReadNumber(*entry, kPositive);
    }
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

fs::path Resolve(const fs::path& file, const std::string& named) {
  return (file.parent_path() / named).lexically_normal();
}

std::string FormatTolerances(const std::map<std::string, double>& tolerances) {
  std::string text = "tolerances:\n";
  for (const auto& [key, value] : tolerances)
    text += "  " + key + ": " + FormatNumber(value) + "\n";
  return text;
}

}  // namespace

Experiment ReadExperimentSettings(const fs::path& file, const ConfigLoader& load) {
  const ConfigNode root = load(file);
  MapReader reader(root);
  Experiment experiment;
  experiment.folder = file.parent_path();
  if (const ConfigNode* node = reader.Optional("robot")) {
    experiment.robot = Resolve(file, ReadText(*node));
  }
  if (const ConfigNode* node = reader.Optional("frame")) {
    experiment.frame = ParseMeasurementFrame(ReadText(*node), node->where);
  }
  if (const ConfigNode* node = reader.Optional("T_robot_camera")) {
    experiment.T_robot_camera = geometry::ReadPose(*node);
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
  if (const ConfigNode* node = reader.Optional("rest_between_s")) {
    experiment.rest_between_s = ReadNumber(*node, kNonNegative);
  }
  if (const ConfigNode* node = reader.Optional("notes")) experiment.notes = ReadText(*node);
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
    text += "T_robot_camera: " + geometry::FormatPose(*experiment.T_robot_camera) + "\n";
  }
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
    return NeedsCalibration{what + " and no T_robot_camera is given"};
  }
  if (recording.camera_on_base) return *experiment.T_robot_camera;
  return Eigen::Isometry3d(BaseRotation(recording).transpose()) * *experiment.T_robot_camera;
}

}  // namespace palpate::experiment
