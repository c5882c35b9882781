// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/node/calibration_input.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "libs/core/index.hpp"
#include "libs/dds/depth_picture.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/invalid_message.hpp"

namespace palpate::force_estimation {

namespace {

using dds::Invalid;

bool IsError(double value) { return std::isfinite(value) && value >= 0.0; }

void ReadHead(const idl::palpate_msgs::Calibration& message, robot::CalibrationFile* file) {
  file->robot = dds::Text(message.robot);
  file->mesh_hash = dds::Text(message.mesh_hash);
  file->element = dds::Text(message.element);
  file->model = dds::Text(message.material_model);
  file->poissons_ratio = message.poissons_ratio;
  file->volumetric = dds::Text(message.volumetric);
  file->c20_over_c10 = message.c20_over_c10;
  file->c30_over_c10 = message.c30_over_c10;
  file->date_utc = dds::Text(message.date_utc);
  file->data = dds::Text(message.data);
  file->data_hash = dds::Text(message.data_hash);
  file->residual_rms_m = message.residual_rms_m;
  file->chi_squared = message.chi_squared;
  file->degrees_of_freedom = static_cast<int>(message.degrees_of_freedom);
}

/// Of Calibration or CalibratedCamera, which hold a pose.
template <typename Source>
Status ReadPoseOf(const Source& message, robot::CalibratedPose* pose) {
  if (!dds::FromPose(message.camera_in_robot, &pose->T_robot_camera)) {
    return Invalid("camera_in_robot is no pose");
  }
  for (int i = 0; i < 3; ++i) {
    const double shift_m2 = message.camera_covariance[7 * i];
    const double turn_rad2 = message.camera_covariance[7 * (i + 3)];
    if (!IsError(shift_m2) || !IsError(turn_rad2)) return Invalid("camera_covariance is none");
    pose->translation_error_m[i] = std::sqrt(shift_m2);
    pose->rotation_error_rad[i] = std::sqrt(turn_rad2);
  }
  return Status::Ok();
}

/// Of the same.
template <typename Source>
Status ReadDepthBiasOf(const Source& message, std::optional<robot::CalibratedDepthBias>* into) {
  into->reset();
  if (!message.has_depth_bias) return Status::Ok();
  const auto& source = message.depth_bias;
  robot::CalibratedDepthBias& bias = into->emplace();
  bias.picture = dds::ToPicture(source.picture);
  bias.map.basis = {.order = static_cast<int>(source.order), .span = source.span};
  bias.map.coefficients =
      Eigen::Map<const Eigen::VectorXd>(source.coefficients._buffer, source.coefficients._length);
  const std::size_t rows = 6 + source.coefficients._length;
  if (source.covariance._length != rows * rows) return Invalid("depth_bias has no covariance");
  bias.map.covariance =
      Eigen::Map<const Eigen::MatrixXd>(source.covariance._buffer, ToIndex(rows), ToIndex(rows));
  return robot::CheckDepthBias(bias);
}

Status ReadFirstCamera(const idl::palpate_msgs::Calibration& message,
                       robot::CalibrationFile* file) {
  file->pose.reset();
  file->depth_bias.reset();
  if (!message.has_camera) {
    return message.has_depth_bias ? Invalid("depth_bias comes without the camera's pose")
                                  : Status::Ok();
  }
  if (Status status = ReadPoseOf(message, &file->pose.emplace()); !status.ok()) return status;
  return ReadDepthBiasOf(message, &file->depth_bias);
}

Status ReadFurtherCameras(const idl::palpate_msgs::Calibration& message,
                          robot::CalibrationFile* file) {
  file->cameras.clear();
  for (const auto& source : dds::Elements(message.cameras)) {
    robot::CalibratedCamera camera;
    camera.name = dds::Text(source.name);
    const bool is_there = std::any_of(file->cameras.begin(), file->cameras.end(),
                                      [&](const auto& other) { return other.name == camera.name; });
    if (is_there) return Invalid("camera '" + camera.name + "' is there twice");
    Status status = ReadPoseOf(source, &camera.pose);
    if (status.ok()) status = ReadDepthBiasOf(source, &camera.depth_bias);
    if (!status.ok()) return Invalid("camera '" + camera.name + "': " + status.message());
    file->cameras.push_back(std::move(camera));
  }
  return Status::Ok();
}

Status ReadMaterials(const idl::palpate_msgs::Calibration& message, robot::CalibrationFile* file) {
  file->moduli.clear();
  for (const auto& modulus : dds::Elements(message.moduli)) {
    const std::string part(dds::Text(modulus.part));
    if (!std::isfinite(modulus.youngs_modulus_pa) || modulus.youngs_modulus_pa <= 0.0 ||
        !IsError(modulus.standard_error_pa)) {
      return Invalid("the modulus of '" + part + "' is none");
    }
    file->moduli.push_back({part, modulus.youngs_modulus_pa, modulus.standard_error_pa});
  }
  file->poissons_ratios.clear();
  for (const auto& ratio : dds::Elements(message.poissons_ratios)) {
    const std::string part(dds::Text(ratio.part));
    if (!(ratio.poissons_ratio > -1.0 && ratio.poissons_ratio < 0.5) ||
        !IsError(ratio.standard_error)) {
      return Invalid("Poisson's ratio of '" + part + "' is none");
    }
    file->poissons_ratios.push_back({part, ratio.poissons_ratio, ratio.standard_error});
  }
  return Status::Ok();
}

Status ReadGravity(const idl::palpate_msgs::Calibration& message, robot::CalibrationFile* file) {
  file->gravity.reset();
  if (!message.has_gravity) return Status::Ok();
  robot::CalibratedGravity& gravity = file->gravity.emplace();
  gravity.gravity_m_s2 = dds::ToVector(message.gravity_m_s2);
  gravity.standard_error_m_s2 = dds::ToVector(message.gravity_standard_error_m_s2);
  if (!gravity.gravity_m_s2.allFinite() || !gravity.standard_error_m_s2.allFinite() ||
      gravity.standard_error_m_s2.minCoeff() < 0.0) {
    return Invalid("gravity_m_s2 has a value that is not a number");
  }
  return Status::Ok();
}

Status ReadGeometry(const idl::palpate_msgs::Calibration& message, robot::CalibrationFile* file) {
  file->geometry_scale.reset();
  if (message.has_geometry_scale) {
    file->geometry_scale =
        robot::CalibratedScale{message.geometry_scale, message.geometry_scale_standard_error};
  }
  file->cable_routes.clear();
  for (const auto& route : dds::Elements(message.cable_routes)) {
    file->cable_routes.push_back({std::string(dds::Text(route.cable)),
                                  static_cast<int>(route.point), dds::ToVector(route.moved_m),
                                  dds::ToVector(route.standard_error_m)});
  }
  return robot::CheckGeometry(file->geometry_scale, file->cable_routes);
}

Status ReadPressureSensors(const idl::palpate_msgs::Calibration& message,
                           robot::CalibrationFile* file) {
  file->pressure_sensors.clear();
  for (const auto& sensor : dds::Elements(message.pressure_sensors)) {
    robot::CalibratedPressureSensor& found = file->pressure_sensors.emplace_back();
    found.chamber = dds::Text(sensor.chamber);
    if (sensor.has_zero) {
      found.zero_Pa = robot::CalibratedNumber{sensor.zero_pa, sensor.zero_standard_error_pa};
    }
    if (sensor.has_gain) {
      found.gain = robot::CalibratedNumber{sensor.gain, sensor.gain_standard_error};
    }
    if (Status status = robot::CheckPressureSensor(found); !status.ok()) return status;
  }
  return Status::Ok();
}

Status ReadNumbers(const idl::palpate_msgs::Calibration& message, robot::CalibrationFile* file) {
  file->drives.clear();
  for (const auto& drive : dds::Elements(message.drives)) {
    const std::string cable(dds::Text(drive.cable));
    if (!std::isfinite(drive.offset_m) || !std::isfinite(drive.gain) ||
        !IsError(drive.offset_standard_error_m) || !IsError(drive.gain_standard_error)) {
      return Invalid("the actuator of cable '" + cable + "' has a value that is not a number");
    }
    file->drives.push_back({cable,
                            {drive.offset_m, drive.gain},
                            {drive.offset_standard_error_m, drive.gain_standard_error}});
  }
  file->undetermined.clear();
  for (const auto& number : dds::Elements(message.undetermined)) {
    file->undetermined.push_back(
        {std::string(dds::Text(number.name)), std::string(dds::Text(number.what_would_tell))});
  }
  return Status::Ok();
}

}  // namespace

Status FromCalibration(const idl::palpate_msgs::Calibration& message,
                       robot::CalibrationFile* calibration) {
  ReadHead(message, calibration);
  if (Status status = ReadFirstCamera(message, calibration); !status.ok()) return status;
  if (Status status = ReadFurtherCameras(message, calibration); !status.ok()) return status;
  if (Status status = ReadMaterials(message, calibration); !status.ok()) return status;
  if (Status status = ReadGravity(message, calibration); !status.ok()) return status;
  if (Status status = ReadGeometry(message, calibration); !status.ok()) return status;
  if (Status status = ReadPressureSensors(message, calibration); !status.ok()) return status;
  return ReadNumbers(message, calibration);
}

CalibrationInput::CalibrationInput(dds::Participant& participant, const robot::RobotModel& model)
    : model_(model), reader_(participant.CreateReader(dds::kCalibrationTopic)) {}

void CalibrationInput::SetInUse(const robot::CalibrationFile& calibration) {
  date_utc_ = calibration.date_utc;
  data_hash_ = calibration.data_hash;
}

std::vector<CalibrationInput::Verdict> CalibrationInput::Take() {
  std::vector<Verdict> verdicts;
  for (const auto& message : reader_.Take()) {
    Verdict verdict = Judge(message);
    const robot::CalibrationFile& calibration = verdict.calibration;
    const bool again = calibration.date_utc == date_utc_ && calibration.data_hash == data_hash_;
    if (verdict.status.ok() && again) continue;
    if (verdict.status.ok()) SetInUse(calibration);
    verdicts.push_back(std::move(verdict));
  }
  return verdicts;
}

CalibrationInput::Verdict CalibrationInput::Judge(
    const idl::palpate_msgs::Calibration& message) const {
  Verdict verdict;
  verdict.status = FromCalibration(message, &verdict.calibration);
  if (!verdict.status.ok()) return verdict;
  verdict.status = robot::CheckCalibration(verdict.calibration, model_);
  const std::string& date_utc = verdict.calibration.date_utc;
  if (verdict.status.ok() && date_utc < date_utc_) {
    verdict.status = {StatusCode::kStale,
                      "it is of " + date_utc + ", older than the one in use, of " + date_utc_};
  }
  return verdict;
}

}  // namespace palpate::force_estimation
