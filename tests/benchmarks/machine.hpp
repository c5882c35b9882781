// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <utility>
#include <vector>

namespace palpate::benchmarks {

/// What the times depend on, as (name, value): processor, cores, load, BLAS, instruction set,
/// compiler.
std::vector<std::pair<std::string, std::string>> DescribeMachine();

}  // namespace palpate::benchmarks
