// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/components/diagnosis/report/browser.hpp"

#include <png.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "libs/core/error.hpp"
#include "libs/core/file.hpp"

namespace palpate::browser {

namespace {

/// Leaves the layout as JSON in the page. What HTML would escape is written as JSON's \\u00XX.
constexpr const char* kMeasure = R"html(<script>
const box = (e) => { const r = e.getBoundingClientRect();
  return [r.x + scrollX, r.y + scrollY, r.width, r.height]; };
const found = { height: document.documentElement.scrollHeight, pictures:
  [...document.querySelectorAll('figure')].map((f) => { const svg = f.querySelector('svg');
    return { id: f.id, box: box(svg), texts: [...svg.querySelectorAll('text')].map(
      (t) => ({ text: t.textContent, box: box(t) })) }; }) };
const pre = document.createElement('pre');
pre.textContent = 'LAYOUT' + JSON.stringify(found).replace(/[&<>\u0080-\uffff]/g,
  (c) => '\\u' + c.charCodeAt(0).toString(16).padStart(4, '0')) + 'LAYOUT';
document.body.appendChild(pre);
</script>)html";

plot::Rect ToRect(const nlohmann::json& box) { return {box[0], box[1], box[2], box[3]}; }

}  // namespace

std::string Browser::Run(const std::string& html, const std::string& arguments) const {
  const std::filesystem::path page = folder_ / "page.html", out = folder_ / "out.txt";
  WriteFile(page, html);
  const std::string command =
      "timeout 100 chromium --headless --no-sandbox --disable-gpu --hide-scrollbars"
      " --disable-dev-shm-usage --no-first-run --disable-background-networking"
      " --user-data-dir='" +
      (folder_ / "profile").string() + "' " + arguments + " 'file://" + page.string() + "' >'" +
      out.string() + "' 2>'" + (folder_ / "log.txt").string() + "'";
  const int status = std::system(command.c_str());
  if (status != 0) {
    throw RunError("chromium (Debian package chromium) failed with status " +
                   std::to_string(status) + ": " + ReadFile(folder_ / "log.txt"));
  }
  return ReadFile(out);
}

Layout Browser::Measure(const std::string& html, int width_px) const {
  const std::string dom =
      Run(html + kMeasure, "--window-size=" + std::to_string(width_px) + ",1200 --dump-dom");
  const auto begin = dom.rfind("<pre>LAYOUT"), end = dom.rfind("LAYOUT</pre>");
  if (begin == std::string::npos || end <= begin) throw RunError("chromium measured nothing");
  const auto found = nlohmann::json::parse(dom.substr(begin + 11, end - begin - 11));
  Layout layout{.height_px = found["height"], .pictures = {}};
  for (const auto& picture : found["pictures"]) {
    layout.pictures.push_back({picture["id"], ToRect(picture["box"]), {}});
    for (const auto& text : picture["texts"]) {
      layout.pictures.back().texts.push_back({text["text"], ToRect(text["box"])});
    }
  }
  return layout;
}

Pixels Browser::Screenshot(const std::string& html, int width_px, int height_px) const {
  const std::filesystem::path file = folder_ / "page.png";
  Run(html, "--window-size=" + std::to_string(width_px) + "," + std::to_string(height_px) +
                " --screenshot='" + file.string() + "'");
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&png, file.c_str()) == 0) throw RunError(png.message);
  png.format = PNG_FORMAT_RGB;
  Pixels pixels{static_cast<int>(png.width), static_cast<int>(png.height), {}};
  pixels.rgb.resize(PNG_IMAGE_SIZE(png));
  if (png_image_finish_read(&png, nullptr, pixels.rgb.data(), 0, nullptr) == 0) {
    throw RunError(png.message);
  }
  return pixels;
}

int Browser::PrintedPages(const std::string& html) const {
  const std::filesystem::path file = folder_ / "page.pdf";
  Run(html, "--no-pdf-header-footer --print-to-pdf='" + file.string() + "'");
  const std::string pdf = ReadFile(file);
  int pages = 0;
  const std::string page = "/Type /Page";
  for (auto at = pdf.find(page); at != std::string::npos; at = pdf.find(page, at + 1)) {
    if (pdf.compare(at + page.size(), 1, "s") != 0) ++pages;  // not the list of pages
  }
  return pages;
}

}  // namespace palpate::browser
