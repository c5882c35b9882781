// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/location_step.hpp"

#include "libs/core/index.hpp"
#include "libs/linalg/cholesky.hpp"

namespace palpate::force_estimation {

namespace {

void AddForce(const fem::InterpolationWeights& weights, const Eigen::Vector3d& force_N,
              Eigen::Ref<Eigen::VectorXd> nodal_force_N) {
  for (size_t k = 0; k < weights.nodes.size(); ++k) {
    nodal_force_N.segment<3>(3 * weights.nodes[k]) += weights.weights[k] * force_N;
  }
}

}  // namespace

Eigen::Matrix<double, 3, 2> Tangents(const Eigen::Vector3d& normal) {
  Eigen::Matrix<double, 3, 2> tangents;
  tangents.col(0) = normal.unitOrthogonal();
  tangents.col(1) = normal.cross(tangents.col(0));
  return tangents;
}

LocationStep::LocationStep(robot::RobotModel& model, ForceNewton& fitter,
                           const LocationStepTuning& tuning)
    : model_(model),
      fitter_(fitter),
      tuning_(tuning),
      nodal_forces_N_(3 * model.elastic_body().NodeCount(), 0) {}

Status LocationStep::Compute(const std::vector<ShapeSite>& sites, const RowTargets& targets,
                             const ModelState& state, std::vector<LocatedForce>* located) {
  const auto k = ToIndex(sites.size());
  const Eigen::Index rows = targets.value_m.size();
  jacobian_.resize(rows, 5 * k);
  jacobian_.leftCols(3 * k) = fitter_.Response();
  nodal_forces_N_.setZero(nodal_forces_N_.rows(), 2 * k);
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(5 * k, 5 * k);
  Eigen::VectorXd right_side = Eigen::VectorXd::Zero(5 * k);
  const fem::QpMatrix& force_prior = fitter_.force_prior();
  information.topLeftCorner(3 * k, 3 * k) = force_prior;
  right_side.head(3 * k) = -force_prior * state.lambda_f_N;
  for (Eigen::Index s = 0; s < k; ++s) {
    const ShapeSite& site = sites[At(s)];
    AddForces(site, state.lambda_f_N.segment<3>(3 * s), 2 * s);
    const double sigma_m = site.hidden ? tuning_.hidden_sigma_m : site.seen_sigma_m;
    const double weight = 1.0 / (sigma_m * sigma_m);
    const Eigen::Vector2d offset =
        Tangents(site.patch.normal).transpose() * (site.seen_rest_m - site.centre.rest_m);
    information.diagonal().segment<2>(3 * k + 2 * s).array() += weight;
    right_side.segment<2>(3 * k + 2 * s) = weight * offset;
  }
  fitter_.RespondTo(nodal_forces_N_, state.x_m, &motions_m_);
  jacobian_.rightCols(2 * k) = motions_m_;
  information.noalias() += jacobian_.transpose() * targets.weight.asDiagonal() * jacobian_;
  right_side.noalias() +=
      jacobian_.transpose() * targets.weight.cwiseProduct(fitter_.fit().residual_m);
  const linalg::Cholesky factor(information);
  if (!factor.ok()) return {StatusCode::kUnobservable, {}};
  const Eigen::VectorXd step = factor.Solve(right_side);
  const Eigen::MatrixXd covariance = factor.Inverse();
  located->resize(sites.size());
  for (Eigen::Index s = 0; s < k; ++s) {
    LocatedForce& one = (*located)[At(s)];
    one.step_rest_m = Tangents(sites[At(s)].patch.normal) * step.segment<2>(3 * k + 2 * s);
    one.location_covariance_m2 = covariance.block<2, 2>(3 * k + 2 * s, 3 * k + 2 * s);
    one.force_covariance_N2 = covariance.block<3, 3>(3 * s, 3 * s);
  }
  return Status::Ok();
}

void LocationStep::AddForces(const ShapeSite& site, const Eigen::Vector3d& force_N,
                             Eigen::Index column) {
  const Eigen::Matrix<double, 3, 2> tangents = Tangents(site.patch.normal);
  const Eigen::Vector3d probe_N = force_N / (2.0 * tuning_.probe_m);
  for (Eigen::Index i = 0; i < 2; ++i) {
    for (const double side : {1.0, -1.0}) {
      const Eigen::Vector3d moved_m = site.centre.rest_m + side * tuning_.probe_m * tangents.col(i);
      AddForce(model_.Patch(moved_m, site.radius_m).weights, side * probe_N,
               nodal_forces_N_.col(column + i));
    }
  }
}

}  // namespace palpate::force_estimation
