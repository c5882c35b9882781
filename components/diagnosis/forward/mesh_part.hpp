// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "libs/fem/interpolation_weights.hpp"
#include "libs/fem/linearisation.hpp"
#include "libs/fem/tet_mesh.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::diagnosis {

/// Elements of a body by their corners: all of them, or those about one place. What one mesh does
/// under loads at rest, against what a finer one does.
struct MeshPart {
  fem::TetMesh mesh;                  ///< tet4
  std::vector<int> material_of_cell;  ///< [elements] index into the body's materials
  fem::FixedDirections fixed;         ///< [3 x nodes]
};

/// All elements, held as the body is.
MeshPart WholeMesh(const robot::RobotBody& body);

/// The elements that share a node with `cell`, held where they meet others, too.
MeshPart PartAbout(const robot::RobotBody& body, int cell);

/// Each element cut into eight; nodes in the middle of an edge are held as both of its ends are.
MeshPart Refined(const MeshPart& part);

/// Adds the nodal forces [3n] of a force on a point.
void AddPointLoad(const fem::InterpolationWeights& point, const Eigen::Vector3d& force_N,
                  Eigen::Ref<Eigen::VectorXd> nodal_N);

/// The part at rest, its stiffness factorised.
class PartAtRest {
 public:
  PartAtRest(const MeshPart& part, fem::ElementType element, const robot::RobotBody& body);

  const fem::TetMesh& mesh() const { return mesh_; }
  /// [3n x loads] m, of nodal loads [3n x loads], N, by the stiffness at rest; nothing where the
  /// part can move as a whole.
  std::optional<Eigen::MatrixXd> MotionUnder(const Eigen::MatrixXd& loads_N);

 private:
  fem::TetMesh mesh_;
  fem::FixedDirections fixed_;
  fem::ElasticBody elastic_;
  fem::Linearisation at_rest_;
};

}  // namespace palpate::diagnosis
