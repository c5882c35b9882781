// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/serve/page_files.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <utility>

#include "libs/core/sha256.hpp"

namespace palpate::view {

/// Made from components/view/web/dist by cmake/embed_files.cpp.
std::span<const PageFile> BuiltInPageFiles();

namespace {

std::string TypeOf(std::string_view path) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 9> kTypes{{
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".json", "application/json"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".ico", "image/x-icon"},
      {".woff2", "font/woff2"},
      {".txt", "text/plain; charset=utf-8"},
  }};
  for (const auto& [ending, type] : kTypes) {
    if (path.ends_with(ending)) return std::string(type);
  }
  return "application/octet-stream";
}

using Answers = std::map<std::string_view, HttpAnswer>;

Answers MakeAnswers() {
  Answers answers;
  for (const PageFile& file : BuiltInPageFiles()) {
    constexpr std::size_t kEtagLength = 16;
    answers[file.path] = {.status = 200,
                          .content_type = TypeOf(file.path),
                          .body = std::make_shared<const std::string>(file.gzip),
                          .gzip = true,
                          .etag = '"' + Sha256Hex(file.gzip).substr(0, kEtagLength) + '"'};
  }
  return answers;
}

}  // namespace

HttpAnswer AnswerPageFile(std::string_view path) {
  static const Answers answers = MakeAnswers();
  const auto found = answers.find(path == "/" ? "/index.html" : path);
  if (found != answers.end()) return found->second;
  return {.body = std::make_shared<const std::string>("no such file\n")};
}

}  // namespace palpate::view
