// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/images/open_images.hpp"

#include <fmt/core.h>

#include <set>
#include <string>

#include "libs/app/yaml.hpp"

namespace palpate::command {

experiment::RgbdSequence OpenImages(const experiment::Recording& recording) {
  static std::set<std::string> printed;
  experiment::RgbdSequence images = experiment::OpenRecordingImages(recording, app::LoadYaml);
  for (const std::string& note : images.notes) {
    if (printed.insert(note).second) fmt::print(stderr, "note: {}\n", note);
  }
  return images;
}

}  // namespace palpate::command
