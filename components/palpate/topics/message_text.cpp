// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>

#include "components/palpate/topics/message_value.hpp"
#include "libs/core/text.hpp"
#include "libs/recording/ros2msg/cdr_reader.hpp"

namespace palpate::command {

namespace {

using Kind = MessageValue::Kind;
using Json = nlohmann::ordered_json;

bool IsFloat(const std::string& type) { return type == "float32" || type == "float64"; }

/// A number as Python's str() has it.
std::string PythonText(std::uint64_t bits, const std::string& type) {
  if (type == "bool") return bits == 0 ? "False" : "True";
  if (type == "uint64") return std::to_string(bits);
  if (type == "int64") return std::to_string(static_cast<std::int64_t>(bits));
  const double value = recording::NumberOf(bits, type);
  return IsFloat(type) ? PythonNumber(value) : FormatNumber(value);
}

/// A number as a scalar of PyYAML.
std::string YamlNumber(std::uint64_t bits, const std::string& type) {
  if (type == "bool") return bits == 0 ? "false" : "true";
  std::string text = PythonText(bits, type);
  if (!IsFloat(type)) return text;
  if (text == "nan") return ".nan";
  if (text.ends_with("inf")) return text.insert(text.size() - 3, ".");
  const std::size_t exponent = text.find('e');
  if (exponent != text.npos && text.find('.') == text.npos) text.insert(exponent, ".0");
  return text;
}

Json JsonNumber(std::uint64_t bits, const std::string& type) {
  if (type == "bool") return bits != 0;
  if (type == "uint64") return bits;
  if (type == "int64") return static_cast<std::int64_t>(bits);
  const double value = recording::NumberOf(bits, type);
  if (!IsFloat(type)) return static_cast<std::int64_t>(value);
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

/// "float64" -> "double", as rosidl names the types of items; "std_msgs/Header" gets its "/msg/".
std::string RosidlTypeName(const std::string& type) {
  if (type == "float64") return "double";
  if (type == "float32") return "float";
  if (type == "bool") return "boolean";
  const std::size_t slash = type.find('/');
  return slash == type.npos || type.find("/msg/") != type.npos
             ? type
             : type.substr(0, slash) + "/msg" + type.substr(slash);
}

std::string AbbreviatedList(const MessageValue& list) {
  const std::string type = RosidlTypeName(list.type);
  const std::string length = std::to_string(list.count);
  return list.is_array ? "<array type: " + type + "[" + length + "]>"
                       : "<sequence type: " + type + ", length: " + length + ">";
}

/// A text as the options want it; characters of UTF-8 stay whole.
std::string ShownText(const std::string& text, const PrintOptions& options) {
  if (options.no_texts) return "<string length: <" + std::to_string(text.size()) + ">>";
  if (options.truncate_length == 0 || text.size() <= options.truncate_length) return text;
  std::size_t end = options.truncate_length;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return text.substr(0, end) + "...";
}

std::uint64_t ShownCount(const MessageValue& list, const PrintOptions& options) {
  const std::uint64_t most = options.truncate_length;
  return most == 0 ? list.count : std::min(list.count, most);
}

bool IsList(const MessageValue& value) {
  return value.kind == Kind::kNumbers || value.kind == Kind::kList;
}

bool IsControl(unsigned char c) { return c < 0x20 || c == 0x7F; }

/// With line ends and other control characters escaped.
std::string DoubleQuoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '\n') {
      quoted += "\\n";
    } else if (c == '"' || c == '\\') {
      quoted += std::string("\\") + c;
    } else if (IsControl(static_cast<unsigned char>(c))) {
      quoted += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

class YamlPrinter {
 public:
  explicit YamlPrinter(const PrintOptions& options) : options_(options) {}

  /// What fits behind "key: " on its line; empty where it needs lines of its own.
  std::string Scalar(const MessageValue& value) const {
    if (value.kind == Kind::kNumber) return YamlNumber(value.bits, value.type);
    if (value.kind == Kind::kText) return YamlScalar(ShownText(value.text, options_));
    if (value.kind == Kind::kMessage) return value.fields.empty() ? "{}" : "";
    if (options_.no_lists) return YamlScalar(AbbreviatedList(value));
    return value.count == 0 ? "[]" : "";
  }

  void Block(const MessageValue& value, const std::string& indent) {
    value.kind == Kind::kMessage ? Fields(value, indent, indent) : Items(value, indent);
  }

  std::string text;

 private:
  /// `first`: before the first field, which may follow the dash of an item.
  void Fields(const MessageValue& message, const std::string& first, const std::string& indent) {
    bool is_first = true;
    for (const auto& [name, value] : message.fields) {
      text += (is_first ? first : indent) + name + ":";
      is_first = false;
      const std::string scalar = Scalar(value);
      text += (scalar.empty() ? "" : " " + scalar) + "\n";
      // PyYAML does not indent the items of a list in a map.
      if (scalar.empty()) Block(value, IsList(value) ? indent : indent + "  ");
    }
  }

  void Items(const MessageValue& list, const std::string& indent) {
    const std::uint64_t shown = ShownCount(list, options_);
    for (std::uint64_t i = 0; i < shown; ++i) {
      if (list.kind == Kind::kNumbers) {
        text += indent + "- " + YamlNumber(list.BitsAt(i), list.type) + "\n";
        continue;
      }
      const MessageValue& item = list.items[i];
      const std::string scalar = Scalar(item);
      if (scalar.empty()) {
        Fields(item, indent + "- ", indent + "  ");
      } else {
        text += indent + "- " + scalar + "\n";
      }
    }
    if (shown < list.count) text += indent + "- '...'\n";
  }

  const PrintOptions& options_;
};

void AppendCsv(const MessageValue& value, const PrintOptions& options, std::string* line) {
  const auto append = [line](const std::string& text) { *line += text + ","; };
  if (value.kind == Kind::kNumber) return append(PythonText(value.bits, value.type));
  if (value.kind == Kind::kText) return append(ShownText(value.text, options));
  if (value.kind == Kind::kMessage) {
    for (const auto& [name, field] : value.fields) AppendCsv(field, options, line);
    return;
  }
  if (options.no_lists) return append(AbbreviatedList(value));
  const std::uint64_t shown = ShownCount(value, options);
  for (std::uint64_t i = 0; i < shown; ++i) {
    if (value.kind == Kind::kNumbers) {
      append(PythonText(value.BitsAt(i), value.type));
    } else {
      AppendCsv(value.items[i], options, line);
    }
  }
  if (shown < value.count) append("...");
}

Json ToJson(const MessageValue& value, const PrintOptions& options) {
  if (value.kind == Kind::kNumber) return JsonNumber(value.bits, value.type);
  if (value.kind == Kind::kText) return ShownText(value.text, options);
  if (value.kind == Kind::kMessage) {
    Json object = Json::object();
    for (const auto& [name, field] : value.fields) object[name] = ToJson(field, options);
    return object;
  }
  if (options.no_lists) return AbbreviatedList(value);
  Json list = Json::array();
  const std::uint64_t shown = ShownCount(value, options);
  for (std::uint64_t i = 0; i < shown; ++i) {
    list.push_back(value.kind == Kind::kNumbers ? JsonNumber(value.BitsAt(i), value.type)
                                                : ToJson(value.items[i], options));
  }
  if (shown < value.count) list.push_back("...");
  return list;
}

}  // namespace

std::string PythonNumber(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0.0 ? "inf" : "-inf";
  // repr() writes an exponent below 1e-4 and from 1e16 on.
  const double size = std::abs(value);
  const bool exponent = size != 0.0 && (size < 1e-4 || size >= 1e16);
  std::array<char, 64> digits{};
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), value,
                    exponent ? std::chars_format::scientific : std::chars_format::fixed)
          .ptr;
  std::string text(digits.data(), end);
  if (!exponent && text.find('.') == text.npos) text += ".0";
  return text;
}

