// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/compare/file_comparison.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <map>

#include "components/palpate/compare/force_comparison.hpp"
#include "libs/core/error.hpp"

namespace palpate::command {

namespace {

using force_estimation::ForceEstimate;
using Frames = std::vector<ForceEstimate>;

/// Names of one recording in both files.
struct Names {
  std::string estimated, truth;
};

std::string ListOf(const ForceFile& file) {
  std::string list;
  for (const auto& [name, frames] : file.of_recording) list += (list.empty() ? "" : ", ") + name;
  return list;
}

bool HasNames(const ForceFile& file) { return !file.of_recording.contains(""); }

bool IsWanted(const std::string& name, const std::vector<std::string>& wanted) {
  return wanted.empty() || std::find(wanted.begin(), wanted.end(), name) != wanted.end();
}

void RequireNames(const ForceFile& estimated, const ForceFile& truth,
                  const std::vector<std::string>& wanted) {
  for (const std::string& name : wanted) {
    if (estimated.of_recording.contains(name) || truth.of_recording.contains(name)) continue;
    throw InputError("--recording: '" + name + "' is in neither file; ESTIMATED has " +
                     ListOf(estimated) + ", TRUTH has " + ListOf(truth));
  }
}

/// A file without names has one recording, which is that of the other file.
std::vector<Names> PairWithNameless(const ForceFile& named, bool named_is_truth,
                                    const std::vector<std::string>& wanted) {
  std::vector<Names> pairs;
  for (const auto& [name, frames] : named.of_recording) {
    if (!IsWanted(name, wanted)) continue;
    pairs.push_back({named_is_truth ? "" : name, named_is_truth ? name : ""});
  }
  if (pairs.size() == 1) return pairs;
  throw InputError(fmt::format("{} names no recordings, and {} has {}: choose one with --recording",
                               named_is_truth ? "ESTIMATED" : "TRUTH",
                               named_is_truth ? "TRUTH" : "ESTIMATED", ListOf(named)));
}

std::vector<Names> PairRecordings(const ForceFile& estimated, const ForceFile& truth,
                                  const FileComparisonRules& rules) {
  RequireNames(estimated, truth, rules.recordings);
  if (!HasNames(estimated) && !HasNames(truth)) return {{"", ""}};
  if (!HasNames(estimated)) return PairWithNameless(truth, true, rules.recordings);
  if (!HasNames(truth)) return PairWithNameless(estimated, false, rules.recordings);
  std::vector<Names> pairs;
  for (const auto& [name, frames] : truth.of_recording) {
    const bool in_both = estimated.of_recording.contains(name) || rules.silence_is_no_contact;
    if (in_both && IsWanted(name, rules.recordings)) pairs.push_back({name, name});
  }
  if (!pairs.empty()) return pairs;
  throw InputError("no recording is in both files; ESTIMATED has " + ListOf(estimated) +
                   ", TRUTH has " + ListOf(truth));
}

/// The frames on the clock of the truth.
Frames FramesOf(const ForceFile& estimated, const std::string& recording, double offset_s) {
  const auto found = estimated.of_recording.find(recording);
  Frames frames = found == estimated.of_recording.end() ? Frames() : found->second;
  for (ForceEstimate& frame : frames) frame.t_s += offset_s;
  return frames;
}

/// With frames that found nothing at the truth's times that are farther than `gap_s` from all rows.
Frames WithSilence(const Frames& frames, const TruthTimeline& truth, double gap_s) {
  Frames all = frames;
  for (const double t_s : truth.times_s()) {
    const auto next = std::lower_bound(
        frames.begin(), frames.end(), t_s,
        [](const ForceEstimate& frame, double time_s) { return frame.t_s < time_s; });
    const bool near_next = next != frames.end() && next->t_s - t_s <= gap_s;
    const bool near_last = next != frames.begin() && t_s - (next - 1)->t_s <= gap_s;
    if (near_next || near_last) continue;
    ForceEstimate& silent = all.emplace_back();
    silent.t_s = t_s;
    silent.status = Status(StatusCode::kNoContact, {});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const ForceEstimate& a, const ForceEstimate& b) { return a.t_s < b.t_s; });
  return all;
}

RecordingScore Compare(const std::string& name, const Frames& frames, const TruthTimeline& truth,
                       const ComparisonRules& rules, ComparisonSummary* all) {
  RecordingScore score;
  score.name = name;
  for (const ForceEstimate& frame : frames) {
    ++score.frames;
    if (!HasResult(frame.status)) {
      ++score.without_result;
    } else if (!truth.At(frame.t_s)) {
      ++score.without_truth;
    } else {
      std::vector<ComparedForce> compared = CompareFrame(frame, truth, rules);
      for (ComparedForce& force : compared) force.recording = name;
      score.summary.Add(compared);
      all->Add(compared);
    }
  }
  return score;
}

std::string SpanOf(const ForceFile& file) {
  double begin_s = std::numeric_limits<double>::infinity();
  double end_s = -begin_s;
  for (const auto& [name, frames] : file.of_recording) {
    for (const ForceEstimate& frame : frames) {
      begin_s = std::min(begin_s, frame.t_s);
      end_s = std::max(end_s, frame.t_s);
    }
  }
  return fmt::format("{:.3f} to {:.3f} s", begin_s, end_s);
}

void AddNotes(const ForceFile& estimated, const ForceFile& truth, const FileComparisonRules& rules,
              FileComparison* comparison) {
  const auto missing = [&](const ForceFile& in, const ForceFile& other, const char* name) {
    if (!HasNames(in) || !HasNames(other)) return;
    for (const auto& [recording, frames] : in.of_recording) {
      if (other.of_recording.contains(recording) || !IsWanted(recording, rules.recordings))
        continue;
      comparison->notes.push_back(fmt::format("recording {} is in {} only", recording, name));
    }
  };
  missing(estimated, truth, "ESTIMATED");
  missing(truth, estimated, "TRUTH");
  const auto unused = [&](const ForceFile& file, const char* name) {
    for (const std::string& column : file.unused_columns) {
      comparison->notes.push_back(fmt::format("column {} of {} is not used", column, name));
    }
  };
  unused(estimated, "ESTIMATED");
  unused(truth, "TRUTH");
  if (truth.kind == ForceFile::Kind::kLoads) {
    comparison->notes.push_back(
        "places of TRUTH are on the undeformed body: location errors hold its displacement");
  }
  if (!estimated.has_frames_without_contact && !rules.silence_is_no_contact) {
    comparison->notes.push_back(
        "ESTIMATED has no row without a contact: when it found nothing is not known, and no force "
        "counts as missed then (--silence-is-no-contact)");
  }
}

}  // namespace

