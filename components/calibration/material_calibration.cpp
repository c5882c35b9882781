// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/material_calibration.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "libs/core/check.hpp"
#include "libs/robot/sensitivity.hpp"

namespace palpate::calibration {

namespace {

/// Residual [rows] and its derivative with respect to ln E, rows scaled by 1 / sigma.
struct Prediction {
  Eigen::VectorXd scaled_residual;
  Eigen::MatrixXd scaled_jacobian;
  std::vector<double> residual_rms_m;
  double residual_rms_all_m = 0.0;
};

class MaterialFit {
 public:
  MaterialFit(robot::RobotModel& model, const std::vector<StaticObservation>& observations,
              const MaterialCalibrationSettings& settings)
      : model_(model), observations_(observations), settings_(settings) {
    for (const StaticObservation& observation : observations) {
      PALPATE_CHECK(observation.position_m.size() == MarkerRows(), observation.name);
      states_.push_back(model.RestState());
      rows_ += static_cast<int>((observation.variance_m2.array() > 0.0).count());
    }
    for (int material : settings.materials) {
      log_modulus_.conservativeResize(log_modulus_.size() + 1);
      log_modulus_[log_modulus_.size() - 1] = std::log(Modulus(material));
    }
  }

  MaterialCalibration Run();

 private:
  Eigen::Index MarkerRows() const {
    return static_cast<Eigen::Index>(3 * model_.body().markers.size());
  }
  double Modulus(int material) const {
    return model_.elastic_body().materials().at(static_cast<size_t>(material)).youngs_modulus_Pa;
  }
  void Apply(const Eigen::VectorXd& log_modulus);
  Status Predict(const Eigen::VectorXd& log_modulus, Prediction* prediction);
  Status PredictMarkers(const StaticObservation& observation, bool loaded,
                        fem::StaticState* state, Eigen::VectorXd* position_m,
                        Eigen::MatrixXd* jacobian);
  Status Iterate(MaterialCalibration* result, Prediction* prediction);
  Status Conclude(const Prediction& prediction, MaterialCalibration* result);

