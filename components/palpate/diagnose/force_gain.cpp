// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/diagnose/force_gain.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <optional>
#include <stdexcept>
#include <string>

#include "components/palpate/diagnose/known_load_errors.hpp"

namespace palpate::command {

namespace {

/// RMS of the frames that both have.
diagnosis::ForceError Compare(const KnownLoadErrors& before, const KnownLoadErrors& after) {
  diagnosis::ForceError error;
  double before_N2 = 0.0;
  double after_N2 = 0.0;
  std::string last;
  for (const auto& [frame, before_N] : before) {
    const auto same = after.find(frame);
    if (same == after.end()) continue;
    before_N2 += before_N.squaredNorm();
    after_N2 += same->second.squaredNorm();
    error.forces += static_cast<int>(before_N.size());
    error.recordings += frame.first != last ? 1 : 0;
    last = frame.first;
  }
  if (error.forces == 0) return error;
  error.before_N = std::sqrt(before_N2 / error.forces);
  error.after_N = std::sqrt(after_N2 / error.forces);
  return error;
}

}  // namespace

diagnosis::ForceError MeasureForceError(const robot::RobotDescription& robot,
                                        const diagnosis::Diagnosis& diagnosis,
                                        const experiment::Experiment& experiment, int threads,
                                        const std::function<bool()>& stop_requested) {
  const bool in_files = diagnosis.not_in_files.size() < diagnosis.result.causes.size();
  if (!in_files ||
      std::none_of(experiment.recordings.begin(), experiment.recordings.end(), HasMeasuredLoads)) {
    return {};
  }
  try {
    std::future<KnownLoadErrors> before =
        std::async(threads > 1 ? std::launch::async : std::launch::deferred, [&] {
          return EstimateKnownLoads(robot, std::nullopt, experiment, Progress::kSilent,
                                    stop_requested);
        });
    const KnownLoadErrors after = EstimateKnownLoads(
        diagnosis.extended, diagnosis.calibration, experiment, Progress::kReported, stop_requested);
    return Compare(before.get(), after);
  } catch (const std::runtime_error& error) {
    diagnosis::ForceError unknown;
    unknown.why_not = error.what();
    return unknown;
  }
}

}  // namespace palpate::command
