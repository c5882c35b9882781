// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/calibration_keys.hpp"

#include "libs/fem/material.hpp"
#include "libs/geometry/pose_text.hpp"
#include "libs/robot/calibrated_depth_bias.hpp"
#include "libs/robot/calibrated_geometry.hpp"
#include "libs/robot/calibrated_pressure_sensor.hpp"

namespace palpate::robot {

namespace {

constexpr NumberRule kPoissonsRatioRule{.min = -1.0, .max = 0.5, .max_open = true};

}  // namespace

const KeyTable& ModulusKeys() {
  static const KeyTable keys{
      .title = "modulus",
      .about = "An estimated Young's modulus.",
      .keys = {{"part", value::Text(), kRequired, "`body`, or the name of a region."},
               {"youngs_modulus_Pa", value::Real(kPositive), kRequired, "Young's modulus."},
               {"standard_error_Pa", value::Real(kNonNegative), kRequired, "Its standard error."}}};
  return keys;
}

const KeyTable& PoissonsRatioKeys() {
  static const KeyTable keys{
      .title = "Poisson's ratio",
      .about = "An estimated Poisson's ratio.",
      .keys = {{"part", value::Text(), kRequired, "`body`, or the name of a region."},
               {"poissons_ratio", value::Real(kPoissonsRatioRule), kRequired, "Poisson's ratio."},
               {"standard_error", value::Real(kNonNegative), kRequired, "Its standard error."}}};
  return keys;
}

const KeyTable& PoseErrorKeys() {
  static const KeyTable keys{.title = "standard error of the pose",
                             .about = "Standard errors of `T_robot_camera`.",
                             .keys = {{"rotation_rad", value::Vector3(kNonNegative), kRequired,
                                       "About the axes of the robot frame."},
                                      {"translation_m", value::Vector3(kNonNegative), kRequired,
                                       "Along the axes of the robot frame."}}};
  return keys;
}

const KeyTable& ActuatorKeys() {
  static const KeyTable keys{
      .title = "actuator",
      .about =
          "How the displacement of an actuator is read: pulled length = (1 + `gain`) x "
          "displacement + `offset_m`.",
      .keys = {{"cable", value::Text(), kRequired, "Name of the cable."},
               {"offset_m", value::Real(), kRequired, "Zero offset."},
               {"offset_standard_error_m", value::Real(kNonNegative), kRequired,
                "Standard error of the offset."},
               {"gain", value::Real(), kRequired, "Relative error of the gain; 0: none."},
               {"gain_standard_error", value::Real(kNonNegative), kRequired,
                "Standard error of the gain."}}};
  return keys;
}

const KeyTable& UndeterminedKeys() {
  static const KeyTable keys{
      .title = "undetermined parameter",
      .about =
          "A parameter that was to be estimated and that the data do not determine. It kept "
          "its prior value.",
      .keys = {
          {"name", value::Text(), kRequired, "The parameter."},
          {"what_would_tell", value::Text(), kRequired, "The recording that would determine it."},
          {"standard_error", value::Real(kNonNegative), Default(0.0),
           "Standard error that the data reach, in the unit of the parameter. 0: unknown."},
          {"limit", value::Real(kNonNegative), Default(0.0),
           "Largest standard error that counts as determined. 0: unknown."}}};
  return keys;
}

const KeyTable& CalibratedCameraKeys() {
  static const KeyTable keys{
      .title = "calibrated camera",
      .about =
          "Pose and depth bias of a camera beside the first, with the moduli and drives of "
          "this file.",
      .keys = {{"name", value::Text(), kRequired, "Its name in the experiment."},
               {"T_robot_camera", value::Map(geometry::MeasuredPoseKeys()), kRequired,
                "Its pose: p_robot = T p_camera."},
               {"T_robot_camera_standard_error", value::Map(PoseErrorKeys()), kOptional,
                "Standard errors of the pose, along and about each axis of the robot frame."},
               {"depth_bias", value::Map(DepthBiasKeys()), kOptional, "Its depth bias."}}};
  return keys;
}

const KeyTable& CalibrationFileKeys() {
  static const KeyTable keys{
      .title = "calibration file",
      .about =
          "What `palpate calibrate` writes, and `palpate estimate` and the processes read. "
          "At least one of `moduli`, `poissons_ratios`, `gravity_m_s2`, `T_robot_camera`, "
          "`drives`, `pressure_sensors`, `geometry_scale` and `cable_routes` is there.",
      .keys = {{"robot", value::Text(), kRequired, "Name of the robot."},
               {"mesh_hash", value::Text(), kRequired,
                "Hash of mesh and element. Another mesh is refused: moduli hold for one mesh."},
               {"element", value::Choice({"tet4", "tet10"}), kRequired, "Finite element."},
               {"model", value::Choice(fem::MaterialModelNames()), kRequired, "Constitutive law."},
               {"poissons_ratio", value::Real(kPoissonsRatioRule), kRequired,
                "Poisson's ratio of the robot file."},
               {"volumetric", value::Choice({"pointwise", "mean_dilatation"}), kOptional,
                "As in the robot file. Absent: not compared."},
               {"c20_over_c10", value::Real(), Default(0.0), "Yeoh's ratio, as in the robot file."},
               {"c30_over_c10", value::Real(), Default(0.0), "Yeoh's ratio, as in the robot file."},
               {"date_utc", value::Text(), kRequired, "When it was made, `2026-01-31T12:00:00Z`."},
               {"data", value::Text(), kRequired, "The data that were used, for people."},
               {"data_hash", value::Text(), kRequired, "SHA-256 of these data."},
               {"moduli", value::ListOfMaps(ModulusKeys()), kOptional,
                "Young's moduli. Absent: those of the robot file."},
               {"poissons_ratios", value::ListOfMaps(PoissonsRatioKeys()), kOptional,
                "Poisson's ratios. Absent: those of the robot file."},
               {"gravity_m_s2", value::Vector3(), kOptional,
                "Gravity, robot frame. Absent: that of the robot file."},
               {"gravity_standard_error_m_s2", value::Vector3(kNonNegative),
                RequiredFor("`gravity_m_s2`"), "Its standard error along each axis."},
               {"T_robot_camera", value::Map(geometry::MeasuredPoseKeys()), kOptional,
                "Pose of the depth camera: p_robot = T p_camera."},
               {"T_robot_camera_standard_error", value::Map(PoseErrorKeys()),
                OnlyFor("`T_robot_camera`"),
                "Its standard error of each axis. Absent: its `standard_error`."},
               {"depth_bias", value::Map(DepthBiasKeys()), OnlyFor("`T_robot_camera`"),
                "Systematic error of the depth, estimated together with the pose."},
               {"cameras", value::ListOfMaps(CalibratedCameraKeys()), kOptional,
                "Depth cameras beside the first one."},
               {"drives", value::ListOfMaps(ActuatorKeys()), kOptional,
                "Offset and gain of the actuators."},
               {"pressure_sensors", value::ListOfMaps(PressureSensorKeys()), kOptional,
                "Zero and gain of the pressure sensors of chambers. Absent: readings hold."},
               {"geometry_scale", value::Map(GeometryScaleKeys()), kOptional,
                "Size of the robot. Absent: as in the robot file."},
               {"cable_routes", value::ListOfMaps(CableRouteKeys()), kOptional,
                "Points of cable routes that are elsewhere than in the robot file."},
               {"undetermined", value::ListOfMaps(UndeterminedKeys()), kOptional,
                "Parameters that the data do not determine."},
               {"residual_rms_m", value::Real(kNonNegative), kRequired,
                "RMS of measured minus computed."},
               {"chi_squared", value::Real(kNonNegative), kRequired, "Chi-squared of the fit."},
               {"degrees_of_freedom", value::WholeNumber(0, 1 << 30), kRequired,
                "Degrees of freedom of the fit."}}};
  return keys;
}

}  // namespace palpate::robot
