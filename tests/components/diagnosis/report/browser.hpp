// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "libs/plot/rect.hpp"

namespace palpate::browser {

/// A text of a depth frame, where Chromium has set it.
struct SetText {
  std::string text;
  plot::Rect box;
};

/// A depth frame of a page: where it is, and its texts, in pixels of the page.
struct Picture {
  std::string id;
  plot::Rect box;
  std::vector<SetText> texts;
};

struct Layout {
  int height_px = 0;
  std::vector<Picture> pictures;
};

/// Red, green and blue of an 8-bit depth frame, rows from the top.
struct Pixels {
  int width_px = 0;
  int height_px = 0;
  std::vector<unsigned char> rgb;
  const unsigned char* At(int x, int y) const {
    return rgb.data() + 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) +
                             static_cast<std::size_t>(x));
  }
};

/// Chromium without a window (Debian package chromium), on pages of a folder of its own. Each call
/// starts it again; throws RunError where it fails or is not installed.
class Browser {
 public:
  explicit Browser(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Where the figures' depth frames stand on a page of this width.
  Layout Measure(const std::string& html, int width_px) const;
  Pixels Screenshot(const std::string& html, int width_px, int height_px) const;
  /// How many pages it prints on.
  int PrintedPages(const std::string& html) const;

 private:
  std::string Run(const std::string& html, const std::string& arguments) const;

  std::filesystem::path folder_;
};

}  // namespace palpate::browser
