// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace palpate {

/// Edit distance with transpositions (optimal string alignment).
int EditDistance(std::string_view a, std::string_view b);

/// The candidate nearest to `word`, empty where none is near.
std::string Nearest(std::string_view word, const std::vector<std::string>& candidates);

/// " (did you mean 'x'?)" for the candidate nearest to `word`, empty where none is near.
std::string DidYouMean(std::string_view word, const std::vector<std::string>& candidates);

/// "a, b, c"
std::string Listed(const std::vector<std::string>& words);

/// What a message may show of an input of any length: at most 80 characters on one line, the rest
/// replaced by "..."; control characters become blanks.
std::string Excerpt(std::string_view text);

/// The whole of `text` as a finite number, C locale. Returns false for anything else
/// ("1e3 ", "nan", "inf", "", "1,5").
bool ParseFinite(std::string_view text, double* value);

/// `text` in double quotes, as YAML and JSON read it back; line ends and other control characters
/// are escaped.
std::string Quoted(std::string_view text);

/// The shortest decimal text that reads back as exactly `value`.
std::string FormatNumber(double value);

}  // namespace palpate
