// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/joint/found_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <optional>

#include "components/calibration/joint/route_unknowns.hpp"
#include "libs/core/index.hpp"
#include "libs/core/utc_text.hpp"
#include "libs/experiment/recording_hash.hpp"

namespace palpate::calibration {

const FittedValue* FindValue(const JointCalibration& fit, const std::string& name) {
  const auto found = std::find_if(fit.values.begin(), fit.values.end(),
                                  [&](const FittedValue& value) { return value.name == name; });
  return found == fit.values.end() ? nullptr : &*found;
}

std::vector<CorrelatedValues> FindCorrelated(const JointCalibration& fit, double least) {
  std::vector<CorrelatedValues> found;
  for (std::size_t i = 0; i < fit.values.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double correlation = fit.correlation(ToIndex(i), ToIndex(j));
      const bool determined = fit.values[i].determined && fit.values[j].determined;
      if (!determined || std::abs(correlation) < least) continue;
      found.push_back({fit.values[j].name, fit.values[i].name, correlation});
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
    return std::abs(a.correlation) > std::abs(b.correlation);
  });
  return found;
}

std::vector<std::string> PartNames(const robot::RobotBody& body) {
  std::vector<std::string> names = {"body"};
  names.insert(names.end(), body.region_names.begin(), body.region_names.end());
  return names;
}

std::vector<std::string> PartsWithElements(const robot::RobotBody& body) {
  const std::vector<std::string> names = PartNames(body);
  std::vector<std::string> parts;
  for (std::size_t m = 0; m < names.size(); ++m) {
    const auto& of_cell = body.material_of_cell;
    const bool any =
        std::find(of_cell.begin(), of_cell.end(), static_cast<int>(m)) != of_cell.end();
    if (any) parts.push_back(names[m]);
  }
  return parts;
}

std::vector<std::string> PartsToFit(const robot::RobotBody& body) {
  std::vector<std::string> parts = PartsWithElements(body);
  if (parts.front() == "body") parts = {"body"};
  return parts;
}

robot::CalibrationFile MakeCalibration(const robot::RobotModel& model,
                                       const std::vector<const experiment::Recording*>& recordings,
                                       const std::filesystem::path& data) {
  robot::CalibrationFile file = robot::DescribeForCalibration(model);
  file.date_utc = UtcText(std::time(nullptr));
  file.data = data.filename().empty() ? data.parent_path().filename() : data.filename();
  for (const experiment::Recording* recording : recordings) {
    file.data += (recording == recordings.front() ? ": " : ", ") + recording->name;
  }
  file.data_hash = experiment::HashRecordings(recordings);
  return file;
}

