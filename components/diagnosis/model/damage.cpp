// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/model/damage.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace palpate::diagnosis {

Eigen::VectorXd CellVolumes_m3(const fem::TetMesh& mesh) {
  Eigen::VectorXd volume_m3(mesh.CellCount());
  for (Eigen::Index cell = 0; cell < volume_m3.size(); ++cell) {
    const Eigen::Vector3d origin_m = mesh.nodes_m.col(mesh.cells(0, cell));
    const auto edge_m = [&](int corner) -> Eigen::Vector3d {
      return mesh.nodes_m.col(mesh.cells(corner, cell)) - origin_m;
    };
    volume_m3[cell] = edge_m(1).cross(edge_m(2)).dot(edge_m(3)) / 6.0;
  }
  return volume_m3;
}

Eigen::MatrixXf BelowLargest_J_m3(const HistoryOperator& history, const Simulation& simulation) {
  Eigen::MatrixXf root(simulation.at_rest.energy_J_m3.size(), history.ColumnCount());
  for (Eigen::Index column = 0; column < root.cols(); ++column) {
    root.col(column) = MemorableOf(simulation, column).energy_J_m3.cwiseMax(0.0F).cwiseSqrt();
  }
  const HistoryOperator::Course course = history.Follow(root);
  return course.largest.cwiseAbs2() - course.now.cwiseAbs2();
}

void Soften(const MullinsSoftening& mullins, const HistoryOperator& history,
            const Simulation& simulation, std::vector<HistoryVariables>* past) {
  const Eigen::MatrixXf below_J_m3 = BelowLargest_J_m3(history, simulation);
  past->resize(simulation.samples.size());
  for (std::size_t s = 0; s < past->size(); ++s) {
    Eigen::VectorXd& factor = (*past)[s].cell_factor;
    if (factor.size() == 0) factor.setOnes(below_J_m3.rows());
    const Eigen::VectorXf& density_J_m3 = simulation.samples[s].in_the_middle.energy_J_m3;
    for (Eigen::Index cell = 0; cell < factor.size(); ++cell) {
      const Eigen::Array<double, HistoryOperator::kLooks, 1> below =
          below_J_m3.row(cell)
              .segment<HistoryOperator::kLooks>(HistoryOperator::kLooks *
                                                static_cast<Eigen::Index>(s))
              .transpose()
              .cast<double>()
              .array() /
          mullins.m_J_m3;
      const double softened = below.unaryExpr([](double u) { return std::erf(u); }).mean();
      const double wanted = 1.0 - mullins.inverse_r * softened;
      const double answer = 4.0 * std::numbers::inv_sqrtpi * (-below.square()).exp().mean() *
                            double{density_J_m3[cell]} * mullins.inverse_r /
                            (mullins.m_J_m3 * factor[cell]);
      factor[cell] += (wanted - factor[cell]) / (1.0 + answer);
    }
  }
}

}  // namespace palpate::diagnosis
