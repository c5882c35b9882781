// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/diagnosis/report/figures/figure.hpp"
#include "components/diagnosis/vocabulary/diagnosis_result.hpp"

namespace palpate::diagnosis {

/// The markers' mean residuals on the body, before and after.
Figure DrawResidualField(const DiagnosisResult& result);

/// The forces that would do the residual, before and after.
Figure DrawResidualForces(const DiagnosisResult& result);

/// RMS of the residual in each recording.
Figure DrawRecordingBars(const DiagnosisResult& result);

/// Residual against actuation, for the actuators that moved most.
Figure DrawHysteresis(const DiagnosisResult& result);

/// Residual in holds against the logarithm of time.
Figure DrawHolds(const DiagnosisResult& result);

/// Probabilities of causes, of none and of another.
Figure DrawProbabilities(const DiagnosisResult& result);

/// How alike the effects of the causes are.
Figure DrawCorrelations(const DiagnosisResult& result);

}  // namespace palpate::diagnosis
