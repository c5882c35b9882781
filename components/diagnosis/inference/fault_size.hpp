// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "components/diagnosis/inference/hypothesis_set.hpp"

namespace palpate::diagnosis {

/// Why a cause as large as a fit has it is no fault (DIAGNOSIS, "Method" 5): within three of the
/// tolerances that a healthy robot has, as likely nothing at all, or so large that it is rather
/// another cause in disguise.
/// Empty: it may be one.
std::string WhyNoFault(const HypothesisSet& hypotheses, const Posterior& posterior, int cause);

}  // namespace palpate::diagnosis
