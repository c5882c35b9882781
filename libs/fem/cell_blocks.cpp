// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/cell_blocks.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/fem/shape_functions.hpp"

namespace palpate::fem {

namespace {

using kernels::kLanes;

/// [blocks][lanes]
std::vector<int> FilledUp(std::vector<int> cells) {
  cells.resize((cells.size() + kLanes - 1) / kLanes * kLanes, -1);
  return cells;
}

/// Places of the cell's nodes, ascending in `row_of_node`.
std::vector<int> LocalOrder(const TetMesh& mesh, int cell, const std::vector<int>& row_of_node) {
  std::vector<int> order(At(static_cast<int>(mesh.cells.rows())));
  for (size_t a = 0; a < order.size(); ++a) order[a] = static_cast<int>(a);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return row_of_node[At(mesh.cells(a, cell))] < row_of_node[At(mesh.cells(b, cell))];
  });
  return order;
}

}  // namespace

CellBlocks::CellBlocks(const TetMesh& mesh, const std::vector<int>& cells, const Material& material,
                       const std::vector<int>& row_of_node)
    : nodes_per_cell_(static_cast<int>(mesh.cells.rows())),
      points_(mesh.element_type() == ElementType::kTet4 ? 1 : 4),
      cells_(FilledUp(cells)) {
  if (material.volumetric == Volumetric::kMeanDilatation &&
      !kernels::SupportsMeanDilatation(material.model)) {
    throw InputError("material '" + std::string(ToString(material.model)) +
                     "' has no volumetric energy of its own: mean_dilatation is not possible");
  }
  kernel_ = kernels::SelectKernel(nodes_per_cell_, material.model, material.volumetric);
  nodes_.resize(cells_.size() * At(nodes_per_cell_));
  gradients_.resize(cells_.size() * At(points_ * nodes_per_cell_ * 3));
  weights_.resize(cells_.size() * At(points_));
  for (int block = 0; block < BlockCount(); ++block) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const int cell = CellAt(block, lane);
      // Lanes left over repeat a cell; their results are never read.
      FillLane(mesh, cell < 0 ? cells.front() : cell, row_of_node, block, lane);
    }
  }
}

void CellBlocks::FillLane(const TetMesh& mesh, int cell, const std::vector<int>& row_of_node,
                          int block, int lane) {
  const std::vector<int> order = LocalOrder(mesh, cell, row_of_node);
  Eigen::Matrix3Xd corners(3, nodes_per_cell_);
  for (int a = 0; a < nodes_per_cell_; ++a) {
    corners.col(a) = mesh.nodes_m.col(mesh.cells(a, cell));
    nodes_[At((block * nodes_per_cell_ + a) * kLanes + lane)] = mesh.cells(order[At(a)], cell);
  }
  const TetQuadrature rule = StiffnessQuadrature(mesh.element_type());
  for (int q = 0; q < points_; ++q) {
    const Eigen::Matrix3Xd dN = ShapeGradients(mesh.element_type(), rule.points.col(q));
    const Eigen::Matrix3d jacobian = corners * dN.transpose();  // dX/dxi
    const double determinant = jacobian.determinant();
    if (!(determinant > 0.0)) {
      throw InputError("cell " + std::to_string(cell) +
                       " is inverted or degenerate at an integration point");
    }
    const Eigen::Matrix3Xd gradients = jacobian.transpose().inverse() * dN;
    for (int a = 0; a < nodes_per_cell_; ++a) {
      for (int i = 0; i < 3; ++i) {
        const int row = ((block * points_ + q) * nodes_per_cell_ + a) * 3 + i;
        gradients_[At(row) * kLanes + At(lane)] = gradients(i, order[At(a)]);
      }
    }
    weights_[At((block * points_ + q) * kLanes + lane)] = determinant * rule.weights[q];
  }
}

void CellBlocks::SetModuli(const std::vector<Material>& materials,
                           const std::vector<int>& material_of_cell,
                           const Eigen::VectorXd& factor_of_cell) {
  lambda_Pa_.clear();
  mu_Pa_.clear();
  c20_over_c10_.clear();
  c30_over_c10_.clear();
  for (const int cell : cells_) {
    const int known_cell = cell < 0 ? cells_.front() : cell;
    const Material& material = materials[At(material_of_cell[At(known_cell)])];
    const double factor = factor_of_cell.size() == 0 ? 1.0 : factor_of_cell[known_cell];
    lambda_Pa_.push_back(factor * material.LameLambda_Pa());
    mu_Pa_.push_back(factor * material.LameMu_Pa());
    c20_over_c10_.push_back(material.c20_over_c10);
    c30_over_c10_.push_back(material.c30_over_c10);
  }
}

kernels::Block CellBlocks::View(int block) const {
  const size_t first = At(block) * kLanes;
  return {.nodes = nodes_.data() + first * At(nodes_per_cell_),
          .gradients = gradients_.data() + first * At(points_ * nodes_per_cell_ * 3),
          .weights = weights_.data() + first * At(points_),
          .lambda_Pa = lambda_Pa_.data() + first,
          .mu_Pa = mu_Pa_.data() + first,
          .c20_over_c10 = c20_over_c10_.data() + first,
          .c30_over_c10 = c30_over_c10_.data() + first};
}

}  // namespace palpate::fem
