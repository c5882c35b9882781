// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/calibration_file.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <utility>

#include "libs/core/config_reader.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/core/text.hpp"
#include "libs/geometry/pose_text.hpp"
#include "libs/robot/calibration_keys.hpp"

namespace palpate::robot {

namespace {

CalibratedModulus ReadModulus(const ConfigNode& node) {
  MapReader map(node, ModulusKeys());
  CalibratedModulus modulus;
  map.Read("part", &modulus.part);
  map.Read("youngs_modulus_Pa", &modulus.youngs_modulus_Pa);
  map.Read("standard_error_Pa", &modulus.standard_error_Pa);
  map.Finish();
  return modulus;
}

CalibratedPoissonsRatio ReadFoundPoissonsRatio(const ConfigNode& node) {
  MapReader map(node, PoissonsRatioKeys());
  CalibratedPoissonsRatio poissons;
  map.Read("part", &poissons.part);
  map.Read("poissons_ratio", &poissons.poissons_ratio);
  map.Read("standard_error", &poissons.standard_error);
  map.Finish();
  return poissons;
}

CalibratedPose ReadCalibratedPose(const ConfigNode& pose_node, const ConfigNode* error_node) {
  CalibratedPose pose;
  std::optional<geometry::PoseStandardError> stated;
  pose.T_robot_camera = geometry::ReadMeasuredPose(pose_node, &stated);
  const geometry::PoseStandardError error = stated.value_or(geometry::PoseStandardError{});
  pose.rotation_error_rad.setConstant(error.rotation_rad);
  pose.translation_error_m.setConstant(error.translation_m);
  if (error_node == nullptr) return pose;
  MapReader errors(*error_node, PoseErrorKeys());
  errors.Read("rotation_rad", &pose.rotation_error_rad);
  errors.Read("translation_m", &pose.translation_error_m);
  errors.Finish();
  return pose;
}

/// As folders and topics of cameras are named.
bool IsNameOfCamera(const std::string& name) {
  const auto is_letter = [](unsigned char c) { return std::isalpha(c) != 0; };
  return !name.empty() && is_letter(static_cast<unsigned char>(name.front())) &&
         std::all_of(name.begin(), name.end(), [&](unsigned char c) {
           return is_letter(c) || std::isdigit(c) != 0 || c == '_';
         });
}

CalibratedCamera ReadCamera(const ConfigNode& node) {
  MapReader map(node, CalibratedCameraKeys());
  CalibratedCamera camera;
  map.Read("name", &camera.name);
  if (!IsNameOfCamera(camera.name)) {
    Refuse(map.Require("name"), "is '" + Excerpt(camera.name) +
                                    "'; must be letters, digits and '_', a letter first: the name "
                                    "that the camera has in the experiment");
  }
  const ConfigNode& pose = map.Require("T_robot_camera");
  camera.pose = ReadCalibratedPose(pose, map.Optional("T_robot_camera_standard_error"));
  if (const ConfigNode* bias = map.Optional("depth_bias")) camera.depth_bias = ReadDepthBias(*bias);
  map.Finish();
  return camera;
}

/// The list `cameras`.
std::vector<CalibratedCamera> ReadCameras(const ConfigNode& list) {
  if (list.kind != ConfigNode::Kind::kList) Refuse(list, "must be a list");
  std::vector<CalibratedCamera> cameras;
  for (const ConfigNode& node : list.items) {
    CalibratedCamera camera = ReadCamera(node);
    const bool is_there =
        std::any_of(cameras.begin(), cameras.end(),
                    [&](const CalibratedCamera& other) { return other.name == camera.name; });
    if (is_there) {
      Refuse(node, "is camera '" + camera.name + "' again; a camera has one pose: remove one");
    }
    cameras.push_back(std::move(camera));
  }
  return cameras;
}

CalibratedDrive ReadDrive(const ConfigNode& node) {
  MapReader map(node, ActuatorKeys());
  CalibratedDrive drive;
  map.Read("cable", &drive.cable);
  map.Read("offset_m", &drive.drive.offset_m);
  map.Read("offset_standard_error_m", &drive.standard_error.offset_m);
  map.Read("gain", &drive.drive.gain);
  map.Read("gain_standard_error", &drive.standard_error.gain);
  map.Finish();
  return drive;
}

Undetermined ReadUndetermined(const ConfigNode& node) {
  MapReader map(node, UndeterminedKeys());
  Undetermined undetermined;
  map.Read("name", &undetermined.name);
  map.Read("what_would_tell", &undetermined.what_would_tell);
  map.Read("standard_error", &undetermined.standard_error);
  map.Read("limit", &undetermined.limit);
  map.Finish();
  return undetermined;
}

/// What the robot and the fit are that the calibration was made with.
void ReadHead(MapReader* map, CalibrationFile* calibration) {
  map->Read("robot", &calibration->robot);
  map->Read("mesh_hash", &calibration->mesh_hash);
  map->Read("element", &calibration->element);
  map->Read("model", &calibration->model);
  map->Read("poissons_ratio", &calibration->poissons_ratio);
  map->Read("volumetric", &calibration->volumetric);
  map->Read("c20_over_c10", &calibration->c20_over_c10);
  map->Read("c30_over_c10", &calibration->c30_over_c10);
  map->Read("date_utc", &calibration->date_utc);
  map->Read("data", &calibration->data);
  map->Read("data_hash", &calibration->data_hash);
}

/// The items of an optional list.
template <typename Item>
std::vector<Item> ReadItems(MapReader* map, const char* key, Item (*read)(const ConfigNode&)) {
  std::vector<Item> items;
  const ConfigNode* list = map->Optional(key);
  if (list == nullptr) return items;
  if (list->kind != ConfigNode::Kind::kList) Refuse(*list, "must be a list");
  for (const ConfigNode& node : list->items) items.push_back(read(node));
  return items;
}

std::string FormatMaterials(const CalibrationFile& calibration) {
  std::string text = calibration.moduli.empty() ? "" : "moduli:\n";
  for (const CalibratedModulus& modulus : calibration.moduli) {
    text += "  - {part: " + Quoted(modulus.part) +
            ", youngs_modulus_Pa: " + FormatNumber(modulus.youngs_modulus_Pa) +
            ", standard_error_Pa: " + FormatNumber(modulus.standard_error_Pa) + "}\n";
  }
  if (!calibration.poissons_ratios.empty()) text += "poissons_ratios:\n";
  for (const CalibratedPoissonsRatio& poissons : calibration.poissons_ratios) {
    text += "  - {part: " + Quoted(poissons.part) +
            ", poissons_ratio: " + FormatNumber(poissons.poissons_ratio) +
            ", standard_error: " + FormatNumber(poissons.standard_error) + "}\n";
  }
  return text;
}

std::string FormatGravity(const CalibratedGravity& gravity) {
  return "gravity_m_s2: " + geometry::FormatVector(gravity.gravity_m_s2) +
         "\ngravity_standard_error_m_s2: " + geometry::FormatVector(gravity.standard_error_m_s2) +
         "\n";
}

/// The pose carries the largest errors, too: then it is whole where it is copied elsewhere.
std::string FormatPoseAndErrors(const CalibratedPose& pose) {
  std::optional<geometry::PoseStandardError> error;
  if (pose.translation_error_m.maxCoeff() > 0.0 && pose.rotation_error_rad.maxCoeff() > 0.0) {
    error = {pose.translation_error_m.maxCoeff(), pose.rotation_error_rad.maxCoeff()};
  }
  return "T_robot_camera: " + geometry::FormatPose(pose.T_robot_camera, error) +
         "\nT_robot_camera_standard_error: {rotation_rad: " +
         geometry::FormatVector(pose.rotation_error_rad) +
         ", translation_m: " + geometry::FormatVector(pose.translation_error_m) + "}\n";
}

/// Each line of `text` as one of an item of a list.
std::string AsItem(const std::string& text) {
  std::string item;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
    item += "    " + text.substr(begin, end - begin);
    begin = end;
  }
  return item;
}

std::string FormatCameras(const std::vector<CalibratedCamera>& cameras) {
  if (cameras.empty()) return {};
  std::string text = "cameras:\n";
  for (const CalibratedCamera& camera : cameras) {
    text += "  - name: " + Quoted(camera.name) + "\n" + AsItem(FormatPoseAndErrors(camera.pose));
    if (camera.depth_bias) text += AsItem(FormatDepthBias(*camera.depth_bias));
  }
  return text;
}

std::string FormatDrives(const std::vector<CalibratedDrive>& drives) {
  if (drives.empty()) return {};
  std::string text = "drives:\n";
  for (const CalibratedDrive& drive : drives) {
    text += "  - {cable: " + Quoted(drive.cable) +
            ", offset_m: " + FormatNumber(drive.drive.offset_m) +
            ", offset_standard_error_m: " + FormatNumber(drive.standard_error.offset_m) +
            ", gain: " + FormatNumber(drive.drive.gain) +
            ", gain_standard_error: " + FormatNumber(drive.standard_error.gain) + "}\n";
  }
  return text;
}

std::string FormatUndetermined(const std::vector<Undetermined>& undetermined) {
  if (undetermined.empty()) return {};
  std::string text = "undetermined:\n";
  for (const Undetermined& number : undetermined) {
    text += "  - {name: " + Quoted(number.name) +
            ", what_would_tell: " + Quoted(number.what_would_tell) +
            ", standard_error: " + FormatNumber(number.standard_error) +
            ", limit: " + FormatNumber(number.limit) + "}\n";
  }
  return text;
}

}  // namespace

