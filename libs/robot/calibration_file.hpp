// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "libs/core/config_node.hpp"
#include "libs/core/status.hpp"
#include "libs/robot/calibrated_depth_bias.hpp"
#include "libs/robot/calibrated_geometry.hpp"
#include "libs/robot/calibrated_pressure_sensor.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::robot {

/// A modulus estimated from data. `part` is "body" or the name of a region.
struct CalibratedModulus {
  std::string part;
  double youngs_modulus_Pa = 0.0;
  double standard_error_Pa = 0.0;
};

/// Pose of the depth camera.
struct CalibratedPose {
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
  /// About and along the robot's axes.
  Eigen::Vector3d rotation_error_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d translation_error_m = Eigen::Vector3d::Zero();
};

/// A camera beside the first, under the name that it has in the experiment.
struct CalibratedCamera {
  std::string name;
  CalibratedPose pose;
  std::optional<CalibratedDepthBias> depth_bias;
};

/// Poisson's ratio estimated from data. `part` as of a modulus.
struct CalibratedPoissonsRatio {
  std::string part;
  double poissons_ratio = 0.0;
  double standard_error = 0.0;
};

/// Gravity in the robot's frame as it acts on the masses of the robot file.
struct CalibratedGravity {
  Eigen::Vector3d gravity_m_s2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d standard_error_m_s2 = Eigen::Vector3d::Zero();
};

/// Offset and gain of the actuator of a cable (RobotModel::SetDrive).
struct CalibratedDrive {
  std::string cable;
  DriveCalibration drive;
  DriveCalibration standard_error;
};

/// A parameter that was to be estimated and that the data do not determine; it kept its prior mean.
struct Undetermined {
  std::string name;
  std::string what_would_tell;  ///< the recording that determines it
  /// That the data reach, and the largest that determines it, in the parameter's unit; 0: unknown.
  double standard_error = 0.0;
  double limit = 0.0;
};

/// What `palpate calibrate` estimates, and `palpate estimate` and the processes use; format:
/// docs/experiment.md. A modulus is bound to the mesh and element that it was estimated with:
/// coarse linear meshes are too stiff, and the fit compensates for it.
struct CalibrationFile {
  std::string robot;            ///< name in the robot file
  std::string mesh_hash;        ///< RobotBody::mesh_hash: mesh and element
  std::string element;          ///< "tet4" | "tet10"
  std::string model;            ///< material model
  double poissons_ratio = 0.0;  ///< of the robot file
  /// "pointwise" | "mean_dilatation"; empty: unknown, and not compared
  std::string volumetric;
  double c20_over_c10 = 0.0;  ///< of the Yeoh material, as c30_over_c10
  double c30_over_c10 = 0.0;
  std::string date_utc;  ///< "2026-01-31T12:00:00Z"
  std::string data;      ///< the data that were used, for people
  std::string data_hash;
  std::vector<CalibratedModulus> moduli;  ///< empty: those of the robot file hold
  std::vector<CalibratedPoissonsRatio> poissons_ratios;
  std::optional<CalibratedGravity> gravity;
  std::optional<CalibratedPose> pose;
  std::optional<CalibratedDepthBias> depth_bias;  ///< only where there is a pose
  std::vector<CalibratedCamera> cameras;          ///< beside the first, by name
  std::vector<CalibratedDrive> drives;
  std::vector<CalibratedPressureSensor> pressure_sensors;
  std::optional<CalibratedScale> geometry_scale;  ///< absent: as large as the robot file says
  std::vector<CalibratedRoute> cable_routes;
  std::vector<Undetermined> undetermined;
  double residual_rms_m = 0.0;
  double chi_squared = 0.0;
  int degrees_of_freedom = 0;
};

/// The file's head for this robot, without moduli and fit.
CalibrationFile DescribeForCalibration(const RobotModel& model);

/// Reads a calibration file strictly. Throws InputError with file:line:column.
CalibrationFile ReadCalibrationFile(const std::filesystem::path& file, const ConfigLoader& load);

/// Throws RunError where it cannot be written.
void WriteCalibrationFile(const CalibrationFile& calibration, const std::filesystem::path& file);

/// kInvalidInput, naming both sides, where the calibration is another robot's, another mesh's,
/// element's or material's than `present` (DescribeForCalibration) says.
Status CheckCalibrated(const CalibrationFile& calibration, const CalibrationFile& present);

/// Applies the calibrated scale and cable routes to a body that is as the robot file has it, before
/// a model is made of it. CheckCalibration refuses what the robot does not have.
void ApplyGeometry(const CalibrationFile& calibration, RobotBody* body);

/// The same; also kInvalidInput where the calibration names a region, a cable or a point of a cable
/// that the robot does not have, or has another scale or other routes than the model
/// (ApplyGeometry).
Status CheckCalibration(const CalibrationFile& calibration, const RobotModel& model);

/// Applies the calibrated moduli, Poisson's ratios, gravity, actuators and pull points to the
/// model. The caller applies the camera pose, and the pressure sensors to their readings. Throws
/// InputError where CheckCalibration is not ok.
void ApplyCalibration(const CalibrationFile& calibration, RobotModel* model);

/// Largest relative standard error of the moduli; 0 without moduli.
double RelativeModulusError(const CalibrationFile& calibration);

}  // namespace palpate::robot
