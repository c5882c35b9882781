// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/plot/label_layout.hpp"

#include <gtest/gtest.h>

namespace palpate::plot {
namespace {

TEST(LabelLayout, KeepsLabelsApartAndInside) {
  const Rect area{0, 0, 600, 400};
  std::vector<LabelRequest> requests;
  for (int i = 0; i < 6; ++i) {
    requests.push_back({{590.0 - i, 200.0 + i}, 120, 20});
  }
  const auto places = PlaceLabels(requests, area, {{560, 180, 40, 40}}, [](int, int) { return 0; });
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_TRUE(area.Contains(places[i]));
    EXPECT_FALSE(places[i].Overlaps({560, 180, 40, 40}));
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_FALSE(places[i].Overlaps(places[k])) << i << ' ' << k;
    }
  }
}

TEST(LabelLayout, AvoidsTheDrawing) {
  const auto right_half = [](int x, int) { return x >= 300 ? 1.0 : 0.0; };
  const auto places = PlaceLabels({{{300, 200}, 100, 20}}, {0, 0, 600, 400}, {}, right_half);
  EXPECT_LE(places[0].right_px(), 300.0);
}

}  // namespace
}  // namespace palpate::plot
