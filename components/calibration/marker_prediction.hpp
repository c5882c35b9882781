// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/calibration/material_calibration.hpp"
#include "libs/core/status.hpp"
#include "libs/fem/static_solver.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// Observed minus predicted marker positions for given moduli, and the derivative of the prediction
/// with respect to ln E. Rows: the observed coordinates of all observations.
struct Prediction {
  Eigen::VectorXd scaled_residual;     ///< [rows] over its standard deviation
  Eigen::MatrixXd scaled_jacobian;     ///< [rows x moduli]
  std::vector<double> residual_rms_m;  ///< of each observation
  double residual_rms_all_m = 0.0;
};

/// Predicts the markers of static observations. `model` and `observations` must outlive it. It
/// changes moduli and gravity of the model.
class MarkerPredictor {
 public:
  MarkerPredictor(robot::RobotModel& model, const std::vector<StaticObservation>& observations,
                  std::vector<int> materials);

  int rows() const { return rows_; }

  /// Sets the moduli and solves all equilibria, starting from the accepted states. Not ok where one
  /// is not reached or has no tangent.
  Status Predict(const Eigen::VectorXd& log_modulus, Prediction* prediction);
  /// The equilibria of the last Predict become the start of the next one.
  void Accept() { accepted_ = states_; }

  void SetModuli(const Eigen::VectorXd& log_modulus);

 private:
  /// Marker positions [3m] and their derivative [3m x moduli].
  struct Markers {
    Eigen::VectorXd position_m;
    Eigen::MatrixXd jacobian_m;
  };

  Status PredictEquilibrium(const StaticObservation& observation,
                            const std::vector<robot::DeadLoad>& loads, fem::StaticState* state,
                            Markers* markers);
  Status PredictReference(const StaticObservation& observation, Markers* markers);
  void AppendRows(const StaticObservation& observation, const Eigen::VectorXd& residual_m,
                  const Eigen::MatrixXd& jacobian_m, Eigen::Index* row, Prediction* prediction);
  Eigen::VectorXd MarkersAt(const Eigen::Ref<const Eigen::VectorXd>& nodal) const;
  Eigen::Index MarkerRows() const;

  robot::RobotModel& model_;
  const std::vector<StaticObservation>& observations_;
  std::vector<int> materials_;
  std::vector<fem::StaticState> states_, accepted_;  ///< one for each observation
  int rows_ = 0;
};

}  // namespace palpate::calibration
