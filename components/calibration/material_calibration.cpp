// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/material_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "components/calibration/marker_prediction.hpp"
#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"
#include "libs/linalg/cholesky.hpp"
#include "libs/linalg/symmetric_eigen.hpp"

namespace palpate::calibration {

namespace {

struct MaterialFitTuning {
  double longest_step = 1.0;  ///< of ln E in one iteration: more may miss equilibria
  /// A prior standard deviation of 1000 on ln E, so that undetermined moduli stay where they are.
  double damping = 1e-6;
  int halvings = 20;         ///< of a step that raises the residual
  double rounding = 1e-12;   ///< share by which a residual may rise
  double at_minimum = 1e-5;  ///< full step below which no better residual means the minimum
};
constexpr MaterialFitTuning kMaterialTuning;

/// Gauss-Newton on the logarithms of the moduli.
class MaterialFit {
 public:
  MaterialFit(robot::RobotModel& model, const std::vector<StaticObservation>& observations,
              const MaterialCalibrationSettings& settings);

  MaterialCalibration Run();

 private:
  Status Iterate(MaterialCalibration* result);
  Status StepDown(Eigen::VectorXd* step);
  Status CheckDetermined() const;
  void Conclude(MaterialCalibration* result) const;
  Eigen::MatrixXd Information() const;
  std::string PartName(int material) const;

