// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/recording/ros2msg/message_definition.hpp"

#include <algorithm>
#include <set>

namespace palpate::recording {

namespace {

std::string FormatField(const Field& field) {
  std::string text = field.type;
  if (field.repeat == Repeat::kSequence) text += "[]";
  if (field.repeat == Repeat::kFixed) text += "[" + std::to_string(field.count) + "]";
  return text + " " + field.name + "\n";
}

std::string FormatOne(const MessageDefinition& definition) {
  std::string text;
  for (const Constant& constant : definition.constants) {
    text += constant.type + " " + constant.name + "=" + constant.value + "\n";
  }
  for (const Field& field : definition.fields) text += FormatField(field);
  return text;
}

bool IsMessage(std::string_view type) { return type.find('/') != type.npos; }

/// `name` and all that it uses, each once, those that use before those that are used.
bool Collect(const std::string& name, const Definitions& definitions,
             std::vector<const MessageDefinition*>* collected) {
  const auto found = definitions.find(name);
  if (found == definitions.end()) return false;
  const MessageDefinition* definition = &found->second;
  if (std::find(collected->begin(), collected->end(), definition) != collected->end()) return true;
  collected->push_back(definition);
  return std::all_of(definition->fields.begin(), definition->fields.end(), [&](const Field& field) {
    return !IsMessage(field.type) || Collect(field.type, definitions, collected);
  });
}

}  // namespace

std::uint32_t SizeOfPrimitive(std::string_view ros_type) {
  static const std::map<std::string, std::uint32_t, std::less<>> kSizes{
      {"bool", 1},   {"byte", 1},    {"char", 1},   {"int8", 1},   {"uint8", 1},
      {"int16", 2},  {"uint16", 2},  {"int32", 4},  {"uint32", 4}, {"int64", 8},
      {"uint64", 8}, {"float32", 4}, {"float64", 8}};
  const auto found = kSizes.find(ros_type);
  return found == kSizes.end() ? 0 : found->second;
}

std::string ShortTypeName(std::string_view ros_type) {
  std::string name(ros_type);
  const std::size_t middle = name.find("/msg/");
  return middle == name.npos ? name : name.erase(middle, 4);
}

std::optional<std::string> FormatRos2msg(const std::string& ros_type,
                                         const Definitions& definitions) {
  std::vector<const MessageDefinition*> collected;
  if (!Collect(ShortTypeName(ros_type), definitions, &collected)) return std::nullopt;
  std::string text = FormatOne(*collected.front());
  for (std::size_t i = 1; i < collected.size(); ++i) {
    text += std::string(80, '=') + "\nMSG: " + collected[i]->name + "\n" + FormatOne(*collected[i]);
  }
  return text;
}

}  // namespace palpate::recording
