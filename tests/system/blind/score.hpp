// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/system/blind/case_runner.hpp"
#include "tests/system/blind/forecast.hpp"
#include "tests/system/blind/share.hpp"

namespace palpate::blind {

/// Smallest effects that must be found. `sigma_m` is that of diagnose.yaml.
struct Limits {
  double sigma_m = 4e-4;
  double single_m = 3e-4;      ///< at least this,
  double single_sigmas = 0.3;  ///< and this many sigma
  double each_of_two_sigmas = 0.5;
};

/// How a set of cases came out. A case without a verdict counts against the diagnosis wherever a
/// verdict was due; one that was not made counts nowhere else.
struct Score {
  int cases = 0;
  int not_made = 0;
  Share without_verdict;  ///< of all that were made
  // One cause, large enough.
  Share top1;     ///< the first that is named
  Share top3;     ///< among the first three (Verdict::First)
  Share place;    ///< of those of the right kind, where there is more than one place
  Share another;  ///< beside a right one, one is named that is not there
  std::map<std::string, Share> top1_of;  ///< by cause
  // Healthy.
  Share false_accusations;
  // Two causes, each large enough.
  Share both, one, third;  ///< named both; at least one; one that is not there
  // Outside of the catalogue; and everybody else whose data are sound.
  Share flagged;
  Share false_flags;
  // Corrupted; and everybody else.
  Share unfit;
  Share wrongly_unfit;
  // Causes that were named rightly, of whatever size.
  Share covered;                         ///< parameters inside their 95 % intervals
  Share told;                            ///< parameters that the verdict has
  std::vector<double> parameter_errors;  ///< |error| / |truth|, vectors as a whole
  std::vector<double> fault_errors;      ///< |error| / |truth - nominal|
  std::vector<double> place_errors_m;    ///< of loads
  std::vector<double> heldout_gains;     ///< of one cause: of squared error beyond noise, what went
  std::vector<Forecast> forecasts;       ///< of first causes, of sound data
};

Score Judge(const std::vector<CaseRecord>& records, const Limits& limits = {});

/// How a single case came out, for people: "named", "accused", "missed", ...
std::string Outcome(const CaseRecord& record, const Limits& limits = {});

}  // namespace palpate::blind
