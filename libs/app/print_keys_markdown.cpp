// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cctype>
#include <sstream>

#include "libs/app/key_reference.hpp"
#include "libs/core/text.hpp"

namespace palpate::app {

namespace {

using ValueKind = ValueType::Kind;

constexpr std::size_t kLineWidth = 110;
/// More alternatives than that are described in a text of their own.
constexpr std::size_t kMostAlternatives = 4;

/// The anchor that a heading gets on the page.
std::string Anchor(const std::string& heading) {
  std::string anchor;
  for (const unsigned char c : heading) {
    if (c == ' ') anchor += '-';
    if (std::isalnum(c) != 0 || c == '_' || c == '-') anchor += static_cast<char>(std::tolower(c));
  }
  return anchor;
}

std::string Wrapped(const std::string& text) {
  std::string wrapped, line, word;
  for (std::istringstream words(text); words >> word;) {
    if (!line.empty() && line.size() + word.size() >= kLineWidth) {
      wrapped += line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
  }
  return wrapped + line + "\n";
}

std::string WithRange(const std::string& what, const NumberRule& rule) {
  const std::string range = DescribeRule(rule);
  return range.empty() ? what : what + " " + range;
}

std::string CountOf(const ValueType& list) {
  if (list.min_items == list.max_items) return std::to_string(list.min_items) + " ";
  return "";
}

std::string AtLeast(const ValueType& list) {
  const bool open = list.min_items > 0 && list.max_items != list.min_items;
  return open ? ", at least " + std::to_string(list.min_items) : "";
}

bool IsVector3(const ValueType& type) {
  return type.kind == ValueKind::kList && type.parts[0].kind == ValueKind::kNumber &&
         type.min_items == 3 && type.max_items == 3;
}

bool HasManyAlternatives(const ValueType& type) { return type.parts.size() > kMostAlternatives; }

std::string TypeText(const ValueType& type);

std::string ListText(const ValueType& list) {
  const ValueType& item = list.parts[0];
  if (IsVector3(list)) return WithRange("`[x, y, z]`", item.rule);
  if (item.kind == ValueKind::kNumber) {
    return WithRange("list of " + CountOf(list) + "numbers", item.rule) + AtLeast(list);
  }
  if (HasManyAlternatives(item)) return "list of maps";
  if (IsVector3(item)) return "list of " + CountOf(list) + "points `[x, y, z]`" + AtLeast(list);
  return "list of " + CountOf(list) + TypeText(item) + AtLeast(list);
}

std::string EitherText(const ValueType& type) {
  if (HasManyAlternatives(type)) return "map";
  std::string text;
  for (const ValueType& part : type.parts) text += (text.empty() ? "" : " or ") + TypeText(part);
  return text;
}

std::string ChoiceText(const std::vector<std::string>& choices) {
  std::string text;
  for (const std::string& choice : choices) text += (text.empty() ? "`" : ", `") + choice + "`";
  return text;
}

std::string IntegerText(const NumberRule& rule) {
  return "integer " + std::to_string(static_cast<int>(rule.min)) + " to " +
         std::to_string(static_cast<int>(rule.max));
}

std::string TypeText(const ValueType& type) {
  switch (type.kind) {
    case ValueKind::kBoolean: return "`true`, `false`";
    case ValueKind::kInteger: return IntegerText(type.rule);
    case ValueKind::kNumber:
      return WithRange("number", type.rule) + (type.may_be_null ? ", or `~`" : "");
    case ValueKind::kText: return type.choices.empty() ? "text" : ChoiceText(type.choices);
    case ValueKind::kFile: return "path";
    case ValueKind::kList: return ListText(type);
    case ValueKind::kMap: return "[" + type.keys->title + "](#" + Anchor(type.keys->title) + ")";
    case ValueKind::kEither: return EitherText(type);
  }
  return {};
}

std::string PresenceText(const Presence& presence) {
  const bool plain_default = !presence.json.empty() && presence.IsUnconditional();
  if (plain_default) return "`" + presence.text + "`";
  return presence.text.empty() ? "optional" : presence.text;
}

/// What a row says of a key, without its name.
std::string RowTail(const Key& key) {
  return " | " + TypeText(key.type) + " | " + UnitOf(key.name) + " | " +
         PresenceText(key.presence) + " | " + key.meaning + " |\n";
}

/// Neighbours of which the same is to be said share a row.
std::string Rows(const std::vector<Key>& keys) {
  std::string rows;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const std::string tail = RowTail(keys[k]);
    rows += "| `" + keys[k].name + "`";
    while (k + 1 < keys.size() && RowTail(keys[k + 1]) == tail)
      rows += ", `" + keys[++k].name + "`";
    rows += tail;
  }
  return rows;
}

std::string Rules(const KeyTable& table) {
  std::string text;
  for (const auto& group : table.exactly_one) text += " Exactly one of " + ChoiceText(group) + ".";
  for (const auto& group : table.at_most_one) text += " At most one of " + ChoiceText(group) + ".";
  return text;
}

void ListMapsIn(const ValueType& type, std::vector<const KeyTable*>* maps) {
  if (type.kind == ValueKind::kMap) maps->push_back(type.keys);
  if (HasManyAlternatives(type)) return;
  for (const ValueType& part : type.parts) ListMapsIn(part, maps);
}

/// Prints the table and, depth first, those of the maps in it that are not in `printed` yet.
void PrintTable(const KeyTable& table, const std::string& heading_marks,
                std::vector<const KeyTable*>* printed, std::string* text) {
  if (std::find(printed->begin(), printed->end(), &table) != printed->end()) return;
  printed->push_back(&table);
  *text += (text->empty() ? "" : "\n") + heading_marks + " " + table.title + "\n\n" +
           Wrapped(table.about + Rules(table)) +
           "\n| key | type and range | unit | default | meaning |\n|---|---|---|---|---|\n";
  std::vector<const KeyTable*> maps;
  for (const auto* keys : {&table.keys, &table.open_keys}) {
    *text += Rows(*keys);
    for (const Key& key : *keys) ListMapsIn(key.type, &maps);
  }
  for (const KeyTable* map : maps) PrintTable(*map, "####", printed, text);
}

}  // namespace

std::string PrintKeysMarkdown(const std::vector<const KeyTable*>& files) {
  std::string text;
  std::vector<const KeyTable*> printed;
  for (const KeyTable* file : files) PrintTable(*file, "###", &printed, &text);
  return text;
}

}  // namespace palpate::app
