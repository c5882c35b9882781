// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/explain/model_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "libs/core/index.hpp"

namespace palpate::diagnosis {

namespace {

/// Squares of the residual of the coordinates that were seen.
struct Squares {
  double sum_m2 = 0.0;
  int count = 0;

  void Add(const Eigen::VectorXd& residual_m) {
    for (const double value : residual_m) {
      if (std::isnan(value)) continue;
      sum_m2 += value * value;
      ++count;
    }
  }
  void Add(const Squares& other) {
    sum_m2 += other.sum_m2;
    count += other.count;
  }
  double Rms_m() const {
    return count > 0 ? std::sqrt(sum_m2 / count) : std::numeric_limits<double>::quiet_NaN();
  }
};

/// [samples] [coordinates] measured - predicted; NaN: not known.
using Residuals = std::vector<Eigen::VectorXd>;

/// `from` [parameters]: what was simulated.
Eigen::VectorXd Residual_m(const ObservedExperiment& observed, const Fit& fit, std::size_t sample,
                           const Eigen::VectorXd& from, const Eigen::VectorXd& z) {
  const SimulatedSample& simulated = fit.simulation.samples[sample];
  const Eigen::VectorXd moved_m = simulated.jacobian_m * (z - from);
  Eigen::VectorXd measured_m(observed.CoordinateCount());
  for (Eigen::Index k = 0; k < measured_m.size(); ++k) {
    measured_m[k] = Measured_m(observed.samples[sample], k);
  }
  return measured_m - simulated.seen_m - moved_m;
}

/// What a shape in which the body was held may be off by is no fault of the simulation: of each
/// marker a constant, at most twice as large as such shapes are off by.
void TakeOffReference(const ObservedExperiment& observed, int recording, Residuals* residuals_m) {
  constexpr double kAtMost = 2.0;
  if (!observed.recordings[At(recording)].held_until_s) return;
  const double most_m = kAtMost * observed.reference_sigma_m;
  for (Eigen::Index k = 0; k < 3 * std::ssize(observed.markers); ++k) {
    double sum_m = 0.0;
    int count = 0;
    for (std::size_t s = 0; s < observed.samples.size(); ++s) {
      const double value_m = (*residuals_m)[s][k];
      if (observed.samples[s].recording != recording || std::isnan(value_m)) continue;
      sum_m += value_m;
      ++count;
    }
    if (count == 0) continue;
    const double off_m = std::clamp(sum_m / count, -most_m, most_m);
    for (std::size_t s = 0; s < observed.samples.size(); ++s) {
      if (observed.samples[s].recording == recording) (*residuals_m)[s][k] -= off_m;
    }
  }
}

/// Of a fit at parameters, of each recording their own: z [recordings], or one for all.
Residuals ResidualsOf(const ObservedExperiment& observed, const HypothesisSet& hypotheses,
                      const Fit& fit, const std::vector<Eigen::VectorXd>& z) {
  const Eigen::VectorXd from = hypotheses.Simulated(fit.z);
  Residuals residuals_m;
  for (std::size_t s = 0; s < observed.samples.size(); ++s) {
    const auto r = static_cast<std::size_t>(observed.samples[s].recording);
    residuals_m.push_back(Residual_m(observed, fit, s, from, z.size() == 1 ? z.front() : z[r]));
  }
  for (int r = 0; r < std::ssize(observed.recordings); ++r) {
    TakeOffReference(observed, r, &residuals_m);
  }
  return residuals_m;
}

Eigen::VectorXd Noise_m(const ObservedExperiment& observed, std::size_t sample) {
  const Sample& seen = observed.samples[sample];
  Eigen::VectorXd noise_m(observed.CoordinateCount());
  for (Eigen::Index k = 0; k < noise_m.size(); ++k) {
    noise_m[k] =
        IsMeasured(seen, k) ? Sigma_m(observed, seen, k) : std::numeric_limits<double>::quiet_NaN();
  }
  return noise_m;
}

/// Places of what is measured [3 x places], robot frame: residuals of markers as they are, of the
/// surface along its normal.
Eigen::Matrix3Xd OnBody(const ObservedExperiment& observed, std::size_t sample,
                        const Eigen::VectorXd& residual_m) {
  const Sample& seen = observed.samples[sample];
  const ObservedRecording& recording = observed.recordings[At(seen.recording)];
  const Eigen::Index markers = std::ssize(observed.markers);
  Eigen::Matrix3Xd on_body_m = Eigen::Matrix3Xd::Constant(
      3, markers + observed.feature_rest_m.cols(), std::numeric_limits<double>::quiet_NaN());
  const Eigen::Matrix3d R_robot_measurement = recording.T_measurement_robot.linear().transpose();
  on_body_m.leftCols(markers) =
      R_robot_measurement * residual_m.head(3 * markers).reshaped(3, markers);
  for (std::size_t f = 0; f < seen.surface.size(); ++f) {
    if (seen.surface[f].count == 0) continue;
    const auto feature = ToIndex(f);
    on_body_m.col(markers + feature) =
        residual_m[3 * markers + feature] *
        (recording.T_camera_robot->linear().transpose() * seen.surface[f].normal.normalized());
  }
  return on_body_m;
}

/// Of one recording, over its samples.
struct Sums {
  Squares before, null_model, after, heldout_before, heldout_after, noise;
  int samples = 0;
};

/// As all other recordings have them.
std::vector<Eigen::VectorXd> LeftOut(const HypothesisSet& hypotheses, const Fit& fit,
                                     const std::vector<int>& causes) {
  std::vector<Eigen::VectorXd> z;
  const Eigen::VectorXd scale = hypotheses.InferScale(fit.model.All(), causes);
  for (std::size_t r = 0; r < fit.model.rows_of_recording.size(); ++r) {
    z.push_back(hypotheses.InferWithin(fit.model.AllBut(r), causes, scale).mean);
  }
  return z;
}

/// Recordings are drawn again, with replacement, as the parts of an experiment that are
/// independent.
void FindGainInterval(const std::vector<Sums>& recordings, ErrorSummary* error) {
  constexpr int kDraws = 1000;
  constexpr double kTail = 0.025;
  std::mt19937_64 random(1);
  std::uniform_int_distribution<std::size_t> any(0, recordings.size() - 1);
  std::vector<double> gains_m;
  for (int draw = 0; draw < kDraws; ++draw) {
    Sums all;
    for (std::size_t r = 0; r < recordings.size(); ++r) {
      const Sums& one = recordings[any(random)];
      all.heldout_before.Add(one.heldout_before);
      all.heldout_after.Add(one.heldout_after);
    }
    const double gain_m = all.heldout_before.Rms_m() - all.heldout_after.Rms_m();
    if (std::isfinite(gain_m)) gains_m.push_back(gain_m);
  }
  if (gains_m.empty()) return;
  std::sort(gains_m.begin(), gains_m.end());
  const auto tail = static_cast<std::size_t>(kTail * static_cast<double>(gains_m.size()));
  error->heldout_gain_low_m = gains_m[tail];
  error->heldout_gain_high_m = gains_m[gains_m.size() - 1 - tail];
}

/// [actuators] as actuation.csv has it.
Eigen::VectorXd ReportedCommand(const Timeline& timeline, double t_s) {
  Eigen::VectorXd command = timeline.CommandAt(t_s);
  for (std::size_t a = 0; a < timeline.actuators.size(); ++a) {
    double& value = command[ToIndex(a)];
    value = timeline.by_tension[a] ? timeline.actuators[a].ReportedForce(value)
                                   : timeline.actuators[a].ReportedDisplacement(value);
  }
  return command;
}

void DescribeBody(const ObservedExperiment& observed, const robot::RobotBody& body,
                  DiagnosisResult* result) {
  for (std::size_t a = 0; a < observed.timeline.actuators.size(); ++a) {
    const robot::ActuatorTraits& actuator = observed.timeline.actuators[a];
    result->cables.push_back(actuator.Title());
    result->cable_units.emplace_back(
        observed.timeline.by_tension[a] ? actuator.force_unit() : actuator.displacement_unit());
  }
  result->markers = observed.markers;
  result->marker_rest_m.resize(3, std::ssize(body.markers) + observed.feature_rest_m.cols());
  for (std::size_t m = 0; m < body.markers.size(); ++m) {
    result->marker_rest_m.col(ToIndex(m)) = body.markers[m].point.rest_m;
  }
  result->marker_rest_m.rightCols(observed.feature_rest_m.cols()) = observed.feature_rest_m;
  for (Eigen::Index f = 0; f < observed.feature_rest_m.cols(); ++f) {
    result->markers.push_back("surface point " + std::to_string(f + 1));
  }
  result->surface_m = body.mesh.nodes_m;
  const Eigen::Matrix3Xi triangles = body.boundary.CornerTriangles();
  for (Eigen::Index k = 0; k < triangles.cols(); ++k) {
    result->triangles.push_back({triangles(0, k), triangles(1, k), triangles(2, k)});
  }
}

}  // namespace

double ExplainedShare(const HypothesisSet& hypotheses, const Selection& selection, int cause) {
  const Fit& best = selection.best;
  std::vector<int> others = best.faults;
  std::erase(others, cause);
  const double with = best.posterior.misfit;
  const double null_model = selection.null_model.posterior.misfit;
  // The only one is far from none: the nominal robot's own fit knows better than a linear model.
  const double without =
      others.empty() ? null_model : hypotheses.InferWithin(best.model.All(), others).misfit;
  const double noise = std::min(with, static_cast<double>(best.model.y.size()));
  if (!(null_model > noise)) return 0.0;
  return std::clamp((without - with) / (null_model - noise), 0.0, 1.0);
}

void DescribeModelError(const ObservedExperiment& observed, const robot::RobotBody& body,
                        const HypothesisSet& hypotheses, const Fit& as_built,
                        const Selection& selection, DiagnosisResult* result) {
  DescribeBody(observed, body, result);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(hypotheses.parameter_count());
  const Fit& best = selection.best;
  const Fit& null_model = selection.null_model;
  const Residuals before_m = ResidualsOf(observed, hypotheses, as_built, {none});
  const Residuals null_model_m =
      ResidualsOf(observed, hypotheses, null_model, {null_model.posterior.mean});
  const Residuals after_m = ResidualsOf(observed, hypotheses, best, {best.posterior.mean});
  const Residuals heldout_before_m = ResidualsOf(
      observed, hypotheses, null_model, LeftOut(hypotheses, null_model, null_model.faults));
  const Residuals heldout_after_m =
      ResidualsOf(observed, hypotheses, best, LeftOut(hypotheses, best, best.faults));
  std::vector<Sums> sums(observed.recordings.size());
  for (std::size_t s = 0; s < observed.samples.size(); ++s) {
    const Sample& sample = observed.samples[s];
    const auto r = static_cast<std::size_t>(sample.recording);
    if (!as_built.simulation.samples[s].status.ok()) continue;
    sums[r].before.Add(before_m[s]);
    sums[r].null_model.Add(null_model_m[s]);
    sums[r].after.Add(after_m[s]);
    sums[r].heldout_before.Add(heldout_before_m[s]);
    sums[r].heldout_after.Add(heldout_after_m[s]);
    sums[r].noise.Add(Noise_m(observed, s));
    ++sums[r].samples;
    result->compared_samples.push_back({.recording = sample.recording,
                                        .t_s = sample.t_s,
                                        .command = ReportedCommand(observed.timeline, sample.t_s),
                                        .before_m = OnBody(observed, s, before_m[s]),
                                        .after_m = OnBody(observed, s, after_m[s])});
  }
  Sums all;
  for (std::size_t r = 0; r < sums.size(); ++r) {
    const Sums& one = sums[r];
    result->recordings.push_back({.name = observed.recordings[r].name,
                                  .kind = observed.recordings[r].kind,
                                  .samples = one.samples,
                                  .before_m = one.before.Rms_m(),
                                  .null_model_m = one.null_model.Rms_m(),
                                  .after_m = one.after.Rms_m(),
                                  .heldout_before_m = one.heldout_before.Rms_m(),
                                  .heldout_after_m = one.heldout_after.Rms_m(),
                                  .noise_m = one.noise.Rms_m()});
    all.before.Add(one.before);
    all.null_model.Add(one.null_model);
    all.after.Add(one.after);
    all.heldout_before.Add(one.heldout_before);
    all.heldout_after.Add(one.heldout_after);
    all.noise.Add(one.noise);
  }
  result->model_error = {.before_m = all.before.Rms_m(),
                         .null_model_m = all.null_model.Rms_m(),
                         .after_m = all.after.Rms_m(),
                         .heldout_before_m = all.heldout_before.Rms_m(),
                         .heldout_after_m = all.heldout_after.Rms_m(),
                         .noise_m = all.noise.Rms_m()};
  if (!best.faults.empty()) FindGainInterval(sums, &result->model_error);
}

}  // namespace palpate::diagnosis
