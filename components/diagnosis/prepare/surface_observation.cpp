// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/prepare/surface_observation.hpp"

#include <algorithm>

#include "components/diagnosis/forward/simulator.hpp"
#include "components/diagnosis/prepare/data_checks.hpp"

namespace palpate::diagnosis {

namespace {

void SetCameraFacts(SurfaceSource* source, ObservedExperiment* observed) {
  for (std::size_t r = 0; r < observed->recordings.size(); ++r) {
    ObservedRecording& recording = observed->recordings[r];
    if (!recording.T_camera_robot) continue;
    const rgbd::RgbdCamera camera = source->Camera(static_cast<int>(r));
    recording.focal_px = Eigen::Vector2d(camera.depth.fx_px, camera.depth.fy_px);
    recording.stereo_px_m = camera.depth.fx_px * camera.baseline_m;
  }
}

Status CheckSurface(const ObservedExperiment& observed, const SurfaceMatcher& matcher) {
  Status status = CheckImages(observed, matcher.clouds());
  if (status.ok() && matcher.outliers() > matcher.matched()) {
    status = {StatusCode::kInvalidInput,
              "most points of the depth frames lie more than 20 mm off the robot: it is another "
              "robot, or T_robot_camera is wrong"};
  }
  const bool has_markers =
      std::any_of(observed.samples.begin(), observed.samples.end(),
                  [](const Sample& sample) { return (sample.count.array() > 0).any(); });
  if (status.ok() || !has_markers) return status;
  return {status.code(), status.message() + "; the markers alone may still suffice"};
}

}  // namespace

Status ObserveSurface(const ModelHypothesis& hypothesis, int threads, SurfaceSource* source,
                      SurfaceMatcher* matcher, ObservedExperiment* observed) {
  observed->feature_rest_m = matcher->rest_m();
  SetCameraFacts(source, observed);
  const Simulator simulator(*observed, threads);
  const std::vector<ShapesInTime> shapes = simulator.Shapes(hypothesis, simulator.Run(hypothesis));
  matcher->Read(*observed, shapes, source);
  matcher->Match(hypothesis, shapes, observed);
  return CheckSurface(*observed, *matcher);
}

}  // namespace palpate::diagnosis
