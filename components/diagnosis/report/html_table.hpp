// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace palpate::diagnosis {

/// A table of texts, escaped when written.
struct HtmlTable {
  std::vector<std::string> head;
  std::vector<bool> numeric;  ///< [columns] set to the right
  std::vector<std::vector<std::string>> rows;
};
std::string FormatTable(const HtmlTable& table);

/// <tag>escaped text</tag>
std::string Element(std::string_view tag, std::string_view text);

}  // namespace palpate::diagnosis
