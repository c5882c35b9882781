// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/report/report_style.hpp"

namespace palpate::diagnosis {

const char* const kReportStyle = R"css(
:root { color-scheme: light; }
* { box-sizing: border-box; }
body {
  margin: 0 auto; max-width: 800px; padding: 24px 20px 48px; background: #fff; color: #1f2933;
  font: 15px/1.5 "DejaVu Sans", "Helvetica Neue", Helvetica, Arial, sans-serif;
}
header { color: #56616d; font-size: 13px; display: flex; justify-content: space-between;
  gap: 20px; margin-bottom: 12px; }
header span { overflow-wrap: anywhere; }
.verdict { border-left: 8px solid var(--tone); background: var(--ground); padding: 14px 20px 16px;
  margin-bottom: 28px; }
.verdict .label { color: var(--tone); font-weight: bold; font-size: 13px; letter-spacing: 0.06em;
  text-transform: uppercase; margin: 0 0 4px; }
h1 { font-size: 25px; line-height: 1.3; margin: 0 0 12px; overflow-wrap: anywhere; }
h2 { font-size: 18px; margin: 34px 0 8px; break-after: avoid; }
p { margin: 6px 0; }
dl.facts { display: grid; grid-template-columns: max-content 1fr; gap: 3px 18px; margin: 0; }
dl.facts dt { color: #56616d; }
dl.facts dd { margin: 0; overflow-wrap: anywhere; }
figure { margin: 26px 0; break-inside: avoid; }
figure h3 { font-size: 15px; margin: 0 0 6px; }
figure svg { display: block; width: 100%; height: auto; }
figcaption, section > p, .absent { color: #56616d; font-size: 13px; }
figcaption { margin-top: 4px; }
.absent { border: 1px dashed #c9d1d9; padding: 6px 14px; margin: 10px 0; break-inside: avoid; }
.absent b { color: #1f2933; }
table { border-collapse: collapse; width: 100%; font-size: 13px; line-height: 1.4; }
th { text-align: left; vertical-align: bottom; border-bottom: 2px solid #9aa5b1; }
th, td { padding: 5px 8px; overflow-wrap: break-word; }
td { vertical-align: top; border-bottom: 1px solid #e4e9ee; }
.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
th.number { white-space: normal; }
tr { break-inside: avoid; }
table + p { break-before: avoid; }
td:first-child:not(.number) { min-width: 9.5em; }
pre { background: #f3f5f7; padding: 10px 14px; font-size: 13px; white-space: pre-wrap;
  overflow-wrap: anywhere; break-after: avoid; }
dl.facts { break-inside: avoid; }
@page { size: A4; margin: 15mm 15mm 17mm;
  @bottom-right { content: counter(page) " / " counter(pages); font: 9pt sans-serif; } }
@media print {
  body { max-width: none; padding: 0; font-size: 10.5pt; print-color-adjust: exact;
    -webkit-print-color-adjust: exact; }
  h1 { font-size: 17pt; }
  header, figcaption, section > p, .absent, table { font-size: 9pt; }
  .verdict { break-inside: avoid; }
}
)css";

}  // namespace palpate::diagnosis
