// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/ros_names.hpp"

#include <algorithm>
#include <cctype>

#include "libs/core/error.hpp"

namespace palpate::dds {

namespace {

bool IsDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool IsNameCharacter(char c) {
  return c == '_' || std::isalnum(static_cast<unsigned char>(c)) != 0;
}

bool IsNamePart(std::string_view part) {
  return !part.empty() && !IsDigit(part.front()) && part.find("__") == part.npos &&
         std::all_of(part.begin(), part.end(), IsNameCharacter);
}

}  // namespace

bool IsRosTopicName(std::string_view name) {
  if (name.empty() || name.front() != '/') return false;
  while (!name.empty()) {
    name.remove_prefix(1);
    const size_t length = std::min(name.find('/'), name.size());
    if (!IsNamePart(name.substr(0, length))) return false;
    name.remove_prefix(length);
  }
  return true;
}

std::string DdsTopicName(std::string_view ros_name) {
  if (!IsRosTopicName(ros_name)) {
    throw InputError("'" + std::string(ros_name) +
                     "' is no ROS topic name (like /robot/mesh_state: letters, digits, _)");
  }
  return "rt" + std::string(ros_name);
}

std::string DdsTypeName(std::string_view ros_type) {
  constexpr std::string_view kMiddle = "/msg/";
  const size_t middle = ros_type.find(kMiddle);
  const std::string_view package = ros_type.substr(0, middle);
  const std::string_view name =
      middle == ros_type.npos ? "" : ros_type.substr(middle + kMiddle.size());
  if (!IsNamePart(package) || !IsNamePart(name)) {
    throw InputError("'" + std::string(ros_type) + "' is no ROS message type (package/msg/Name)");
  }
  return std::string(package) + "::msg::dds_::" + std::string(name) + "_";
}

std::string RosNamePart(std::string_view text) {
  std::string part;
  for (const char c : text) {
    const char mapped = IsNameCharacter(c) ? c : '_';
    if (mapped != '_' || part.empty() || part.back() != '_') part += mapped;
  }
  if (part.empty() || IsDigit(part.front())) part.insert(part.begin(), '_');
  return part;
}

}  // namespace palpate::dds