CalibrationFile ReadCalibrationFile(const std::filesystem::path& file, const ConfigLoader& load) {
  const ConfigNode root = load(file);
  MapReader map(root, CalibrationFileKeys());
  CalibrationFile calibration;
  ReadHead(&map, &calibration);
  calibration.moduli = ReadItems(&map, "moduli", ReadModulus);
  calibration.poissons_ratios = ReadItems(&map, "poissons_ratios", ReadFoundPoissonsRatio);
  if (map.Optional("gravity_m_s2") != nullptr) {
    calibration.gravity.emplace();
    map.Read("gravity_m_s2", &calibration.gravity->gravity_m_s2);
    map.Read("gravity_standard_error_m_s2", &calibration.gravity->standard_error_m_s2);
  }
  if (const ConfigNode* pose = map.Optional("T_robot_camera")) {
    calibration.pose = ReadCalibratedPose(*pose, map.Optional("T_robot_camera_standard_error"));
  }
  if (const ConfigNode* bias = map.Optional("depth_bias")) {
    if (!calibration.pose) Refuse(*bias, "needs T_robot_camera, which it was found with");
    calibration.depth_bias = ReadDepthBias(*bias);
  }
  if (const ConfigNode* list = map.Optional("cameras")) calibration.cameras = ReadCameras(*list);
  calibration.drives = ReadItems(&map, "drives", ReadDrive);
  calibration.pressure_sensors = ReadItems(&map, "pressure_sensors", ReadPressureSensor);
  if (const ConfigNode* scale = map.Optional("geometry_scale")) {
    calibration.geometry_scale = ReadGeometryScale(*scale);
  }
  calibration.cable_routes = ReadItems(&map, "cable_routes", ReadCableRoute);
  calibration.undetermined = ReadItems(&map, "undetermined", ReadUndetermined);
  if (calibration.moduli.empty() && calibration.poissons_ratios.empty() && !calibration.gravity &&
      !calibration.pose && calibration.drives.empty() && calibration.pressure_sensors.empty() &&
      !calibration.geometry_scale && calibration.cable_routes.empty()) {
    Refuse(root,
           "must hold moduli, poissons_ratios, gravity_m_s2, T_robot_camera, drives, "
           "pressure_sensors, geometry_scale or cable_routes: what was calibrated");
  }
  map.Read("residual_rms_m", &calibration.residual_rms_m);
  map.Read("chi_squared", &calibration.chi_squared);
  map.Read("degrees_of_freedom", &calibration.degrees_of_freedom);
  map.Finish();
  return calibration;
}

