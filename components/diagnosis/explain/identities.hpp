// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/diagnosis/data/observed_experiment.hpp"

namespace palpate::diagnosis {

/// What is not identifiable from data of this kind, in words
/// (docs/theory/model_selection.md).
std::vector<std::string> Identities(const ObservedExperiment& observed);

}  // namespace palpate::diagnosis
