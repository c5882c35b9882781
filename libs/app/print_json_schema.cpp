// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <cmath>
#include <utility>

#include "libs/app/key_reference.hpp"
#include "libs/core/text.hpp"

namespace palpate::app {

namespace {

/// A JSON value as text; objects and lists are indented when they are put into another.
using Json = std::string;

Json Indented(const Json& json) {
  Json indented;
  for (const char c : json) indented += c == '\n' ? std::string("\n  ") : std::string(1, c);
  return indented;
}

Json Object(const std::vector<std::pair<std::string, Json>>& members) {
  Json object;
  for (const auto& [name, json] : members) {
    object += (object.empty() ? "\n  " : ",\n  ") + Quoted(name) + ": " + Indented(json);
  }
  return object.empty() ? "{}" : "{" + object + "\n}";
}

Json List(const std::vector<Json>& items) {
  Json list;
  for (const Json& item : items) list += (list.empty() ? "" : ", ") + item;
  return "[" + list + "]";
}

Json Texts(const std::vector<std::string>& texts) {
  std::vector<Json> items;
  for (const std::string& text : texts) items.push_back(Quoted(text));
  return List(items);
}

/// Members of one schema, in the order in which they are to stand.
using Members = std::vector<std::pair<std::string, Json>>;

Members MembersOf(const ValueType& type);
Members MembersOf(const KeyTable& table);

Members Typed(const char* name, bool may_be_null) {
  return {{"type", may_be_null ? Texts({name, "null"}) : Quoted(name)}};
}

void AddRange(const NumberRule& rule, Members* members) {
  if (std::isfinite(rule.min)) {
    members->emplace_back(rule.min_open ? "exclusiveMinimum" : "minimum", FormatNumber(rule.min));
  }
  if (std::isfinite(rule.max)) {
    members->emplace_back(rule.max_open ? "exclusiveMaximum" : "maximum", FormatNumber(rule.max));
  }
}

Members ChoiceMembers(const ValueType& type) {
  std::vector<Json> words;
  for (const std::string& choice : type.choices) words.push_back(Quoted(choice));
  if (type.may_be_null) words.push_back("null");
  return {{"enum", List(words)}};
}

Members ListMembers(const ValueType& type) {
  Members members = Typed("array", type.may_be_null);
  members.emplace_back("items", Object(MembersOf(type.parts[0])));
  if (type.min_items > 0) members.emplace_back("minItems", std::to_string(type.min_items));
  if (type.max_items < ValueType::kUnlimited) {
    members.emplace_back("maxItems", std::to_string(type.max_items));
  }
  return members;
}

Members EitherMembers(const ValueType& type) {
  std::vector<Json> parts;
  for (const ValueType& part : type.parts) parts.push_back(Object(MembersOf(part)));
  if (type.may_be_null) parts.push_back(Object({{"type", Quoted("null")}}));
  return {{"anyOf", List(parts)}};
}

Members MembersOf(const ValueType& type) {
  Members members;
  switch (type.kind) {
    case ValueType::Kind::kBoolean: return Typed("boolean", type.may_be_null);
    case ValueType::Kind::kInteger:
    case ValueType::Kind::kNumber:
      members =
          Typed(type.kind == ValueType::Kind::kInteger ? "integer" : "number", type.may_be_null);
      AddRange(type.rule, &members);
      return members;
    case ValueType::Kind::kText:
      return type.choices.empty() ? Typed("string", type.may_be_null) : ChoiceMembers(type);
    case ValueType::Kind::kFile: return Typed("string", type.may_be_null);
    case ValueType::Kind::kList: return ListMembers(type);
    case ValueType::Kind::kMap:
      members = MembersOf(*type.keys);
      if (type.may_be_null) members.front() = Typed("object", true).front();
      return members;
    case ValueType::Kind::kEither: return EitherMembers(type);
  }
  return members;
}

Json SchemaOf(const Key& key) {
  ValueType type = key.type;
  // The readers take a key without a value for an absent one.
  if (!key.presence.MustBeThere()) type.may_be_null = true;
  const std::string unit = UnitOf(key.name);
  Members members = {
      {"description", Quoted(unit.empty() ? key.meaning : key.meaning + " Unit: " + unit + ".")}};
  for (auto& member : MembersOf(type)) {
    if (member.first != "description") members.push_back(std::move(member));
  }
  if (!key.presence.json.empty()) members.emplace_back("default", key.presence.json);
  return Object(members);
}

/// "Exactly one of" and "at most one of", as schemas that all must hold.
std::vector<Json> RulesOf(const KeyTable& table) {
  std::vector<Json> rules;
  const auto require = [](const std::vector<std::string>& keys) {
    return Object({{"required", Texts(keys)}});
  };
  for (const auto& group : table.exactly_one) {
    std::vector<Json> each;
    for (const std::string& key : group) each.push_back(require({key}));
    rules.push_back(Object({{"oneOf", List(each)}}));
  }
  for (const auto& group : table.at_most_one) {
    rules.push_back(Object({{"not", require(group)}}));
  }
  return rules;
}

Members MembersOf(const KeyTable& table) {
  Members properties, patterns;
  std::vector<std::string> required;
  for (const Key& key : table.keys) {
    properties.emplace_back(key.name, SchemaOf(key));
    if (key.presence.kind == Presence::Kind::kRequired) required.push_back(key.name);
  }
  for (const Key& key : table.open_keys) {
    std::string pattern = ".";
    for (const char c : key.name.substr(key.name.rfind('>') + 1)) {
      pattern += c == '.' ? std::string("\\.") : std::string(1, c);
    }
    patterns.emplace_back(pattern + "$", SchemaOf(key));
  }
  Members members = {{"type", Quoted("object")}, {"description", Quoted(table.about)}};
  members.emplace_back("properties", Object(properties));
  if (!patterns.empty()) members.emplace_back("patternProperties", Object(patterns));
  if (!required.empty()) members.emplace_back("required", Texts(required));
  members.emplace_back("additionalProperties", "false");
  const std::vector<Json> rules = RulesOf(table);
  if (!rules.empty()) members.emplace_back("allOf", List(rules));
  return members;
}

}  // namespace

std::string PrintJsonSchema(const KeyTable& file) {
  Members members = {{"$schema", Quoted("https://json-schema.org/draft/2020-12/schema")},
                     {"title", Quoted(file.title)}};
  for (auto& member : MembersOf(file)) members.push_back(std::move(member));
  return Object(members) + "\n";
}

}  // namespace palpate::app