void WriteCalibrationFile(const CalibrationFile& calibration, const std::filesystem::path& file) {
  std::string text = "# Made by palpate calibrate. Moduli hold for this mesh and element only.\n";
  text += "robot: " + Quoted(calibration.robot) + "\n";
  text += "mesh_hash: " + Quoted(calibration.mesh_hash) + "\n";
  text += "element: " + calibration.element + "\n";
  text += "model: " + calibration.model + "\n";
  text += "poissons_ratio: " + FormatNumber(calibration.poissons_ratio) + "\n";
  if (!calibration.volumetric.empty()) text += "volumetric: " + calibration.volumetric + "\n";
  if (calibration.model == fem::ToString(fem::MaterialModel::kYeoh)) {
    text += "c20_over_c10: " + FormatNumber(calibration.c20_over_c10) + "\n";
    text += "c30_over_c10: " + FormatNumber(calibration.c30_over_c10) + "\n";
  }
  text += "date_utc: " + Quoted(calibration.date_utc) + "\n";
  text += "data: " + Quoted(calibration.data) + "\n";
  text += "data_hash: " + Quoted(calibration.data_hash) + "\n";
  text += FormatMaterials(calibration);
  if (calibration.gravity) text += FormatGravity(*calibration.gravity);
  if (calibration.pose) text += FormatPoseAndErrors(*calibration.pose);
  if (calibration.depth_bias) text += FormatDepthBias(*calibration.depth_bias);
  text += FormatCameras(calibration.cameras);
  text += FormatDrives(calibration.drives);
  text += FormatPressureSensors(calibration.pressure_sensors);
  text += FormatGeometry(calibration.geometry_scale, calibration.cable_routes);
  text += FormatUndetermined(calibration.undetermined);
  text += "residual_rms_m: " + FormatNumber(calibration.residual_rms_m) + "\n";
  text += "chi_squared: " + FormatNumber(calibration.chi_squared) + "\n";
  text += "degrees_of_freedom: " + std::to_string(calibration.degrees_of_freedom) + "\n";
  WriteFile(file, text);
}

}  // namespace palpate::robot
