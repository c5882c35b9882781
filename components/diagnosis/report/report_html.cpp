// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/report/report_html.hpp"

#include "components/diagnosis/report/figures/figures.hpp"
#include "components/diagnosis/report/html_table.hpp"
#include "components/diagnosis/report/report_style.hpp"
#include "components/diagnosis/report/report_tables.hpp"
#include "components/diagnosis/vocabulary/verdict_words.hpp"

namespace palpate::diagnosis {

namespace {

/// Colours of the verdict: its bar and label, and its ground.
std::string ToneOf(Verdict verdict) {
  switch (verdict) {
    case Verdict::kNoFault: return "--tone: #00795a; --ground: #eef7f3";
    case Verdict::kCause: return "--tone: #0067a3; --ground: #eef5fa";
    case Verdict::kIndistinguishable:
    case Verdict::kPartlyExplained: return "--tone: #96660a; --ground: #fdf6e9";
    case Verdict::kUnexplained: return "--tone: #b34e00; --ground: #fdf1e9";
    case Verdict::kDataUnfit: break;
  }
  return "--tone: #56616d; --ground: #f3f5f7";
}

std::string Head(const DiagnosisResult& result) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n" +
         Element("title", "Diagnosis of " + result.robot + ": " + VerdictLabel(result.verdict)) +
         "<style>" + kReportStyle + "</style>\n</head>\n";
}

std::string VerdictBlock(const DiagnosisResult& result) {
  std::string html = "<header>" + Element("span", "Diagnosis of " + result.robot) +
                     Element("span", result.data) + "</header>\n";
  html += "<div class=\"verdict\" style=\"" + ToneOf(result.verdict) + "\">\n";
  const std::string partial = result.interrupted ? " (interrupted, partial)" : "";
  html += "<p class=\"label\">" + VerdictLabel(result.verdict) + partial + "</p>\n";
  html += Element("h1", VerdictHeadline(result)) + "<dl class=\"facts\">\n";
  for (const VerdictDetail& detail : VerdictDetails(result)) {
    html += Element("dt", detail.label) + Element("dd", detail.text);
  }
  return html + "</dl>\n</div>\n";
}

std::string FigureBlock(const Figure& figure, int* number) {
  if (figure.svg.empty()) {
    return "<div class=\"absent\" id=\"" + figure.id + "\">" + Element("b", figure.title + ":") +
           Element("span", "left out. " + figure.absent) + "</div>\n";
  }
  return "<figure id=\"" + figure.id + "\">\n" +
         Element("h3", "Figure " + std::to_string(++*number) + ". " + figure.title) + figure.svg +
         Element("figcaption", figure.caption) + "</figure>\n";
}

std::string Section(const std::string& title, const std::string& content) {
  if (content.empty()) return "";
  return "<section>\n" + Element("h2", title) + content + "</section>\n";
}

std::string ViewCommands(const std::vector<std::string>& commands) {
  if (commands.empty()) return "";
  std::string html = Element(
      "p", "In a browser, moving with the recordings: of the robot file, then as diagnosed.");
  for (const std::string& command : commands) html += Element("pre", command);
  return html;
}

}  // namespace

std::string FormatReport(const DiagnosisResult& result,
                         const std::vector<std::string>& view_commands) {
  std::string html = Head(result) + "<body>\n" + VerdictBlock(result) + "<main>\n";
  int number = 0;
  std::string figures;
  for (const Figure& figure :
       {DrawResidualField(result), DrawRecordingBars(result), DrawProbabilities(result),
        DrawResidualForces(result), DrawHysteresis(result), DrawHolds(result),
        DrawCorrelations(result)}) {
    figures += FigureBlock(figure, &number);
  }
  const bool named = !result.causes.empty();
  html += Section(named ? "Model error, and what the causes change" : "Model error", figures);
  html += Section("Causes named", CauseTable(result));
  html += Section("Next experiments", ExperimentTable(result));
  html += Section("Faults not named, and why", RivalTable(result));
  html += Section("Recordings", RecordingTable(result));
  html += Section("What these data can show", FindableTable(result));
  html += Section("Not identifiable from data of this kind", IdentityList(result));
  html += Section("The residuals on the body", ViewCommands(view_commands));
  html += Section("How to repeat", HowToRepeat(result));
  return html + "</main>\n</body>\n</html>\n";
}

}  // namespace palpate::diagnosis
