// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/node_matrix.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/fem/shape_functions.hpp"

namespace palpate::fem {

NodeMatrix::NodeMatrix(const TetMesh& mesh)
    : nodes_per_cell_(static_cast<int>(mesh.cells.rows())),
      pairs_per_cell_(nodes_per_cell_ * (nodes_per_cell_ + 1) / 2),
      column_start_(At(mesh.NodeCount()) + 1, 0) {
  NodePairs columns;  // (column, row), column <= row
  for (int node = 0; node < mesh.NodeCount(); ++node) columns.emplace_back(node, node);
  for (Eigen::Index cell = 0; cell < mesh.cells.cols(); ++cell) {
    for (int a = 1; a < nodes_per_cell_; ++a) {
      for (int b = 0; b < a; ++b) {
        columns.push_back(std::minmax(mesh.cells(a, cell), mesh.cells(b, cell)));
      }
    }
  }
  std::sort(columns.begin(), columns.end());
  columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
  for (const auto& [column, row] : columns) {
    ++column_start_[At(column) + 1];
    row_.push_back(row);
  }
  for (size_t j = 1; j < column_start_.size(); ++j) column_start_[j] += column_start_[j - 1];
  values_.assign(row_.size(), 0.0);
  entry_of_cell_.reserve(At(mesh.CellCount() * pairs_per_cell_));
  for (Eigen::Index cell = 0; cell < mesh.cells.cols(); ++cell) {
    for (int a = 0; a < nodes_per_cell_; ++a) {
      for (int b = 0; b <= a; ++b) {
        entry_of_cell_.push_back(Entry(mesh.cells(a, cell), mesh.cells(b, cell)));
      }
    }
  }
}

int NodeMatrix::Entry(int node_a, int node_b) const {
  const auto [column, row] = std::minmax(node_a, node_b);
  const auto first = row_.begin() + column_start_[At(column)];
  const auto last = row_.begin() + column_start_[At(column) + 1];
  const auto found = std::lower_bound(first, last, row);
  PALPATE_CHECK(found != last && *found == row, node_a, node_b);
  return static_cast<int>(found - row_.begin());
}

void NodeMatrix::SetZero() { std::fill(values_.begin(), values_.end(), 0.0); }

void NodeMatrix::Add(int node_a, int node_b, double value) {
  values_[At(Entry(node_a, node_b))] += value;
}

void NodeMatrix::AddProduct(const Eigen::VectorXd& nodal, double factor,
                            Eigen::VectorXd& result) const {
  for (int column = 0; column < NodeCount(); ++column) {
    const int begin = column_start_[At(column)];
    const Eigen::Vector3d own = factor * nodal.segment<3>(3 * column);
    Eigen::Vector3d sum = values_[At(begin)] * own;
    for (int k = begin + 1; k < column_start_[At(column) + 1]; ++k) {
      const int row = row_[At(k)];
      const double value = values_[At(k)];
      sum += (factor * value) * nodal.segment<3>(3 * row);
      result.segment<3>(3 * row) += value * own;
    }
    result.segment<3>(3 * column) += sum;
  }
}

double NodeMatrix::Quadratic(const Eigen::VectorXd& nodal) const {
  Eigen::VectorXd product = Eigen::VectorXd::Zero(nodal.size());
  AddProduct(nodal, 1.0, product);
  return nodal.dot(product);
}

void NodeMatrix::BindTo(const StiffnessMatrix& stiffness) {
  PALPATE_CHECK(stiffness.NodeCount() == NodeCount(), stiffness.NodeCount(), NodeCount());
  address_.clear();
  for (int column = 0; column < NodeCount(); ++column) {
    for (int k = column_start_[At(column)]; k < column_start_[At(column) + 1]; ++k) {
      address_.push_back(stiffness.Slot(column, row_[At(k)]).address);
    }
  }
}

void NodeMatrix::AddTo(double factor, StiffnessMatrix& stiffness) const {
  PALPATE_CHECK(address_.size() == values_.size(), address_.size(), values_.size());
  double* blocks = stiffness.Values().data();
  for (size_t k = 0; k < values_.size(); ++k) {
    if (address_[k] < 0) continue;
    double* block = blocks + address_[k];
    const double value = factor * values_[k];
    block[0] += value;
    block[4] += value;
    block[8] += value;
  }
}

void AddConsistentMass(const TetMesh& mesh, const Eigen::VectorXd& density_kg_m3,
                       NodeMatrix* mass) {
  const TetQuadrature rule = FineQuadrature();
  const auto nodes_per_cell = mesh.cells.rows();
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    Eigen::Matrix3Xd corners(3, nodes_per_cell);
    for (int a = 0; a < nodes_per_cell; ++a) corners.col(a) = mesh.nodes_m.col(mesh.cells(a, cell));
    Eigen::MatrixXd local = Eigen::MatrixXd::Zero(nodes_per_cell, nodes_per_cell);
    for (int q = 0; q < rule.weights.size(); ++q) {
      const Eigen::Vector3d xi = rule.points.col(q);
      const Eigen::Matrix3d jacobian =
          corners * ShapeGradients(mesh.element_type(), xi).transpose();
      const Eigen::VectorXd N = ShapeFunctions(mesh.element_type(), xi);
      local += density_kg_m3[cell] * rule.weights[q] * jacobian.determinant() * N * N.transpose();
    }
    mass->AddCell(cell, local);
  }
}

}  // namespace palpate::fem
