// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/skin/first_look.hpp"

#include <algorithm>

#include "components/diagnosis/data/fitness.hpp"
#include "components/diagnosis/model/simulator.hpp"

namespace palpate::diagnosis {

namespace {

void TellCameras(SkinSource* pictures, ObservedExperiment* observed) {
  for (std::size_t r = 0; r < observed->recordings.size(); ++r) {
    ObservedRecording& recording = observed->recordings[r];
    if (!recording.T_camera_robot) continue;
    const rgbd::RgbdCamera camera = pictures->Camera(static_cast<int>(r));
    recording.focal_px = Eigen::Vector2d(camera.depth.fx_px, camera.depth.fy_px);
    recording.stereo_px_m = camera.depth.fx_px * camera.baseline_m;
  }
}

std::string WhyOfNoUse(const ObservedExperiment& observed, const SkinMatcher& matcher) {
  std::string why = WhyUnfit(observed, matcher.clouds());
  if (why.empty() && matcher.outliers() > matcher.matched()) {
    why =
        "most of what pictures show lies more than 20 mm off the robot: it is another one, or the "
        "camera stands elsewhere than T_robot_camera says";
  }
  const bool has_markers =
      std::any_of(observed.samples.begin(), observed.samples.end(),
                  [](const Sample& sample) { return (sample.count.array() > 0).any(); });
  if (!why.empty() && has_markers) why += "; the markers alone may still tell";
  return why;
}

}  // namespace

std::string LookAtPictures(const ModelHypothesis& hypothesis, int threads, SkinSource* pictures,
                           SkinMatcher* matcher, ObservedExperiment* observed) {
  observed->feature_rest_m = matcher->rest_m();
  TellCameras(pictures, observed);
  const Simulator simulator(*observed, threads);
  const std::vector<ShapesInTime> shapes = simulator.Shapes(hypothesis, simulator.Run(hypothesis));
  matcher->Look(*observed, shapes, pictures);
  matcher->Match(hypothesis, shapes, observed);
  return WhyOfNoUse(*observed, *matcher);
}

}  // namespace palpate::diagnosis
