// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "libs/fem/stiffness_matrix.hpp"
#include "tests/benchmarks/contender.hpp"
#include "tests/benchmarks/robots.hpp"
#include "tests/benchmarks/sensing_scene.hpp"
#include "tests/benchmarks/solver_bench.hpp"

namespace palpate::benchmarks {

/// What the benchmarks of one robot work on. Each thing is made when it is first asked for. Throws
/// as SensingScene does.
class Workbench {
 public:
  explicit Workbench(NamedRobot robot) : robot_(std::move(robot)) {}

  const NamedRobot& robot() const { return robot_; }

  /// All of them see the same frames, which the first contender has computed.
  SensingScene& Scene(const Contender& contender);
  /// About the tangent with cables at the scenes' first state. The scenes go when the first solver
  /// is made: both together would fill the memory of a small machine.
  SolverBench& Solver(const Contender& contender);

 private:
  const fem::StiffnessMatrix& Tangent();

  NamedRobot robot_;
  std::map<std::string, std::unique_ptr<SensingScene>> scenes_;  ///< by contender
  std::optional<fem::StiffnessMatrix> tangent_;
  std::map<std::string, std::unique_ptr<SolverBench>> solvers_;  ///< by contender
};

/// Internal forces and exact tangent at the scene's first state, on the threads of its model.
class Assembly {
 public:
  explicit Assembly(SensingScene& scene)
      : body_(scene.model().elastic_body()),
        x_m_(scene.first_state().x_m),
        force_N_(Eigen::VectorXd::Zero(x_m_.size())),
        matrix_(scene.model().linearisation().matrix()) {}

  int Size() const { return matrix_.Size(); }
  void Assemble() {
    force_N_.setZero();
    body_.AddForcesAndSetTangent(x_m_, force_N_, matrix_);
  }

 private:
  const fem::ElasticBody& body_;
  Eigen::VectorXd x_m_;
  Eigen::VectorXd force_N_;
  fem::StiffnessMatrix matrix_;
};

}  // namespace palpate::benchmarks
