// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/cloud/cloud_matching.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "libs/core/statistics.hpp"

namespace palpate::calibration {

namespace {

struct Candidate {
  Eigen::Index point;
  SurfaceFoot foot;
  double height_m;  ///< along the normal
};

/// Stricter limits lose points of the robot, looser ones take points of other objects.
struct CloudMatchingTuning {
  double most_across_m = 2e-3;  ///< distance across the normal; beyond, the point is past an edge
  double least_trust = 0.03;    ///< weight below which a point is left out
};
constexpr CloudMatchingTuning kMatchingTuning;

double AcrossOf_m(const Candidate& candidate) {
  const double squared_m2 = candidate.foot.distance_m * candidate.foot.distance_m -
                            candidate.height_m * candidate.height_m;
  return std::sqrt(std::max(0.0, squared_m2));
}

/// 1 at 0, falling smoothly to 0 at 1 and beyond: the root of Tukey's biweight. Points with jumping
/// weights would keep the camera moving between rounds.
double Fading(double share) { return std::max(0.0, 1.0 - share * share); }

std::vector<Candidate> CandidatesOf(const SurfaceInView& surface, const Eigen::Matrix3Xd& points_m,
                                    const geometry::RigidTransform& T_robot_camera,
                                    double widest_m) {
  std::vector<Candidate> candidates;
  for (Eigen::Index k = 0; k < points_m.cols(); ++k) {
    const Eigen::Vector3d here_m = T_robot_camera * points_m.col(k);
    const std::optional<SurfaceFoot> foot = surface.FootOf(here_m);
    if (!foot || foot->distance_m > widest_m) continue;
    const Candidate candidate{k, *foot, foot->normal.dot(here_m - foot->position_m)};
    if (AcrossOf_m(candidate) < kMatchingTuning.most_across_m) candidates.push_back(candidate);
  }
  return candidates;
}

/// From the median distance, which is 0.6745 standard deviations of normal noise.
double GateOf(const std::vector<Candidate>& candidates, const CloudSettings& settings) {
  std::vector<double> off_m;
  for (const Candidate& candidate : candidates) off_m.push_back(std::abs(candidate.height_m));
  return std::clamp(settings.gate_sigmas * UpperMedian(off_m) / 0.6745, settings.narrowest_gate_m,
                    settings.widest_gate_m);
}

Status Invalid(const CloudFrame& frame, const std::string& what) {
  return {StatusCode::kInvalidInput, frame.name + ": " + what};
}

Status CheckCloud(const CloudFrame& frame, const rgbd::SensedCloud& cloud,
                  const CloudSettings& settings) {
  if (cloud.sigma_m.size() != cloud.Count()) {
    return Invalid(frame, std::to_string(cloud.sigma_m.size()) + " sigmas for " +
                              std::to_string(cloud.Count()) + " points");
  }
  for (Eigen::Index k = 0; k < cloud.Count(); ++k) {
    const bool fine = cloud.points_m.col(k).allFinite() && cloud.points_m(2, k) > 0.0f &&
                      std::isfinite(cloud.sigma_m[k]) && cloud.sigma_m[k] > 0.0f;
    if (!fine) {
      return Invalid(frame,
                     "point " + std::to_string(k) +
                         " of the cloud is not finite, not in front of the camera, or its sigma "
                         "is not above 0");
    }
  }
  if (cloud.Count() < settings.least_points) {
    return {StatusCode::kNoRobotSeen, frame.name + ": " + std::to_string(cloud.Count()) +
                                          " points, fewer than " +
                                          std::to_string(settings.least_points)};
  }
  return Status::Ok();
}

Status CheckFrame(const robot::RobotModel& model, const CloudFrame& frame,
                  const CloudSettings& settings) {
  if (static_cast<int>(frame.cables.size()) != model.ActuatorCount()) {
    return Invalid(frame, std::to_string(frame.cables.size()) + " inputs, the robot has " +
                              std::to_string(model.ActuatorCount()) + " actuators");
  }
  const std::size_t cameras = settings.further_cameras.size();
  if (!frame.further.empty() && frame.further.size() != cameras) {
    return Invalid(frame, "clouds of " + std::to_string(frame.further.size()) +
                              " further cameras, the settings have " + std::to_string(cameras));
  }
  std::vector<const rgbd::SensedCloud*> clouds;
  if (frame.cloud.Count() > 0) clouds.push_back(&frame.cloud);
  for (const rgbd::SensedCloud& cloud : frame.further) {
    if (cloud.Count() > 0) clouds.push_back(&cloud);
  }
  if (clouds.empty()) return CheckCloud(frame, frame.cloud, settings);
  for (const rgbd::SensedCloud* cloud : clouds) {
    if (Status status = CheckCloud(frame, *cloud, settings); !status.ok()) return status;
  }
  return Status::Ok();
}

/// Whether each camera sees the robot in a frame.
Status CheckCameras(const std::vector<CloudFrame>& frames, const CloudSettings& settings) {
  const auto see = [&](const auto& sees) {
    return std::any_of(frames.begin(), frames.end(), sees);
  };
  if (!see([](const CloudFrame& frame) { return frame.cloud.Count() > 0; }))
    return {StatusCode::kNoRobotSeen, "the first camera sees the robot in no frame"};
  for (std::size_t k = 0; k < settings.further_cameras.size(); ++k) {
    if (!see([k](const CloudFrame& frame) {
          return !frame.further.empty() && frame.further[k].Count() > 0;
        }))
      return {StatusCode::kNoRobotSeen,
              "camera '" + settings.further_cameras[k].name + "' sees the robot in no frame"};
  }
  return Status::Ok();
}

}  // namespace

Status CheckClouds(const robot::RobotModel& model, const std::vector<CloudFrame>& frames,
                   const CloudSettings& settings) {
  if (frames.empty()) return {StatusCode::kInvalidInput, "no cloud was given"};
  for (const CloudFrame& frame : frames) {
    if (Status status = CheckFrame(model, frame, settings); !status.ok()) return status;
  }
  return CheckCameras(frames, settings);
}

std::vector<SurfaceSighting> MatchCloud(const SurfaceInView& surface, const ThinCloud& cloud,
                                        const Eigen::Matrix3Xd& unbiased_m,
                                        const geometry::RigidTransform& T_robot_camera,
                                        const CloudSettings& settings, CloudMatch* match) {
  *match = {.points = static_cast<int>(cloud.Count()), .outlier_share = 1.0};
  const std::vector<Candidate> candidates =
      CandidatesOf(surface, unbiased_m, T_robot_camera, settings.widest_gate_m);
  std::vector<SurfaceSighting> sightings;
  if (candidates.empty()) return sightings;
  const double gate_m = GateOf(candidates, settings);
  double squares_m2 = 0.0;
  for (const Candidate& candidate : candidates) {
    const double trust = Fading(candidate.height_m / gate_m) *
                         Fading(AcrossOf_m(candidate) / kMatchingTuning.most_across_m) *
                         candidate.foot.openness;
    if (trust < kMatchingTuning.least_trust) continue;
    const Eigen::Vector3d point_m = cloud.points_m.col(candidate.point);
    const Eigen::Vector3d normal_camera =
        T_robot_camera.rotation().conjugate() * candidate.foot.normal;
    const double depth_m =
        std::abs(normal_camera.dot(point_m)) / point_m.z() * cloud.sigma_m[candidate.point];
    const double facet_m =
        settings.facet_error_share * surface.FacetError_m(candidate.foot.triangle);
    sightings.push_back({.position_m = point_m,
                         .sigma_m = std::hypot(depth_m, facet_m) / trust,
                         .point = surface.WeightsOf(candidate.foot),
                         .normal = candidate.foot.normal});
    squares_m2 += candidate.height_m * candidate.height_m;
  }
  match->matched = static_cast<int>(sightings.size());
  match->outlier_share = 1.0 - static_cast<double>(match->matched) / match->points;
  if (match->matched > 0) match->rms_m = std::sqrt(squares_m2 / match->matched);
  return sightings;
}

}  // namespace palpate::calibration
