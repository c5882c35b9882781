// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "libs/core/thread_team.hpp"
#include "libs/fem/assembly_shares.hpp"
#include "libs/fem/cell_blocks.hpp"
#include "libs/fem/fibre.hpp"
#include "libs/fem/fibre_forces.hpp"
#include "libs/fem/material.hpp"
#include "libs/fem/stiffness_matrix.hpp"
#include "libs/fem/tet_mesh.hpp"

namespace palpate::fem {

/// The internal forces of a meshed elastic body with its fibres, and their exact tangent.
/// Sign: F_int(x) = dEnergy/dx is what the body resists with; equilibrium is F_int(x) = f_ext, and
/// the tangent K = dF_int/dx is positive definite at stable states. (The paper's F(x), eq. 1, is
/// -F_int, and its K, eq. 2, is -K.)
/// Results do not depend on the number of threads, bit for bit. One call at a time: the sums of the
/// threads are kept in the body. After BindTo nothing is allocated.
class ElasticBody {
 public:
  /// `material_of_cell` [cells] indexes `materials`. Throws InputError where a cell's map from the
  /// reference element is inverted at an integration point, or a material does not allow its
  /// volumetric treatment.
  ElasticBody(const TetMesh& mesh, std::vector<Material> materials,
              const std::vector<int>& material_of_cell,
              const std::vector<EmbeddedFibre>& fibres = {});

  int NodeCount() const { return static_cast<int>(rest_m_.size() / 3); }
  const Eigen::VectorXd& rest_m() const { return rest_m_; }  ///< [3n]
  const std::vector<Material>& materials() const { return materials_; }
  const FibreForces& fibres() const { return fibres_; }
  /// Pairs of nodes that share a cell.
  NodePairs CoupledPairs() const;

  /// All cells of this material get another modulus; the pattern and the rest shape stay.
  void SetYoungsModulus(int material, double youngs_modulus_Pa);
  /// The same for Poisson's ratio, in (-1, 0.5), at fixed Young's modulus.
  void SetPoissonsRatio(int material, double poissons_ratio);
  /// Each cell's moduli are its material's times `factor` [cells], all > 0: of damage or
  /// temperature. At first 1 everywhere.
  void SetCellFactors(const Eigen::VectorXd& factor);

  /// Adds F_int(x) [3n], N. Returns the smallest det F (<= 0: an element is inverted, and the
  /// forces must not be used).
  double AddForces(const Eigen::VectorXd& x_m, Eigen::VectorXd& force_N) const;
  /// The same without the fibres: what grows in proportion to all moduli.
  double AddForcesOfCells(const Eigen::VectorXd& x_m, Eigen::VectorXd& force_N) const;
  /// The part of F_int that cells of one material give. All moduli enter linearly, so
  /// dF_int/dE = this / E.
  void AddForcesOfMaterial(int material, const Eigen::VectorXd& x_m,
                           Eigen::VectorXd& force_N) const;
  /// Adds F_int(x) to `force_N` and sets `stiffness`, to which BindTo was called, to K(x). Returns
  /// the smallest det F.
  double AddForcesAndSetTangent(const Eigen::VectorXd& x_m, Eigen::VectorXd& force_N,
                                StiffnessMatrix& stiffness) const;
  /// Elastic energy, J; `min_J` gets the smallest det F.
  double Energy(const Eigen::VectorXd& x_m, double* min_J) const;
  /// The same for each cell without fibres: overwrites `energy_J` [cells]. Returns the smallest
  /// det F.
  double CellEnergies(const Eigen::VectorXd& x_m, Eigen::VectorXd* energy_J) const;

  /// Puts the cells in the order of elimination of `stiffness`, looks up where their blocks lie in
  /// it, and shares them out among the threads of `team`; none: the calling thread alone.
  void BindTo(const StiffnessMatrix& stiffness, std::shared_ptr<ThreadTeam> team = nullptr);

 private:
  /// Internal force on one node, filled up to a whole vector register.
  struct alignas(32) ForceRow {
    double N[4];
  };
  /// What a thread found.
  struct alignas(64) ThreadResult {
    double min_J;
  };

  void MakeBlocks(const RowOrder& order);
  void Share(RowOrder order, const StiffnessMatrix* stiffness, int threads);
  /// Calls work(thread index) for every share; gives the smallest det F that they found.
  template <typename Work>
  double OnEveryShare(const Work& work) const;
  /// Evaluates the blocks of one share: adds its rows to `force_N`, and sets its block columns of
  /// `stiffness` unless that is null. Returns the smallest det F.
  double AddShare(const AssemblyShare& share, const double* x_m, Eigen::VectorXd& force_N,
                  StiffnessMatrix* stiffness) const;
  void AddShareOfMaterial(const AssemblyShare& share, int material, const double* x_m,
                          Eigen::VectorXd& force_N) const;
  /// Energies of the blocks of one share; each cell's too unless `of_cell_J` [cells] is null.
  double EnergiesOfShare(const AssemblyShare& share, const double* x_m, double* of_cell_J) const;
  void ClearRows(const AssemblyShare& share) const;
  void AddRows(const AssemblyShare& share, Eigen::VectorXd& force_N) const;

  TetMesh mesh_;
  Eigen::VectorXd rest_m_;
  std::vector<Material> materials_;
  std::vector<int> material_of_cell_;
  Eigen::VectorXd factor_of_cell_;  ///< [cells], or empty: 1
  FibreForces fibres_;

  std::vector<CellBlocks> laws_;
  RowOrder order_;
  std::vector<AssemblyShare> shares_;  ///< one for each thread that has work
  bool bound_ = false;
  std::shared_ptr<ThreadTeam> team_;

  mutable std::vector<ForceRow> force_rows_;
  mutable std::vector<ThreadResult> results_;            ///< [shares]
  mutable std::vector<Eigen::VectorXd> block_energy_J_;  ///< [laws][blocks]
};

}  // namespace palpate::fem
