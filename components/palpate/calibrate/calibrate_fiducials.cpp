// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <utility>

#include "components/offline/images/image_samples.hpp"
#include "components/palpate/calibrate/calibrate_methods.hpp"
#include "components/palpate/calibrate/calibrate_points.hpp"
#include "components/palpate/calibrate/image_settings.hpp"
#include "components/palpate/find_robot.hpp"
#include "components/palpate/images/open_images.hpp"
#include "components/perception/markers/fiducial_detector.hpp"
#include "components/perception/registered_frame.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/images/rgbd_sequence.hpp"

namespace palpate::command {

namespace {

using calibration::UnlabelledFrame;
using perception::FiducialFrame;

/// Index of the robot's marker; -1 for no name.
int IndexOf(const std::string& name, const std::vector<std::string>& markers) {
  if (name.empty()) return -1;
  const auto found = std::find(markers.begin(), markers.end(), name);
  if (found != markers.end()) return static_cast<int>(found - markers.begin());
  throw InputError("perception.markers.names: the robot has no marker '" + name + "'" +
                   DidYouMean(name, markers));
}

std::vector<calibration::MarkerSighting> PointsOf(const FiducialFrame& seen,
                                                  const std::vector<std::string>& markers) {
  std::vector<calibration::MarkerSighting> points;
  for (const perception::Fiducial& fiducial : seen.fiducials) {
    points.push_back({.marker = IndexOf(fiducial.name, markers),
                      .position_m = fiducial.position_m,
                      .covariance_m2 = fiducial.covariance_m2});
  }
  return points;
}

std::string Rejected(const perception::FiducialRejections& rejected) {
  return fmt::format(
      "{} regions of their colour are no fiducials: {} too small, {} too large, {} not round, {} "
      "without depth, {} at an edge, {} too similar in colour to their surroundings",
      rejected.Count(), rejected.too_small, rejected.too_large, rejected.not_round,
      rejected.no_depth, rejected.at_edge, rejected.wrong_color);
}

/// Adds the points of one recording's images.
void Look(const std::vector<offline::ImageSample>& samples,
          const perception::FiducialConfig& config, const std::vector<std::string>& markers,
          bool with_images, PointsWithoutNames* points) {
  perception::FiducialDetector detector(config);
  detector.SetCamera(samples.front().images->camera);
  perception::Registration registration(samples.front().images->camera);
  perception::RegisteredFrame registered;
  rgbd::RgbdFrame images;
  for (const offline::ImageSample& sample : samples) {
    sample.images->Read(sample.index, &images);
    const FiducialFrame& seen = detector.Detect(images);
    if (!seen.status.ok()) throw InputError(sample.frame.name + ": " + seen.status.message());
    if (seen.fiducials.empty()) {
      fmt::print(stderr, "excluded: {}: no fiducial is seen; {}\n", sample.frame.name,
                 Rejected(seen.rejected));
      continue;
    }
    points->frames.push_back({.frame = {.name = sample.frame.name,
                                        .cables = sample.frame.cables,
                                        .loads = sample.frame.loads,
                                        .gravity_m_s2 = sample.frame.gravity_m_s2},
                              .points = PointsOf(seen, markers)});
    if (!with_images || !registration.Register(images, &registered).ok()) continue;
    points->grounds.push_back({registered.color, sample.images->camera.depth});
  }
}

}  // namespace

robot::CalibrationFile CalibrateFromFiducials(const CalibrateOptions& options,
                                              const experiment::Experiment& experiment,
                                              const std::vector<int>& materials,
                                              robot::RobotModel* model) {
  perception::FiducialConfig config =
      perception::FiducialsOf(PerceptionOf(options.overrides, experiment));
  PointsWithoutNames points;
  points.settings.request = RequestOf(options, experiment, materials, true);
  // An error common to all points of an image is not noise of each point.
  points.settings.request.depth_bias_sigma = std::exchange(config.depth_bias, 0.0);
  points.settings.named = !config.names.empty();
  const std::vector<std::string> markers = model->MarkerNames();
  for (const std::string& name : config.names) IndexOf(name, markers);
  points.recordings = RecordingsWithImages(options, experiment);
  for (const experiment::Recording* recording : points.recordings) {
    const auto images = OpenImages(*recording);
    Look(offline::SamplesOf(*recording, images, *model, ParseCableInput(options.cable_input)),
         config, markers, !options.assignment.empty(), &points);
  }
  if (points.frames.empty()) {
    throw RunError(
        "no image shows a fiducial: check their colour (--set "
        "perception.markers.color_rgb=[r, g, b]) and their size (perception.markers.min_radius_m, "
        "max_radius_m)");
  }
  return CalibrateFromPoints(options, experiment, points, model);
}

}  // namespace palpate::command
