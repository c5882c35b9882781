// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "libs/scenario/effect.hpp"

namespace palpate::blind {

/// A parameter as verdict.json has it.
struct Estimate {
  double value = 0.0;
  double ci95_low = 0.0;
  double ci95_high = 0.0;
};

/// A cause by name; of `causes` also with its parameters.
struct Suspect {
  std::string id = {};
  std::vector<std::string> where = {};
  double probability = 0.0;
  std::map<std::string, Estimate> parameters = {};

  /// Whether this is the name of that effect, or of its twin (TwinsOf). Two swapped cables have no
  /// order.
  bool Names(const scenario::ActiveEffect& effect) const;
  /// The kind of cause is right, wherever it is.
  bool IsOfKind(const scenario::ActiveEffect& effect) const;
};

/// RMS m; NaN where the file has none.
struct Residuals {
  double before = 0.0;  ///< the robot file as it is
  double heldout_after = 0.0;
  double noise = 0.0;
};

/// verdict.json (docs/experiment.md), as far as the judge reads it.
struct Verdict {
  std::string verdict = {};
  std::vector<Suspect> causes = {};
  std::vector<Suspect> alternatives = {};
  std::vector<Suspect> indistinguishable_from = {};
  Residuals residuals_m = {};

  /// There is a gap that the catalogue does not explain.
  bool IsFlagged() const { return verdict == "unexplained" || verdict == "partly_explained"; }
  /// The verdict accuses.
  bool Accuses() const;
  /// The most probable ones, no two equal: causes, then those not identifiable from the first,
  /// then alternatives.
  std::vector<const Suspect*> First(std::size_t count) const;
};

/// Throws RunError, saying what is wrong: no such verdict, `cause` without one, a cause without a
/// name, a probability beyond [0, 1], an interval whose ends are exchanged, a number that is none.
Verdict ReadVerdict(const std::filesystem::path& file);

}  // namespace palpate::blind
