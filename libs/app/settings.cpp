// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/settings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libs/app/yaml.hpp"
#include "libs/core/check.hpp"
#include "libs/core/text.hpp"

namespace palpate::app {

namespace {

using Kind = ConfigNode::Kind;

/// Reads one entry into the value that a Setting points at.
struct ValueReader {
  const ConfigNode& node;
  const Setting& setting;

  void operator()(bool* value) const { *value = ReadBool(node); }

  void operator()(int* value) const {
    using Limits = std::numeric_limits<int>;
    const double lowest = std::ceil(setting.rule.min) + (setting.rule.min_open ? 1.0 : 0.0);
    const double highest = std::floor(setting.rule.max) - (setting.rule.max_open ? 1.0 : 0.0);
    *value = ReadInteger(node, lowest > Limits::min() ? static_cast<int>(lowest) : Limits::min(),
                         highest < Limits::max() ? static_cast<int>(highest) : Limits::max());
  }

  void operator()(double* value) const { *value = ReadNumber(node, setting.rule); }

  void operator()(std::string* value) const {
    *value = setting.choices.empty() ? ReadText(node) : ReadChoice(node, setting.choices);
  }

  void operator()(std::filesystem::path* value) const {
    const std::filesystem::path path = ReadText(node);
    const bool in_file = node.where.line > 0;
    const bool beside_file = in_file && !path.empty() && path.is_relative();
    *value = beside_file ? std::filesystem::path(node.where.file).parent_path() / path : path;
  }

  void operator()(std::optional<double>* value) const { *value = ReadNumber(node, setting.rule); }

  void operator()(Eigen::Vector3d* value) const { *value = ReadVector3(node, setting.rule); }

  void operator()(std::vector<double>* value) const { *value = ReadNumbers(node, setting.rule); }

  void operator()(std::vector<std::string>* value) const {
    if (node.kind != Kind::kList) Refuse(node, "must be a list of texts");
    std::vector<std::string> texts;
    for (const ConfigNode& item : node.items) texts.push_back(ReadText(item));
    *value = std::move(texts);
  }
};

void ReadEntry(const ConfigNode& node, const Setting& setting) {
  if (node.kind == Kind::kNull) {
    const auto* optional = std::get_if<std::optional<double>*>(&setting.value);
    if (optional == nullptr) Refuse(node, "must have a value");
    (*optional)->reset();
    return;
  }
  std::visit(ValueReader{node, setting}, setting.value);
}

const Setting* FindSetting(const std::string& key, const std::vector<Setting>& settings) {
  for (const Setting& setting : settings) {
    if (setting.key == key) return &setting;
  }
  return nullptr;
}

bool IsGroup(const std::string& key, const std::vector<Setting>& settings) {
  for (const Setting& setting : settings) {
    if (setting.key.starts_with(key + ".")) return true;
  }
  return false;
}

/// The keys that may stand in the map of that prefix ("" or "contact.").
std::vector<std::string> KeysBelow(const std::string& prefix,
                                   const std::vector<Setting>& settings) {
  std::vector<std::string> keys;
  for (const Setting& setting : settings) {
    if (!setting.key.starts_with(prefix)) continue;
    std::string key =
        setting.key.substr(prefix.size(), setting.key.find('.', prefix.size()) - prefix.size());
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(std::move(key));
  }
  return keys;
}

void LoadMap(const ConfigNode& map, const std::string& prefix,
             const std::vector<Setting>& settings) {
  if (map.kind != Kind::kMap) Refuse(map, "must be a map of settings (key: value)");
  for (const auto& [key, entry] : map.entries) {
    const std::string full_key = prefix + key;
    if (const Setting* setting = FindSetting(full_key, settings)) {
      ReadEntry(entry, *setting);
    } else if (IsGroup(full_key, settings)) {
      LoadMap(entry, full_key + ".", settings);
    } else {
      const std::vector<std::string> allowed = KeysBelow(prefix, settings);
      throw InputError(entry.key_where, "unknown key '" + Excerpt(full_key) + "'" +
                                            DidYouMean(key, allowed) +
                                            "; allowed: " + Listed(allowed));
    }
  }
}

}  // namespace

void SettingsCollector::Add(const char* key, SettingValue value, const NumberRule& rule,
                            std::vector<std::string> choices, const char* help) {
  const std::string full_key = prefix_ + key;
  PALPATE_CHECK(FindSetting(full_key, *settings_) == nullptr, full_key, "declared twice");
  settings_->push_back({full_key, value, rule, std::move(choices), help});
}

void LoadSettings(const ConfigNode& root, const std::vector<Setting>& settings) {
  if (root.kind != Kind::kNull) LoadMap(root, "", settings);
}

void ApplyOverride(const std::string& assignment, const std::vector<Setting>& settings) {
  const size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw InputError("--set " + assignment + ": must be written as KEY=VALUE");
  }
  const std::string key = assignment.substr(0, equals);
  const Setting* setting = FindSetting(key, settings);
  if (setting == nullptr) {
    std::vector<std::string> keys;
    for (const Setting& known : settings) keys.push_back(known.key);
    throw InputError("--set " + assignment + ": unknown key '" + key + "'" + DidYouMean(key, keys) +
                     "; allowed: " + Listed(keys));
  }
  ConfigNode node = ParseYaml(assignment.substr(equals + 1), "--set " + assignment);
  node.where = {"--set " + assignment};
  node.path = key;
  ReadEntry(node, *setting);
}

}  // namespace palpate::app
