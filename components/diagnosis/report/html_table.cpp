// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/report/html_table.hpp"

#include "libs/plot/svg_document.hpp"

namespace palpate::diagnosis {

namespace {

/// What must not be torn apart at the end of a line.
std::string Escaped(std::string_view text) {
  constexpr std::string_view kBreaks[] = {" %", " mm", " = ", " \u00B1 ", "ln BF", "held out"};
  std::string html = plot::EscapeXml(text);
  for (const std::string_view together : kBreaks) {
    for (auto at = html.find(together); at != std::string::npos; at = html.find(together, at + 1)) {
      for (auto space = html.find(' ', at); space < at + together.size();
           space = html.find(' ', space)) {
        html.replace(space, 1, "&#160;");
      }
    }
  }
  return html;
}

std::string Row(const std::vector<std::string>& cells, const std::vector<bool>& numeric,
                const std::string& tag) {
  std::string html = "<tr>";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const bool right = i < numeric.size() && numeric[i];
    html += "<" + tag + (right ? " class=\"number\">" : ">");
    html += Escaped(cells[i]);
    html += "</" + tag + ">";
  }
  return html + "</tr>\n";
}

}  // namespace

std::string FormatTable(const HtmlTable& table) {
  std::string html = "<table>\n<thead>" + Row(table.head, table.numeric, "th") + "</thead>\n";
  html += "<tbody>\n";
  for (const auto& row : table.rows) html += Row(row, table.numeric, "td");
  return html + "</tbody>\n</table>\n";
}

std::string Element(std::string_view tag, std::string_view text) {
  std::string html = "<";
  html.append(tag).append(">").append(Escaped(text)).append("</").append(tag).append(">\n");
  return html;
}

}  // namespace palpate::diagnosis
