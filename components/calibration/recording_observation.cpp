// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/recording_observation.hpp"

#include <optional>

#include "components/calibration/recording_phase.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/experiment/recording_inputs.hpp"

namespace palpate::calibration {

namespace {

/// Mean position of each robot marker over `window` and its variance, both in the robot frame;
/// variance -1: not observed.
void AverageMarkers(const experiment::Experiment& experiment,
                    const experiment::Recording& recording, const Eigen::Isometry3d& T_robot,
                    const experiment::TimeWindow& window, const robot::RobotModel& model,
                    double marker_bias_m, Eigen::VectorXd* position_m,
                    Eigen::VectorXd* variance_m2) {
  const std::vector<std::string> names = model.MarkerNames();
  const std::vector<experiment::MarkerMean> means =
      experiment::MeanOver(*recording.markers, window);
  const Eigen::Vector3d sigma = experiment.markers_sigma_m.value_or(Eigen::Vector3d::Zero());
  position_m->setZero(ToIndex(3 * names.size()));
  variance_m2->setConstant(position_m->size(), -1.0);
  int seen = 0;
  for (size_t m = 0; m < names.size(); ++m) {
    const std::optional<size_t> column = recording.markers->IndexOf(names[m]);
    if (!column || means[*column].count == 0) continue;
    const experiment::MarkerMean& mean = means[*column];
    const Eigen::Vector3d noise = mean.deviation_m.cwiseMax(sigma);
    const Eigen::Matrix3d covariance = T_robot.linear() * noise.cwiseAbs2().asDiagonal() *
                                       T_robot.linear().transpose() / mean.count;
    const auto row = ToIndex(3 * m);
    position_m->segment<3>(row) = T_robot * mean.mean_m;
    // Rounding of the file bounds the accuracy of a mean.
    constexpr double kFloor_m2 = 1e-14;
    variance_m2->segment<3>(row) =
        covariance.diagonal().array() + marker_bias_m * marker_bias_m + kFloor_m2;
    ++seen;
  }
  if (seen == 0) {
    throw InputError(recording.folder.string() + ": no marker of the robot was seen from " +
                     std::to_string(window.begin_s) + " s to " + std::to_string(window.end_s) +
                     " s");
  }
}

/// Displacements of this recording count from its reference window.
void ObserveReference(const experiment::Experiment& experiment,
                      const experiment::Recording& recording, const Eigen::Isometry3d& T_robot,
                      const robot::RobotModel& model, StaticObservation* observation) {
  observation->reference = recording.reference->shape == experiment::ReferenceShape::kUndeformed
                               ? ReferenceShape::kUndeformed
                               : ReferenceShape::kEquilibrium;
  Eigen::VectorXd reference_variance;
  AverageMarkers(experiment, recording, T_robot, recording.reference->window_s, model, 0.0,
                 &observation->reference_position_m, &reference_variance);
  for (Eigen::Index i = 0; i < reference_variance.size(); ++i) {
    double& variance = observation->variance_m2[i];
    const bool seen_twice = variance > 0.0 && reference_variance[i] > 0.0;
    variance = seen_twice ? variance + reference_variance[i] : -1.0;
  }
}

}  // namespace

StaticObservation ObserveRecording(const experiment::Experiment& experiment,
                                   const experiment::Recording& recording,
                                   const robot::RobotModel& model, robot::CableInput preferred,
                                   double marker_bias_m) {
  const auto& frames = experiment::RequireMarkers(recording).frames;
  experiment::CheckMarkers(recording, model.MarkerNames());
  experiment::CheckActuators(recording, model.CableNames(), model.ChamberNames());
  const Eigen::Isometry3d T_robot = experiment::RequireRobotFromMarkers(experiment, recording);
  const experiment::TimeWindow window = recording.steady_window_s.value_or(
      experiment::TimeWindow{frames.front().t_s, frames.back().t_s});
  const double middle_s = 0.5 * (window.begin_s + window.end_s);

  StaticObservation observation;
  observation.name = recording.name;
  AverageMarkers(experiment, recording, T_robot, window, model, marker_bias_m,
                 &observation.position_m, &observation.variance_m2);
  if (recording.reference) ObserveReference(experiment, recording, T_robot, model, &observation);
  observation.cables = CablesAt(recording, model, preferred, middle_s);
  observation.loads = LoadsAt(recording, model, middle_s);
  observation.gravity_m_s2 = experiment::BaseRotation(recording).transpose() * model.gravity_m_s2();
  return observation;
}

}  // namespace palpate::calibration
