// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <string_view>

namespace palpate::plot {

/// About how wide a text (UTF-8) is, px: what DejaVu Sans takes, the widest of the fonts that a
/// figure asks for.
double TextWidth_px(std::string_view text, double size_px, bool bold = false);

/// `text`, or as much of its beginning as fits, with an ellipsis.
std::string Shortened(std::string_view text, double size_px, double width_px);

}  // namespace palpate::plot
