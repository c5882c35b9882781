// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/estimate/known_truth.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "components/palpate/simulate/sealed_answer.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/core/sha256.hpp"

namespace palpate::command {

namespace {

/// Shares that make the comparison the same for robots of any size and strength.
struct KnownTruthTuning {
  /// Of the body's diagonal. Larger: a wrong place counts as found; smaller: a place that is off by
  /// a patch counts as a miss and a false alarm.
  double same_place = 0.1;
  /// Of the largest true force: smaller ones may be missed.
  double smallest_force = 0.1;
};
constexpr KnownTruthTuning kKnownTruthTuning;

TruthTimeline TimelineOf(const RecordingTruth& recording) {
  TruthTimeline timeline;
  for (const TrueForces& frame : recording.frames) {
    std::vector<TrueContact> contacts;
    for (const virtual_robot::TrueForce& force : frame.forces) {
      contacts.push_back({force.name, force.position_m, force.force_N});
    }
    timeline.Add(frame.t_s, std::move(contacts));
  }
  return timeline;
}

double LargestForce_N(const std::vector<RecordingTruth>& recordings) {
  double largest_N = 0.0;
  for (const RecordingTruth& recording : recordings) {
    for (const TrueForces& frame : recording.frames) {
      for (const virtual_robot::TrueForce& force : frame.forces) {
        largest_N = std::max(largest_N, force.force_N.norm());
      }
    }
  }
  return largest_N;
}

/// The longest time between two samples of a recording: steadiness cannot be seen within less.
double LongestPeriod_s(const std::vector<RecordingTruth>& recordings) {
  double longest_s = 0.0;
  for (const RecordingTruth& recording : recordings) {
    for (std::size_t i = 1; i < recording.frames.size(); ++i) {
      longest_s = std::max(longest_s, recording.frames[i].t_s - recording.frames[i - 1].t_s);
    }
  }
  return longest_s;
}

}  // namespace

KnownTruth ReadKnownTruth(const std::filesystem::path& answer,
                          const experiment::Experiment& experiment, double body_diagonal_m) {
  if (experiment.answer_sha256 && Sha256Hex(ReadFile(answer)) != *experiment.answer_sha256) {
    throw InputError(
        SourceLocation{answer.string()},
        "is the ground truth of another experiment: its hash is not answer_sha256 of " +
            (experiment.folder / "experiment.yaml").string());
  }
  const std::vector<RecordingTruth> recordings = ReadRecordingTruths(answer);
  KnownTruth truth;
  for (const RecordingTruth& recording : recordings) {
    truth.of_recording.emplace(recording.name, TimelineOf(recording));
  }
  truth.rules.same_place_m = kKnownTruthTuning.same_place * body_diagonal_m;
  truth.rules.smallest_N = kKnownTruthTuning.smallest_force * LargestForce_N(recordings);
  if (LongestPeriod_s(recordings) > 0.5 * truth.rules.steady_window_s) {
    truth.rules.steady_window_s = 0.0;
  }
  return truth;
}

}  // namespace palpate::command
