// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/vocabulary/diagnosis_result.hpp"

namespace palpate::diagnosis {

std::string ToString(Verdict verdict) {
  switch (verdict) {
    case Verdict::kNoFault: return "no_fault";
    case Verdict::kCause: return "cause";
    case Verdict::kIndistinguishable: return "indistinguishable";
    case Verdict::kPartlyExplained: return "partly_explained";
    case Verdict::kUnexplained: return "unexplained";
    case Verdict::kDataUnfit: break;
  }
  return "data_unfit";
}

}  // namespace palpate::diagnosis
