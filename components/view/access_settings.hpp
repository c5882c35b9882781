// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "components/view/config.hpp"
#include "components/view/serve/access.hpp"

namespace palpate::view {

inline constexpr const char* kTokenVariable = "PALPATE_VIEW_TOKEN";

/// The token that clients must give; empty: none. `from_environment`: kTokenVariable, may be empty.
/// Throws InputError for a file that cannot be read, a token that is too short or has other letters
/// than an address may have, an address that is none, and an address of the network without a
/// token; each with the remedy.
std::string TokenOf(const HttpConfig& config, const std::string& from_environment);

/// Rules of the page's port, and of Foxglove's.
AccessRules PageRules(const HttpConfig& config, const std::string& token);
AccessRules FoxgloveRules(const HttpConfig& http, const FoxgloveConfig& foxglove,
                          const std::string& token);

}  // namespace palpate::view
