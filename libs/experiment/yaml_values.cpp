// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/yaml_values.hpp"

#include <array>
#include <cstdio>

#include "libs/core/config_reader.hpp"
#include "libs/core/text.hpp"

namespace palpate::experiment {

TimeWindow ReadWindow(const ConfigNode& node) {
  const std::vector<double> ends = ReadNumbers(node);
  if (ends.size() != 2) Refuse(node, "must be [begin, end] in seconds");
  if (ends[0] >= ends[1]) Refuse(node, "the window must end after it begins");
  return {ends[0], ends[1]};
}

std::string FormatWindow(const TimeWindow& window) {
  return "[" + FormatNumber(window.begin_s) + ", " + FormatNumber(window.end_s) + "]";
}

std::string QuoteText(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (c == '\n') {
      quoted += "\\n";
    } else if (code < 0x20 || code == 0x7f) {
      std::array<char, 8> escape{};
      std::snprintf(escape.data(), escape.size(), "\\x%02x", static_cast<unsigned>(code));
      quoted += escape.data();
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

}  // namespace palpate::experiment
