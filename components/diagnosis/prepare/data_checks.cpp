// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/prepare/data_checks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "libs/core/index.hpp"
#include "libs/core/text.hpp"

namespace palpate::diagnosis {

namespace {

using experiment::ActuatorQuantity;
using experiment::MarkerFrame;
using experiment::Recording;

/// Fewer say nothing about their order.
constexpr std::size_t kFewestFrames = 6;

/// How much a series changes from one value to the next, over how much it changes at all: near 0
/// for a motion that is followed, 1 where neighbours have nothing to do with each other.
struct Jumpiness {
  double steps = 0.0;
  double variance = 0.0;

  void Add(const std::vector<Eigen::Vector3d>& series) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& value : series) mean += value / static_cast<double>(series.size());
    for (std::size_t k = 0; k < series.size(); ++k) {
      variance += (series[k] - mean).squaredNorm();
      if (k > 0) steps += 0.5 * (series[k] - series[k - 1]).squaredNorm();
    }
  }
  double Ratio() const { return variance > 0.0 ? steps / variance : 0.0; }
};

Jumpiness OfMarkers(const Recording& recording) {
  Jumpiness jumpiness;
  for (std::size_t m = 0; m < recording.markers->names.size(); ++m) {
    std::vector<Eigen::Vector3d> series;
    for (const MarkerFrame& frame : recording.markers->frames) {
      if (frame.positions_m[m]) series.push_back(*frame.positions_m[m]);
    }
    if (!series.empty()) jumpiness.Add(series);
  }
  return jumpiness;
}

/// Of the commands at the stamps of the markers.
Jumpiness OfCommands(const Recording& recording) {
  Jumpiness jumpiness;
  for (const auto& column : recording.actuation->columns) {
    if (column.quantity != ActuatorQuantity::kDisplacement) continue;
    std::vector<Eigen::Vector3d> series;
    for (const MarkerFrame& frame : recording.markers->frames) {
      series.emplace_back(recording.actuation->ValueAt(column, frame.t_s), 0.0, 0.0);
    }
    jumpiness.Add(series);
  }
  return jumpiness;
}

bool IsFrozen(const Recording& recording) {
  constexpr int kFewest = 6;
  constexpr double kShare = 0.3;
  int pairs = 0;
  int same = 0;
  const auto& frames = recording.markers->frames;
  for (std::size_t k = 1; k < frames.size(); ++k) {
    ++pairs;
    bool equal = true;
    for (std::size_t m = 0; m < frames[k].positions_m.size(); ++m) {
      equal = equal && frames[k].positions_m[m] == frames[k - 1].positions_m[m];
    }
    if (equal) ++same;
  }
  return pairs >= kFewest && same > kShare * pairs;
}

/// Variance of one sample: as stated, else what the stillest recording changes by from one frame to
/// the next.
double NoiseVariance_m2(const experiment::Experiment& experiment) {
  if (experiment.markers_sigma_m) return experiment.markers_sigma_m->squaredNorm();
  double least_m2 = std::numeric_limits<double>::infinity();
  for (const Recording& recording : experiment.recordings) {
    if (!recording.markers || recording.markers->frames.size() < kFewestFrames) continue;
    const auto samples =
        static_cast<double>(recording.markers->frames.size() * recording.markers->names.size());
    least_m2 = std::min(least_m2, OfMarkers(recording).steps / samples);
  }
  return least_m2;
}

bool IsShuffled(const Recording& recording, double noise_variance_m2) {
  constexpr double kMotion = 9.0;  // of the noise's variance
  constexpr double kJumpy = 0.5;
  constexpr double kMoreThanCommands = 3.0;
  if (!recording.actuation || recording.markers->frames.size() < kFewestFrames) return false;
  const Jumpiness markers = OfMarkers(recording);
  const double noise_m2 =
      static_cast<double>(recording.markers->frames.size() * recording.markers->names.size()) *
      noise_variance_m2;
  return markers.variance > kMotion * noise_m2 && markers.Ratio() > kJumpy &&
         markers.Ratio() > kMoreThanCommands * OfCommands(recording).Ratio();
}

/// Depth frames of one recording that were matched, by time.
std::vector<const SeenCloud*> CloudsOf(const ObservedExperiment& observed,
                                       const SurfaceClouds& clouds, std::size_t recording) {
  std::vector<const SeenCloud*> seen;
  for (std::size_t s = 0; s < clouds.size(); ++s) {
    if (static_cast<std::size_t>(observed.samples[s].recording) != recording) continue;
    for (const SeenCloud& one : clouds[s]) {
      if (one.height_m.size() > 0) seen.push_back(&one);
    }
  }
  return seen;
}

