// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>

#include "libs/app/settings.hpp"
#include "libs/core/text.hpp"

namespace palpate::app {

namespace {

template <typename List, typename Format>
std::string JoinList(const List& list, const Format& format) {
  std::string text;
  for (const auto& item : list) text += (text.empty() ? "" : ", ") + format(item);
  return "[" + text + "]";
}

/// The value as YAML that reads back as exactly the same value.
struct ValueFormatter {
  std::string operator()(const bool* value) const { return *value ? "true" : "false"; }
  std::string operator()(const int* value) const { return std::to_string(*value); }
  std::string operator()(const double* value) const { return FormatNumber(*value); }
  std::string operator()(const std::string* value) const { return Quoted(*value); }
  std::string operator()(const std::filesystem::path* value) const {
    return Quoted(value->string());
  }
  std::string operator()(const std::optional<double>* value) const {
    return value->has_value() ? FormatNumber(**value) : "null";
  }
  std::string operator()(const Eigen::Vector3d* value) const {
    return JoinList(*value, FormatNumber);
  }
  std::string operator()(const std::vector<double>* value) const {
    return JoinList(*value, FormatNumber);
  }
  std::string operator()(const std::vector<std::string>* value) const {
    return JoinList(*value, Quoted);
  }
};

/// What the setting may be: "> 0", "reliable, best_effort", or "" for anything of its type.
std::string DescribeRange(const Setting& setting) {
  if (setting.choices.empty()) return DescribeRule(setting.rule);
  std::string list;
  for (const std::string& choice : setting.choices) list += (list.empty() ? "" : ", ") + choice;
  return list;
}

std::string FormatValue(const Setting& setting) {
  return std::visit(ValueFormatter{}, setting.value);
}

/// Opens the maps of `key` that differ from those of the key before; returns the indentation.
std::string OpenGroups(const std::string& key, const std::string& key_before, std::string* yaml) {
  std::string indent;
  size_t start = 0;
  for (size_t dot = key.find('.'); dot != std::string::npos; dot = key.find('.', start)) {
    const bool is_open = key_before.compare(0, dot + 1, key, 0, dot + 1) == 0;
    if (!is_open) *yaml += indent + key.substr(start, dot - start) + ":\n";
    indent += "  ";
    start = dot + 1;
  }
  return indent;
}

std::string EscapePipes(const std::string& text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
  return escaped;
}

}  // namespace

std::string PrintYaml(const std::vector<Setting>& settings) {
  std::string yaml;
  std::string key_before;
  for (const Setting& setting : settings) {
    const std::string indent = OpenGroups(setting.key, key_before, &yaml);
    const std::string range = DescribeRange(setting);
    yaml += indent + "# " + setting.help + (range.empty() ? "" : " (" + range + ")") + "\n";
    yaml += indent + setting.key.substr(setting.key.rfind('.') + 1) + ": " + FormatValue(setting) +
            "\n";
    key_before = setting.key;
  }
  return yaml;
}

std::string PrintMarkdown(const std::vector<Setting>& settings) {
  std::string table = "| parameter | default | range | meaning |\n|---|---|---|---|\n";
  for (const Setting& setting : settings) {
    table += "| `" + setting.key + "` | `" + EscapePipes(FormatValue(setting)) + "` | " +
             EscapePipes(DescribeRange(setting)) + " | " + EscapePipes(setting.help) + " |\n";
  }
  return table;
}

}  // namespace palpate::app
