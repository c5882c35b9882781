// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "libs/core/config_node.hpp"
#include "libs/experiment/markers.hpp"

namespace palpate::experiment {

/// `[t0, t1]`, s, t0 < t1.
TimeWindow ReadWindow(const ConfigNode& node);

/// What the reader above, and YAML, read back exactly.
std::string FormatWindow(const TimeWindow& window);
std::string QuoteText(const std::string& text);  ///< double-quoted, escaped

}  // namespace palpate::experiment
