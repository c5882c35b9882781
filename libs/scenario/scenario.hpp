// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "libs/core/config_node.hpp"
#include "libs/fem/prony_term.hpp"
#include "libs/rgbd/rgbd_camera.hpp"
#include "libs/scenario/effect.hpp"

namespace palpate::scenario {

using PronyTerm = fem::PronyTerm;

/// The virtual robot's body where it differs from the robot file.
struct BodyTruth {
  std::filesystem::path mesh_file;  ///< empty: the robot file's; unit and placement are its
  int refine = 1;                   ///< 0 to 2: so often is every tetrahedron cut in eight
  std::string element;              ///< tet4 | tet10; empty: the robot file's
  std::string material_model;       ///< empty: the robot file's
  std::optional<double> youngs_modulus_Pa;
  std::optional<double> poissons_ratio;
  double c20_over_c10 = 0.0;  ///< yeoh only
  double c30_over_c10 = 0.0;
  std::vector<PronyTerm> prony;  ///< empty: creep of the robot file
};

enum class MotionMode { kQuasiStatic, kDynamic };

struct Motion {
  MotionMode mode = MotionMode::kQuasiStatic;
  double time_step_s = 1.0 / 60.0;     ///< > 0, the largest
  double rayleigh_mass_1_s = 1.0;      ///< alpha of C = alpha M + beta K, >= 0
  double rayleigh_stiffness_s = 1e-3;  ///< beta, >= 0
};

/// How a chamber gets its pressure where that is not ideal.
struct ChamberSupply {
  std::string chamber;
  double valve_time_constant_s = 0.0;  ///< >= 0, without the leak
  double leak_ratio = 0.0;             ///< >= 0, conductance of the leak over that of the valve
  double sensor_gain = 0.0;  ///< the supply has (1 + gain) p + zero where its sensor reads p
  double sensor_zero_Pa = 0.0;
  double sensor_noise_Pa = 0.0;  ///< >= 0, standard deviation of a reading
  SourceLocation location = {};
};

/// hand: fingers and palm of capsules, seen by the camera only; touches nothing.
enum class ToolShape { kSphere, kCylinder, kPlate, kHand };

/// A rigid body that moves along its path. Its frame: origin in the centre; a cylinder's axis is z.
struct Tool {
  std::string name;
  ToolShape shape = ToolShape::kSphere;
  double radius_m = 0.01;                     ///< sphere, cylinder
  double length_m = 0.05;                     ///< cylinder, ends flat
  Eigen::Vector3d size_m{0.05, 0.05, 0.005};  ///< plate: full edges along x, y, z
  double friction_coefficient = 0.0;          ///< Coulomb's, >= 0, on the robot
  Eigen::Vector3d color_rgb{0.2, 0.3, 0.8};   ///< [0, 1]
};

struct Waypoint {
  double t_s = 0.0;
  Eigen::Isometry3d T_robot_tool = Eigen::Isometry3d::Identity();
};

/// Positions straight, rotations by the shortest arc between waypoints; held before the first and
/// after the last. A tool without a path in a recording is not there.
struct ToolPath {
  std::string tool;
  std::vector<Waypoint> waypoints;  ///< time rising, at least one
};

/// A weight hung on the body: a dead load along gravity (as turned with the base), declared to the
/// estimator in loads.csv.
struct HungWeight {
  double t_s = 0.0;  ///< acts from here to the next time that is named for any weight
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< of the undeformed body
  double mass_kg = 0.0;                                  ///< >= 0
  double patch_radius_m = 0.0;
};

/// Commands at one time, before any effect. Linear between rows. NaN: the cable is free (it has no
/// tension), the chamber open to the air.
struct CommandRow {
  double t_s = 0.0;
  /// [commands] in the order of CommandScript::cables: displacement of a cable, m; pressure of a
  /// chamber above ambient, Pa.
  Eigen::VectorXd displacement_m;
};

struct CommandScript {
  std::vector<std::string> cables;    ///< names of the cables and chambers with a command
  std::vector<CommandRow> rows;       ///< time rising, at least one where cables is not empty
  std::vector<bool> of_chamber = {};  ///< [commands], or empty: of cables alone

