// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/mesh_io/vtu_text.hpp"

#include <tinyxml2.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "libs/fem/mesh_io/limits.hpp"

namespace palpate::fem::mesh_io {

namespace {

using tinyxml2::XMLElement;

constexpr char kMark = '\x1A';  // "substitute": no number, name or base64 holds it

/// Where the markup ends that begins with the '<' at `start`; npos where it does not.
size_t MarkupEnd(std::string_view xml, size_t start) {
  const std::string_view markup = xml.substr(start);
  const auto past = [&](std::string_view end_mark, size_t from) {
    const size_t found = xml.find(end_mark, start + from);
    return found == std::string_view::npos ? found : found + end_mark.size();
  };
  if (markup.starts_with("<!--")) return past("-->", 4);
  if (markup.starts_with("<![CDATA[")) return past("]]>", 9);
  char quote = '\0';
  for (size_t position = start + 1; position < xml.size(); ++position) {
    const char letter = xml[position];
    if (quote != '\0') {
      if (letter == quote) quote = '\0';
    } else if (letter == '"' || letter == '\'') {
      quote = letter;
    } else if (letter == '>') {
      return position + 1;
    }
  }
  return std::string_view::npos;
}

/// The text between a start tag that ends at `start` and the end tag, if it is plain.
std::string_view PlainText(std::string_view xml, size_t start) {
  const size_t end = xml.find('<', start);
  if (end == std::string_view::npos || !xml.substr(end).starts_with("</DataArray")) return {};
  const std::string_view text = xml.substr(start, end - start);
  const bool is_blank = std::all_of(text.begin(), text.end(), IsWhiteSpace);
  return is_blank || text.find('&') != std::string_view::npos ? std::string_view() : text;
}

std::string LineEnds(std::string_view text) {
  return std::string(static_cast<size_t>(std::count(text.begin(), text.end(), '\n')), '\n');
}

bool IsStartTag(std::string_view tag) {
  constexpr std::string_view kName = "<DataArray";
  return tag.starts_with(kName) && tag.size() > kName.size() + 1 &&
         (IsWhiteSpace(tag[kName.size()]) || tag[kName.size()] == '>') &&
         tag[tag.size() - 2] != '/';
}

std::optional<size_t> IndexOfMark(std::string_view text) {
  const size_t mark = text.find_first_not_of(kWhiteSpace);
  if (mark == std::string_view::npos || text[mark] != kMark) return std::nullopt;
  size_t index = 0;
  const auto [end, error] =
      std::from_chars(text.data() + mark + 1, text.data() + text.size(), index);
  return error == std::errc() ? std::optional(index) : std::nullopt;
}

}  // namespace

std::string CutArrayTexts(std::string_view xml, std::vector<std::string_view>* texts) {
  std::string rest;
  size_t copied = 0;
  for (size_t position = xml.find('<'); position != std::string_view::npos;
       position = xml.find('<', position)) {
    const size_t end = MarkupEnd(xml, position);
    if (end == std::string_view::npos) break;
    const bool is_array = IsStartTag(xml.substr(position, end - position));
    position = end;
    if (!is_array) continue;
    const std::string_view text = PlainText(xml, end);
    if (text.empty()) continue;
    rest.append(xml.substr(copied, end - copied));
    const size_t first = text.find_first_not_of(kWhiteSpace);
    rest += LineEnds(text.substr(0, first)) + kMark + std::to_string(texts->size()) +
            LineEnds(text.substr(first));
    texts->push_back(text);
    copied = position = end + text.size();
  }
  return rest.append(xml.substr(copied));
}

ArrayText TextOfArray(const XMLElement& array, const VtuStorage& storage) {
  for (const auto* node = array.FirstChild(); node != nullptr; node = node->NextSibling()) {
    if (node->ToText() == nullptr) continue;
    const std::string_view text = node->Value();
    if (text.find_first_not_of(kWhiteSpace) == std::string_view::npos) continue;
    const std::optional<size_t> index = IndexOfMark(text);
    const bool is_cut = index && *index < storage.texts.size();
    return {.text = is_cut ? storage.texts[*index] : text, .line = node->GetLineNum()};
  }
  return {};
}

std::string ArrayName(const XMLElement& array) {
  if (const char* name = array.Attribute("Name")) return name;
  const tinyxml2::XMLNode* parent = array.Parent();
  return parent != nullptr && parent->ToElement() != nullptr ? parent->ToElement()->Name() : "";
}

}  // namespace palpate::fem::mesh_io
