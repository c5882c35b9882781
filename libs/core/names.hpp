// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "libs/core/text.hpp"

namespace palpate {

/// Where `name` is among `names`; nullopt: nowhere.
inline std::optional<std::size_t> IndexOf(std::string_view name,
                                          const std::vector<std::string>& names) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

/// "unknown cable 'x' (did you mean 'y'?)", `what` being "cable".
inline std::string Unknown(const std::string& what, std::string_view name,
                           const std::vector<std::string>& names) {
  return "unknown " + what + " '" + std::string(name) + "'" + DidYouMean(name, names);
}

}  // namespace palpate
