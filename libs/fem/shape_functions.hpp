// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/fem/tet_mesh.hpp"

namespace palpate::fem {

/// Shape functions of tet4 (linear) and tet10 (quadratic) in the reference tetrahedron with corners
/// 0, e1, e2, e3; node order of ElementType.
Eigen::VectorXd ShapeFunctions(ElementType type, const Eigen::Vector3d& xi);
/// [3 x nodes] derivatives with respect to xi.
Eigen::Matrix3Xd ShapeGradients(ElementType type, const Eigen::Vector3d& xi);

/// Points and weights on the reference tetrahedron; the weights add up to its volume, 1/6.
struct TetQuadrature {
  Eigen::Matrix3Xd points;
  Eigen::VectorXd weights;
};

/// The rule the stiffness is integrated with: one point for tet4, four for tet10 (degree 2).
TetQuadrature StiffnessQuadrature(ElementType type);
/// Eleven points, exact for polynomials of degree 4: for loads and error norms.
TetQuadrature FineQuadrature();

/// Lumps rho over the volume onto the nodes, consistently: m_i = integral of rho N_i, kg.
/// [nodes]; corner entries of tet10 are negative. `density_kg_m3` has one value for each cell.
Eigen::VectorXd ConsistentNodalMass_kg(const TetMesh& mesh, const Eigen::VectorXd& density_kg_m3);

}  // namespace palpate::fem
