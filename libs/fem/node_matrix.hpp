// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/core/index.hpp"
#include "libs/fem/stiffness_matrix.hpp"
#include "libs/fem/tet_mesh.hpp"

namespace palpate::fem {

/// A symmetric matrix over the nodes of a mesh that is the same for x, y and z: A (x) I3, as a mass
/// matrix does. Nodes are coupled where they share a cell. Its unit is its user's.
class NodeMatrix {
 public:
  explicit NodeMatrix(const TetMesh& mesh);

  int NodeCount() const { return static_cast<int>(column_start_.size()) - 1; }
  void SetZero();
  /// Adds the symmetric matrix `local` [nodes x nodes of a cell] to the entries of a cell.
  template <typename Local>
  void AddCell(int cell, const Local& local) {
    const int* entry = entry_of_cell_.data() + static_cast<size_t>(cell * pairs_per_cell_);
    for (int a = 0; a < nodes_per_cell_; ++a) {
      for (int b = 0; b <= a; ++b) values_[At(*entry++)] += local(a, b);
    }
  }
  /// Adds `value` to entry (a, b), and to (b, a). The two share a cell, or are one node.
  void Add(int node_a, int node_b, double value);

  /// Adds factor * A nodal to `result`; both [3n], x y z interleaved.
  void AddProduct(const Eigen::VectorXd& nodal, double factor, Eigen::VectorXd& result) const;
  /// nodal' A nodal.
  double Quadratic(const Eigen::VectorXd& nodal) const;

  /// Looks up its blocks once; AddTo needs it.
  void BindTo(const StiffnessMatrix& stiffness);
  /// Adds factor * A to the matrix that BindTo was called with.
  void AddTo(double factor, StiffnessMatrix& stiffness) const;

 private:
  int Entry(int node_a, int node_b) const;

  int nodes_per_cell_;
  int pairs_per_cell_;
  std::vector<int> column_start_;   ///< [n + 1] into row_; lower triangle, columns compressed
  std::vector<int> row_;            ///< ascending in each column, the diagonal first
  std::vector<int> entry_of_cell_;  ///< [cells][pairs (a, b), b <= a]
  std::vector<int> address_;        ///< [entries] first entry of the block, or -1
  std::vector<double> values_;      ///< [entries]
};

/// Consistent mass matrix, entries integral of rho N_a N_b, kg: added to `mass`, which was made for
/// `mesh`. `density_kg_m3` has one value for each cell. Exact for cells with straight edges.
void AddConsistentMass(const TetMesh& mesh, const Eigen::VectorXd& density_kg_m3, NodeMatrix* mass);

}  // namespace palpate::fem
