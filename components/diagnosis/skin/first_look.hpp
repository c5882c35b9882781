// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "components/diagnosis/skin/skin_matcher.hpp"
#include "components/diagnosis/skin/skin_source.hpp"

namespace palpate::diagnosis {

/// Looks at all pictures and matches them, about where `draft` stands. Tells `observed` what is
/// known of the cameras, too. Why that tells nothing; empty: it does.
std::string LookAtPictures(const ModelHypothesis& hypothesis, int threads, SkinSource* pictures,
                           SkinMatcher* matcher, ObservedExperiment* observed);

}  // namespace palpate::diagnosis
