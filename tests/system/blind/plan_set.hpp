// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <ostream>
#include <vector>

#include "tests/system/blind/blind_set.hpp"
#include "tests/system/blind/plan_runner.hpp"
#include "tests/system/blind/share.hpp"

namespace palpate::blind {

/// Of the questions that counted: how many the further recording answered.
struct PlanScore {
  Share proposed;
  Share drawn;
};

PlanScore Judge(const std::vector<PlanRecord>& records);

/// Cases of the set's seeds, two at a time, until so many of them as it has left a question, or ten
/// times as many were tried. Prints the seed, a line for each as it ends, and the score.
std::vector<PlanRecord> RunPlans(const BlindSet& set, std::ostream& out);

}  // namespace palpate::blind
