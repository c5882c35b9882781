// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/diagnose/surface_images.hpp"

#include <algorithm>

#include "components/palpate/images/open_images.hpp"
#include "libs/core/index.hpp"

namespace palpate::command {

namespace {

/// FNV-1a, 64 bits (G. Fowler, L. C. Noll, K.-P. Vo).
std::uint64_t DigestOf(const rgbd::DepthImage& depth) {
  constexpr std::uint64_t kPrime = 1099511628211ULL;
  std::uint64_t digest = 14695981039346656037ULL;
  for (const std::uint16_t value : depth.values) digest = (digest ^ value) * kPrime;
  return digest;
}

}  // namespace

SurfaceImages::SurfaceImages(const experiment::Experiment& experiment, const robot::RobotBody& body,
                             const perception::Config& config)
    : experiment_(experiment), viewer_(config, body) {}

diagnosis::SegmentedCloud SurfaceImages::Segment(int recording, int frame,
                                                 const diagnosis::ExpectedShape& expected) {
  const ExpectedNodes nodes{expected.nodes_m, expected.T_robot_camera};
  const perception::SegmentedFrame& seen =
      viewer_.Look(SequenceOf(recording), static_cast<std::size_t>(frame), &nodes);
  return {seen.status, seen.robot, DigestOf(viewer_.images().depth)};
}

rgbd::RgbdCamera SurfaceImages::Camera(int recording) { return SequenceOf(recording).camera; }

const experiment::RgbdSequence& SurfaceImages::SequenceOf(int recording) {
  const auto known = sequences_.find(recording);
  if (known != sequences_.end()) return known->second;
  return sequences_.emplace(recording, OpenImages(experiment_.recordings[At(recording)]))
      .first->second;
}

bool HasSurfaceImages(const experiment::Experiment& experiment) {
  return std::any_of(experiment.recordings.begin(), experiment.recordings.end(),
                     [](const experiment::Recording& recording) {
                       return !recording.depth_images.empty() || !recording.clouds.empty();
                     });
}

}  // namespace palpate::command
