// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/diagnosis/model/history_operator.hpp"
#include "components/diagnosis/model/model_hypothesis.hpp"
#include "components/diagnosis/model/simulation.hpp"
#include "libs/fem/tet_mesh.hpp"

namespace palpate::diagnosis {

/// [cells] by their corners.
Eigen::VectorXd CellVolumes_m3(const fem::TetMesh& mesh);

/// [cells x samples Memory::kLooks] by how much the energy density lies below the largest that each
/// cell has seen until then, J/m^3. It grows as the square of how far the body is bent, and that is
/// followed.
Eigen::MatrixXf BelowLargest_J_m3(const HistoryOperator& history, const Simulation& simulation);

/// A step of the damage of all samples towards what MullinsSoftening asks for after the energies of
/// `simulation`, the shorter the more these will answer (under a given load they go as 1 / eta^2).
void Soften(const MullinsSoftening& mullins, const HistoryOperator& history,
            const Simulation& simulation, std::vector<HistoryVariables>* past);

}  // namespace palpate::diagnosis
