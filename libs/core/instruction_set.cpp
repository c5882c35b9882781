// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/instruction_set.hpp"

namespace palpate {

namespace {

std::vector<InstructionSet> Detect() {
  std::vector<InstructionSet> sets{InstructionSet::kPortable};
#if defined(__x86_64__)
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (avx2) sets.push_back(InstructionSet::kAvx2);
  const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") &&
                      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512bw");
  if (avx512) sets.push_back(InstructionSet::kAvx512);
#endif
  return sets;
}

}  // namespace

const std::vector<InstructionSet>& AvailableInstructionSets() {
  static const std::vector<InstructionSet> sets = Detect();
  return sets;
}

std::string_view ToString(InstructionSet set) {
  switch (set) {
    case InstructionSet::kPortable: return "portable";
    case InstructionSet::kAvx2: return "avx2";
    case InstructionSet::kAvx512: return "avx512";
  }
  return {};
}

}  // namespace palpate
