// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "libs/app/yaml.hpp"
#include "libs/dds/participant.hpp"
#include "libs/dds/wait_set.hpp"

namespace palpate::dds {

inline TopicTable BuiltInTable() {
  return ReadTopicTable(app::ParseYaml(std::string(BuiltInTopicsYaml()), "topics.yaml"));
}

/// The domain that this test program has for itself (set by CMake).
inline uint32_t TestDomain() {
  const char* domain = std::getenv("ROS_DOMAIN_ID");
  return domain ? static_cast<uint32_t>(std::atoi(domain)) : 0;
}

/// The built-in table with one row changed by `change(TopicSettings&)`.
template <typename Change>
TopicTable TableWith(std::string_view name, const Change& change) {
  std::vector<TopicSettings> topics = BuiltInTable().topics();
  for (TopicSettings& topic : topics) {
    if (topic.name == name) change(topic);
  }
  return TopicTable(std::move(topics));
}

/// A node with a loop, as tests need it.
struct TestNode {
  explicit TestNode(const std::string& name, TopicTable table = BuiltInTable(),
                    GidLayout layout = GidLayout::kHumble)
      : participant({.domain_id = TestDomain(), .node_name = name, .gid_layout = layout},
                    std::move(table)),
        loop(participant) {}

  std::function<void()> Waker() {
    return [this] { loop.Wake(); };
  }

  /// Waits, at most 10 s, until `condition` holds.
  template <typename Condition>
  bool WaitFor(const Condition& condition) {
    return loop.DispatchUntil(condition, WaitSet::Clock::now() + std::chrono::seconds(10));
  }

  Participant participant;
  WaitSet loop;
};

}  // namespace palpate::dds
