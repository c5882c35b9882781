// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "components/offline/messages/image_files.hpp"
#include "components/offline/messages/recorded_camera.hpp"

namespace palpate::offline {

/// A depth camera beside the first, whose topics are /camera_NAME/... .
struct FurtherRecordedCamera {
  std::string name;
  TopicRoles roles;  ///< in which its topics have the place of the first camera's
  CollectedTopics topics;
  RecordedCamera camera;
};

/// The clock of an experiment, as ChooseClock has chosen it.
struct ChosenClock {
  std::int64_t origin_ns = 0;
  bool is_of_stamps = true;  ///< else of the recording
};
ChosenClock ClockOf(const CollectedTopics& topics, std::int64_t origin_ns);

/// The cameras beside the first that have depth images, by name, on the clock of the experiment.
/// `remap`: rules of --remap. One that cannot be read, or has another clock, is left out with a
/// note.
std::vector<FurtherRecordedCamera> FindFurtherCameras(const recording::RecordedMessages& recorded,
                                                      const std::vector<std::string>& remap,
                                                      const std::string& robot_frame,
                                                      const ChosenClock& clock,
                                                      std::vector<std::string>* notes);

/// Writes cameras/NAME/ of each stretch in which the camera has images.
void WriteFurtherCamera(const recording::RecordedMessages& recorded,
                        const FurtherRecordedCamera& camera, std::vector<Stretch> stretches,
                        std::vector<std::string>* notes);

}  // namespace palpate::offline
