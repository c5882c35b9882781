// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/plot/text_width.hpp"

#include <gtest/gtest.h>

namespace palpate::plot {
namespace {

TEST(TextWidth, GrowsWithSizeAndCountsCharactersNotBytes) {
  EXPECT_DOUBLE_EQ(TextWidth_px("abc", 24.0), 2.0 * TextWidth_px("abc", 12.0));
  EXPECT_GT(TextWidth_px("mmm", 12.0), TextWidth_px("iii", 12.0));
  EXPECT_DOUBLE_EQ(TextWidth_px("\u00E9\u00E9", 12.0), 2.0 * TextWidth_px("\u2192", 12.0));
  EXPECT_GT(TextWidth_px("abc", 12.0, true), TextWidth_px("abc", 12.0));
}

TEST(TextWidth, ShortensToWhatFits) {
  EXPECT_EQ(Shortened("short", 12.0, 100.0), "short");
  const std::string cut = Shortened("a name that is far too long for its place", 12.0, 100.0);
  EXPECT_TRUE(cut.starts_with("a name"));
  EXPECT_TRUE(cut.ends_with("\u2026"));
  EXPECT_LE(TextWidth_px(cut, 12.0), 100.0);
  EXPECT_GT(TextWidth_px(cut, 12.0), 80.0);
}

TEST(TextWidth, NeverCutsACharacterInTwo) {
  const std::string name = "\u00E9\u00E9\u00E9\u00E9\u00E9\u00E9";
  for (double width_px = 0.0; width_px < 80.0; width_px += 1.0) {
    std::string cut = Shortened(name, 12.0, width_px);
    if (cut.ends_with("\u2026")) cut.resize(cut.size() - 3);
    EXPECT_EQ(cut.size() % 2, 0U) << width_px;
  }
}

}  // namespace
}  // namespace palpate::plot
