// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

#include "libs/core/thread_team.hpp"
#include "libs/fem/sparse/sparse_solver.hpp"
#include "libs/fem/stiffness_matrix.hpp"
#include "tests/benchmarks/contender.hpp"

namespace palpate::benchmarks {

/// One contender at work on one matrix.
class SolverBench {
 public:
  /// `matrix` must outlive this.
  SolverBench(const Contender& contender, const fem::StiffnessMatrix& matrix);

  const fem::SparseSolver& solver() const { return *solver_; }
  int Size() const { return matrix_.Size(); }
  bool has_factor() const { return has_factor_; }

  void Factorize();  ///< RunError where there is no factor
  /// Right-hand sides for so many calls of SolveNext, always the same.
  void SetColumns(int count, int calls);
  void SolveNext();  ///< Needs a factor.
  /// Throws RunError where what SolveNext found last is no solution: fast and wrong does not count.
  void CheckLast() const;

 private:
  ThreadTeam team_;
  const fem::StiffnessMatrix& matrix_;
  std::unique_ptr<fem::SparseSolver> solver_;
  bool has_factor_ = false;
  Eigen::MatrixXd right_hand_sides_;
  std::vector<Eigen::MatrixXd> columns_;  ///< of each call
  size_t next_ = 0;
};

}  // namespace palpate::benchmarks
