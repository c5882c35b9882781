// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/fem/kernels/kernel.hpp"
#include "libs/fem/material.hpp"
#include "libs/fem/stiffness_matrix.hpp"
#include "libs/fem/tet_mesh.hpp"

namespace palpate::fem {

/// The internal forces of a meshed elastic body and their exact tangent.
/// Sign: F_int(x) = dEnergy/dx is what the body resists with; equilibrium is F_int(x) = f_ext, and
/// the tangent K = dF_int/dx is positive definite at stable states. (The paper's F(x), eq. 1, is
/// -F_int, and its K, eq. 2, is -K.)
class ElasticBody {
 public:
  /// `material_of_cell` [cells] indexes `materials`. Throws InputError where a cell's map from the
  /// reference element is inverted at an integration point, or a material does not allow its
  /// volumetric treatment.
  ElasticBody(const TetMesh& mesh, std::vector<Material> materials,
              const std::vector<int>& material_of_cell);

  int NodeCount() const { return static_cast<int>(rest_m_.size() / 3); }
  const Eigen::VectorXd& rest_m() const { return rest_m_; }  ///< [3n]
  const std::vector<Material>& materials() const { return materials_; }
  /// Pairs of nodes that share a cell.
  NodePairs CoupledPairs() const;

  /// All cells of this material get another modulus; the pattern and the rest shape stay.
  void SetYoungsModulus(int material, double youngs_modulus_Pa);

  /// Adds F_int(x) [3n], N. Returns the smallest det F (<= 0: an element is inverted, and the
  /// forces must not be used).
  double AddForces(const Eigen::VectorXd& x_m, Eigen::VectorXd& force_N) const;
  /// The part of F_int that cells of one material give. All moduli enter linearly, so
  /// dF_int/dE = this / E.
  void AddForcesOfMaterial(int material, const Eigen::VectorXd& x_m,
                           Eigen::VectorXd& force_N) const;
  /// Adds F_int(x) to `force_N` and K(x) to `stiffness`, to which BindTo was called. Returns the
  /// smallest det F.
  double AddForcesAndTangent(const Eigen::VectorXd& x_m, Eigen::VectorXd& force_N,
                             StiffnessMatrix& stiffness) const;
  /// Elastic energy, J; `min_J` gets the smallest det F.
  double Energy(const Eigen::VectorXd& x_m, double* min_J) const;

  /// Looks up once where each cell's blocks lie in `stiffness`.
  void BindTo(const StiffnessMatrix& stiffness);

 private:
  /// Cells of one material model, eight to a block, in the layout of kernels::Block.
  struct Group {
    kernels::Kernel kernel = nullptr;
    int nodes_per_cell = 0;
    int points = 0;
    std::vector<int> cells;         ///< of the mesh, in lane order
    std::vector<int> material;      ///< [cells]
    std::vector<int> nodes;         ///< [blocks][nodes][lanes]
    std::vector<double> gradients;  ///< [blocks][points][nodes][3][lanes]
    std::vector<double> weights;    ///< [blocks][points][lanes]
    std::vector<double> lambda_Pa;  ///< [blocks][lanes]
    std::vector<double> mu_Pa;      ///< [blocks][lanes]
    std::vector<BlockSlot> slots;   ///< [blocks][lanes][pairs]

    int BlockCount() const { return static_cast<int>(lambda_Pa.size()) / kernels::kLanes; }
    int LanesUsed(int block) const;
    kernels::Block View(int block) const;
  };

  Group MakeGroup(const TetMesh& mesh, const std::vector<int>& cells,
                  const std::vector<int>& material_of_cell) const;
  void FillCell(const TetMesh& mesh, int cell, int block, int lane, Group& group) const;
  void UpdateModuli(Group& group) const;

  Eigen::VectorXd rest_m_;
  std::vector<Material> materials_;
  std::vector<Group> groups_;
};

}  // namespace palpate::fem
