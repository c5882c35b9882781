// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "tests/benchmarks/block.hpp"

namespace palpate::benchmarks {

/// `diagnosis/simulate`, `differentiate_one`, `differentiate_all`, `screen`: the steps of a
/// diagnosis, each over all moments of an experiment. `diagnosis/blind`: PALPATE_BLIND_CASES hidden
/// causes through `palpate simulate` and `palpate diagnose`, from PALPATE_BLIND_SEED on
/// (tests/system/blind). Each case takes minutes, so that there is no such benchmark where
/// PALPATE_BLIND_CASES is not set. `diagnosis/next_experiment`: as many questions that few data
/// leave open, with the experiment that answers them best as `palpate diagnose --plan` has it, and
/// with one drawn of its ranking. Both print their own tables; the figures are their counters, too.
/// Throws InputError for what is no number.
std::vector<Block> DiagnosisBlocks();

}  // namespace palpate::benchmarks
