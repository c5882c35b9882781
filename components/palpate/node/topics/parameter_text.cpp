// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/topics/parameter_text.hpp"

#include <fmt/core.h>

#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <vector>

#include "components/palpate/topics/message_value.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"

namespace palpate::command {

namespace {

using Json = nlohmann::ordered_json;

/// By the index of ParameterValue.
constexpr std::array<const char*, 10> kTypeNames{
    "not set",    "boolean",       "integer",       "double",       "string",
    "byte array", "boolean array", "integer array", "double array", "string array"};
constexpr std::array<const char*, 10> kGetWords{"",     "Boolean", "Integer", "Double", "String",
                                                "Byte", "Boolean", "Integer", "Double", "String"};

/// As Python prints it.
struct ToText {
  std::string operator()(std::monostate) const { return "None"; }
  std::string operator()(bool value) const { return value ? "True" : "False"; }
  std::string operator()(std::int64_t value) const { return std::to_string(value); }
  std::string operator()(std::uint8_t value) const { return std::to_string(value); }
  std::string operator()(double value) const { return PythonNumber(value); }
  std::string operator()(const std::string& value) const { return value; }
  template <typename Value>
  std::string operator()(const std::vector<Value>& values) const {
    std::string list;
    for (const auto& value : values) {
      list += list.empty() ? "" : ", ";
      if constexpr (std::is_same_v<Value, std::string>) {
        list += "'" + value + "'";
      } else {
        list += (*this)(static_cast<Value>(value));
      }
    }
    return "[" + list + "]";
  }
};

struct ToJson {
  Json operator()(std::monostate) const { return nullptr; }
  Json operator()(double value) const { return std::isfinite(value) ? Json(value) : Json(nullptr); }
  template <typename Value>
  Json operator()(const Value& value) const {
    return value;
  }
};

template <typename Number>
bool ParseWhole(const std::string& text, Number* value) {
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, *value);
  return result.ec == std::errc() && result.ptr == end;
}

/// One value by the rules of YAML: true, 3, 0.5, text.
ParameterValue Guess(const ConfigNode& node) {
  std::int64_t whole = 0;
  double number = 0.0;
  if (node.quoted) return node.text;
  if (node.text == "true" || node.text == "false") return node.text == "true";
  if (ParseWhole(node.text, &whole)) return whole;
  if (ParseFinite(node.text, &number)) return number;
  return node.text;
}

/// The items of a list, all of the type of the first; whole numbers go as numbers.
ParameterValue GuessList(const ConfigNode& node) {
  std::vector<std::string> texts;
  std::vector<double> numbers;
  std::vector<std::int64_t> wholes;
  std::vector<bool> switches;
  for (const ConfigNode& item : node.items) {
    const ParameterValue value = Guess(item);
    texts.push_back(item.text);
    if (const auto* is = std::get_if<bool>(&value)) switches.push_back(*is);
    if (const auto* is = std::get_if<std::int64_t>(&value)) {
      wholes.push_back(*is);
      numbers.push_back(static_cast<double>(*is));
    }
    if (const auto* is = std::get_if<double>(&value)) numbers.push_back(*is);
  }
  if (texts.empty()) return texts;
  if (switches.size() == texts.size()) return switches;
  if (wholes.size() == texts.size()) return wholes;
  if (numbers.size() == texts.size()) return numbers;
  return texts;
}

ParameterValue GuessText(const std::string& text) {
  const ConfigNode root = app::ParseYaml("value: " + text, "value");
  const ConfigNode* node = root.Find("value");
  if (node == nullptr || node->kind == ConfigNode::Kind::kNull) return std::string();
  if (node->kind == ConfigNode::Kind::kMap) throw InputError("a parameter is no map");
  return node->kind == ConfigNode::Kind::kList ? GuessList(*node) : Guess(*node);
}

/// A whole number where a number is wanted, and an empty list of anything.
ParameterValue Widened(const ParameterValue& value, const ParameterValue& like) {
  const auto* whole = std::get_if<std::int64_t>(&value);
  if (whole != nullptr && std::holds_alternative<double>(like)) return static_cast<double>(*whole);
  const auto* wholes = std::get_if<std::vector<std::int64_t>>(&value);
  if (wholes != nullptr && std::holds_alternative<std::vector<double>>(like)) {
    return std::vector<double>(wholes->begin(), wholes->end());
  }
  const auto* texts = std::get_if<std::vector<std::string>>(&value);
  const bool is_list = like.index() >= std::variant_size_v<ParameterValue> - 5;
  if (texts != nullptr && texts->empty() && is_list) return like;
  return value;
}

}  // namespace

std::string ParameterTypeName(const ParameterValue& value) { return kTypeNames[value.index()]; }

std::string ParameterLine(const ParameterValue& value, bool hide_type) {
  if (std::holds_alternative<std::monostate>(value)) return "Parameter not set.";
  const std::string text = std::visit(ToText{}, value);
  if (hide_type) return text;
  const bool is_list = std::string_view(kTypeNames[value.index()]).ends_with("array");
  return fmt::format("{} {}: {}", kGetWords[value.index()], is_list ? "values are" : "value is",
                     text);
}

std::string ParameterJson(const ParameterValue& value) {
  return std::visit(ToJson{}, value).dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string ParameterDescription(const Parameter& parameter) {
  std::string text = fmt::format("Parameter name: {}\n  Type: {}\n", parameter.name,
                                 ParameterTypeName(parameter.value));
  if (!parameter.description.empty()) {
    text += fmt::format("  Description: {}\n", parameter.description);
  }
  text += "  Constraints:\n";
  if (!parameter.fixed_because.empty()) text += "    Read only: true\n";
  if (parameter.range) {
    const bool whole = std::holds_alternative<std::int64_t>(parameter.value);
    const auto format = [&](double number) {
      return whole ? FormatNumber(number) : PythonNumber(number);
    };
    text += fmt::format("    Min value: {}\n    Max value: {}\n", format(parameter.range->first),
                        format(parameter.range->second));
  }
  if (!parameter.constraints.empty()) {
    text += fmt::format("    Additional constraints: {}\n", parameter.constraints);
  }
  return text;
}

ParameterValue ParseParameter(const std::string& text, const ParameterValue& like) {
  if (std::holds_alternative<std::string>(like)) return text;
  const ParameterValue value = Widened(GuessText(text), like);
  if (like.index() != 0 && value.index() != like.index()) {
    throw InputError(fmt::format("the value must be of type {}, not '{}'", ParameterTypeName(like),
                                 Excerpt(text)));
  }
  return value;
}

}  // namespace palpate::command
