// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/parameters.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "libs/app/log.hpp"
#include "libs/core/text.hpp"

namespace palpate::app {

namespace {

constexpr const char* kSimTimeSetting = "dds.use_sim_time";
constexpr const char* kSimTimeParameter = "use_sim_time";

struct ToParameterValue {
  ParameterValue operator()(const bool* value) const { return *value; }
  ParameterValue operator()(const int* value) const { return std::int64_t{*value}; }
  ParameterValue operator()(const double* value) const { return *value; }
  ParameterValue operator()(const std::string* value) const { return *value; }
  ParameterValue operator()(const std::filesystem::path* value) const { return value->string(); }
  ParameterValue operator()(const std::optional<double>* value) const {
    return *value ? ParameterValue(**value) : ParameterValue();
  }
  ParameterValue operator()(const Eigen::Vector3d* value) const {
    return std::vector<double>(value->begin(), value->end());
  }
  ParameterValue operator()(const std::vector<double>* value) const { return *value; }
  ParameterValue operator()(const std::vector<std::string>* value) const { return *value; }
};

std::string Constraints(const Setting& setting) {
  return setting.choices.empty() ? DescribeRule(setting.rule) : Listed(setting.choices);
}

std::string FixedBecause(const std::string& program, const std::string& key,
                         const NodeOptions& options) {
  return "read at start; change " + key +
         (options.config_file.empty() ? " with --set " + key + "=VALUE"
                                      : " in " + options.config_file.string()) +
         " and restart " + program;
}

Parameter ParameterOf(const std::string& program, const Setting& setting,
                      const NodeOptions& options) {
  Parameter parameter;
  parameter.name = setting.key == kSimTimeSetting ? kSimTimeParameter : setting.key;
  parameter.value = std::visit(ToParameterValue{}, setting.value);
  parameter.description = setting.help;
  parameter.constraints = Constraints(setting);
  const NumberRule& rule = setting.rule;
  if (std::isfinite(rule.min) && std::isfinite(rule.max) && !rule.min_open && !rule.max_open) {
    parameter.range = {rule.min, rule.max};
  }
  parameter.fixed_because = FixedBecause(program, setting.key, options);
  return parameter;
}

Parameter LogLevelOf(const NodeOptions& options) {
  Parameter parameter;
  parameter.name = "log_level";
  parameter.value = options.log_level;
  parameter.description = "Lowest severity that is logged";
  parameter.constraints = Listed(LogLevels());
  parameter.change = [](const ParameterValue& value) -> std::string {
    const auto* level = std::get_if<std::string>(&value);
    if (level != nullptr && SetLogLevel(*level)) return "";
    return "must be one of " + Listed(LogLevels()) +
           (level == nullptr ? "" : ", not '" + *level + "'" + DidYouMean(*level, LogLevels()));
  };
  return parameter;
}

}  // namespace

std::vector<Parameter> ParametersOf(const std::string& program,
                                    const std::vector<Setting>& settings,
                                    const NodeOptions& options) {
  std::vector<Parameter> parameters;
  for (const Setting& setting : settings) {
    parameters.push_back(ParameterOf(program, setting, options));
  }
  parameters.push_back(LogLevelOf(options));
  return parameters;
}

}  // namespace palpate::app
