// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/cloud/join_frames.hpp"

#include <algorithm>

namespace palpate::calibration {

std::vector<CloudFrame> JoinFrames(std::vector<CloudFrame> first,
                                   const std::vector<std::vector<CloudFrame>>& further) {
  std::vector<CloudFrame> joined = std::move(first);
  for (std::size_t k = 0; k < further.size(); ++k) {
    for (const CloudFrame& frame : further[k]) {
      auto place = std::find_if(joined.begin(), joined.end(),
                                [&](const CloudFrame& one) { return one.name == frame.name; });
      if (place == joined.end()) {
        place = joined.insert(joined.end(), frame);
        place->cloud = {};
      }
      place->further.resize(further.size());
      place->further[k] = frame.cloud;
    }
  }
  for (CloudFrame& frame : joined) frame.further.resize(further.size());
  return joined;
}

}  // namespace palpate::calibration
