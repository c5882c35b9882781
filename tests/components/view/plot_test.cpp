// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "components/view/plot/force_plot.hpp"
#include "components/view/plot/series_shapes.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/plot/text_width.hpp"
#include "tests/support/not_a_number.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::view {
namespace {

using testing::HasSubstr;
using testing::SizeIs;
using tinyxml2::XMLElement;

// A drawn plot, read back.
class Drawn {
 public:
  explicit Drawn(const TimePlot& plot) {
    EXPECT_EQ(document_.Parse(DrawTimePlot(plot).c_str()), tinyxml2::XML_SUCCESS)
        << document_.ErrorStr();
    Visit(document_.RootElement());
  }
  const XMLElement* root() const { return document_.RootElement(); }
  std::vector<const XMLElement*> All(const std::string& name) const {
    std::vector<const XMLElement*> found;
    for (const XMLElement* element : elements_) {
      if (element->Name() == name) found.push_back(element);
    }
    return found;
  }
  std::vector<std::string> Texts() const {
    std::vector<std::string> texts;
    for (const XMLElement* element : All("text")) {
      if (element->GetText() != nullptr) texts.emplace_back(element->GetText());
    }
    return texts;
  }

 private:
  void Visit(const XMLElement* element) {
    for (; element != nullptr; element = element->NextSiblingElement()) {
      elements_.push_back(element);
      Visit(element->FirstChildElement());
    }
  }
  tinyxml2::XMLDocument document_;
  std::vector<const XMLElement*> elements_;
};

std::vector<SvgPoint> PointsOf(const XMLElement* element) {
  std::istringstream text(element->Attribute("points"));
  std::vector<SvgPoint> points;
  char comma = 0;
  for (SvgPoint point; text >> point.x_px >> comma >> point.y_px;) points.push_back(point);
  return points;
}

TimePlot OnePanel(const TimeSeries& series) {
  TimePlot plot;
  plot.title = "a <plot> & \"more\"\x01";
  plot.panels = {{"panel", "force (N)", true, {series}}};
  return plot;
}

const TimeSeries kRamp{"ramp", palette::kEstimate, false, {0, 1, 2, 3}, {0, 1, 2, 4}, {}};

TEST(TimePlot, IsWellFormedWhateverTheTextsHold) {
  const Drawn drawn(OnePanel(kRamp));
  EXPECT_STREQ(drawn.root()->Name(), "svg");
  EXPECT_STREQ(drawn.root()->Attribute("viewBox"), "0 0 900 500");
  EXPECT_THAT(drawn.Texts(), testing::Contains("a <plot> & \"more\"\xEF\xBF\xBD"));
  EXPECT_THAT(drawn.Texts(), testing::IsSupersetOf({"panel", "force (N)", "time (s)", "ramp"}));
}

TEST(TimePlot, PutsEachSampleAtItsPlaceBetweenTheAxes) {
  const Drawn drawn(OnePanel(kRamp));
  const auto lines = drawn.All("polyline");
  ASSERT_THAT(lines, SizeIs(1));
  const std::vector<SvgPoint> points = PointsOf(lines[0]);
  ASSERT_THAT(points, SizeIs(4));
  // Even steps of time are even on paper, twice the force is twice as high.
  const double step_px = points[1].x_px - points[0].x_px;
  EXPECT_NEAR(points[3].x_px - points[2].x_px, step_px, 0.02);
  EXPECT_GT(3.0 * step_px, 750.0);  // the width is used
  const double unit_px = points[0].y_px - points[1].y_px;
  EXPECT_NEAR(points[0].y_px - points[3].y_px, 4.0 * unit_px, 0.05);
  EXPECT_GT(4.0 * unit_px, 300.0);
  EXPECT_GE(points[3].y_px, 0.0);
  EXPECT_LE(points[3].x_px, 900.0);
  const auto marks = drawn.All("text");
  const auto four = std::find_if(marks.begin(), marks.end(), [](const XMLElement* text) {
    return text->GetText() == std::string("4.0");
  });
  ASSERT_NE(four, marks.end());
  EXPECT_NEAR((*four)->DoubleAttribute("y"), points[3].y_px, 5.0);
}

TEST(TimePlot, HasGapsWhereThereIsNoValue) {
  TimeSeries series = kRamp;
  series.t_s = {0, 1, 2, 3, 4, 5, 6};
  series.values = {1, 2, kNaN, 2, kNaN, 3, 3};
  series.half_widths = {0.5, 0.5, 0.5, 0.5, 0.5, kNaN, 0.5};
  const Drawn drawn(OnePanel(series));
  const auto lines = drawn.All("polyline");
  ASSERT_THAT(lines, SizeIs(2));
  EXPECT_THAT(PointsOf(lines[0]), SizeIs(2));
  EXPECT_THAT(drawn.All("circle"), SizeIs(1));   // the value alone
  EXPECT_THAT(drawn.All("polygon"), SizeIs(1));  // the only stretch of band with two ends
  EXPECT_THAT(DrawTimePlot(OnePanel(series)), testing::Not(HasSubstr("nan")));
}

TEST(TimePlot, DrawsTheBandAroundTheValues) {
  TimeSeries series = kRamp;
  series.values = {2, 2, 2, 2};
  series.half_widths = {1, 1, 1, 1};
  const Drawn drawn(OnePanel(series));
  ASSERT_THAT(drawn.All("polygon"), SizeIs(1));
  const std::vector<SvgPoint> outline = PointsOf(drawn.All("polygon")[0]);
  ASSERT_THAT(outline, SizeIs(8));
  const double value_px = PointsOf(drawn.All("polyline")[0])[0].y_px;
  EXPECT_LT(outline.front().y_px, value_px);
  EXPECT_NEAR(value_px - outline.front().y_px, outline.back().y_px - value_px, 0.02);
}

TEST(TimePlot, AWideBandDoesNotDwarfTheValues) {
  TimeSeries series = kRamp;
  series.half_widths = {100, 100, 100, 100};
  const AxisRange range = ValueRange({"", "", true, {series}});
  EXPECT_EQ(range.lower, 0.0);
  EXPECT_EQ(range.upper, 6.0);
  series.values = {-2, 2, 0, 1};
  EXPECT_LT(ValueRange({"", "", true, {series}}).lower, -2.0);
}

TEST(TimePlot, DrawsAxesWithoutASingleValue) {
  TimeSeries series{"none", palette::kTruth, false, {kNaN}, {kNaN}, {}};
  const Drawn drawn(OnePanel(series));
  EXPECT_THAT(drawn.All("polyline"), SizeIs(0));
  EXPECT_GT(drawn.All("line").size(), 6U);
  series = {"one", palette::kTruth, false, {3.0}, {0.0}, {}};
  EXPECT_THAT(Drawn(OnePanel(series)).All("circle"), SizeIs(1));
}

TEST(TimePlot, RefusesListsOfDifferentLengthAndPanelsWithoutRoom) {
  TimeSeries series = kRamp;
  series.values.pop_back();
  EXPECT_THROW(DrawTimePlot(OnePanel(series)), RunError);
  series = kRamp;
  series.half_widths = {1.0};
  EXPECT_THROW(DrawTimePlot(OnePanel(series)), RunError);
  EXPECT_THROW(DrawTimePlot({}), RunError);
  TimePlot crowded = OnePanel(kRamp);
  crowded.panels.resize(9);
  EXPECT_THROW(DrawTimePlot(crowded), RunError);
  EXPECT_THROW(SaveTimePlot("/no/such/folder/plot.svg", OnePanel(kRamp)), RunError);
}

TEST(TimePlot, NamesASeriesOfSeveralPanelsOnceInTheLegend) {
  TimePlot plot = OnePanel(kRamp);
  plot.panels.push_back(plot.panels.front());
  const std::vector<std::string> texts = Drawn(plot).Texts();
  EXPECT_EQ(std::count(texts.begin(), texts.end(), "ramp"), 1);
  EXPECT_EQ(std::count(texts.begin(), texts.end(), "time (s)"), 1);
}

TEST(TimePlot, ATitleOfAnyLengthEndsBeforeTheLegend) {
  for (const std::size_t length : {10, 60, 90, 400}) {
    TimePlot plot = OnePanel(kRamp);
    plot.title = std::string(length, 'm');
    const Drawn drawn(plot);
    const auto text = [&](std::string_view begin) {
      const std::vector<const XMLElement*> all = drawn.All("text");
      return *std::find_if(all.begin(), all.end(), [&](const XMLElement* element) {
        return std::string_view(element->GetText()).starts_with(begin);
      });
    };
    const XMLElement& title = *text("mmm");
    const double width_px =
        plot::TextWidth_px(title.GetText(), title.DoubleAttribute("font-size"), true);
    EXPECT_LT(title.DoubleAttribute("x") + width_px, text("ramp")->DoubleAttribute("x")) << length;
  }
}

TEST(ForcePlot, HasAPanelForEachContactThatGrowsWithThem) {
  const test_support::TestFolder folder;
  ForceTrack track{"contact_1", {0, 1, 2}, {kNaN, 1.0, 1.1}, {kNaN, 0.1, 0.1}, {}, {}, {0, 1, 1}};
  ForceTrack hidden{"contact_2", {0, 1}, {kNaN, kNaN}, {kNaN, kNaN}, {0.5, 0.6}, {0.2, 0.2}, {}};
  EXPECT_EQ(MakeForcePlot("forces", {track}).height_px, 500);
  const TimePlot plot = MakeForcePlot("forces", {track, hidden, track, track});
  ASSERT_THAT(plot.panels, SizeIs(4));
  EXPECT_GT(plot.height_px, 500);
  EXPECT_THAT(plot.panels[0].series, SizeIs(2));  // truth and estimate
  EXPECT_EQ(plot.panels[0].series[0].values, track.true_N);
  EXPECT_EQ(plot.panels[0].series[1].half_widths.size(), 3U);
  ASSERT_THAT(plot.panels[1].series, SizeIs(1));  // out of view only
  EXPECT_EQ(plot.panels[1].series[0].values, hidden.hidden_N);
  SaveTimePlot(folder.path() / "forces.svg", plot);
  EXPECT_EQ(ReadFile(folder.path() / "forces.svg"), DrawTimePlot(plot));
  EXPECT_THAT(MakeForcePlot("none", {}).panels, SizeIs(1));
}

}  // namespace
}  // namespace palpate::view
