// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/residual_forces.hpp"

#include "libs/core/index.hpp"
#include "libs/linalg/cholesky.hpp"

namespace palpate::diagnosis {

namespace {

/// One sigma of each component.
constexpr double kPrior_N = 0.05;

/// Forces are the first three parameters of their fault, along the world's axes; then the place.
constexpr Eigen::Index kComponents = 3;

std::vector<int> ForcesOf(const HypothesisSet& hypotheses) {
  std::vector<int> forces;
  for (int k = 0; k < hypotheses.size(); ++k) {
    if (hypotheses.model(k).name().id == "permanent_force") forces.push_back(k);
  }
  return forces;
}

Eigen::Matrix3Xd PlacesOf(const HypothesisSet& hypotheses, const std::vector<int>& forces) {
  Eigen::Matrix3Xd place_m(3, std::ssize(forces));
  for (Eigen::Index k = 0; k < place_m.cols(); ++k) {
    const auto& parameters = hypotheses.model(forces[At(k)]).parameters();
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      place_m(axis, k) = parameters[At(kComponents + axis)].nominal;
    }
  }
  return place_m;
}

/// What one recording shows of parameters that are known to be so.
struct Known {
  const LinearModel& model;
  const Eigen::VectorXd& mean;
  const Eigen::MatrixXd& covariance;
};

/// Rows of one recording.
struct Rows {
  Eigen::Index first = 0, count = 0;
};

Rows RowsOf(const LinearModel& model, std::size_t recording) {
  Rows rows{0, model.rows_of_recording[recording]};
  for (std::size_t r = 0; r < recording; ++r) rows.first += model.rows_of_recording[r];
  return rows;
}

Eigen::VectorXd LeftOf(const Known& known, const Rows& rows) {
  return known.model.y.segment(rows.first, rows.count) -
         known.model.J.middleRows(rows.first, rows.count) * known.mean;
}

std::size_t WorstRecording(const Known& known) {
  std::size_t worst = 0;
  double most = -1.0;
  for (std::size_t r = 0; r < known.model.rows_of_recording.size(); ++r) {
    const Rows rows = RowsOf(known.model, r);
    const double sum = LeftOf(known, rows).squaredNorm();
    if (rows.count == 0 || sum <= most * static_cast<double>(rows.count)) continue;
    most = sum / static_cast<double>(rows.count);
    worst = r;
  }
  return worst;
}

/// [3 x forces] world frame: the most probable, where the recording's noise and what is not known
/// of the parameters may have done it as well.
Eigen::Matrix3Xd ForcesFor(const HypothesisSet& hypotheses, const Known& known,
                           const std::vector<int>& forces, std::size_t recording) {
  const Rows rows = RowsOf(known.model, recording);
  const auto J = known.model.J.middleRows(rows.first, rows.count);
  Eigen::MatrixXd effect(rows.count, kComponents * std::ssize(forces));
  for (std::size_t k = 0; k < forces.size(); ++k) {
    effect.middleCols<kComponents>(kComponents * ToIndex(k)) =
        J.middleCols<kComponents>(hypotheses.first(forces[k]));
  }
  Eigen::MatrixXd S = J * known.covariance * J.transpose();
  S.diagonal().array() += 1.0;
  const linalg::Cholesky factor(S);
  Eigen::MatrixXd A = effect.transpose() * factor.Solve(effect);
  A.diagonal().array() += 1.0 / (kPrior_N * kPrior_N);
  const Eigen::VectorXd pull = effect.transpose() * factor.Solve(LeftOf(known, rows));
  const Eigen::VectorXd force_N = linalg::Cholesky(A).Solve(pull);
  return force_N.reshaped(3, std::ssize(forces));
}

}  // namespace

ResidualForces FindResidualForces(const ObservedExperiment& observed,
                                  const HypothesisSet& hypotheses, const Selection& selection) {
  const GaussianPrior null_model = hypotheses.PriorWith({}, selection.null_model.posterior.scale);
  const Eigen::MatrixXd tolerances = null_model.sigma.array().square().matrix().asDiagonal();
  const Known before{selection.null_model.model, null_model.mean, tolerances};
  const Posterior& posterior = selection.best.posterior;
  const Known after{selection.best.model, posterior.mean, posterior.covariance};
  const std::size_t recording = WorstRecording(selection.goodness_of_fit.passed ? before : after);
  const std::vector<int> forces = ForcesOf(hypotheses);
  const Eigen::Matrix3d R_robot_world = observed.recordings[recording].base_rotation.transpose();
  return {.recording = observed.recordings[recording].name,
          .place_m = PlacesOf(hypotheses, forces),
          .before_N = R_robot_world * ForcesFor(hypotheses, before, forces, recording),
          .after_N = R_robot_world * ForcesFor(hypotheses, after, forces, recording)};
}

}  // namespace palpate::diagnosis