/// The whole of a depth frame, down to its noise, is never the same twice.
bool IsFrozen(const std::vector<const SeenCloud*>& clouds) {
  constexpr std::size_t kFewestPairs = 3;
  constexpr double kShare = 0.3;
  std::size_t same = 0;
  for (std::size_t k = 1; k < clouds.size(); ++k) {
    if (clouds[k]->digest == clouds[k - 1]->digest) ++same;
  }
  const std::size_t pairs = clouds.empty() ? 0 : clouds.size() - 1;
  return pairs >= kFewestPairs && static_cast<double>(same) > kShare * static_cast<double>(pairs);
}

/// How the commands go at the stamps of depth frames.
Jumpiness OfCommands(const Timeline& timeline, const std::vector<const SeenCloud*>& clouds) {
  Jumpiness jumpiness;
  for (Eigen::Index c = 0; c < std::ssize(timeline.actuators); ++c) {
    std::vector<Eigen::Vector3d> series;
    for (const SeenCloud* one : clouds) {
      const double commanded = timeline.CommandAt(one->frame.t_s)[c];
      if (std::isfinite(commanded)) series.emplace_back(commanded, 0.0, 0.0);
    }
    if (!series.empty()) jumpiness.Add(series);
  }
  return jumpiness;
}

/// [features] variance of the noise of one depth frame in a recording, m2; NaN: never seen there.
Eigen::VectorXd NoiseOfFrames_m2(const ObservedExperiment& observed, std::size_t recording) {
  Eigen::VectorXd sum_m2 = Eigen::VectorXd::Zero(observed.feature_rest_m.cols());
  Eigen::VectorXd samples = sum_m2;
  for (const Sample& sample : observed.samples) {
    if (static_cast<std::size_t>(sample.recording) != recording) continue;
    for (std::size_t f = 0; f < sample.surface.size(); ++f) {
      const SurfaceMeasurement& surface = sample.surface[f];
      if (surface.count == 0) continue;
      const auto feature = ToIndex(f);
      sum_m2[feature] += surface.count * surface.sigma_m * surface.sigma_m;
      ++samples[feature];
    }
  }
  return sum_m2.cwiseQuotient(samples);
}

/// The surface lies off where it is thought to be as smoothly as the body moves: most features of
/// which that is far more than noise jump as much as their stamps make of it. One alone may look
/// from edge to edge.
bool IsShuffled(const ObservedExperiment& observed, std::size_t recording,
                const std::vector<const SeenCloud*>& clouds) {
  constexpr double kMotion = 9.0;  // of the noise's variance
  constexpr double kJumpy = 0.5;
  constexpr double kMoreThanCommands = 3.0;
  constexpr int kFewestFeatures = 5;
  if (clouds.empty()) return false;
  const Eigen::VectorXd noise_m2 = NoiseOfFrames_m2(observed, recording);
  const double of_commands = OfCommands(observed.timeline, clouds).Ratio();
  int moving = 0;
  int jumping = 0;
  for (Eigen::Index f = 0; f < noise_m2.size(); ++f) {
    std::vector<Eigen::Vector3d> series;
    for (const SeenCloud* one : clouds) {
      if (std::isfinite(one->height_m[f])) series.emplace_back(one->height_m[f], 0.0, 0.0);
    }
    Jumpiness jumpiness;
    jumpiness.Add(series);
    const double of_noise_m2 = static_cast<double>(series.size()) * noise_m2[f];
    if (series.size() < kFewestFrames || !(jumpiness.variance > kMotion * of_noise_m2)) continue;
    ++moving;
    if (jumpiness.Ratio() > std::max(kJumpy, kMoreThanCommands * of_commands)) ++jumping;
  }
  return moving >= kFewestFeatures && 2 * jumping > moving;
}

Status Refused(const std::string& why) { return {StatusCode::kInvalidInput, why}; }

/// A rest in which all chambers are open to the air. Cables are never left alone on purpose.
bool MayBeOpen(const experiment::Experiment& experiment, const Recording& recording) {
  if (recording.kind != experiment::RecordingKind::kRest) return false;
  return std::all_of(
      experiment.recordings.begin(), experiment.recordings.end(), [](const Recording& one) {
        return !one.actuation ||
               std::all_of(one.actuation->columns.begin(), one.actuation->columns.end(),
                           [](const auto& column) { return column.of_chamber; });
      });
}

}  // namespace

