// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <ostream>

#include "tests/benchmarks/results.hpp"

namespace palpate::benchmarks {

/// How right the forces of the sensing sets that have run were, and the paper's Table III beside
/// ours. Nothing where none has run.
void PrintSensing(std::ostream& out, const Results& results);

}  // namespace palpate::benchmarks
