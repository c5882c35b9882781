// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/calibrate/calibration_output.hpp"

#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "components/palpate/choose_recordings.hpp"
#include "libs/core/error.hpp"
#include "libs/geometry/pose_text.hpp"

namespace palpate::command {

namespace {

std::vector<double> ToList(const Eigen::Vector3d& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

void PrintCamera(const robot::CalibratedPose& pose,
                 const std::optional<robot::CalibratedDepthBias>& depth_bias) {
  constexpr double kDegrees = 57.29577951308232;
  fmt::print("T_robot_camera: {}\n", geometry::FormatPose(pose.T_robot_camera));
  fmt::print("  standard error: {:.2f} mm, {:.3f} degrees\n", 1e3 * pose.translation_error_m.norm(),
             kDegrees * pose.rotation_error_rad.norm());
  if (!depth_bias) return;
  fmt::print("depth bias: {:.2f} % of z at the image centre; the file has the map\n",
             100.0 * depth_bias->map.coefficients[0]);
}

void PrintCameras(const std::vector<robot::CalibratedCamera>& cameras) {
  for (const robot::CalibratedCamera& camera : cameras) {
    fmt::print("camera '{}': ", camera.name);
    PrintCamera(camera.pose, camera.depth_bias);
  }
}

nlohmann::ordered_json ToJson(const robot::CalibratedPose& found) {
  const Eigen::Isometry3d& pose = found.T_robot_camera;
  const Eigen::Quaterniond rotation(pose.linear());
  return {{"translation_m", ToList(pose.translation())},
          {"rotation_xyzw", {rotation.x(), rotation.y(), rotation.z(), rotation.w()}},
          {"rotation_standard_error_rad", ToList(found.rotation_error_rad)},
          {"translation_standard_error_m", ToList(found.translation_error_m)}};
}

void PrintGeometry(const robot::CalibrationFile& file) {
  if (file.geometry_scale) {
    fmt::print("size: {:.4f} of the robot file's (standard error {:.4f})\n",
               file.geometry_scale->scale, file.geometry_scale->standard_error);
  }
  for (const robot::CalibratedRoute& route : file.cable_routes) {
    const std::string point =
        route.point == 0 ? "fixed point" : "eyelet " + std::to_string(route.point);
    fmt::print("{} of {}: moved by {} m (standard error {} m)\n", point, route.cable,
               geometry::FormatVector(route.moved_m),
               geometry::FormatVector(route.standard_error_m));
  }
}

void AddGeometry(const robot::CalibrationFile& file, nlohmann::ordered_json* json) {
  if (file.geometry_scale) {
    (*json)["geometry_scale"] = {{"scale", file.geometry_scale->scale},
                                 {"standard_error", file.geometry_scale->standard_error}};
  }
  for (const robot::CalibratedRoute& route : file.cable_routes) {
    (*json)["cable_routes"].push_back({{"cable", route.cable},
                                       {"point", route.point},
                                       {"moved_m", ToList(route.moved_m)},
                                       {"standard_error_m", ToList(route.standard_error_m)}});
  }
}

}  // namespace

std::string FailureText(const Status& status) {
  return "the fit failed (" + std::string(ToString(status.code())) + "): " + status.message();
}

void RequireFit(const Status& status) {
  if (!status.ok()) throw RunError(FailureText(status));
}

std::string UndeterminedText(const robot::Undetermined& number) {
  std::string reached;
  if (number.limit > 0.0) {
    reached = fmt::format(" (standard error {:.3g}, at most {:.3g} counts)", number.standard_error,
                          number.limit);
  }
  return fmt::format(
      "{} is not determined by these data{} and keeps its value; to determine it: {}", number.name,
      reached, number.what_would_tell);
}

namespace {

std::string SensorText(const robot::CalibratedPressureSensor& sensor) {
  std::string text;
  if (sensor.zero_Pa) {
    text += fmt::format(" zero {:.0f} Pa (standard error {:.0f} Pa)", sensor.zero_Pa->value,
                        sensor.zero_Pa->standard_error);
  }
  if (sensor.gain) {
    text += fmt::format("{} gain {:.2f} % ({:.2f} %)", text.empty() ? "" : ",",
                        100.0 * sensor.gain->value, 100.0 * sensor.gain->standard_error);
  }
  return text;
}

nlohmann::ordered_json ToJson(const robot::CalibratedPressureSensor& sensor) {
  nlohmann::ordered_json json = {{"chamber", sensor.chamber}};
  if (sensor.zero_Pa) {
    json["zero_Pa"] = sensor.zero_Pa->value;
    json["zero_standard_error_Pa"] = sensor.zero_Pa->standard_error;
  }
  if (sensor.gain) {
    json["gain"] = sensor.gain->value;
    json["gain_standard_error"] = sensor.gain->standard_error;
  }
  return json;
}

}  // namespace

void PrintCalibration(const robot::CalibrationFile& file) {
  for (const robot::CalibratedModulus& modulus : file.moduli) {
    fmt::print("E of {}: {:.2f} kPa, standard error {:.2f} kPa ({:.2g} %)\n", modulus.part,
               1e-3 * modulus.youngs_modulus_Pa, 1e-3 * modulus.standard_error_Pa,
               100.0 * modulus.standard_error_Pa / modulus.youngs_modulus_Pa);
  }
  for (const robot::CalibratedPoissonsRatio& poissons : file.poissons_ratios) {
    fmt::print("Poisson's ratio of {}: {:.4f}, standard error {:.4f}\n", poissons.part,
               poissons.poissons_ratio, poissons.standard_error);
  }
  if (file.gravity) {
    fmt::print("gravity: {} m/s^2, standard error {}\n",
               geometry::FormatVector(file.gravity->gravity_m_s2),
               geometry::FormatVector(file.gravity->standard_error_m_s2));
  }
  if (file.pose) PrintCamera(*file.pose, file.depth_bias);
  PrintCameras(file.cameras);
  for (const robot::CalibratedDrive& drive : file.drives) {
    fmt::print(
        "actuator of {}: offset {:.3f} mm (standard error {:.3f} mm), gain {:.2f} % ({:.2f} %)\n",
        drive.cable, 1e3 * drive.drive.offset_m, 1e3 * drive.standard_error.offset_m,
        100.0 * drive.drive.gain, 100.0 * drive.standard_error.gain);
  }
  for (const robot::CalibratedPressureSensor& sensor : file.pressure_sensors) {
    fmt::print("pressure sensor of {}:{}\n", sensor.chamber, SensorText(sensor));
  }
  PrintGeometry(file);
  for (const robot::Undetermined& number : file.undetermined) {
    fmt::print("{}\n", UndeterminedText(number));
  }
}

void PrintCalibrationJson(const robot::CalibrationFile& file) {
  nlohmann::ordered_json moduli = nlohmann::ordered_json::array();
  for (const robot::CalibratedModulus& modulus : file.moduli) {
    moduli.push_back({{"part", modulus.part},
                      {"youngs_modulus_Pa", modulus.youngs_modulus_Pa},
                      {"standard_error_Pa", modulus.standard_error_Pa}});
  }
  nlohmann::ordered_json json = {{"robot", file.robot},
                                 {"mesh_hash", file.mesh_hash},
                                 {"element", file.element},
                                 {"model", file.model},
                                 {"data", file.data},
                                 {"data_hash", file.data_hash},
                                 {"moduli", moduli},
                                 {"residual_rms_m", file.residual_rms_m},
                                 {"chi_squared", file.chi_squared},
                                 {"degrees_of_freedom", file.degrees_of_freedom}};
  for (const robot::CalibratedPoissonsRatio& poissons : file.poissons_ratios) {
    json["poissons_ratios"].push_back({{"part", poissons.part},
                                       {"poissons_ratio", poissons.poissons_ratio},
                                       {"standard_error", poissons.standard_error}});
  }
  if (file.gravity) {
    json["gravity_m_s2"] = ToList(file.gravity->gravity_m_s2);
    json["gravity_standard_error_m_s2"] = ToList(file.gravity->standard_error_m_s2);
  }
  if (file.pose) json["T_robot_camera"] = ToJson(*file.pose);
  for (const robot::CalibratedCamera& camera : file.cameras) {
    json["cameras"].push_back({{"name", camera.name}, {"T_robot_camera", ToJson(camera.pose)}});
  }
  for (const robot::CalibratedDrive& drive : file.drives) {
    json["drives"].push_back({{"cable", drive.cable},
                              {"offset_m", drive.drive.offset_m},
                              {"offset_standard_error_m", drive.standard_error.offset_m},
                              {"gain", drive.drive.gain},
                              {"gain_standard_error", drive.standard_error.gain}});
  }
  for (const robot::CalibratedPressureSensor& sensor : file.pressure_sensors) {
    json["pressure_sensors"].push_back(ToJson(sensor));
  }
  AddGeometry(file, &json);
  for (const robot::Undetermined& number : file.undetermined) {
    json["undetermined"].push_back({{"name", number.name},
                                    {"what_would_tell", number.what_would_tell},
                                    {"standard_error", number.standard_error},
                                    {"limit", number.limit}});
  }
  fmt::print("{}\n", json.dump(2));
}

}  // namespace palpate::command
