// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "libs/fem/tet_mesh.hpp"

namespace palpate::fem {

/// Softening of a material that was strained before, as R. W. Ogden and D. G. Roxburgh have it (A
/// pseudo-elastic model for the Mullins effect in filled rubber, Proc. R. Soc. Lond. A 455, 1999,
/// with their beta = 0): its moduli are times
///   eta = 1 - erf((W_max - W) / m) / r,
/// W the energy density of the undamaged material, W_max its largest value so far.
struct MullinsLaw {
  double r = 2.0;       ///< > 1
  double m_J_m3 = 1.0;  ///< > 0

  bool operator==(const MullinsLaw&) const = default;
};

/// eta of an element whose energy density lies `below_J_m3` >= 0 below its largest so far.
double Damage(const MullinsLaw& law, double below_J_m3);

/// A step of the damage eta [cells] towards what the law asks for at the energy densities
/// `density_J_m3` [cells] of the undamaged material. `largest_J_m3` [cells] holds the largest so
/// far, and is raised to these. The step is the shorter the more the energies answer under a given
/// load, as 1 / eta^2. Returns by how much the worst cell was off.
double StepDamage(const MullinsLaw& law, const Eigen::VectorXd& density_J_m3,
                  Eigen::VectorXd* largest_J_m3, Eigen::VectorXd* damage);

/// [cells] by their corners, m^3.
Eigen::VectorXd CellVolumes_m3(const TetMesh& mesh);

}  // namespace palpate::fem
