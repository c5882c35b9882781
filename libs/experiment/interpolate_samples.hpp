// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <optional>
#include <vector>

namespace palpate::experiment {

/// The quantity at `now_s`: linear between the samples that are present; before the first of them
/// the first, after the last the last. `samples`: one for each of the rising `t_s`, at least one
/// present.
double InterpolateSamples(const std::vector<double>& t_s,
                          const std::vector<std::optional<double>>& samples, double now_s);

}  // namespace palpate::experiment