FileComparison CompareForces(const ForceFile& estimated, const ForceFile& truth,
                             const FileComparisonRules& rules) {
  const std::vector<Names> pairs = PairRecordings(estimated, truth, rules);
  std::map<std::string, TruthTimeline> timelines;
  for (const Names& names : pairs) {
    timelines.emplace(names.truth, TruthOf(truth, names.truth, rules.timing));
  }
  FileComparison comparison;
  comparison.rules = RulesOf(timelines, rules.same_place_m);
  if (rules.smallest_N) comparison.rules.smallest_N = *rules.smallest_N;
  for (const Names& names : pairs) {
    const TruthTimeline& timeline = timelines.at(names.truth);
    Frames frames = FramesOf(estimated, names.estimated, rules.time_offset_s);
    if (rules.silence_is_no_contact) {
      frames = WithSilence(frames, timeline, rules.timing.longest_gap_s);
    }
    const std::string& name = names.truth.empty() ? names.estimated : names.truth;
    comparison.recordings.push_back(
        Compare(name, frames, timeline, comparison.rules, &comparison.all));
  }
  if (comparison.all.frames() == 0) {
    throw RunError("no time of ESTIMATED (" + SpanOf(estimated) + ") has a known truth; TRUTH is " +
                   SpanOf(truth) + ". Clocks that differ: --time-offset");
  }
  AddNotes(estimated, truth, rules, &comparison);
  return comparison;
}

}  // namespace palpate::command
