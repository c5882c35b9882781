// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "components/palpate/compare/comparison_summary.hpp"

namespace palpate::command {

// The metrics of docs/force_metrics.md, for `palpate estimate --answer` and `palpate compare`.

/// "30 of 33 steady forces detected; ...": one line without its end.
std::string ToLine(const ComparisonSummary& summary);

/// Every metric, a line each with its end. What is not known is left out.
std::string ToTable(const ComparisonSummary& summary);

/// Every metric. What is not known is left out.
nlohmann::ordered_json ToJson(const ComparisonSummary& summary);

}  // namespace palpate::command