  robot::RobotModel& model_;
  const std::vector<StaticObservation>& observations_;
  MaterialCalibrationSettings settings_;
  std::vector<fem::StaticState> states_;
  Eigen::VectorXd log_modulus_;
  int rows_ = 0;
};

void MaterialFit::Apply(const Eigen::VectorXd& log_modulus) {
  for (Eigen::Index p = 0; p < log_modulus.size(); ++p) {
    model_.SetYoungsModulus(settings_.materials[static_cast<size_t>(p)],
                            std::exp(log_modulus[p]));
  }
}

/// Marker positions in the equilibrium of one observation, and their derivative: all internal
/// forces of a material are proportional to its modulus.
Status MaterialFit::PredictMarkers(const StaticObservation& observation, bool loaded,
                                   fem::StaticState* state, Eigen::VectorXd* position_m,
                                   Eigen::MatrixXd* jacobian) {
  const std::vector<robot::DeadLoad> none;
  const fem::StaticResult result =
      model_.Solve(observation.cables, loaded ? observation.loads : none, state);
  if (!result.status.ok()) {
    return {result.status.code(),
            observation.name + ": no equilibrium was reached: " + result.status.message()};
  }
  const Eigen::Index parameters = log_modulus_.size();
  Eigen::MatrixXd force_derivative = Eigen::MatrixXd::Zero(state->x_m.size(), parameters);
  for (Eigen::Index p = 0; p < parameters; ++p) {
    Eigen::VectorXd internal = Eigen::VectorXd::Zero(state->x_m.size());
    model_.elastic_body().AddForcesOfMaterial(settings_.materials[static_cast<size_t>(p)],
                                              state->x_m, internal);
    force_derivative.col(p) = -internal;
  }
  Eigen::MatrixXd dx;
  Status status =
      robot::EquilibriumSensitivity(model_, observation.cables, *state, force_derivative, &dx);
  if (!status.ok()) return status;
  const auto& markers = model_.body().markers;
  for (size_t m = 0; m < markers.size(); ++m) {
    const auto row = static_cast<Eigen::Index>(3 * m);
    position_m->segment<3>(row) = markers[m].point.weights.Position(state->x_m);
    for (Eigen::Index p = 0; p < parameters; ++p) {
      jacobian->block<3, 1>(row, p) = markers[m].point.weights.Position(dx.col(p));
    }
  }
  return status;
}

Status MaterialFit::Predict(const Eigen::VectorXd& log_modulus, Prediction* prediction) {
  Apply(log_modulus);
  prediction->scaled_residual.resize(rows_);
  prediction->scaled_jacobian.resize(rows_, log_modulus.size());
  prediction->residual_rms_m.clear();
  double sum_all = 0.0;
  Eigen::Index row = 0;
  for (size_t o = 0; o < observations_.size(); ++o) {
    const StaticObservation& observation = observations_[o];
    model_.SetGravity(observation.gravity_m_s2);
    Eigen::VectorXd position(MarkerRows());
    Eigen::MatrixXd jacobian(MarkerRows(), log_modulus.size());
    Status status = PredictMarkers(observation, true, &states_[o], &position, &jacobian);
    if (!status.ok()) return status;
    Eigen::VectorXd target = observation.position_m;
    if (observation.reference != ReferenceShape::kNone) {
      fem::StaticState rest = model_.RestState();
      Eigen::VectorXd start(MarkerRows());
      Eigen::MatrixXd start_jacobian = Eigen::MatrixXd::Zero(MarkerRows(), log_modulus.size());
      if (observation.reference == ReferenceShape::kEquilibrium) {
        status = PredictMarkers(observation, false, &rest, &start, &start_jacobian);
        if (!status.ok()) return status;
      } else {
        const auto& markers = model_.body().markers;
        for (size_t m = 0; m < markers.size(); ++m) {
          start.segment<3>(static_cast<Eigen::Index>(3 * m)) =
              markers[m].point.weights.Position(rest.x_m);
        }
      }
      target += start - observation.reference_position_m;
      jacobian -= start_jacobian;
    }
    double sum = 0.0;
    int used = 0;
    for (Eigen::Index i = 0; i < MarkerRows(); ++i) {
      if (!(observation.variance_m2[i] > 0.0)) continue;
      const double sigma = std::sqrt(observation.variance_m2[i]);
      const double residual = target[i] - position[i];
      prediction->scaled_residual[row] = residual / sigma;
      prediction->scaled_jacobian.row(row++) = jacobian.row(i) / sigma;
      sum += residual * residual;
      ++used;
    }
    prediction->residual_rms_m.push_back(std::sqrt(sum / std::max(1, used)));
    sum_all += sum;
  }
  prediction->residual_rms_all_m = std::sqrt(sum_all / std::max(1, rows_));
  return Status::Ok();
}

/// Gauss-Newton; a step that leads to no equilibrium or to a larger residual is halved.
Status MaterialFit::Iterate(MaterialCalibration* result, Prediction* prediction) {
  Status status = Predict(log_modulus_, prediction);
  if (!status.ok()) return status;
  constexpr double kLongestStep = 1.0;  // a factor of e in one iteration
  for (result->iterations = 1; result->iterations <= settings_.max_iterations;
       ++result->iterations) {
    const Eigen::MatrixXd& J = prediction->scaled_jacobian;
    Eigen::VectorXd step = (J.transpose() * J)
                               .completeOrthogonalDecomposition()
                               .solve(J.transpose() * prediction->scaled_residual);
    const double longest = step.cwiseAbs().maxCoeff();
    if (longest > kLongestStep) step *= kLongestStep / longest;
    const double before = prediction->scaled_residual.squaredNorm();
    Prediction trial;
    bool accepted = false;
    for (int halving = 0; halving < 20 && !accepted; ++halving, step *= 0.5) {
      const std::vector<fem::StaticState> states = states_;
      status = Predict(log_modulus_ + step, &trial);
      const double after = status.ok() ? trial.scaled_residual.squaredNorm() : before;
      accepted = status.ok() && after <= before * (1.0 + 1e-12);
      if (accepted) break;
      states_ = states;
    }
    if (!accepted) {
      // Nothing better within reach: the minimum, where the full step was down to rounding.
      return longest < 1e-5 ? Predict(log_modulus_, prediction)
                            : Status(StatusCode::kNotConverged, "no step lowers the residual");
    }
    log_modulus_ += step;
    *prediction = std::move(trial);
    if (step.cwiseAbs().maxCoeff() <= settings_.tolerance) return Status::Ok();
  }
  return {StatusCode::kNotConverged, "iterations used up"};
}

Status MaterialFit::Conclude(const Prediction& prediction, MaterialCalibration* result) {
  const Eigen::Index p = log_modulus_.size();
  result->chi_squared = prediction.scaled_residual.squaredNorm();
  result->degrees_of_freedom = rows_ - static_cast<int>(p);
  result->residual_rms_m = prediction.residual_rms_all_m;
  result->residual_rms_of_observation_m = prediction.residual_rms_m;
  const Eigen::MatrixXd information =
      prediction.scaled_jacobian.transpose() * prediction.scaled_jacobian;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(information);
  for (Eigen::Index k = 0; k < p; ++k) {
    const double sigma = 1.0 / std::sqrt(std::max(eigen.eigenvalues()[k], 1e-300));
    if (sigma <= settings_.undetermined_sigma) continue;
    Eigen::Index worst = 0;
    eigen.eigenvectors().col(k).cwiseAbs().maxCoeff(&worst);
    const int material = settings_.materials[static_cast<size_t>(worst)];
    const std::string name =
        material == 0 ? "the body"
                      : "region " + model_.body().region_names[static_cast<size_t>(material) - 1];
    return {StatusCode::kUnobservable,
            "these data do not determine Young's modulus of " + name +
                ": add a recording with a known load"};
  }
  const double inflation =
      result->degrees_of_freedom > 0
          ? std::max(1.0, result->chi_squared / result->degrees_of_freedom)
          : 1.0;
  const Eigen::MatrixXd covariance =
      inflation * information.llt().solve(Eigen::MatrixXd::Identity(p, p));
  const Eigen::VectorXd sigma = covariance.diagonal().cwiseSqrt();
  result->correlation =
      sigma.cwiseInverse().asDiagonal() * covariance * sigma.cwiseInverse().asDiagonal();
  for (Eigen::Index k = 0; k < p; ++k) {
    const double modulus = std::exp(log_modulus_[k]);
    result->moduli.push_back({.material = settings_.materials[static_cast<size_t>(k)],
                              .youngs_modulus_Pa = modulus,
                              .standard_error_Pa = modulus * sigma[k]});
  }
  return Status::Ok();
}

MaterialCalibration MaterialFit::Run() {
  MaterialCalibration result;
  if (rows_ < static_cast<int>(log_modulus_.size())) {
    result.status = Status(StatusCode::kUnobservable, "fewer marker coordinates than moduli");
    return result;
  }
  const Eigen::VectorXd before = log_modulus_;
  const Eigen::Vector3d gravity = model_.gravity_m_s2();
  Prediction prediction;
  result.status = Iterate(&result, &prediction);
  if (result.status.ok()) result.status = Conclude(prediction, &result);
  Apply(result.status.ok() ? log_modulus_ : before);
  model_.SetGravity(gravity);
  return result;
}

}  // namespace

MaterialCalibration CalibrateMaterial(robot::RobotModel& model,
                                      const std::vector<StaticObservation>& observations,
                                      const MaterialCalibrationSettings& settings) {
  PALPATE_CHECK(!settings.materials.empty());
  return MaterialFit(model, observations, settings).Run();
}

}  // namespace palpate::calibration
