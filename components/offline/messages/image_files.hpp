// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "components/offline/messages/recorded_camera.hpp"

namespace palpate::offline {

/// The folder of the images of a stretch of time, both ends included.
struct Stretch {
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
  int segment = -1;  ///< Phase::segment
  std::filesystem::path folder;
};

/// Writes depth/, color/ and clouds/ of each stretch. A colour image goes with the depth image
/// nearest in time, within half the time between depth images, and has its name. Throws RunError
/// where a file cannot be written, InputError where an image has another size than its camera.
void WriteImages(const recording::RecordedMessages& recorded, const TopicRoles& roles,
                 const CollectedTopics& topics, const RecordedCamera& camera,
                 const std::vector<Stretch>& stretches, std::vector<std::string>* notes);

}  // namespace palpate::offline
