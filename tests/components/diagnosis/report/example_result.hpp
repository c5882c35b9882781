// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/diagnosis/vocabulary/diagnosis_result.hpp"

namespace palpate::diagnosis {

// Made-up diagnoses of the robot four_leg, as realistic as reports need.

/// Friction of cable north, seen in four of nine recordings.
DiagnosisResult FrictionExample();

/// Friction of cable north, and creep of the body.
DiagnosisResult TwoCausesExample();

/// Friction or backlash of cable north.
DiagnosisResult IndistinguishableExample();

DiagnosisResult PartlyExplainedExample();
DiagnosisResult UnexplainedExample();
DiagnosisResult HealthyExample();

/// A frozen camera: next to nothing is known.
DiagnosisResult DataUnfitExample();

/// One of each verdict.
std::vector<DiagnosisResult> AllExamples();

}  // namespace palpate::diagnosis
