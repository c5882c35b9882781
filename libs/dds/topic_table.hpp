// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "libs/core/config_node.hpp"

namespace palpate::dds {

enum class Reliability { kReliable, kBestEffort };
enum class Durability { kVolatile, kTransientLocal };

/// One row of config/topics.yaml.
struct TopicSettings {
  std::string name;  ///< ROS name; "<name>" stands for one part that is known at run time
  std::string type;  ///< ROS type, package/msg/Name
  Reliability reliability = Reliability::kReliable;
  Durability durability = Durability::kVolatile;
  int depth = 1;                     ///< samples kept, >= 1 (keep-last)
  std::optional<double> rate_hz;     ///< nominal; absent: now and then
  std::optional<double> deadline_s;  ///< promised by writers and asked for by readers
  bool recorded = true;
  bool global = false;          ///< ROS 2 knows it under this name in every namespace
  bool sole_writer = false;     ///< one process alone may write it (SoleWriters)
  bool raw = false;             ///< so large that dds.remote_raw may keep it on its host
  bool this_host_only = false;  ///< not in the file: what Participant makes of `raw`
  /// Components and others that write and read it ("capture"), or kAnyComponent; access_rights.hpp.
  std::vector<std::string> writers;
  std::vector<std::string> readers;
};

/// In `writers` and `readers`: every component.
inline constexpr char kAnyComponent[] = "all";

/// The one table of all topics.
class TopicTable {
 public:
  /// Throws InputError where two rows have one name.
  explicit TopicTable(std::vector<TopicSettings> topics);

  const std::vector<TopicSettings>& topics() const { return topics_; }
  /// The row; throws InputError (with "did you mean") where there is none.
  const TopicSettings& At(std::string_view name) const;

 private:
  std::vector<TopicSettings> topics_;
};

/// Reads the parsed config/topics.yaml strictly. Throws InputError with file:line:column.
TopicTable ReadTopicTable(const ConfigNode& node);

/// Text of config/topics.yaml as it was when this program was built.
std::string_view BuiltInTopicsYaml();

}  // namespace palpate::dds
