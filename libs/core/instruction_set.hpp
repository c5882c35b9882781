// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string_view>
#include <vector>

namespace palpate {

/// Instruction sets that inner loops are compiled for, in rising order.
enum class InstructionSet { kPortable, kAvx2, kAvx512 };

/// What this processor has, kPortable first and the best one last.
const std::vector<InstructionSet>& AvailableInstructionSets();
inline InstructionSet BestInstructionSet() { return AvailableInstructionSets().back(); }

std::string_view ToString(InstructionSet set);

}  // namespace palpate
