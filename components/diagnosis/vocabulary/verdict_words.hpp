// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/diagnosis/vocabulary/diagnosis_result.hpp"

namespace palpate::diagnosis {

/// The verdict's kind for people: "Cause found".
std::string VerdictLabel(Verdict verdict);

/// The verdict in one sentence, with parameters and probabilities (plain text, UTF-8):
/// "Friction of cable north, mu = 0.21 ± 0.02 (95 %), p = 0.97."
std::string VerdictHeadline(const DiagnosisResult& result);

/// What the headline rests on.
struct VerdictDetail {
  std::string label;  ///< "Left-out error"
  std::string text;   ///< "4.1 → 0.8 mm (noise 0.7 mm)"
};
std::vector<VerdictDetail> VerdictDetails(const DiagnosisResult& result);

/// Headline and details as one paragraph, for a terminal.
std::string VerdictParagraph(const DiagnosisResult& result);

/// What the named causes change in files, one value each: "E of `middle`: 250 → 179 ± 10 kPa".
std::vector<std::string> ChangeTexts(const DiagnosisResult& result);

/// How often a healthy robot of this kind would be accused; empty: not known.
std::string HealthyText(const DiagnosisResult& result);

/// A cause for people: the words of the cause or rival of that name, else id and places.
std::string WordsFor(const CauseName& name, const DiagnosisResult& result);

/// "a, b and c"
std::string Enumeration(const std::vector<std::string>& items);

}  // namespace palpate::diagnosis
