// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/explain/identities.hpp"

#include <algorithm>

namespace palpate::diagnosis {

namespace {

std::size_t PlacesOfLoads(const ObservedExperiment& observed) {
  constexpr double kElsewhere_m = 5e-3;
  std::vector<Eigen::Vector3d> places_m;
  for (const Sample& sample : observed.samples) {
    for (const experiment::KnownLoad& load : sample.loads) {
      const bool known = std::any_of(places_m.begin(), places_m.end(), [&](const auto& place_m) {
        return (place_m - load.position_m).norm() < kElsewhere_m;
      });
      if (!known) places_m.push_back(load.position_m);
    }
  }
  return places_m.size();
}

/// Whether depth cameras saw all their recordings from one place.
bool SeenFromOnePlace(const ObservedExperiment& observed) {
  const ObservedRecording* first = nullptr;
  for (const ObservedRecording& recording : observed.recordings) {
    if (!recording.by_depth_camera && !recording.T_camera_robot) continue;
    if (first == nullptr) first = &recording;
    if (!recording.T_view_robot().isApprox(first->T_view_robot(), 1e-6)) return false;
  }
  return first != nullptr;
}

}  // namespace

std::vector<std::string> Identities(const ObservedExperiment& observed) {
  const bool loaded = std::any_of(observed.samples.begin(), observed.samples.end(),
                                  [](const Sample& sample) { return !sample.loads.empty(); });
  const bool tilted = std::any_of(
      observed.recordings.begin(), observed.recordings.end(),
      [](const ObservedRecording& recording) { return !recording.base_rotation.isIdentity(); });
  std::vector<std::string> identities = {
      "A negative zero offset of an actuator and a slack cable are not identifiable.",
      "A mass on the body (of markers, too) and a downward force are not identifiable at any base "
      "tilt.",
      "Stretch and cutting-in of a cable that ends where it first touches the body are not "
      "identifiable."};
  if (!loaded) {
    identities.emplace_back(
        "Without a known load only density over modulus and force over modulus are identifiable: "
        "hang "
        "a known weight on the robot.");
  }
  if (loaded && PlacesOfLoads(observed) == 1) {
    identities.emplace_back(
        "The place of a known load that acts at one place only is not identifiable from the "
        "modulus: "
        "hang it elsewhere, too.");
  }
  if (!tilted) {
    identities.emplace_back(
        "Without a tilted base gravity's direction and a sideways force are hardly identifiable: "
        "tilt "
        "the base by 15 degrees.");
  }
  if (SeenFromOnePlace(observed)) {
    identities.emplace_back(
        "From one camera pose depth scale and distance, and image centre and viewing direction, "
        "are "
        "hardly identifiable: record again from another known pose.");
  }
  return identities;
}

}  // namespace palpate::diagnosis
