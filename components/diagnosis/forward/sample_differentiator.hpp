// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "components/diagnosis/forward/actuator_chain.hpp"
#include "components/diagnosis/forward/fault_model.hpp"
#include "components/diagnosis/forward/sample_solver.hpp"
#include "libs/robot/sensitivity/point_sensitivity.hpp"
#include "libs/robot/sensitivity/sensitivity_solver.hpp"

namespace palpate::diagnosis {

/// [parameters][cables x samples] what dz of each parameter changes of what the actuators take in;
/// empty for those of faults that do not act on actuators, or are not `wanted` [faults].
/// `actuators` are those at `z`.
std::vector<Eigen::MatrixXd> ActuatorChanges(const ActuatorChain& train,
                                             const ModelHypothesis& nominal,
                                             const FaultModelList& models, const Eigen::VectorXd& z,
                                             const std::vector<bool>& wanted,
                                             const ActuatorSettings& drives);

/// How what is measured moves with the parameters of faults. What compliant cables yield by when
/// their tension changes is counted, what a compliant base then turns by is not. For one thread.
class SampleDifferentiator {
 public:
  /// All must outlive it. `solver` is prepared for each sample before, and in its parts as they
  /// slide. Samples of the same shape one after the other cost less.
  SampleDifferentiator(const ModelHypothesis& hypothesis, const FaultModelList& models,
                       const Eigen::VectorXd& z, const std::vector<bool>& wanted,
                       const std::vector<Eigen::MatrixXd>& actuator_change,
                       const ObservedExperiment& observed, SampleSolver* solver);

  /// [coordinates x parameters] m per z; 0 for faults that are not requested, and for what
  /// was not measured. NaN where there are no derivatives.
  Eigen::MatrixXd At(const FaultContext& at);

 private:
  struct WantedParameter {
    const FaultModel* fault;
    int number;           ///< of the fault's
    Eigen::Index column;  ///< among those of all faults
    Eigen::VectorXd z;    ///< [parameters of the fault]
  };

  static std::vector<WantedParameter> Wanted(const FaultModelList& models, const Eigen::VectorXd& z,
                                             const std::vector<bool>& wanted);
  Status ComputeRows(const FaultContext& at);
  void Collect(const FaultContext& at);
  Status AddPushes(const FaultContext& at, Eigen::MatrixXd* jacobian_m);
  void Observe(const FaultContext& at);
  void ShowTo(const FaultContext& of, Eigen::MatrixXd* jacobian_m) const;
  void ShowSurfaceTo(const FaultContext& of, Eigen::MatrixXd* jacobian_m) const;

  const ModelHypothesis& hypothesis_;
  std::vector<WantedParameter> parameters_;  ///< one fault after the other
  Eigen::Index parameter_count_;             ///< of all faults, those that are not wanted, too
  const std::vector<Eigen::MatrixXd>& actuator_change_;
  SampleSolver& solver_;
  bool markers_seen_;  ///< of any marker there is a measurement
  std::vector<robot::ObservationRow> marker_rows_;
  std::vector<robot::ObservationRow> rows_;  ///< what is measured here, on the body
  std::vector<Eigen::Index> coordinate_of_;  ///< [rows]
  robot::PointSensitivity of_rows_;
  std::optional<TangentState> rows_at_;  ///< of of_rows_, where another sample may have the same
  robot::SensitivitySolver of_body_;
  std::vector<robot::ParameterPtr> acting_;  ///< on the body, here
  std::vector<Eigen::Index> column_of_;      ///< [acting] of the parameter
};

}  // namespace palpate::diagnosis