  Eigen::VectorXd At(double t_s) const;  ///< [commands]
};

struct RecordingPlan {
  std::string name;
  std::string kind = "free";  ///< as in recording.yaml
  double duration_s = 1.0;    ///< > 0
  CommandScript commands;
  std::vector<ToolPath> tool_paths;
  std::vector<HungWeight> weights;
  Eigen::Vector2d base_tilt_deg = Eigen::Vector2d::Zero();
  /// Pose to which the camera was moved on purpose; it goes into recording.yaml.
  std::optional<Eigen::Isometry3d> T_robot_camera;
  std::string notes;
  SourceLocation location;
};

enum class DepthSensor { kNone, kStereo, kTimeOfFlight };

/// Noise of the depth image of the virtual camera.
struct DepthNoise {
  DepthSensor sensor = DepthSensor::kStereo;
  double subpixel_px = 0.08;          ///< sigma of the disparity
  double correlation_px = 1.5;        ///< over which it is correlated in the image
  double temporal_correlation = 0.3;  ///< between frames, [0, 1)
  double disparity_step_px = 1.0 / 32.0;
  double periodic_bias_px = 0.05;     ///< of the sub-pixel interpolation
  double low_frequency_bias = 0.003;  ///< smooth over the image, share of z, RMS
  double edge_hole_ratio = 0.5;       ///< of pixels along depth edges
  double flying_pixel_ratio = 0.1;
  double grazing_angle_rad = 1.22;  ///< beyond it holes grow
  double range_sigma_m = 0.002;     ///< time of flight: at 1 m on white; grows with 1/amplitude
};

struct CameraSpec {
  rgbd::RgbdCamera camera;  ///< as its data sheet, and camera.yaml, have it
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();  ///< of the depth camera
  double rate_hz = 30.0;
  DepthNoise noise;
};

/// A camera beside the first. Effects act on the first alone; noise and bias are its own.
struct FurtherCamera : CameraSpec {
  std::string name;             ///< of its folder in a recording
  double delay_s = 0.0;         ///< of its first frame, since the start of a recording, >= 0
  double clock_offset_s = 0.0;  ///< its stamps less the time
};

/// Everything that is drawn and is not the robot or a tool.
struct Stage {
  double table_height_m = 0.0;  ///< top of the table, robot frame (z up)
  Eigen::Vector2d table_size_m{0.8, 0.8};
  Eigen::Vector3d table_color_rgb{0.45, 0.33, 0.22};
  double background_distance_m = 0.5;  ///< of the wall behind, from the robot's axis; 0: none
  Eigen::Vector3d background_color_rgb{0.75, 0.76, 0.78};
  Eigen::Vector3d robot_color_rgb{0.85, 0.30, 0.25};
  double marker_radius_m = 0.004;  ///< of the coloured discs at the robot's markers; 0: none
  /// Of all these discs; without: hues of their own, as far apart as can be.
  std::optional<Eigen::Vector3d> marker_color_rgb;
  double light = 1.0;  ///< brightness of the lamps
};

struct MarkerSpec {
  Eigen::Vector3d sigma_m{3e-4, 3e-4, 3e-4};  ///< > 0
  double rate_hz = 30.0;
  double missing_share = 0.0;  ///< [0, 1] of the positions are not seen, drawn by the seed
  /// The depth camera measures the markers, with its errors, and takes no images. Else motion
  /// capture measures them without bias, in the frame of the camera where there is one.
  bool by_depth_camera = false;
};

/// scenario.yaml: a virtual bench, and what is done on it. Every key: README.md here.
struct Scenario {
  std::filesystem::path file;
  std::string name;
  BodyTruth body;
  Motion motion;
  std::vector<ChamberSupply> supply = {};  ///< of chambers whose supply is not ideal
  std::vector<Effect> effects;
  /// Standard deviation of each parameter of the catalogue, in its manufacturing tolerances. 0:
  /// exactly as the robot file says.
  double clutter = 0.0;
  std::vector<Tool> tools;
  std::optional<CameraSpec> camera;            ///< without: no images
  std::vector<FurtherCamera> further_cameras;  ///< only beside `camera`
  Stage stage;
  std::optional<MarkerSpec> markers;      ///< without: no markers
  double rest_between_s = 1.0;            ///< between recordings, commands at zero
  std::vector<RecordingPlan> recordings;  ///< at least one; names rising

  const Tool& ToolNamed(const std::string& name) const;
  bool TakesPictures() const { return camera && !(markers && markers->by_depth_camera); }
  /// When each recording begins on the bench's clock (schedule.hpp), s.
  std::vector<double> RecordingBegins_s() const;
  /// The scenario with the camera of that number as its only one; 0: `camera`.
  Scenario WithCamera(std::size_t number) const;
};

/// Reads strictly: unknown keys, wrong units, a tool, cable or effect that does not exist are
/// refused with file:line:column. What depends on the robot (cable, region and marker names) is
/// checked by CheckAgainst.
Scenario ReadScenario(const std::filesystem::path& file, const ConfigLoader& load);

/// What a scenario has to know of a robot file.
struct RobotNames {
  std::vector<std::string> cables;
  std::vector<std::string> chambers = {};
  std::vector<std::string> regions;
  std::vector<std::string> markers;
  /// Of the material, to which the tolerance is added. NaN: unknown, nu has no tolerance.
  double poissons_ratio = std::numeric_limits<double>::quiet_NaN();

  /// Cables, then chambers: the order of all commands.
  std::vector<std::string> Actuators() const;
};

/// Throws InputError, at the effect's or the recording's place in the file, where the scenario
/// names what the robot does not have, or asks for more effects of a kind than the robot has
/// places.
void CheckAgainst(const Scenario& scenario, const RobotNames& robot);

/// Where the tool is at time `t_s` of the recording; nothing: it is not there.
std::optional<Eigen::Isometry3d> PoseAt(const RecordingPlan& plan, const std::string& tool,
                                        double t_s);

}  // namespace palpate::scenario
