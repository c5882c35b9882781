// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/estimate/known_truth.hpp"

#include "components/palpate/compare/force_file.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/core/sha256.hpp"

namespace palpate::command {

namespace {

/// A share that makes the comparison the same for robots of any size.
struct KnownTruthTuning {
  /// Of the body's diagonal. Larger: a wrong place counts as found; smaller: a place that is off by
  /// a patch counts as a miss and a false alarm.
  double same_place = 0.1;
};
constexpr KnownTruthTuning kKnownTruthTuning;

}  // namespace

double SamePlace_m(double body_diagonal_m) {
  return kKnownTruthTuning.same_place * body_diagonal_m;
}

KnownTruth ReadKnownTruth(const std::filesystem::path& answer,
                          const experiment::Experiment& experiment, double body_diagonal_m) {
  if (experiment.answer_sha256 && Sha256Hex(ReadFile(answer)) != *experiment.answer_sha256) {
    throw InputError(
        SourceLocation{answer.string()},
        "is the ground truth of another experiment: its hash is not answer_sha256 of " +
            (experiment.folder / "experiment.yaml").string());
  }
  const ForceFile forces = ReadAnswerForces(answer);
  KnownTruth truth;
  for (const auto& [recording, frames] : forces.of_recording) {
    truth.of_recording.emplace(recording, TruthOf(forces, recording, {}));
  }
  truth.rules = RulesOf(truth.of_recording, SamePlace_m(body_diagonal_m));
  return truth;
}

}  // namespace palpate::command
