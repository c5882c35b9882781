// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <ostream>

#include "tests/system/blind/acceptance.hpp"

namespace palpate::blind {

/// One line: the seed that repeats it, what was hidden, what was said.
void PrintCase(std::ostream& out, const CaseRecord& record);

/// Every figure with its 95 % interval (Wilson) and what is wanted.
void PrintScore(std::ostream& out, const Score& score, const Acceptance& acceptance = {});

}  // namespace palpate::blind