namespace {

robot::CalibratedPose PoseOf(const FittedCamera& fit) {
  robot::CalibratedPose pose;
  pose.T_robot_camera =
      Eigen::Translation3d(fit.T_robot_camera.translation_m()) * fit.T_robot_camera.rotation();
  const Eigen::Matrix<double, 6, 1> errors = fit.pose_covariance.diagonal().cwiseSqrt();
  pose.rotation_error_rad = errors.head<3>();
  pose.translation_error_m = errors.tail<3>();
  return pose;
}

void TakeActuators(const JointCalibration& fit, const robot::RobotModel& model,
                   robot::CalibrationFile* file) {
  for (const std::string& cable : model.ActuatorNames()) {
    const FittedValue* offset = FindValue(fit, "cable_offset:" + cable);
    const FittedValue* gain = FindValue(fit, "cable_gain:" + cable);
    const bool has_offset = offset != nullptr && offset->determined;
    const bool has_gain = gain != nullptr && gain->determined;
    if (!has_offset && !has_gain) continue;
    robot::CalibratedDrive actuator{.cable = cable, .drive = {}, .standard_error = {}};
    if (has_offset) {
      actuator.drive.offset_m = offset->value;
      actuator.standard_error.offset_m = offset->standard_error;
    }
    if (has_gain) {
      actuator.drive.gain = gain->value;
      actuator.standard_error.gain = gain->standard_error;
    }
    file->drives.push_back(actuator);
  }
}

/// Nothing where it was not asked for, or not determined.
std::optional<robot::CalibratedNumber> FoundNumber(const JointCalibration& fit,
                                                   const std::string& name) {
  const FittedValue* value = FindValue(fit, name);
  if (value == nullptr || !value->determined) return std::nullopt;
  return robot::CalibratedNumber{value->value, value->standard_error};
}

void TakePressureSensors(const JointCalibration& fit, const robot::RobotModel& model,
                         robot::CalibrationFile* file) {
  for (const std::string& chamber : model.ChamberNames()) {
    const robot::CalibratedPressureSensor sensor{
        .chamber = chamber,
        .zero_Pa = FoundNumber(fit, "pressure_zero:" + chamber),
        .gain = FoundNumber(fit, "pressure_gain:" + chamber)};
    if (sensor.zero_Pa || sensor.gain) file->pressure_sensors.push_back(sensor);
  }
}

void TakeMaterials(const JointCalibration& fit, const std::vector<std::string>& parts,
                   robot::CalibrationFile* file) {
  for (const std::string& part : parts) {
    const FittedValue* modulus = FindValue(fit, "youngs_modulus:" + part);
    if (modulus != nullptr && modulus->determined) {
      file->moduli.push_back({part, modulus->value, modulus->standard_error});
    }
    const FittedValue* poissons = FindValue(fit, "poissons_ratio:" + part);
    if (poissons != nullptr && poissons->determined) {
      file->poissons_ratios.push_back({part, poissons->value, poissons->standard_error});
    }
  }
}

/// Direction and mass factor as one vector.
void TakeGravity(const JointCalibration& fit, const Eigen::Vector3d& nominal_m_s2,
                 robot::CalibrationFile* file) {
  Eigen::Vector3d turned_m_s2 = nominal_m_s2;
  Eigen::Vector3d variance = Eigen::Vector3d::Zero();
  for (const TiltAxis& axis : TiltAxes(nominal_m_s2)) {
    const FittedValue* tilt = FindValue(fit, "gravity_tilt:" + axis.name);
    if (tilt == nullptr || !tilt->determined) continue;
    const Eigen::Vector3d per_tilt_m_s2 = axis.direction.cross(nominal_m_s2);
    turned_m_s2 += tilt->value * per_tilt_m_s2;
    variance += (tilt->standard_error * per_tilt_m_s2).cwiseAbs2();
  }
  const FittedValue* mass = FindValue(fit, "mass_factor");
  const bool has_mass = mass != nullptr && mass->determined;
  if (has_mass) variance += (mass->standard_error * turned_m_s2).cwiseAbs2();
  if (variance.isZero()) return;
  file->gravity =
      robot::CalibratedGravity{(has_mass ? mass->value : 1.0) * turned_m_s2, variance.cwiseSqrt()};
}

/// Of one point of a cable's route.
void TakeRoute(const JointCalibration& fit, const robot::RobotBody& body, int cable, int point,
               robot::CalibrationFile* file) {
  robot::CalibratedRoute route{.cable = body.cables[At(cable)].name, .point = point};
  Eigen::Vector3d variance_m2 = Eigen::Vector3d::Zero();
  for (const TiltAxis& axis : AcrossCable(body, cable, point)) {
    const FittedValue* off = FindValue(fit, RouteName(route.cable, point, axis.name));
    if (off == nullptr || !off->determined) continue;
    route.moved_m += off->value * axis.direction;
    variance_m2 += (off->standard_error * axis.direction).cwiseAbs2();
  }
  if (variance_m2.isZero(0.0)) return;
  route.standard_error_m = variance_m2.cwiseSqrt();
  file->cable_routes.push_back(route);
}

void TakeGeometry(const JointCalibration& fit, const robot::RobotBody& body,
                  robot::CalibrationFile* file) {
  const FittedValue* scale = FindValue(fit, "geometry_scale");
  if (scale != nullptr && scale->determined) {
    file->geometry_scale = robot::CalibratedScale{scale->value, scale->standard_error};
  }
  for (std::size_t c = 0; c < body.cables.size(); ++c) {
    for (int point = 0; point <= static_cast<int>(body.cables[c].eyelets.size()); ++point) {
      TakeRoute(fit, body, static_cast<int>(c), point, file);
    }
  }
}

}  // namespace

void TakeFit(const JointCalibration& fit, const robot::RobotModel& model,
             robot::CalibrationFile* file) {
  if (!fit.pose_covariance.isZero()) file->pose = PoseOf(fit);
  TakeActuators(fit, model, file);
  TakePressureSensors(fit, model, file);
  TakeMaterials(fit, PartNames(model.body()), file);
  TakeGravity(fit, model.gravity_m_s2(), file);
  TakeGeometry(fit, model.body(), file);
  for (const FittedValue& value : fit.values) {
    if (value.determined) continue;
    file->undetermined.push_back(
        {value.name, value.what_would_tell, value.reached_error, value.error_limit});
  }
  file->residual_rms_m = fit.residual_rms_m;
  file->chi_squared = fit.chi_squared;
  file->degrees_of_freedom = fit.degrees_of_freedom;
}

void TakeDepthBias(const JointCalibration& fit, const geometry::DepthPicture& picture,
                   robot::CalibrationFile* file) {
  if (!fit.depth_bias || !file->pose) return;
  file->depth_bias = robot::CalibratedDepthBias{picture, *fit.depth_bias};
}

robot::CalibratedCamera CameraOf(const std::string& name, const FittedCamera& fit,
                                 const std::optional<geometry::DepthPicture>& picture) {
  robot::CalibratedCamera camera{.name = name, .pose = PoseOf(fit), .depth_bias = {}};
  if (picture && fit.depth_bias)
    camera.depth_bias = robot::CalibratedDepthBias{*picture, *fit.depth_bias};
  return camera;
}

}  // namespace palpate::calibration
