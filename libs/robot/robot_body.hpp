// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "libs/fem/boundary_surface.hpp"
#include "libs/fem/embedding.hpp"
#include "libs/fem/enclosed_volume.hpp"
#include "libs/fem/fibre.hpp"
#include "libs/fem/material.hpp"
#include "libs/fem/mullins.hpp"
#include "libs/fem/prony_term.hpp"
#include "libs/fem/tet_mesh.hpp"
#include "libs/robot/actuator.hpp"
#include "libs/robot/robot_description.hpp"

namespace palpate::robot {

struct BodyCable {
  std::string name;
  Eigen::Vector3d pull_point_m;         ///< fixed to the ground
  std::vector<fem::BodyPoint> eyelets;  ///< at least one; the cable is attached to the last
  double max_tension_N = 0.0;
  double friction_coefficient = 0.0;
  double guide_radius_m = 0.0;
  /// [eyelets] how far each sits off its place in the robot file, of a robot of scale 1; empty: not
  /// at all (eyelets.hpp).
  std::vector<Eigen::Vector3d> eyelets_moved_m = {};
  double play_m = 0.0;  ///< full width, of the actuator
};

struct BodyChamber {
  std::string name;
  fem::MovingSurface wall;       ///< closed; its outside is the material
  double volume_m3 = 0.0;        ///< of the undeformed body, > 0
  double dead_volume_m3 = 0.0;   ///< of the tube
  double max_pressure_Pa = 0.0;  ///< above ambient
};

struct BodyFibre {
  std::string name;
  std::vector<Eigen::Matrix3Xd> paths_m;  ///< polylines [3 x >= 2], as laid, for scale 1
  fem::EmbeddedFibre embedded = {};
  double length_m = 0.0;  ///< of all of them, for scale 1
};

struct BodyMarker {
  std::string name;
  fem::BodyPoint point;
};

/// A robot file put together with its mesh: everything that an FE model is made from, at rest, in
/// the robot frame. Plain data; nothing is solved here.
struct RobotBody {
  std::string name;
  fem::TetMesh mesh;              ///< placed, of the element that the robot file names
  fem::BoundarySurface boundary;  ///< of `mesh`
  /// Faces of `boundary` where something can touch, in rising order: fem::OuterFaces, of the region
  /// of `feature_points` where the robot file names one. Empty: all.
  std::vector<int> contact_faces;

  /// Name of the mesh as it lies in the file, and of the element: 64-bit FNV-1a over the nodes (in
  /// metres, before the placement), the elements and the number of nodes per element, as
  /// "fnv1a-<16 hex digits>". A calibrated modulus holds for one mesh and element only.
  std::string mesh_hash;

  std::vector<fem::Material> materials;  ///< 0: the body's; k + 1: of region k
  /// Of the body in the robot file: calibrations name it, whatever they make of `materials`.
  double nominal_poissons_ratio = 0.0;
  std::vector<int> material_of_cell;      ///< [elements] index into materials
  std::vector<std::string> region_names;  ///< in the order of the robot file
  /// Of all materials (history_state.hpp); static equilibria are of a relaxed body that was not
  /// strained before.
  std::vector<fem::PronyTerm> creep;
  std::optional<fem::MullinsLaw> softening;

  /// [3 x n] directions that are held; nodes that no element uses are held too.
  Eigen::Matrix<bool, 3, Eigen::Dynamic> fixed;
  /// [n] Share of each node in the weight. By volume: integral of rho N_i, for tet10 negative on
  /// most corners. Per node: the total mass shared equally by the nodes that elements use.
  Eigen::VectorXd node_mass_kg;
  Eigen::Vector3d gravity_m_s2;

  double scale = 1.0;  ///< how much larger all of it is than the robot file says (ScaleBody)
  std::vector<BodyCable> cables;
  std::vector<BodyChamber> chambers;
  std::vector<BodyFibre> fibres;
  double eyelet_room_m = 0.0;  ///< how far a model of it can move eyelets (GiveEyeletsRoom)
  std::vector<BodyMarker> markers;
  std::vector<fem::BodyPoint> feature_points;
  /// The robot file gives them; else they are spread over contact_faces.
  bool feature_points_are_given = false;
  Eigen::Matrix3Xd feature_normals;  ///< [3 x feature_points] unit, outward, of the nearest face

  /// What a log should say: the mesh, fixed nodes, points that lie off the mesh.
  std::vector<std::string> notes;
  /// What is likely an error of the robot file: a modulus below 1 kPa, a cable in a hollow.
  std::vector<std::string> warnings;
};

/// Reads the mesh that `robot` names, places it and puts everything on it. Throws InputError: a
/// mesh that cannot be read or solved, or is of another element; a fixed box without a node; a
/// piece of the mesh that is not held against every rigid motion; a region without an element; a
/// point of a cable more than 20 mm or 5 % of the body's diagonal from the body, whichever is less;
/// a marker or a given feature point farther from it than that diagonal; what ChamberWall and
/// LayFibre refuse.
RobotBody BuildRobotBody(const RobotDescription& robot);

/// Cables, then chambers: the order of commands and multipliers.
std::vector<ActuatorTraits> ActuatorsOf(const RobotBody& body);

/// The fibres of all of them, for the elastic body.
std::vector<fem::EmbeddedFibre> EmbeddedFibres(const std::vector<BodyFibre>& fibres);

/// The rest surface where something can touch: contact_faces, or all where there are none.
geometry::TriangleSurface ContactSurface(const RobotBody& body);

}  // namespace palpate::robot
