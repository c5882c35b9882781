// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/design/planned_experiment.hpp"

#include <algorithm>
#include <cmath>

#include "libs/core/index.hpp"

namespace palpate::diagnosis {

namespace {

/// After that no body of these materials remembers anything.
constexpr double kRelaxed_s = 3e3;
/// After the experiment: beside it the length of all proposals is nothing.
constexpr double kLongAfter_s = 1e7;

/// Between two frames; what is quicker than this is not counted, as frames hang together.
double FrameInterval_s(const ObservedExperiment& observed) {
  constexpr double kShortestInterval_s = 0.2;
  double least_s = 2.0;
  for (const Sample& sample : observed.samples) {
    for (std::size_t k = 1; k < sample.frame_t_s.size(); ++k) {
      least_s = std::min(least_s, sample.frame_t_s[k] - sample.frame_t_s[k - 1]);
    }
  }
  return std::max(kShortestInterval_s, least_s);
}

/// [markers] whether these data see them.
std::vector<bool> SeenMarkers(const ObservedExperiment& observed) {
  std::vector<bool> seen(observed.markers.size(), false);
  for (const Sample& sample : observed.samples) {
    for (std::size_t m = 0; m < seen.size(); ++m) {
      seen[m] = seen[m] || sample.count[ToIndex(m)] > 0;
    }
  }
  return seen;
}

/// The last recording in which the camera stood where it usually does.
int PlainRecording(const ObservedExperiment& observed) {
  for (std::size_t k = observed.recordings.size(); k-- > 0;) {
    const ObservedRecording& recording = observed.recordings[k];
    if (recording.kind != "camera_moved" && recording.base_rotation.isIdentity()) {
      return static_cast<int>(k);
    }
  }
  return 0;
}

/// Frames all along, with markers at their rest: only times and counts are used of them.
experiment::MarkerTracks Frames(const ObservedExperiment& observed, const robot::RobotBody& body,
                                double begin_s, double duration_s, double interval_s) {
  experiment::MarkerTracks tracks;
  std::vector<std::optional<Eigen::Vector3d>> positions_m;
  const std::vector<bool> seen = SeenMarkers(observed);
  for (std::size_t m = 0; m < seen.size(); ++m) {
    if (!seen[m]) continue;
    tracks.names.push_back(observed.markers[m]);
    positions_m.emplace_back(body.markers[m].point.rest_m);
  }
  tracks.names_where.resize(tracks.names.size());
  const int frames = static_cast<int>(std::floor(duration_s / interval_s));
  for (int k = 0; k <= frames; ++k) {
    tracks.frames.push_back(
        {.t_s = begin_s + k * interval_s, .positions_m = positions_m, .line = 0});
  }
  return tracks;
}

/// The surface as a recording's depth frames show it where most of it is in view; empty: none do.
std::vector<SurfaceMeasurement> SurfaceOf(const ObservedExperiment& observed, int recording) {
  const auto seen = [](const std::vector<SurfaceMeasurement>& surface) {
    return std::count_if(surface.begin(), surface.end(),
                         [](const SurfaceMeasurement& one) { return one.count > 0; });
  };
  std::vector<SurfaceMeasurement> best;
  for (const Sample& sample : observed.samples) {
    if (sample.recording == recording && seen(sample.surface) > seen(best)) best = sample.surface;
  }
  return best;
}

/// Half a recording would be another one than was proposed.
void LeaveOutWhatFailed(const ObservedExperiment& planned, Simulation* simulation) {
  std::vector<bool> failed(planned.recordings.size(), false);
  for (std::size_t s = 0; s < planned.samples.size(); ++s) {
    if (simulation->samples[s].status.ok()) continue;
    failed[At(planned.samples[s].recording)] = true;
  }
  for (std::size_t s = 0; s < planned.samples.size(); ++s) {
    if (!failed[At(planned.samples[s].recording)]) continue;
    simulation->samples[s].status =
        Status(StatusCode::kNotConverged, "the robot does not get through the recording");
  }
}

}  // namespace

ObservedExperiment ObserveProposals(const experiment::Experiment& experiment,
                                    const ObservedExperiment& observed,
                                    const robot::RobotBody& body,
                                    const std::vector<Proposal>& proposals) {
  constexpr int kSamplesEach = 8;
  experiment::Experiment all = experiment;
  all.markers_sigma_m = observed.sigma_m;
  all.rest_between_s.reset();
  for (experiment::Recording& made : all.recordings) {
    made.markers.reset();
    made.depth_images.clear();
    made.clouds.clear();
    made.steady_window_s.reset();
    made.reference.reset();
  }
  const double first_s = observed.timeline.end_s.back() + kLongAfter_s;
  const double interval_s = FrameInterval_s(observed);
  double begin_s = first_s;
  for (const Proposal& proposal : proposals) {
    experiment::Recording& planned = all.recordings.emplace_back(proposal.recording);
    planned.name = proposal.title;
    if (planned.actuation) {
      for (double& t_s : planned.actuation->t_s) t_s += begin_s;
    }
    for (experiment::KnownLoad& load : planned.loads) load.t_s += begin_s;
    planned.markers = Frames(observed, body, begin_s, proposal.duration_s, interval_s);
    begin_s += proposal.duration_s + kRelaxed_s;
  }
  ObservedExperiment planned =
      Observe(all, body, {.most_samples = kSamplesEach * static_cast<int>(proposals.size())});
  const int plain = PlainRecording(observed);
  for (std::size_t k = 0; k < planned.recordings.size(); ++k) {
    ObservedRecording& recording = planned.recordings[k];
    const bool made = k < observed.recordings.size();
    const ObservedRecording& like = observed.recordings[made ? k : static_cast<std::size_t>(plain)];
    if (!made) recording.pose_of = plain;
    recording.T_measurement_robot = like.T_measurement_robot;
    recording.knows_pose = like.knows_pose;
    recording.pose_error = like.pose_error;
    recording.camera_frame = like.camera_frame;
    recording.by_depth_camera = like.by_depth_camera;
    recording.T_camera_robot = like.T_camera_robot;
    recording.stereo_px_m = like.stereo_px_m;
    recording.focal_px = like.focal_px;
  }
  planned.feature_rest_m = observed.feature_rest_m;
  const std::vector<SurfaceMeasurement> surface = SurfaceOf(observed, plain);
  for (Sample& sample : planned.samples) {
    sample.frame_t_s = {sample.t_s};
    sample.surface = surface;
  }
  planned.reference_sigma_m = observed.reference_sigma_m;
  planned.timeline.begin_s.front() = observed.timeline.begin_s.front();
  planned.timeline.end_s.back() = first_s;
  return planned;
}

LinearModel PredictProposals(const ObservedExperiment& planned, const robot::RobotBody& body,
                             const HypothesisSet& hypotheses, const Fit& fit,
                             const std::vector<int>& of, const NoiseModel& noise, int threads) {
  const FaultModelList models = hypotheses.All();
  std::vector<bool> wanted(models.size(), false);
  for (const int k : of) wanted[At(k)] = true;
  const ModelHypothesis nominal = NominalHypothesis(body, planned);
  ModelHypothesis hypothesis = HypothesisWith(nominal, models, fit.z);
  for (std::size_t k = 0; k < planned.recordings.size(); ++k) {
    const int pose_of = planned.recordings[k].pose_of;
    if (pose_of < 0) continue;
    hypothesis.T_seen[k] = hypothesis.T_seen[At(pose_of)];
    hypothesis.T_surface_seen[k] = hypothesis.T_surface_seen[At(pose_of)];
  }
  const Simulator simulator(planned, threads);
  Simulation simulation = simulator.Run(hypothesis);
  simulator.Differentiate(hypothesis, models, fit.z, wanted, nominal, &simulation);
  LeaveOutWhatFailed(planned, &simulation);
  Eigen::Matrix3Xd rest_m(3, std::ssize(body.markers));
  for (std::size_t m = 0; m < body.markers.size(); ++m) {
    rest_m.col(ToIndex(m)) = body.markers[m].point.rest_m;
  }
  return Linearise(planned, simulation, hypotheses.Simulated(fit.z), rest_m, noise);
}

}  // namespace palpate::diagnosis
