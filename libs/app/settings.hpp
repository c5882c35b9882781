// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "libs/core/config_node.hpp"
#include "libs/core/config_reader.hpp"

namespace palpate::app {

/// Where the value of a setting lives: a member of somebody's settings struct. An optional may be
/// unset (null in the file).
using SettingValue =
    std::variant<bool*, int*, double*, std::string*, std::filesystem::path*, std::optional<double>*,
                 Eigen::Vector3d*, std::vector<double>*, std::vector<std::string>*>;

/// One parameter: a single line of a struct's Visit() serves loading, checking, --print-config and
/// the README table.
struct Setting {
  std::string key;  ///< "youngs_modulus_Pa"; of a struct inside the struct: "contact.radius_m"
  SettingValue value;
  NumberRule rule;                   ///< of a number, or of each number of a list
  std::vector<std::string> choices;  ///< of a text; empty: any text
  std::string help;
};

/// Gathers the settings of a struct. The struct declares them, without knowing this header:
///
///   template <typename Visitor>
///   void Visit(Visitor&& v) {
///     v("youngs_modulus_Pa", youngs_modulus_Pa, {.min = 1.0}, "Stiffness of the material at
///     rest"); v("qos", qos, {"reliable", "best_effort"}, "Reliability that is asked for");
///     v("robot_file", robot_file, "Robot description");     // bool, text, path
///     v("contact", contact, "How contacts are spread");      // a struct with a Visit of its own
///   }
class SettingsCollector {
 public:
  explicit SettingsCollector(std::vector<Setting>* settings, std::string prefix = {})
      : settings_(settings), prefix_(std::move(prefix)) {}

  template <typename Value>
  void operator()(const char* key, Value& value, const char* help) {
    if constexpr (std::is_constructible_v<SettingValue, Value*>) {
      Add(key, &value, {}, {}, help);
    } else {
      value.Visit(SettingsCollector(settings_, prefix_ + key + "."));
    }
  }
  template <typename Value>
  void operator()(const char* key, Value& value, const NumberRule& rule, const char* help) {
    Add(key, &value, rule, {}, help);
  }
  void operator()(const char* key, std::string& value, std::vector<std::string> choices,
                  const char* help) {
    Add(key, &value, {}, std::move(choices), help);
  }

 private:
  void Add(const char* key, SettingValue value, const NumberRule& rule,
           std::vector<std::string> choices, const char* help);

  std::vector<Setting>* settings_;
  std::string prefix_;
};

template <typename Config>
std::vector<Setting> ListSettings(Config& config) {
  std::vector<Setting> settings;
  config.Visit(SettingsCollector(&settings));
  return settings;
}

/// Reads a settings tree into the struct that `settings` points into; what is absent keeps its
/// value. Paths are resolved against the folder of the file that names them. Throws InputError
/// (file:line:column, key, value, rule) for an unknown key, a wrong type, a value out of range.
void LoadSettings(const ConfigNode& root, const std::vector<Setting>& settings);

/// Reads one "key=value" of the command line, the value written as in a file. Throws InputError
/// that begins with "--set".
void ApplyOverride(const std::string& assignment, const std::vector<Setting>& settings);

/// The settings as a file that LoadSettings reads back to exactly the same values, each with its
/// text and rule as a comment.
std::string PrintYaml(const std::vector<Setting>& settings);

/// The parameter table of a component's README: parameter, default, range, meaning.
std::string PrintMarkdown(const std::vector<Setting>& settings);

}  // namespace palpate::app