std::string YamlScalar(const std::string& text) {
  static const std::regex kOtherType(
      R"(~|null|Null|NULL|true|True|TRUE|false|False|FALSE|yes|Yes|YES|no|No|NO|on|On|ON|off|Off|OFF|y|Y|n|N|[-+]?[0-9][0-9_.,:]*([eE][-+]?[0-9]+)?|[-+]?0[xXbBoO][0-9a-fA-F_]+|[-+]?\.[0-9_]+([eE][-+]?[0-9]+)?|[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN)|<<|=|[0-9]{4}-[0-9]{1,2}-[0-9]{1,2}.*)");
  if (std::any_of(text.begin(), text.end(), IsControl)) return DoubleQuoted(text);
  const bool plain =
      !text.empty() && text.front() != ' ' && text.back() != ' ' && text.back() != ':' &&
      std::string_view(",[]{}#&*!|>'\"%@`").find(text.front()) == std::string_view::npos &&
      !(std::string_view("-?:").find(text.front()) != std::string_view::npos &&
        (text.size() == 1 || text[1] == ' ')) &&
      text.find(": ") == text.npos && text.find(" #") == text.npos && text != "---" &&
      text != "..." && !std::regex_match(text, kOtherType);
  if (plain) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("''") : std::string(1, c);
  return quoted + "'";
}

std::string YamlText(const MessageValue& value, const PrintOptions& options) {
  YamlPrinter printer(options);
  const std::string scalar = printer.Scalar(value);
  if (!scalar.empty()) {
    // A message with nothing in it prints nothing.
    return value.kind == Kind::kMessage ? "" : scalar + "\n";
  }
  printer.Block(value, "");
  return std::move(printer.text);
}

std::string CsvText(const MessageValue& value, const PrintOptions& options) {
  std::string line;
  AppendCsv(value, options, &line);
  if (!line.empty()) line.pop_back();
  return line + "\n";
}

std::string JsonText(const MessageValue& value, const PrintOptions& options) {
  // Texts that are no UTF-8 must not stop the output.
  return ToJson(value, options).dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace palpate::command
