// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "libs/core/status.hpp"

namespace palpate::command {

/// The status of a word of forces.csv and of messages; nullopt for another word.
std::optional<StatusCode> StatusOfWord(std::string_view word);

/// All words, with ", " between them.
std::string StatusWords();

}  // namespace palpate::command
