// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <memory>

#include "libs/fem/sparse/sparse_solver.hpp"
#include "libs/robot/robot_description.hpp"
#include "tests/benchmarks/sensing_scene.hpp"

namespace palpate::benchmarks {

/// The parts of an update one by one, about the scene's first state.
class Stages {
 public:
  /// Throws as SensingScene does.
  explicit Stages(const robot::RobotDescription& description);

  int Size() const { return matrix_.Size(); }
  const fem::SparseSolver& solver() const { return *solver_; }

  void Assemble();      ///< internal forces and exact tangent
  void Factorize();     ///< of the tangent at the state. Throws RunError where there is none.
  void ResetColumns();  ///< eight right-hand sides
  void Solve();

 private:
  SensingScene scene_;
  Eigen::VectorXd x_m_;
  fem::StiffnessMatrix assembled_;
  Eigen::VectorXd force_N_;
  fem::StiffnessMatrix matrix_;
  std::unique_ptr<fem::SparseSolver> solver_;
  Eigen::MatrixXd columns_;
};

}  // namespace palpate::benchmarks