Status CheckImages(const ObservedExperiment& observed, const SurfaceClouds& clouds) {
  std::size_t seen = 0;
  std::size_t depth_frames = 0;
  std::string why_not;
  for (const std::vector<SeenCloud>& of_sample : clouds) {
    for (const SeenCloud& one : of_sample) {
      ++depth_frames;
      if (one.cloud.Count() > 0) ++seen;
      if (one.cloud.Count() == 0) why_not = one.why_not;
    }
  }
  constexpr std::size_t kFewestShare = 2;  // one in so many
  if (kFewestShare * seen < depth_frames) {
    return Refused("the robot is seen in " + FormatNumber(static_cast<double>(seen)) + " of " +
                   FormatNumber(static_cast<double>(depth_frames)) +
                   " depth frames: " + (why_not.empty() ? "they are empty" : why_not));
  }
  for (std::size_t r = 0; r < observed.recordings.size(); ++r) {
    const std::vector<const SeenCloud*> of_recording = CloudsOf(observed, clouds, r);
    const std::string who = "recording " + observed.recordings[r].name;
    if (IsFrozen(of_recording)) {
      return Refused(who + ": depth frames are identical to the last digit: the camera was frozen");
    }
    if (IsShuffled(observed, r, of_recording)) {
      return Refused(
          who + ": the clouds jump while the cables move steadily: the stamps are out of order");
    }
  }
  return Status::Ok();
}

Status CheckTables(const experiment::Experiment& experiment) {
  bool actuated = false;
  for (const Recording& recording : experiment.recordings) {
    actuated = actuated || recording.actuation.has_value();
  }
  const double noise_variance_m2 = NoiseVariance_m2(experiment);
  for (const Recording& recording : experiment.recordings) {
    const std::string who = "recording " + recording.name;
    const bool measured =
        recording.markers || !recording.depth_images.empty() || !recording.clouds.empty();
    if (measured && actuated && !recording.actuation && !MayBeOpen(experiment, recording)) {
      return Refused(who +
                     " has no actuation.csv, but others have: its cable commands are unknown");
    }
    if (!recording.markers) continue;
    if (IsFrozen(recording)) {
      return Refused(who + ": the markers are identical to the last digit: the camera was frozen");
    }
    if (IsShuffled(recording, noise_variance_m2)) {
      return Refused(
          who + ": the markers jump while the cables move steadily: the stamps are out of order");
    }
  }
  return Status::Ok();
}

Status CheckAgainstNominal(const ObservedExperiment& observed, const Simulation& as_built) {
  constexpr double kMostFailed = 0.2;
  constexpr double kOtherSize = 0.1;
  int failed = 0;
  double spread_measured_m = 0.0;
  double spread_simulated_m = 0.0;
  for (std::size_t s = 0; s < observed.samples.size(); ++s) {
    const SimulatedSample& simulated = as_built.samples[s];
    if (!simulated.status.ok()) {
      ++failed;
      continue;
    }
    std::vector<Eigen::Index> seen;
    for (Eigen::Index m = 0; m < simulated.markers; ++m) {
      if (observed.samples[s].count[m] > 0) seen.push_back(m);
    }
    if (seen.size() < 3) continue;
    const Eigen::Matrix3Xd measured_m = observed.samples[s].position_m(Eigen::all, seen);
    const Eigen::Matrix3Xd expected_m = simulated.markers_m()(Eigen::all, seen);
    spread_measured_m += (measured_m.colwise() - measured_m.rowwise().mean()).norm();
    spread_simulated_m += (expected_m.colwise() - expected_m.rowwise().mean()).norm();
  }
  if (failed > kMostFailed * static_cast<double>(observed.samples.size())) {
    return Refused("the simulated robot has no equilibrium at " + FormatNumber(failed) + " of " +
                   FormatNumber(static_cast<double>(observed.samples.size())) +
                   " samples: " + as_built.status.message());
  }
  if (spread_simulated_m == 0.0 && observed.HasSurface()) return Status::Ok();
  if (spread_simulated_m == 0.0) return Refused("no sample has three markers");
  const double size = spread_measured_m / spread_simulated_m;
  if (std::abs(size - 1.0) > kOtherSize) {
    return Refused(
        "the markers lie " + FormatNumber(std::round(100.0 * size) / 100.0) +
        " times as far from each other as on this robot: another robot, or a wrong unit");
  }
  return Status::Ok();
}

}  // namespace palpate::diagnosis
