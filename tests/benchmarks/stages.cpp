// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/stages.hpp"

#include <cmath>

#include "libs/core/error.hpp"

namespace palpate::benchmarks {

namespace {

constexpr int kFewMarkers = 5;
constexpr int kRightHandSides = 8;

/// The scene's tangent at its first state, cables included.
fem::StiffnessMatrix TangentOf(SensingScene& scene) {
  fem::Linearisation& linearisation = scene.model().linearisation();
  const Status status =
      linearisation.Update(scene.state().x_m, scene.state().lambda_a_N, scene.external_force_N());
  if (!status.ok()) throw RunError("the state has no tangent: " + status.message());
  return linearisation.matrix();
}

}  // namespace

Stages::Stages(const robot::RobotDescription& description)
    : scene_(description, kFewMarkers, SensingScene::Update::kOneStep),
      x_m_(scene_.state().x_m),
      assembled_(scene_.model().linearisation().matrix()),
      force_N_(Eigen::VectorXd::Zero(x_m_.size())),
      matrix_(TangentOf(scene_)),
      solver_(fem::MakeCholmodSolver(matrix_.Pattern())),
      columns_(matrix_.Size(), kRightHandSides) {}

void Stages::Assemble() {
  assembled_.SetZero();
  force_N_.setZero();
  scene_.model().elastic_body().AddForcesAndTangent(x_m_, force_N_, assembled_);
}

void Stages::Factorize() {
  const Status status = solver_->Factorize(matrix_.Values());
  if (!status.ok()) throw RunError("the tangent has no factor: " + status.message());
}

void Stages::ResetColumns() {
  for (Eigen::Index row = 0; row < columns_.rows(); ++row) {
    for (Eigen::Index column = 0; column < columns_.cols(); ++column) {
      columns_(row, column) = std::sin(static_cast<double>(row * (column + 1)));
    }
  }
}

void Stages::Solve() { solver_->Solve(columns_); }

}  // namespace palpate::benchmarks