  robot::RobotModel& model_;
  MaterialCalibrationSettings settings_;
  MarkerPredictor predictor_;
  std::vector<double> modulus_before_Pa_;
  Eigen::VectorXd log_modulus_;
  Prediction prediction_;  ///< at log_modulus_
};

MaterialFit::MaterialFit(robot::RobotModel& model,
                         const std::vector<StaticObservation>& observations,
                         const MaterialCalibrationSettings& settings)
    : model_(model),
      settings_(settings),
      predictor_(model, observations, settings.materials),
      log_modulus_(ToIndex(settings.materials.size())) {
  for (size_t p = 0; p < settings.materials.size(); ++p) {
    const auto material = static_cast<size_t>(settings.materials[p]);
    modulus_before_Pa_.push_back(model.elastic_body().materials().at(material).youngs_modulus_Pa);
    log_modulus_[ToIndex(p)] = std::log(modulus_before_Pa_.back());
  }
}

MaterialCalibration MaterialFit::Run() {
  MaterialCalibration result;
  if (predictor_.rows() < static_cast<int>(log_modulus_.size())) {
    result.status = Status(StatusCode::kUnobservable, "fewer marker coordinates than moduli");
    return result;
  }
  const Eigen::Vector3d gravity_m_s2 = model_.gravity_m_s2();
  result.status = Iterate(&result);
  model_.SetGravity(gravity_m_s2);
  if (result.status.ok()) {
    Conclude(&result);
    predictor_.SetModuli(log_modulus_);
  } else {
    for (size_t p = 0; p < modulus_before_Pa_.size(); ++p) {
      model_.SetYoungsModulus(settings_.materials[p], modulus_before_Pa_[p]);
    }
  }
  return result;
}

/// Ends where the full step is down to the tolerance.
Status MaterialFit::Iterate(MaterialCalibration* result) {
  Status status = predictor_.Predict(log_modulus_, &prediction_);
  if (!status.ok()) return status;
  predictor_.Accept();
  constexpr double kLongestStep = kMaterialTuning.longest_step;
  const Eigen::MatrixXd damping =
      kMaterialTuning.damping * Eigen::MatrixXd::Identity(log_modulus_.size(), log_modulus_.size());
  while (result->iterations < settings_.max_iterations) {
    ++result->iterations;
    const Eigen::VectorXd gradient =
        prediction_.scaled_jacobian.transpose() * prediction_.scaled_residual;
    Eigen::VectorXd step = linalg::Cholesky(Information() + damping).Solve(gradient);
    const double longest = step.cwiseAbs().maxCoeff();
    if (longest <= settings_.tolerance) return CheckDetermined();
    if (longest > kLongestStep) step *= kLongestStep / longest;
    status = StepDown(&step);
    if (status.ok()) continue;
    // No lower residual: the minimum, where the full step was within rounding.
    const Status determined = CheckDetermined();
    return determined.ok() && longest > kMaterialTuning.at_minimum ? status : determined;
  }
  const Status determined = CheckDetermined();
  return determined.ok() ? Status(StatusCode::kNotConverged, "iterations used up") : determined;
}

/// Takes the step, halved until it leads to equilibria and to no larger residual.
Status MaterialFit::StepDown(Eigen::VectorXd* step) {
  const double before = prediction_.scaled_residual.squaredNorm();
  Status status;
  for (int halving = 0; halving < kMaterialTuning.halvings; ++halving, *step *= 0.5) {
    Prediction trial;
    status = predictor_.Predict(log_modulus_ + *step, &trial);
    if (!status.ok() ||
        !(trial.scaled_residual.squaredNorm() <= before * (1.0 + kMaterialTuning.rounding))) {
      continue;
    }
    predictor_.Accept();
    log_modulus_ += *step;
    prediction_ = std::move(trial);
    return status;
  }
  return status.ok() ? Status(StatusCode::kNotConverged, "no step lowers the residual") : status;
}

/// J' S^-1 J with respect to ln E.
Eigen::MatrixXd MaterialFit::Information() const {
  return prediction_.scaled_jacobian.transpose() * prediction_.scaled_jacobian;
}

std::string MaterialFit::PartName(int material) const {
  if (material == 0) return "the body";
  return "region " + model_.body().region_names[static_cast<size_t>(material) - 1];
}

Status MaterialFit::CheckDetermined() const {
  const linalg::SymmetricEigen eigen = linalg::DecomposeSymmetric(Information());
  for (Eigen::Index k = 0; k < log_modulus_.size(); ++k) {
    const double sigma = 1.0 / std::sqrt(std::max(eigen.values[k], 1e-300));
    if (sigma <= settings_.undetermined_sigma) continue;
    Eigen::Index worst = 0;
    eigen.vectors.col(k).cwiseAbs().maxCoeff(&worst);
    return {StatusCode::kUnobservable,
            "these data do not determine Young's modulus of " +
                PartName(settings_.materials[At(worst)]) + ": its relative standard error is " +
                FormatNumber(std::round(100.0 * sigma) / 100.0) + ", and at most " +
                FormatNumber(settings_.undetermined_sigma) + " counts"};
  }
  return Status::Ok();
}

/// Birge's ratio: a residual beyond the noise widens the errors, and never narrows them.
void MaterialFit::Conclude(MaterialCalibration* result) const {
  const Eigen::Index p = log_modulus_.size();
  result->chi_squared = prediction_.scaled_residual.squaredNorm();
  result->degrees_of_freedom = predictor_.rows() - static_cast<int>(p);
  result->residual_rms_m = prediction_.residual_rms_all_m;
  result->residual_rms_of_observation_m = prediction_.residual_rms_m;
  const double inflation = result->degrees_of_freedom > 0
                               ? std::max(1.0, result->chi_squared / result->degrees_of_freedom)
                               : 1.0;
  const Eigen::MatrixXd covariance = inflation * linalg::Cholesky(Information()).Inverse();
  const Eigen::VectorXd sigma = covariance.diagonal().cwiseSqrt();
  result->correlation =
      sigma.cwiseInverse().asDiagonal() * covariance * sigma.cwiseInverse().asDiagonal();
  for (Eigen::Index k = 0; k < p; ++k) {
    const double modulus_Pa = std::exp(log_modulus_[k]);
    result->moduli.push_back({.material = settings_.materials[At(k)],
                              .youngs_modulus_Pa = modulus_Pa,
                              .standard_error_Pa = modulus_Pa * sigma[k]});
  }
}

}  // namespace

MaterialCalibration CalibrateMaterial(robot::RobotModel& model,
                                      const std::vector<StaticObservation>& observations,
                                      const MaterialCalibrationSettings& settings) {
  PALPATE_CHECK(!settings.materials.empty());
  return MaterialFit(model, observations, settings).Run();
}

}  // namespace palpate::calibration
