// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/forces/bias_frames.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace palpate::offline {

namespace {

using experiment::Recording;

struct BiasFramesTuning {
  /// Misfit (BiasSequence) of first frames that nobody says to be contact-free. Larger: a contact
  /// that no camera sees becomes a bias; smaller: errors of the camera pose prevent it.
  double largest_misfit_of_first = 2.0;
};
constexpr BiasFramesTuning kBiasFramesTuning;

std::string NameOutlier(const ShapeReplay::BiasRecording& outlier, bool is_alone) {
  return fmt::format(
      "{}: not used for the depth bias: its shape is {:.2g} mm RMS off {}. Something touches the "
      "robot, its commands are not what they were, or the camera pose is off by some millimetres",
      outlier.recording->name, 1e3 * outlier.verdict.difference_m,
      is_alone ? "the model by more than the camera's errors"
               : "that of the other contact-free recordings");
}

/// Processes the frames before the first in which something is seen to touch the robot. Where that
/// is the first of all, it may be what holds the robot: then all frames count, and their shape
/// decides. Returns their number.
int UseContactFree(const std::vector<const Recording*>& recordings, BiasFrames* found) {
  constexpr int kAll = std::numeric_limits<int>::max();
  int frames = 0;
  for (const Recording* recording : recordings) {
    const auto start = found->replay->EstimateDepthBiasFromStart(*recording, kAll);
    frames += start.frames > 0 ? start.frames : found->replay->EstimateDepthBias(*recording);
    if (start.frames == 0 || !start.ends_with_contact) continue;
    found->notes.push_back(
        fmt::format("{}: something is seen to touch the robot in frame {}: only the frames before "
                    "it are used for the depth bias",
                    recording->name, start.frames + 1));
  }
  return frames;
}

/// Processes the recordings. Where one of them does not pass, a new replay processes the others.
int UseRecordings(std::vector<const Recording*> recordings,
                  const std::function<std::unique_ptr<ShapeReplay>()>& make_replay,
                  BiasFrames* found) {
  const int frames = UseContactFree(recordings, found);
  const auto judged = found->replay->JudgeBiasRecordings();
  std::vector<std::string> outliers;
  for (const ShapeReplay::BiasRecording& bias : judged) {
    if (bias.verdict.contact_free || bias.verdict.frames == 0) continue;
    outliers.push_back(NameOutlier(bias, judged.size() == 1));
    std::erase(recordings, bias.recording);
  }
  if (outliers.empty()) return frames;
  *found = {.replay = make_replay(), .notes = std::move(outliers)};
  return UseContactFree(recordings, found);
}

/// The number of frames; 0: none pass, and the replay knows of none.
int UseFirstFrames(const Recording& recording, int most,
                   const std::function<std::unique_ptr<ShapeReplay>()>& make_replay,
                   BiasFrames* found) {
  const int frames = found->replay->EstimateDepthBiasFromStart(recording, most).frames;
  if (frames == 0) return 0;
  const auto judged = found->replay->JudgeBiasRecordings();
  const bool pass = std::any_of(judged.begin(), judged.end(), [&](const auto& bias) {
    return bias.recording == &recording && bias.verdict.frames > 0 &&
           bias.verdict.misfit < kBiasFramesTuning.largest_misfit_of_first;
  });
  if (!pass) found->replay = make_replay();
  return pass ? frames : 0;
}

}  // namespace

BiasFrames FindBiasFrames(const BiasRequest& request,
                          const std::function<std::unique_ptr<ShapeReplay>()>& make_replay) {
  BiasFrames found{.replay = make_replay(), .notes = {}};
  const int frames = UseRecordings(BiasRecordings(request.experiment), make_replay, &found);
  if (frames > 0) {
    found.notes.push_back(fmt::format("depth bias estimated from {} contact-free frames", frames));
    return found;
  }
  if (request.is_calibrated) {
    found.notes.emplace_back("depth bias of the calibration file");
    return found;
  }
  for (const PlannedRecording& planned : request.plan) {
    if (planned.from != EstimateFrom::kShape) continue;
    const int first =
        UseFirstFrames(*planned.recording, request.most_first_frames, make_replay, &found);
    if (first == 0) continue;
    found.notes.push_back(
        fmt::format("no contact-free recording (kind rest, ramp, hold, ...): depth bias estimated "
                    "from the first {} frames of {}, in which nothing is seen to touch the robot",
                    first, planned.recording->name));
    return found;
  }
  found.notes.emplace_back(
      "no contact-free recording (kind rest, ramp, hold, ...) and no depth bias in a calibration: "
      "it is estimated together with the forces of each frame. Intervals are wider, and contacts "
      "that the camera does not see are not searched");
  return found;
}

}  // namespace palpate::offline
