// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "components/diagnosis/report/figures/figure.hpp"
#include "components/diagnosis/report/report_html.hpp"
#include "tests/components/diagnosis/report/browser.hpp"
#include "tests/components/diagnosis/report/example_result.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::diagnosis {
namespace {

using browser::Browser;
using browser::Layout;
using browser::Picture;
using browser::Pixels;

constexpr int kWidth_px = 860;

/// Of the pixels of a rectangle: those that are not white, and how many colours there are.
struct Ink {
  double share = 0.0;
  std::size_t colors = 0;
};

Ink InkIn(const plot::Rect& box, const Pixels& page) {
  std::set<int> colors;
  int drawn = 0, all = 0;
  for (int y = static_cast<int>(box.y_px); y < static_cast<int>(box.bottom_px()); ++y) {
    for (int x = static_cast<int>(box.x_px); x < static_cast<int>(box.right_px()); ++x) {
      const unsigned char* rgb = page.At(x, y);
      const int color = rgb[0] << 16 | rgb[1] << 8 | rgb[2];
      drawn += color == 0xFFFFFF ? 0 : 1;
      ++all;
      colors.insert(color);
    }
  }
  return {static_cast<double>(drawn) / std::max(all, 1), colors.size()};
}

/// Pixels of one colour below the legend.
int PixelsOf(const plot::Color& color, const plot::Rect& box, const Pixels& page) {
  constexpr int kLegend_px = 60;
  int count = 0;
  for (int y = static_cast<int>(box.y_px) + kLegend_px; y < static_cast<int>(box.bottom_px());
       ++y) {
    for (int x = static_cast<int>(box.x_px); x < static_cast<int>(box.right_px()); ++x) {
      const unsigned char* rgb = page.At(x, y);
      count += rgb[0] == std::lround(255.0 * color.r) && rgb[1] == std::lround(255.0 * color.g) &&
               rgb[2] == std::lround(255.0 * color.b);
    }
  }
  return count;
}

/// A text's box without the room above and below its letters.
plot::Rect Letters(const plot::Rect& box) {
  const double x_px = std::min(1.0, 0.1 * box.width_px), y_px = std::min(3.0, 0.2 * box.height_px);
  return {box.x_px + x_px, box.y_px + y_px, box.width_px - 2.0 * x_px, box.height_px - 2.0 * y_px};
}

/// "a / b" for each pair of texts that overlap, "a" for each that leaves the depth frame.
std::vector<std::string> BadlySet(const Picture& picture) {
  std::vector<std::string> bad;
  for (std::size_t i = 0; i < picture.texts.size(); ++i) {
    const plot::Rect box = Letters(picture.texts[i].box);
    if (!picture.box.Contains(box)) bad.push_back(picture.texts[i].text);
    for (std::size_t k = 0; k < i; ++k) {
      if (!box.Overlaps(Letters(picture.texts[k].box))) continue;
      bad.push_back(picture.texts[k].text + " / " + picture.texts[i].text);
    }
  }
  return bad;
}

TEST(ReportRendering, EveryFigureIsThereAndNotBlank) {
  const test_support::TestFolder folder;
  const Browser browser(folder.path());
  const std::string html = FormatReport(FrictionExample());
  const Layout layout = browser.Measure(html, kWidth_px);
  ASSERT_EQ(layout.pictures.size(), 7U);
  const Pixels page = browser.Screenshot(html, kWidth_px, layout.height_px);
  ASSERT_EQ(page.width_px, kWidth_px);
  ASSERT_EQ(page.height_px, layout.height_px);
  for (const Picture& picture : layout.pictures) {
    EXPECT_GT(picture.box.width_px, 700.0) << picture.id;
    EXPECT_GT(picture.box.height_px, 150.0) << picture.id;
    ASSERT_LE(picture.box.bottom_px(), page.height_px);
    const Ink ink = InkIn(picture.box, page);
    EXPECT_GT(ink.share, 0.03) << picture.id;
    EXPECT_LT(ink.share, 0.6) << picture.id;
    EXPECT_GT(ink.colors, 20U) << picture.id;
    const bool has_before = picture.id != "probabilities" && picture.id != "correlations";
    EXPECT_GE(PixelsOf(ink::kBefore, picture.box, page), has_before ? 100 : 0) << picture.id;
    if (picture.id.starts_with("residual-")) continue;  // nothing is left to be seen
    EXPECT_GT(PixelsOf(ink::kAfter, picture.box, page), 100) << picture.id;
  }
}

TEST(ReportRendering, NoTextIsClippedOrOverAnother) {
  const test_support::TestFolder folder;
  const Browser browser(folder.path());
  std::vector<DiagnosisResult> results = AllExamples();
  results.push_back(TwoCausesExample());
  results.push_back(FrictionExample());
  for (std::string& name : results.back().correlation_names) name = "lag";
  for (const DiagnosisResult& result : results) {
    for (const Picture& picture : browser.Measure(FormatReport(result), kWidth_px).pictures) {
      EXPECT_FALSE(picture.texts.empty());
      EXPECT_THAT(BadlySet(picture), testing::IsEmpty())
          << ToString(result.verdict) << ' ' << picture.id;
    }
  }
}

TEST(ReportRendering, LongNamesAreClippedByUsNotByThePicture) {
  const test_support::TestFolder folder;
  DiagnosisResult result = FrictionExample();
  const std::string longer = " of a robot whose maker likes long names very much";
  for (RecordingError& recording : result.recordings) recording.name += longer;
  for (std::string& name : result.correlation_names) name += longer;
  for (Rival& rival : result.rivals) rival.words += longer;
  result.causes[0].words += longer;
  for (const Picture& picture :
       Browser(folder.path()).Measure(FormatReport(result), kWidth_px).pictures) {
    EXPECT_THAT(BadlySet(picture), testing::IsEmpty()) << picture.id;
  }
}

TEST(ReportRendering, PrintsOnAFewPages) {
  const test_support::TestFolder folder;
  const Browser browser(folder.path());
  EXPECT_EQ(browser.PrintedPages(FormatReport(FrictionExample())), 7);
  EXPECT_EQ(browser.PrintedPages(FormatReport(DataUnfitExample())), 1);
}

}  // namespace
}  // namespace palpate::diagnosis
