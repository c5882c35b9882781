// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/surface/surface_matcher.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "components/diagnosis/forward/measured_points.hpp"
#include "libs/core/index.hpp"

namespace palpate::diagnosis {

namespace {

/// How far beside the predicted outline a cloud point may lie.
constexpr double kBeside_m = 3e-3;
/// A cloud that lies farther off the surface is of something else: a depth scale of 3.5 % moves it
/// by 16 mm half a metre away.
constexpr double kFarthest_m = 0.02;
/// What changes from shape to shape as other facets and other pixels come into view, one sigma; no
/// number of depth frames takes it away.
constexpr double kMatching_m = 8e-5;
/// Depth frames that follow each other err alike.
constexpr double kInCommon = 1.3;
/// By how much of a wave the effect of one is found, and where the two begin.
constexpr double kRipple_px = 0.02;
constexpr double kRippleTurns[] = {0.0, 0.25};

/// Nodes as the camera measures them, but for what it errs by on slanted surface, camera frame
/// [3n].
Eigen::VectorXd AsMeasured(const CameraView& camera, const Eigen::Isometry3d& T_camera_robot,
                           const Eigen::Matrix3Xf& nodes_m) {
  Eigen::Matrix3Xd measured_m = T_camera_robot * nodes_m.cast<double>();
  for (auto node_m : measured_m.colwise()) {
    node_m = camera.Measured({.at_m = node_m});
  }
  return measured_m.reshaped();
}

/// As a stereo camera would have it whose disparities are off by a wave (StereoRipple).
rgbd::SensedCloud Rippled(rgbd::SensedCloud cloud, double stereo_px_m, double turns) {
  for (auto point_m : cloud.points_m.colwise()) {
    const double z_m = static_cast<double>(point_m.z());
    const double wave = std::cos(2.0 * std::numbers::pi * (stereo_px_m / z_m - turns));
    point_m *= static_cast<float>(1.0 - z_m / stereo_px_m * kRipple_px * wave);
  }
  return cloud;
}

double HeightOf(const correspondence::FeatureMatch& match, const Eigen::VectorXd& measured_m) {
  return match.target_m - match.row.Value(measured_m);
}

/// The point of the body that a row is about: nodes count as they face the way that it looks.
void AddPoint(const robot::ObservationRow& row, const Eigen::Vector3d& normal, double share,
              std::map<int, double>* weights) {
  const double squared = normal.squaredNorm();
  for (std::size_t k = 0; k < row.nodes.size(); ++k) {
    (*weights)[row.nodes[k]] += share * row.coefficients[k].dot(normal) / squared;
  }
}

fem::InterpolationWeights PointOf(const std::map<int, double>& weights) {
  fem::InterpolationWeights point;
  for (const auto& [node, weight] : weights) {
    point.nodes.push_back(node);
    point.weights.push_back(weight);
  }
  return point;
}

}  // namespace

SurfaceMatcher::SurfaceMatcher(const robot::RobotBody& body)
    : body_(body), features_(body), surface_(features_.triangles()), patches_(features_) {}

void SurfaceMatcher::Read(const ObservedExperiment& observed,
                          const std::vector<ShapesInTime>& shapes, SurfaceSource* source) {
  clouds_.assign(observed.samples.size(), {});
  for (std::size_t s = 0; s < observed.samples.size(); ++s) {
    const Sample& sample = observed.samples[s];
    const auto& recording = observed.recordings[At(sample.recording)];
    for (const DepthFrame& frame : sample.depth_frames) {
      SeenCloud& seen = clouds_[s].emplace_back();
      seen.frame = frame;
      if (shapes[s].empty()) {
        seen.why_not = "the simulated robot has no equilibrium there";
        continue;
      }
      SegmentedCloud look = source->Segment(
          sample.recording, frame.number,
          {shapes[s].At(frame.t_s, shapes[s].nodes_m), recording.T_camera_robot->inverse()});
      seen.digest = look.digest;
      if (!look.status.ok()) {
        seen.why_not = look.status.message();
        continue;
      }
      seen.cloud = std::move(look.cloud);
      seen.cloud.colors_rgb = {};
    }
  }
}

void SurfaceMatcher::Match(const ModelHypothesis& hypothesis,
                           const std::vector<ShapesInTime>& shapes, ObservedExperiment* observed) {
  matched_ = 0;
  outliers_ = 0;
  measured_.assign(static_cast<std::size_t>(features_.Count()), {});
  nominal_ = measured_;
  for (std::size_t s = 0; s < observed->samples.size(); ++s) {
    observed->samples[s].surface.assign(static_cast<std::size_t>(features_.Count()), {});
    if (!shapes[s].empty()) MatchSample(hypothesis, shapes[s], s, observed);
  }
  SetSigmas(observed);
}

/// A feature whose few points lie at an edge, or askew, scatters by more than its points' noise.
void SurfaceMatcher::SetSigmas(ObservedExperiment* observed) const {
  constexpr double kFewest = 8.0;
  MeanOf typical;  // of measured over nominal variance
  for (std::size_t f = 0; f < measured_.size(); ++f) {
    if (measured_[f].count >= kFewest)
      typical.Add(std::max(1.0, measured_[f].Mean() / nominal_[f].Mean()));
  }
  for (Sample& sample : observed->samples) {
    for (std::size_t f = 0; f < sample.surface.size(); ++f) {
      SurfaceMeasurement& surface = sample.surface[f];
      if (surface.count == 0) continue;
      const double nominal_m2 = nominal_[f].Mean();
      double variance_m2 = nominal_m2 * (typical.count > 0.0 ? typical.Mean() : 1.0);
      if (measured_[f].count >= kFewest) variance_m2 = std::max(nominal_m2, measured_[f].Mean());
      surface.sigma_m = std::hypot(kInCommon * std::sqrt(variance_m2 / surface.count), kMatching_m);
    }
  }
}

void SurfaceMatcher::MatchSample(const ModelHypothesis& hypothesis, const ShapesInTime& shapes,
                                 std::size_t s, ObservedExperiment* observed) {
  Sample& sample = observed->samples[s];
  const auto r = static_cast<std::size_t>(sample.recording);
  CameraErrors errors = hypothesis.camera;
  errors.incidence_bias_m = 0.0;
  const auto camera = ViewOf(errors, *observed, sample, Target::kSurface);
  if (!camera) return;
  const Eigen::Isometry3d T_camera_robot =
      *observed->recordings[r].T_camera_robot * hypothesis.T_surface_seen[r];
  std::vector<Eigen::VectorXd> measured_m;  // [shapes] [3n]
  for (const Eigen::Matrix3Xf& nodes_m : shapes.nodes_m) {
    measured_m.push_back(AsMeasured(*camera, T_camera_robot, nodes_m));
  }
  std::vector<std::vector<FeatureInFrame>> in_frames(sample.surface.size());
  for (SeenCloud& seen : clouds_[s]) {
    if (seen.cloud.Count() == 0) continue;
    MeasureFeatures(shapes.At(seen.frame.t_s, measured_m), observed->recordings[r].stereo_px_m,
                    &seen, &in_frames);
  }
  for (std::size_t f = 0; f < in_frames.size(); ++f) {
    if (in_frames[f].empty()) continue;
    SurfaceMeasurement& measurement = sample.surface[f];
    measurement = Mean(in_frames[f]);
    for (const FeatureInFrame& one : in_frames[f]) nominal_[f].Add(one.sigma_m * one.sigma_m);
    if (sample.still) AddScatter(in_frames[f], &measured_[f]);
    measurement.rest_m = measurement.point.Position(body_.mesh.nodes_m.reshaped());
    std::vector<double> there_m;  // [shapes]
    for (const Eigen::Matrix3Xf& nodes_m : shapes.nodes_m) {
      const Eigen::VectorXd x_m = nodes_m.cast<double>().reshaped();
      there_m.push_back(measurement.normal.dot(
          camera->Measured({.at_m = T_camera_robot * measurement.point.Position(x_m)})));
    }
    for (const double t_s : sample.frame_t_s) {
      measurement.measured_m +=
          shapes.At(t_s, there_m) / static_cast<double>(sample.frame_t_s.size());
    }
  }
}

/// Adds what one depth frame shows of each feature.
void SurfaceMatcher::MeasureFeatures(const Eigen::VectorXd& measured_m, double stereo_px_m,
                                     SeenCloud* seen,
                                     std::vector<std::vector<FeatureInFrame>>* in_frames) {
  surface_.MoveTo(measured_m, Eigen::Isometry3d::Identity());
  view_.Look(surface_.vertices_m(), surface_.triangles());
  const auto match = [&](const rgbd::SensedCloud& cloud) {
    std::vector<correspondence::FeatureMatch> found(in_frames->size());
    patches_.Match(cloud, Eigen::Isometry3d::Identity(), surface_, view_, {kBeside_m, kFarthest_m},
                   found);
    return found;
  };
  const std::vector<correspondence::FeatureMatch> found = match(seen->cloud);
  std::vector<std::vector<correspondence::FeatureMatch>> rippled;
  for (const double turns : kRippleTurns) {
    if (stereo_px_m > 0.0) rippled.push_back(match(Rippled(seen->cloud, stereo_px_m, turns)));
  }
  seen->height_m.setConstant(std::ssize(found), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t f = 0; f < found.size(); ++f) {
    if (found[f].state == correspondence::MatchState::kOutlier) ++outliers_;
    if (found[f].state != correspondence::MatchState::kMatched) continue;
    ++matched_;
    const double height_m = HeightOf(found[f], measured_m);
    seen->height_m[ToIndex(f)] = height_m;
    FeatureInFrame& one = (*in_frames)[f].emplace_back();
    one = {height_m, found[f].sigma_m, found[f].row, found[f].normal};
    for (std::size_t k = 0; k < rippled.size(); ++k) {
      if (rippled[k][f].state != correspondence::MatchState::kMatched) continue;
      one.ripple_m_px[ToIndex(k)] = (HeightOf(rippled[k][f], measured_m) - height_m) / kRipple_px;
    }
  }
}

void SurfaceMatcher::AddScatter(const std::vector<FeatureInFrame>& depth_frames,
                                MeanOf* variance_m2) {
  double mean_m = 0.0;
  for (const FeatureInFrame& one : depth_frames)
    mean_m += one.height_m / static_cast<double>(depth_frames.size());
  for (const FeatureInFrame& one : depth_frames) {
    variance_m2->sum += std::pow(one.height_m - mean_m, 2);
  }
  variance_m2->count += static_cast<double>(depth_frames.size()) - 1.0;
}

SurfaceMeasurement SurfaceMatcher::Mean(const std::vector<FeatureInFrame>& depth_frames) {
  SurfaceMeasurement mean;
  mean.count = static_cast<int>(depth_frames.size());
  const double share = 1.0 / static_cast<double>(depth_frames.size());
  std::map<int, double> weights;
  for (const FeatureInFrame& one : depth_frames) {
    mean.measured_m += share * one.height_m;
    mean.normal += share * one.normal;
    mean.ripple_m_px += share * one.ripple_m_px;
    AddPoint(one.row, one.normal, share, &weights);
  }
  mean.point = PointOf(weights);
  return mean;
}

}  // namespace palpate::diagnosis
