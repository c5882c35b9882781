// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/cameras.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <set>

#include "libs/core/config_reader.hpp"
#include "libs/core/text.hpp"
#include "libs/geometry/pose_text.hpp"

namespace palpate::experiment {

namespace {

/// Clocks may count from any day; nanoseconds of more do not fit in 64 bits.
constexpr NumberRule kClockOffset{.min = -4e9, .max = 4e9};

const CameraSettings* Find(const std::vector<CameraSettings>& cameras, const std::string& name) {
  const auto found = std::find_if(cameras.begin(), cameras.end(),
                                  [&](const auto& camera) { return camera.name == name; });
  return found == cameras.end() ? nullptr : &*found;
}

CameraSettings ReadOne(const ConfigNode& node) {
  MapReader reader(node, CameraSettingsKeys());
  CameraSettings camera;
  reader.Read("name", &camera.name);
  if (!IsCameraName(camera.name)) {
    Refuse(reader.Require("name"),
           "is '" + camera.name + "'; must be letters, digits and '_', a letter first");
  }
  if (const ConfigNode* pose = reader.Optional("T_robot_camera")) {
    camera.T_robot_camera = geometry::ReadMeasuredPose(*pose, &camera.T_robot_camera_error);
  }
  reader.Read("clock_offset_s", &camera.clock_offset_s);
  reader.Finish();
  return camera;
}

void Shift(std::int64_t by_ns, std::vector<StampedFile>* files) {
  for (StampedFile& file : *files) file.t_ns -= by_ns;
}

double ClockOffset_s(const Experiment& experiment, const Recording& recording,
                     const std::string& name) {
  for (const auto* cameras : {&recording.camera_settings, &experiment.cameras}) {
    const CameraSettings* settings = Find(*cameras, name);
    if (settings != nullptr && settings->clock_offset_s) return *settings->clock_offset_s;
  }
  return 0.0;
}

}  // namespace

const KeyTable& CameraSettingsKeys() {
  static const KeyTable keys{
      .title = "further camera",
      .about = "A depth camera beside the first one. Its images lie in `cameras/<name>/`.",
      .keys = {{"name", value::Text(), kRequired,
                "Name of its folder: letters, digits and `_`, a letter first."},
               {"T_robot_camera", value::Map(geometry::MeasuredPoseKeys()), kOptional,
                "Its pose: p_robot = T p_camera. Absent: in recording.yaml that of "
                "experiment.yaml, there unknown."},
               {"clock_offset_s", value::Real(kClockOffset), kOptional,
                "Its stamps less the time `t_s` of the tables. Absent: in recording.yaml that of "
                "experiment.yaml, there 0."}}};
  return keys;
}

bool IsCameraName(const std::string& name) {
  const auto is_letter = [](unsigned char c) { return std::isalpha(c) != 0; };
  return !name.empty() && is_letter(static_cast<unsigned char>(name.front())) &&
         std::all_of(name.begin(), name.end(), [&](unsigned char c) {
           return is_letter(c) || std::isdigit(c) != 0 || c == '_';
         });
}

std::vector<CameraSettings> ReadCameraSettings(const ConfigNode& list) {
  if (list.kind != ConfigNode::Kind::kList) Refuse(list, "must be a list of {name, ...}");
  std::vector<CameraSettings> cameras;
  for (const ConfigNode& item : list.items) {
    CameraSettings camera = ReadOne(item);
    if (Find(cameras, camera.name) != nullptr) {
      Refuse(item, "the camera '" + camera.name + "' is there twice");
    }
    cameras.push_back(std::move(camera));
  }
  return cameras;
}

std::string FormatCameraSettings(const std::vector<CameraSettings>& cameras) {
  if (cameras.empty()) return {};
  std::string text = "cameras:\n";
  for (const CameraSettings& camera : cameras) {
    text += "  - name: " + camera.name + "\n";
    if (camera.T_robot_camera) {
      text += "    T_robot_camera: " +
              geometry::FormatPose(*camera.T_robot_camera, camera.T_robot_camera_error) + "\n";
    }
    if (camera.clock_offset_s) {
      text += "    clock_offset_s: " + FormatNumber(*camera.clock_offset_s) + "\n";
    }
  }
  return text;
}

std::vector<std::string> FurtherCameras(const Experiment& experiment) {
  std::set<std::string> names;
  for (const Recording& recording : experiment.recordings) {
    for (const CameraFiles& camera : recording.cameras) names.insert(camera.name);
  }
  return {names.begin(), names.end()};
}

Recording OfCamera(const Experiment& experiment, const Recording& recording,
                   const std::string& name) {
  Recording alone = recording;
  alone.depth_images.clear();
  alone.color_images.clear();
  alone.clouds.clear();
  alone.camera_file.reset();
  alone.T_robot_camera.reset();
  alone.T_robot_camera_error.reset();
  alone.cameras.clear();
  alone.camera_settings.clear();
  if (const CameraSettings* settings = Find(recording.camera_settings, name)) {
    alone.T_robot_camera = settings->T_robot_camera;
    alone.T_robot_camera_error = settings->T_robot_camera_error;
  }
  for (const CameraFiles& camera : recording.cameras) {
    if (camera.name != name) continue;
    alone.folder = camera.folder;
    alone.depth_images = camera.depth_images;
    alone.color_images = camera.color_images;
    alone.clouds = camera.clouds;
    alone.camera_file = camera.camera_file;
  }
  const std::int64_t offset_ns = std::llround(1e9 * ClockOffset_s(experiment, recording, name));
  for (auto* files : {&alone.depth_images, &alone.color_images, &alone.clouds}) {
    Shift(offset_ns, files);
  }
  return alone;
}

Experiment OfCamera(const Experiment& experiment, const std::string& name) {
  Experiment alone = experiment;
  alone.T_robot_camera.reset();
  alone.T_robot_camera_error.reset();
  alone.cameras.clear();
  if (const CameraSettings* settings = Find(experiment.cameras, name)) {
    alone.T_robot_camera = settings->T_robot_camera;
    alone.T_robot_camera_error = settings->T_robot_camera_error;
  }
  for (Recording& recording : alone.recordings) recording = OfCamera(experiment, recording, name);
  return alone;
}

void SetPose(const std::string& name, const Eigen::Isometry3d& T_robot_camera,
             const geometry::PoseStandardError& error, Experiment* experiment) {
  auto& cameras = experiment->cameras;
  auto camera = std::find_if(cameras.begin(), cameras.end(),
                             [&](const CameraSettings& one) { return one.name == name; });
  if (camera == cameras.end()) {
    camera = cameras.insert(camera, CameraSettings{});
    camera->name = name;
  }
  camera->T_robot_camera = T_robot_camera;
  camera->T_robot_camera_error = error;
}

}  // namespace palpate::experiment
