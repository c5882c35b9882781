// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "libs/core/config_node.hpp"
#include "libs/core/number_rule.hpp"
#include "libs/fem/material.hpp"
#include "libs/fem/mullins.hpp"
#include "libs/fem/prony_term.hpp"
#include "libs/fem/tet_mesh.hpp"
#include "libs/geometry/box.hpp"

namespace palpate::robot {

/// Axis-aligned box in the robot frame, bounds included.
using Box = geometry::Box;

struct MeshSettings {
  std::filesystem::path file;                                ///< resolved against the robot file
  double metres_per_unit = 1.0;                              ///< of `unit: m | cm | mm`
  Eigen::Vector3d rotate_xyz_deg = Eigen::Vector3d::Zero();  ///< about the fixed x, then y, then z
  Eigen::Vector3d translate_m = Eigen::Vector3d::Zero();     ///< after the rotation
  SourceLocation where;                                      ///< of `file`
};

enum class MassDistribution { kVolume, kPerNode };

struct MassSettings {
  std::optional<double> total_kg;  ///< one of the two is given
  std::optional<double> density_kg_m3;
  MassDistribution distribution = MassDistribution::kVolume;
};

/// A cable. First point of its route: the pull point, fixed to the ground. The others are eyelets
/// on the body through which it slides; it is attached to the last one.
struct CableSettings {
  std::string name;
  Eigen::Matrix3Xd path_m;         ///< [3 x >=2], robot frame, at rest
  double max_tension_N = 1e3;      ///< > 0
  double guide_radius_m = 0.0015;  ///< >= 0; 0: barycentric points
  /// >= 0; of the cable in its eyelets (cable_friction.hpp).
  double friction_coefficient = 0.0;
  SourceLocation where;
  double play_m = 0.0;  ///< >= 0, full width, of the actuator
};

/// The wall of a chamber: one of the three.
struct ChamberSurface {
  int inner_skin = 0;          ///< > 0: the n-th closed inner surface of the mesh (fem::InnerSkins)
  std::string physical_group;  ///< not empty: triangles that the mesh file names so
  std::filesystem::path file;  ///< not empty: a closed surface (STL), placed as the mesh is
};

/// A closed chamber in the body that a fluid under pressure fills.
struct ChamberSettings {
  std::string name;  ///< no cable has it
  ChamberSurface surface;
  double dead_volume_m3 = 0.0;     ///< >= 0; of the tube up to the sensor or valve
  double max_pressure_Pa = 100e3;  ///< > 0, above ambient
  SourceLocation where;
  SourceLocation surface_where;
};

/// A fibre wound round an axis, as a thread or as separate closed rings.
struct Winding {
  enum class Kind { kHelix, kRings };
  Kind kind = Kind::kHelix;
  Eigen::Matrix<double, 3, 2> axis_m;  ///< where it begins and ends, robot frame; they differ
  double radius_m = 0.0;               ///< > 0
  double spacing_m = 0.0;              ///< > 0, along the axis: pitch of the helix, or of the rings
  bool left_handed = false;            ///< of a helix
};

/// A line in the body that keeps its length: a thread, or rings. Either a polyline or a winding.
struct FibreSettings {
  std::string name;
  Eigen::Matrix3Xd path_m;         ///< [3 x >=2], robot frame, at rest; or empty
  std::optional<Winding> winding;  ///< where there is no path
  /// EA, N, > 0. Nothing: stiff enough to keep its length (fibre_paths.hpp).
  std::optional<double> axial_stiffness_N;
  SourceLocation where;
};

/// A named part of the body; its own modulus where given, else the body's.
struct RegionSettings {
  std::string name;
  Box box;  ///< takes the elements whose centroid lies inside; a later region wins over an earlier
  std::optional<double> youngs_modulus_Pa;
  SourceLocation where;
  std::string mesh_group = {};  ///< not empty: takes the elements of this group instead
};

struct MarkerSettings {
  std::string name;
  Eigen::Vector3d position_m;  ///< of the undeformed body, before gravity; may be off the surface
  SourceLocation where;
};

/// The robot file (config/robots/*.yaml; format: docs/robot_file.md), as it was written.
struct RobotDescription {
  std::filesystem::path file;
  std::string name;
  MeshSettings mesh;
  fem::ElementType element = fem::ElementType::kTet10;
  fem::Material material;
  std::vector<fem::PronyTerm> creep = {};         ///< of all materials
  std::optional<fem::MullinsLaw> softening = {};  ///< of all materials
  MassSettings mass;
  Eigen::Vector3d gravity_m_s2{0.0, 0.0, -9.81};
  std::vector<Box> fixed;
  std::vector<SourceLocation> fixed_where;
  std::vector<CableSettings> cables;
  std::vector<ChamberSettings> chambers = {};
  std::vector<FibreSettings> fibres = {};
  std::vector<RegionSettings> regions;
  std::vector<MarkerSettings> markers;
  int feature_point_count = 51;       ///< used where no positions are given
  Eigen::Matrix3Xd feature_points_m;  ///< [3 x k] given positions, or empty
  std::string feature_point_region;   ///< name in `regions`: only its surface; empty: all
  SourceLocation feature_points_where;
};

/// Reads a robot file strictly. Throws InputError with file:line:column for an unknown key or unit
/// (with the allowed ones), a wrong type, NaN, a value out of range, a cable with fewer than two
/// points, a name given twice. BuildRobotBody checks whether mesh, boxes and points fit together.
///
/// Lengths are in metres; `mesh.translate_mm` may stand for `mesh.translate_m`. Defaults:
/// element tet10, gravity (0, 0, -9.81), 51 feature points, `material.volumetric` mean_dilatation
/// for tet10 from a Poisson's ratio of 0.48 on (against locking) where the material model has it,
/// else pointwise.
RobotDescription ReadRobotFile(const std::filesystem::path& file, const ConfigLoader& load);

/// Poisson's ratio from which tet10 averages the dilatation over the element by default.
inline constexpr double kNearlyIncompressible = 0.48;
/// Beyond it displacements change by less than 0.01 %, while rounding and Newton iterations grow
/// tenfold with each further digit (docs/near_incompressibility.md).
inline constexpr double kLargestPoissonsRatio = 0.4999;
inline constexpr NumberRule kPoissonsRatio{
    .min = -1.0, .max = kLargestPoissonsRatio, .min_open = true};
inline constexpr int kMaxFeaturePoints = 100000;
inline constexpr int kMaxInnerSkin = 1000;
/// Of one fibre: rings, and turns of a helix.
inline constexpr int kMaxRings = 10000;

/// The description as the text of a robot file that lies in `folder`: the path of the mesh is
/// written relative to it. Reading it back gives the same description.
std::string FormatRobotFile(const RobotDescription& robot, const std::filesystem::path& folder);

/// Writes FormatRobotFile to `file`. Throws RunError where that fails.
void WriteRobotFile(const RobotDescription& robot, const std::filesystem::path& file);

}  // namespace palpate::robot
