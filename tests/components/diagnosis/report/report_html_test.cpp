// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/report/report_html.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <set>
#include <utility>

#include "tests/components/diagnosis/report/example_result.hpp"

namespace palpate::diagnosis {
namespace {

using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsSupersetOf;
using testing::Not;
using testing::SizeIs;

const char* const kFigures[] = {"residual-field",  "recording-bars", "probabilities",
                                "residual-forces", "hysteresis",     "holds",
                                "correlations"};

/// The svg elements of a page.
std::vector<std::string> Pictures(const std::string& html) {
  std::vector<std::string> pictures;
  for (auto at = html.find("<svg"); at != std::string::npos; at = html.find("<svg", at + 1)) {
    pictures.push_back(html.substr(at, html.find("</svg>", at) + 6 - at));
  }
  return pictures;
}

/// What a page has from a figure's element on.
std::string FigureOf(const std::string& html, const std::string& id) {
  const auto at = html.find("<figure id=\"" + id + "\">");
  return at == std::string::npos ? "" : html.substr(at, html.find("</figure>", at) - at);
}

struct Drawing {
  std::vector<std::string> texts, ids;
  int shapes = 0;
};

void Visit(const tinyxml2::XMLElement* element, Drawing* drawing) {
  for (; element != nullptr; element = element->NextSiblingElement()) {
    const std::string name = element->Name();
    if (name == "text" && element->GetText() != nullptr)
      drawing->texts.emplace_back(element->GetText());
    if (element->Attribute("id") != nullptr) drawing->ids.emplace_back(element->Attribute("id"));
    drawing->shapes += name == "line" || name == "rect" || name == "polyline" || name == "polygon";
    Visit(element->FirstChildElement(), drawing);
  }
}

/// Reads a depth frame; a failure of the test where it is no XML.
Drawing Read(const std::string& svg) {
  tinyxml2::XMLDocument document;
  EXPECT_EQ(document.Parse(svg.c_str()), tinyxml2::XML_SUCCESS) << document.ErrorStr();
  Drawing drawing;
  Visit(document.RootElement(), &drawing);
  return drawing;
}

Drawing ReadFigure(const std::string& html, const std::string& id) {
  const std::vector<std::string> pictures = Pictures(FigureOf(html, id));
  EXPECT_THAT(pictures, SizeIs(1)) << id;
  return pictures.empty() ? Drawing() : Read(pictures.front());
}

/// Cuts each triangle of the surface into three.
void Refine(DiagnosisResult* result) {
  const auto triangles = std::exchange(result->triangles, {});
  Eigen::Index next = result->surface_m.cols();
  result->surface_m.conservativeResize(3, next + static_cast<Eigen::Index>(triangles.size()));
  Eigen::Matrix3Xd& nodes_m = result->surface_m;
  for (const auto& [a, b, c] : triangles) {
    nodes_m.col(next) = (nodes_m.col(a) + nodes_m.col(b) + nodes_m.col(c)) / 3.0;
    const int middle = static_cast<int>(next++);
    for (const auto& [from, to] : {std::pair{a, b}, {b, c}, {c, a}}) {
      result->triangles.push_back({from, to, middle});
    }
  }
}

TEST(ReportHtml, EveryPictureIsWellFormedAndSharesNoId) {
  for (const DiagnosisResult& result : AllExamples()) {
    std::multiset<std::string> ids;
    for (const std::string& svg : Pictures(FormatReport(result))) {
      const Drawing drawing = Read(svg);
      EXPECT_GT(drawing.shapes, 10);
      ids.insert(drawing.ids.begin(), drawing.ids.end());
    }
    EXPECT_EQ(std::set<std::string>(ids.begin(), ids.end()).size(), ids.size());
  }
}

TEST(ReportHtml, SaysTheVerdictFirst) {
  for (const DiagnosisResult& result : AllExamples()) {
    const std::string html = FormatReport(result);
    EXPECT_LT(html.find("<h1>"), html.find("<h2>"));
    EXPECT_EQ(html.find("<h1>"), html.rfind("<h1>"));
  }
  EXPECT_THAT(FormatReport(FrictionExample()), HasSubstr("<h1>Friction of cable north, mu"));
}

TEST(ReportHtml, HasEveryFigureWithTitleUnitsAndCaption) {
  const std::string html = FormatReport(FrictionExample());
  const std::vector<std::vector<std::string>> labels = {
      {"x (mm)", "y (mm)", "z (mm)", "before", "after", "leg_north", "arrow of 2 mm"},
      {"residual, RMS (mm)", "before", "noise", "left out: with the causes", "02_ramp_north"},
      {"probability (no unit)", "friction of cable north", "none: null model",
       "other: unmodelled cause", "0.97"},
      {"x (mm)", "y (mm)", "z (mm)", "before", "after", "arrow of 0.05 N"},
      {"displacement commanded (mm)", "residual (mm)", "cable north, in 02_ramp_north", "before"},
      {"time since the hold began (s), logarithmic", "residual (mm)", "06_hold_north", "100"},
      {"correlation (no unit)", "0.91", "-0.66", "1  friction of cable north"}};
  for (std::size_t i = 0; i < labels.size(); ++i) {
    EXPECT_THAT(ReadFigure(html, kFigures[i]).texts, IsSupersetOf(labels[i])) << kFigures[i];
    EXPECT_THAT(FigureOf(html, kFigures[i]),
                HasSubstr("<h3>Figure " + std::to_string(i + 1) + ". "));
    EXPECT_THAT(FigureOf(html, kFigures[i]), HasSubstr("<figcaption>"));
  }
}

TEST(ReportHtml, ShowsTensionsInNewton) {
  DiagnosisResult result = FrictionExample();
  result.cable_units.assign(result.cables.size(), "N");
  for (ComparedSample& compared : result.compared_samples) compared.command *= 1e3;
  const std::vector<std::string> texts = ReadFigure(FormatReport(result), "hysteresis").texts;
  EXPECT_THAT(texts, testing::Contains("tension commanded (N)"));
  EXPECT_THAT(texts, Each(Not(HasSubstr("displacement"))));
}

TEST(ReportHtml, SaysWhyAFigureIsLeftOut) {
  const std::string html = FormatReport(DataUnfitExample());
  EXPECT_THAT(Pictures(html), IsEmpty());
  for (const std::string id : kFigures) {
    const auto at = html.find("<div class=\"absent\" id=\"" + id + "\">");
    ASSERT_NE(at, std::string::npos) << id;
    EXPECT_THAT(html.substr(at, html.find("</div>", at) - at), HasSubstr("left out. ")) << id;
  }
  DiagnosisResult no_holds = FrictionExample();
  for (RecordingError& recording : no_holds.recordings) recording.kind = "free";
  EXPECT_THAT(FormatReport(no_holds), HasSubstr("No recording is a hold"));
  EXPECT_THAT(FigureOf(FormatReport(no_holds), "hysteresis"), HasSubstr("<svg"));
}

TEST(ReportHtml, NeedsNothingFromOutside) {
  for (const DiagnosisResult& result : AllExamples()) {
    const std::string html = FormatReport(result);
    for (const char* outside :
         {"<script", "<link", "<img", "src=", "href=", "url(http", "@import"}) {
      EXPECT_THAT(html, Not(HasSubstr(outside)));
    }
    EXPECT_THAT(html, Not(HasSubstr("nan")));
    EXPECT_THAT(html, Not(HasSubstr("inf ")));
  }
}

TEST(ReportHtml, EscapesEveryName) {
  DiagnosisResult result = FrictionExample();
  const std::string hostile = "<b onclick=\"x\">&'";
  result.robot = result.data = result.data_hash = result.version = result.command = hostile;
  result.reason = hostile;
  for (auto* names : {&result.cables, &result.markers, &result.identities,
                      &result.correlation_names, &result.causes[0].seen_in}) {
    names->assign(names->size(), hostile);
  }
  for (RecordingError& recording : result.recordings) recording.name = hostile;
  for (Rival& rival : result.rivals) rival.words = rival.why_not = hostile;
  result.causes[0].words = hostile;
  result.causes[0].parameters[0].name = hostile;
  result.experiments[0].title = result.experiments[0].by_hand = hostile;
  const std::string html = FormatReport(result);
  EXPECT_THAT(html, Not(HasSubstr("<b onclick")));
  EXPECT_THAT(html, HasSubstr("&lt;b onclick=&quot;x&quot;&gt;&amp;"));
  for (const std::string& svg : Pictures(html)) Read(svg);
}

TEST(ReportHtml, ShowsTheTenBestExperiments) {
  DiagnosisResult result = FrictionExample();
  const ExperimentProposal one = result.experiments.front();
  result.experiments.assign(12, one);
  for (std::size_t k = 0; k < result.experiments.size(); ++k) {
    result.experiments[k].title = "experiment <" + std::to_string(k + 1) + ">";
  }
  const std::string html = FormatReport(result);
  EXPECT_THAT(html, HasSubstr("experiment &lt;10&gt;"));
  EXPECT_THAT(html, Not(HasSubstr("experiment &lt;11&gt;")));
}

TEST(ReportHtml, TellsHowToRepeatAndToSeeItMove) {
  const DiagnosisResult result = FrictionExample();
  EXPECT_THAT(FormatReport(result), Not(HasSubstr("palpate view")));
  const std::string html =
      FormatReport(result, {"palpate view exp --robot rod", "palpate view exp --results <out>"});
  EXPECT_THAT(html, HasSubstr("<pre>palpate view exp --robot rod</pre>"));
  EXPECT_THAT(html, HasSubstr("<pre>palpate view exp --results &lt;out&gt;</pre>"));
  for (const std::string& text : {result.command, result.data_hash, result.version, result.robot,
                                  result.rivals[0].why_not, result.identities[1]}) {
    EXPECT_THAT(html, HasSubstr(text));
  }
}

TEST(ReportHtml, StandsLargeRobotsAndManyRecordings) {
  DiagnosisResult result = FrictionExample();
  const auto recording = result.recordings.front();
  for (int i = 0; i < 60; ++i) {
    result.recordings.push_back(recording);
    result.recordings.back().name = "recording_with_quite_a_long_name_" + std::to_string(i);
  }
  result.rivals.resize(80, result.rivals.front());
  while (result.triangles.size() < 100'000) Refine(&result);
  const std::string html = FormatReport(result);
  EXPECT_THAT(html, HasSubstr("Of 69 recordings the "));
  EXPECT_THAT(html, HasSubstr("60 less probable ones are left out"));
  EXPECT_LT(html.size(), 2'000'000U);
}

}  // namespace
}  // namespace palpate::diagnosis
