// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/access_rights.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"

namespace palpate::dds {

namespace {

constexpr char kRecorder[] = "recorder";
constexpr char kPlayer[] = "player";
constexpr char kView[] = "view";
constexpr char kTopicPrefix[] = "rt";
constexpr char kEveryTopic[] = "rt/*";
constexpr char kDiscovery[] = "ros_discovery_info";
constexpr std::string_view kRunTimePart = "<name>";
/// Nodes of ROS 2 that are not ours, and what each node of ROS 2 has besides topics: events of
/// parameters, and services.
constexpr std::array<std::string_view, 3> kNeighbours{"camera_driver", "robot_driver",
                                                      "robot_controller"};
constexpr std::array<std::string_view, 3> kOfEachRosNode{"rt/parameter_events", "rq/*", "rr/*"};

template <typename Range>
bool Has(const Range& range, std::string_view word) {
  return std::find(range.begin(), range.end(), word) != range.end();
}

bool ReadsAll(const std::string& role) {
  return role == kRecorder || role == kView || role == kObserver || role == kOperator;
}

bool Writes(const TopicSettings& topic, const std::string& role) {
  const bool is_command = role == kObserver || role == kOperator;
  return Has(topic.writers, role) || (role == kPlayer && topic.recorded) ||
         (Has(topic.writers, kAnyComponent) && !is_command);
}

bool Reads(const TopicSettings& topic, const std::string& role) {
  return Has(topic.readers, role) || Has(topic.readers, kAnyComponent);
}

std::vector<std::string> Sorted(const std::set<std::string>& names) {
  return {names.begin(), names.end()};
}

}  // namespace

std::vector<std::string> RolesOf(const TopicTable& table) {
  std::set<std::string> roles{kRecorder, kPlayer, kView, kObserver, kOperator};
  for (const TopicSettings& topic : table.topics()) {
    roles.insert(topic.writers.begin(), topic.writers.end());
    roles.insert(topic.readers.begin(), topic.readers.end());
  }
  roles.erase(kAnyComponent);
  return Sorted(roles);
}

std::vector<std::string> OwnRolesOf(const TopicTable& table) {
  std::vector<std::string> roles = RolesOf(table);
  std::erase_if(roles, [](const std::string& role) { return Has(kNeighbours, role); });
  return roles;
}

security::AccessRights RightsOf(const TopicTable& table, const std::string& role,
                                const TopicNames& names) {
  const std::vector<std::string> roles = RolesOf(table);
  if (!Has(roles, role)) {
    throw InputError("'" + role + "' is neither a component nor a command: " + Listed(roles) +
                     DidYouMean(role, roles));
  }
  std::set<std::string> write{kDiscovery};
  std::set<std::string> read;
  if (ReadsAll(role)) read = {kDiscovery, kEveryTopic};
  for (const TopicSettings& topic : table.topics()) {
    const bool has_part = topic.name.find(kRunTimePart) != topic.name.npos;
    const std::string name = kTopicPrefix + names.Resolve(topic, has_part ? "*" : "");
    if (Writes(topic, role)) write.insert(name);
    if (Reads(topic, role) && !ReadsAll(role)) read.insert(name);
  }
  if (Has(kNeighbours, role)) {
    read.insert(kDiscovery);
    write.insert(kOfEachRosNode.begin(), kOfEachRosNode.end());
    read.insert(kOfEachRosNode.begin(), kOfEachRosNode.end());
  }
  return {Sorted(write), Sorted(read)};
}

}  // namespace palpate::dds
