// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/ros_arguments.hpp"

#include <cstddef>

#include "libs/core/error.hpp"

namespace palpate::app {

namespace {

/// "NODE:use_sim_time:=true" -> "dds.use_sim_time=true"
std::string ToSetting(const std::string& parameter) {
  const std::size_t assign = parameter.find(":=");
  if (assign == parameter.npos) {
    throw InputError("--ros-args -p " + parameter + ": must be written as NAME:=VALUE");
  }
  std::string name = parameter.substr(0, assign);
  name = name.substr(name.find(':') == name.npos ? 0 : name.find(':') + 1);
  if (name == "use_sim_time") name = "dds.use_sim_time";
  return name + "=" + parameter.substr(assign + 2);
}

std::string ToLogLevel(const std::string& level) {
  if (level == "warn" || level == "WARN") return "warning";
  if (level == "fatal" || level == "FATAL") return "error";
  return level;
}

}  // namespace

std::vector<std::string> WithoutRosArguments(const std::vector<std::string>& words) {
  std::vector<std::string> translated;
  bool of_ros = false;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (!of_ros || word == "--") {
      of_ros = !of_ros && word == "--ros-args";
      if (word != "--" && word != "--ros-args") translated.push_back(word);
      continue;
    }
    if (word == "--ros-args") continue;
    const bool remap = word == "-r" || word == "--remap";
    const bool parameter = word == "-p" || word == "--param";
    if (!remap && !parameter && word != "--log-level") {
      throw InputError("--ros-args " + word + ": only -r, -p and --log-level are known here");
    }
    if (++i == words.size()) throw InputError("--ros-args " + word + ": its value is missing");
    translated.emplace_back(remap ? "--remap" : parameter ? "--set" : "--log-level");
    translated.push_back(remap ? words[i] : parameter ? ToSetting(words[i]) : ToLogLevel(words[i]));
  }
  return translated;
}

}  // namespace palpate::app
