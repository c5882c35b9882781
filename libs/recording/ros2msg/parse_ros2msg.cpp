// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <sstream>

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/recording/ros2msg/message_definition.hpp"

namespace palpate::recording {

namespace {

std::string_view Trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// "Header" in package "sensor_msgs" -> "sensor_msgs/Header"; ROS 1 wrote some so.
std::string FullTypeName(const std::string& type, const std::string& package) {
  if (SizeOfPrimitive(type) > 0 || type == "string" || type == "wstring") return type;
  if (type.find('/') != type.npos) return ShortTypeName(type);
  if (type == "time" || type == "duration") {
    return type == "time" ? "builtin_interfaces/Time" : "builtin_interfaces/Duration";
  }
  return (type == "Header" ? "std_msgs" : package) + "/" + type;
}

/// Takes "[]", "[9]" or "[<=9]" off a type, and "<=9" off a bounded string.
void TakeRepeat(std::string* type, Field* field) {
  const std::size_t open = type->find('[');
  if (open != type->npos) {
    const std::string inside = type->substr(open + 1, type->find(']') - open - 1);
    const bool fixed = !inside.empty() && inside[0] != '<';
    field->repeat = fixed ? Repeat::kFixed : Repeat::kSequence;
    if (fixed) field->count = static_cast<std::uint32_t>(std::strtoul(inside.c_str(), nullptr, 10));
    type->erase(open);
  }
  type->erase(std::min(type->size(), type->find("<=")));
}

void ParseLine(std::string_view line, MessageDefinition* definition) {
  const std::size_t comment = line.find('#');
  const std::size_t equal = line.find('=');
  // The value of a text constant may have a "#" in it.
  const bool is_text = line.starts_with("string ") && equal < comment;
  line = Trimmed(is_text ? line : line.substr(0, comment));
  if (line.empty()) return;
  const std::size_t space = line.find_first_of(" \t");
  if (space == line.npos) throw InputError("'" + Excerpt(line) + "' is no field of a message");
  std::string type(line.substr(0, space));
  std::string_view rest = Trimmed(line.substr(space));
  const std::string package = definition->name.substr(0, definition->name.find('/'));
  const std::size_t assigned = rest.find('=');
  const std::size_t name_end = std::min(rest.find_first_of(" \t="), rest.size());
  if (assigned != rest.npos && Trimmed(rest.substr(name_end)).starts_with('=')) {
    definition->constants.push_back({type, std::string(rest.substr(0, name_end)),
                                     std::string(Trimmed(rest.substr(assigned + 1)))});
    return;
  }
  Field field;
  TakeRepeat(&type, &field);
  field.type = FullTypeName(type, package);
  field.name = rest.substr(0, name_end);
  definition->fields.push_back(std::move(field));
}

}  // namespace

Definitions ParseRos2msg(const std::string& ros_type, std::string_view text) {
  Definitions definitions;
  std::string name = ShortTypeName(ros_type);
  MessageDefinition* current = &definitions[name];
  current->name = name;
  std::istringstream lines{std::string(text)};
  std::string line;
  while (std::getline(lines, line)) {
    const std::string_view trimmed = Trimmed(line);
    if (trimmed.starts_with("===")) continue;
    if (trimmed.starts_with("MSG:")) {
      name = ShortTypeName(Trimmed(trimmed.substr(4)));
      current = &definitions[name];
      *current = {name, {}, {}};
      continue;
    }
    ParseLine(trimmed, current);
  }
  return definitions;
}

}  // namespace palpate::recording
