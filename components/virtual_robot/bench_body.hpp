// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "components/virtual_robot/effects.hpp"
#include "libs/fem/boundary_surface.hpp"
#include "libs/fem/linearisation.hpp"
#include "libs/fem/material.hpp"
#include "libs/fem/mullins.hpp"
#include "libs/fem/prony_term.hpp"
#include "libs/fem/tet_mesh.hpp"
#include "libs/robot/robot_body.hpp"
#include "libs/robot/robot_description.hpp"
#include "libs/scenario/scenario.hpp"

namespace palpate::virtual_robot {

/// The body of the bench: the robot file's, with the mesh, element and material that the scenario
/// gives it, and with the effects that change what it is made of and its shape at rest.
struct BenchBody {
  fem::TetMesh nominal;  ///< undeformed, as drawn: where points of files are located
  fem::TetMesh mesh;     ///< undeformed, as it is
  /// [3n] undeformed, as it was when the cables were put on: before a plastic set.
  Eigen::VectorXd assembled_m;
  fem::BoundarySurface boundary;
  std::string mesh_hash;
  std::vector<fem::Material> materials;  ///< 0: the body's; k + 1: of region k
  std::vector<int> material_of_cell;
  std::vector<std::string> region_names;
  std::vector<fem::PronyTerm> prony;         ///< of all materials
  std::optional<fem::MullinsLaw> softening;  ///< of all materials; none: they do not soften
  double density_kg_m3 = 0.0;  ///< of the body as drawn; a mass per node counts as spread evenly
  fem::FixedDirections fixed;
  Eigen::Vector3d gravity_m_s2 = Eigen::Vector3d::Zero();
  std::vector<robot::BodyCable> cables;
  std::vector<robot::BodyChamber> chambers;
  std::vector<robot::BodyFibre> fibres;
  std::vector<robot::BodyMarker> markers;

  Eigen::VectorXd rest_m() const { return mesh.nodes_m.reshaped(); }  ///< [3n]
  std::vector<std::string> CableNames() const;
  std::vector<std::string> MarkerNames() const;
};

/// Throws InputError where the mesh, the material or an effect does not fit.
BenchBody MakeBenchBody(const robot::RobotDescription& robot, const scenario::BodyTruth& truth,
                        const Effects& effects);

}  // namespace palpate::virtual_robot
