// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/node/convert.hpp"
#include "libs/dds/depth_picture.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"

namespace palpate::calibration {

namespace {

using Covariance = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

/// ROS has translation before rotation.
Covariance InRosOrder(const Eigen::Matrix<double, 6, 6>& turn_and_shift) {
  Covariance ros;
  ros.topLeftCorner<3, 3>() = turn_and_shift.bottomRightCorner<3, 3>();
  ros.topRightCorner<3, 3>() = turn_and_shift.bottomLeftCorner<3, 3>();
  ros.bottomLeftCorner<3, 3>() = turn_and_shift.topRightCorner<3, 3>();
  ros.bottomRightCorner<3, 3>() = turn_and_shift.topLeftCorner<3, 3>();
  return ros;
}

void SetHead(const robot::CalibrationFile& file, idl::palpate_msgs::Calibration* message) {
  dds::SetText(message->robot, file.robot);
  dds::SetText(message->mesh_hash, file.mesh_hash);
  dds::SetText(message->element, file.element);
  dds::SetText(message->material_model, file.model);
  message->poissons_ratio = file.poissons_ratio;
  dds::SetText(message->volumetric, file.volumetric);
  message->c20_over_c10 = file.c20_over_c10;
  message->c30_over_c10 = file.c30_over_c10;
  dds::SetText(message->date_utc, file.date_utc);
  dds::SetText(message->data, file.data);
  dds::SetText(message->data_hash, file.data_hash);
  message->residual_rms_m = file.residual_rms_m;
  message->chi_squared = file.chi_squared;
  message->degrees_of_freedom = static_cast<std::uint32_t>(file.degrees_of_freedom);
}

/// `Target`: Calibration or CalibratedCamera.
template <typename Target>
void SetDepthBias(const std::optional<robot::CalibratedDepthBias>& bias, Target* message) {
  message->has_depth_bias = bias.has_value();
  if (!bias) return;
  const geometry::DepthBiasMap& map = bias->map;
  auto& target = message->depth_bias;
  dds::SetPicture(target.picture, bias->picture);
  target.order = static_cast<std::uint32_t>(map.basis.order);
  target.span = map.basis.span;
  dds::SetNumbers(target.coefficients, map.coefficients.data(),
                  static_cast<std::size_t>(map.coefficients.size()));
  // It is symmetric: rows or columns.
  dds::SetNumbers(target.covariance, map.covariance.data(),
                  static_cast<std::size_t>(map.covariance.size()));
}

/// Their poses have no correlations: a file holds none.
void SetCameras(const robot::CalibrationFile& file, idl::palpate_msgs::Calibration* message) {
  dds::Resize(message->cameras, file.cameras.size());
  for (std::size_t k = 0; k < file.cameras.size(); ++k) {
    const robot::CalibratedCamera& found = file.cameras[k];
    auto& camera = message->cameras._buffer[k];
    dds::SetText(camera.name, found.name);
    camera.camera_in_robot = dds::ToPose(found.pose.T_robot_camera);
    Eigen::Matrix<double, 6, 1> errors;
    errors << found.pose.translation_error_m, found.pose.rotation_error_rad;
    Eigen::Map<Covariance>(camera.camera_covariance) =
        errors.cwiseAbs2().asDiagonal().toDenseMatrix();
    SetDepthBias(found.depth_bias, &camera);
  }
}

void SetMaterials(const robot::CalibrationFile& file, idl::palpate_msgs::Calibration* message) {
  dds::Resize(message->moduli, file.moduli.size());
  for (std::size_t k = 0; k < file.moduli.size(); ++k) {
    auto& modulus = message->moduli._buffer[k];
    dds::SetText(modulus.part, file.moduli[k].part);
    modulus.youngs_modulus_pa = file.moduli[k].youngs_modulus_Pa;
    modulus.standard_error_pa = file.moduli[k].standard_error_Pa;
  }
  dds::Resize(message->poissons_ratios, file.poissons_ratios.size());
  for (std::size_t k = 0; k < file.poissons_ratios.size(); ++k) {
    auto& ratio = message->poissons_ratios._buffer[k];
    dds::SetText(ratio.part, file.poissons_ratios[k].part);
    ratio.poissons_ratio = file.poissons_ratios[k].poissons_ratio;
    ratio.standard_error = file.poissons_ratios[k].standard_error;
  }
  message->has_gravity = file.gravity.has_value();
  if (!file.gravity) return;
  dds::SetVector(message->gravity_m_s2, file.gravity->gravity_m_s2);
  dds::SetVector(message->gravity_standard_error_m_s2, file.gravity->standard_error_m_s2);
}

void SetGeometry(const robot::CalibrationFile& file, idl::palpate_msgs::Calibration* message) {
  message->has_geometry_scale = file.geometry_scale.has_value();
  const robot::CalibratedScale scale = file.geometry_scale.value_or(robot::CalibratedScale());
  message->geometry_scale = scale.scale;
  message->geometry_scale_standard_error = scale.standard_error;
  dds::Resize(message->cable_routes, file.cable_routes.size());
  for (std::size_t k = 0; k < file.cable_routes.size(); ++k) {
    auto& route = message->cable_routes._buffer[k];
    dds::SetText(route.cable, file.cable_routes[k].cable);
    route.point = static_cast<uint32_t>(file.cable_routes[k].point);
    dds::SetVector(route.moved_m, file.cable_routes[k].moved_m);
    dds::SetVector(route.standard_error_m, file.cable_routes[k].standard_error_m);
  }
}

void SetPressureSensors(const robot::CalibrationFile& file,
                        idl::palpate_msgs::Calibration* message) {
  const robot::CalibratedNumber none;
  dds::Resize(message->pressure_sensors, file.pressure_sensors.size());
  for (std::size_t k = 0; k < file.pressure_sensors.size(); ++k) {
    const robot::CalibratedPressureSensor& found = file.pressure_sensors[k];
    auto& sensor = message->pressure_sensors._buffer[k];
    dds::SetText(sensor.chamber, found.chamber);
    sensor.has_zero = found.zero_Pa.has_value();
    sensor.zero_pa = found.zero_Pa.value_or(none).value;
    sensor.zero_standard_error_pa = found.zero_Pa.value_or(none).standard_error;
    sensor.has_gain = found.gain.has_value();
    sensor.gain = found.gain.value_or(none).value;
    sensor.gain_standard_error = found.gain.value_or(none).standard_error;
  }
}

void SetNumbersFound(const robot::CalibrationFile& file, idl::palpate_msgs::Calibration* message) {
  dds::Resize(message->drives, file.drives.size());
  for (std::size_t k = 0; k < file.drives.size(); ++k) {
    auto& actuator = message->drives._buffer[k];
    dds::SetText(actuator.cable, file.drives[k].cable);
    actuator.offset_m = file.drives[k].drive.offset_m;
    actuator.offset_standard_error_m = file.drives[k].standard_error.offset_m;
    actuator.gain = file.drives[k].drive.gain;
    actuator.gain_standard_error = file.drives[k].standard_error.gain;
  }
  SetPressureSensors(file, message);
  SetDepthBias(file.depth_bias, message);
  SetCameras(file, message);
  SetMaterials(file, message);
  SetGeometry(file, message);
  dds::Resize(message->undetermined, file.undetermined.size());
  for (std::size_t k = 0; k < file.undetermined.size(); ++k) {
    auto& number = message->undetermined._buffer[k];
    dds::SetText(number.name, file.undetermined[k].name);
    dds::SetText(number.what_would_tell, file.undetermined[k].what_would_tell);
  }
}

}  // namespace

dds::Message<idl::palpate_msgs::Calibration> ToCalibration(
    const robot::CalibrationFile& file, const Eigen::Matrix<double, 6, 6>& pose_covariance,
    std::int64_t stamp_ns) {
  dds::Message<idl::palpate_msgs::Calibration> message;
  dds::SetHeader(message->header, stamp_ns, geometry::kRobotFrame);
  SetHead(file, &*message);
  SetNumbersFound(file, &*message);
  message->has_camera = file.pose.has_value();
  message->camera_in_robot =
      dds::ToPose(file.pose ? file.pose->T_robot_camera : Eigen::Isometry3d::Identity());
  Eigen::Map<Covariance>(message->camera_covariance) = InRosOrder(pose_covariance);
  return message;
}

dds::Message<idl::palpate_msgs::CalibrationStatus> ToStatus(const Progress& progress,
                                                            std::int64_t stamp_ns) {
  dds::Message<idl::palpate_msgs::CalibrationStatus> message;
  dds::SetHeader(message->header, stamp_ns, geometry::kRobotFrame);
  dds::SetText(message->request_id, progress.request_id);
  dds::SetText(message->state, progress.state);
  dds::SetText(message->status, ToString(progress.status.code()));
  dds::SetText(message->reason, progress.status.ok() ? progress.reason : progress.status.message());
  message->frames_taken = static_cast<std::uint32_t>(progress.frames_taken);
  message->frames_wanted = static_cast<std::uint32_t>(progress.frames_wanted);
  return message;
}

}  // namespace palpate::calibration
