// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/core/index.hpp"
#include "libs/fem/kernels/kernel.hpp"
#include "libs/fem/material.hpp"
#include "libs/fem/tet_mesh.hpp"

namespace palpate::fem {

/// Cells of one material model and volumetric treatment, eight to a block, in the layout of
/// kernels::Block. The local nodes of each cell are sorted by `row_of_node`, so that the blocks of
/// a matrix in that order lie in its lower triangle as they come.
class CellBlocks {
 public:
  /// `cells` of `mesh`, in the order in which they shall be evaluated. Throws InputError where a
  /// cell's map from the reference element is inverted at an integration point, or the material
  /// does not allow its volumetric treatment.
  CellBlocks(const TetMesh& mesh, const std::vector<int>& cells, const Material& material,
             const std::vector<int>& row_of_node);

  int BlockCount() const { return static_cast<int>(cells_.size()) / kernels::kLanes; }
  int NodesPerCell() const { return nodes_per_cell_; }
  /// The cell in a lane, or -1: the lane is left over, what it gives is to be ignored.
  int CellAt(int block, int lane) const { return cells_[At(block * kernels::kLanes + lane)]; }
  int NodeAt(int block, int node, int lane) const {
    return nodes_[At((block * nodes_per_cell_ + node) * kernels::kLanes + lane)];
  }

  /// `factor_of_cell` [cells of the mesh] multiplies the moduli; empty: 1.
  void SetModuli(const std::vector<Material>& materials, const std::vector<int>& material_of_cell,
                 const Eigen::VectorXd& factor_of_cell);

  void Evaluate(int block, const double* x_m, const kernels::Output& output) const {
    kernel_(View(block), x_m, output);
  }

 private:
  kernels::Block View(int block) const;
  void FillLane(const TetMesh& mesh, int cell, const std::vector<int>& row_of_node, int block,
                int lane);

  kernels::Kernel kernel_;
  int nodes_per_cell_;
  int points_;
  std::vector<int> cells_;         ///< [blocks][lanes]
  std::vector<int> nodes_;         ///< [blocks][nodes][lanes]
  std::vector<double> gradients_;  ///< [blocks][points][nodes][3][lanes]
  std::vector<double> weights_;    ///< [blocks][points][lanes]
  std::vector<double> lambda_Pa_;  ///< [blocks][lanes], as those below
  std::vector<double> mu_Pa_;
  std::vector<double> c20_over_c10_;
  std::vector<double> c30_over_c10_;
};

}  // namespace palpate::fem
