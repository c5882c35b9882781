// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "libs/core/severity.hpp"
#include "libs/dds/commanded_fault.hpp"
#include "libs/dds/domain.hpp"
#include "libs/dds/entity.hpp"
#include "libs/dds/parameter_services.hpp"
#include "libs/dds/raw_writer.hpp"
#include "libs/dds/reader.hpp"
#include "libs/dds/ros_clock.hpp"
#include "libs/dds/ros_graph.hpp"
#include "libs/dds/security_qos.hpp"
#include "libs/dds/topic_names.hpp"
#include "libs/dds/topic_table.hpp"
#include "libs/dds/topics.hpp"
#include "libs/dds/writer.hpp"

namespace palpate::dds {

struct ParticipantSettings {
  uint32_t domain_id = 0;  ///< 0 to 232, ROS_DOMAIN_ID
  std::string node_name;   ///< as `ros2 node list` shows it
  std::string node_namespace = "/";
  GidLayout gid_layout = GidLayout::kHumble;
  std::vector<std::string> remap = {};     ///< TopicNames
  bool use_sim_time = false;               ///< take the time from /clock
  std::vector<Parameter> parameters = {};  ///< that its WaitSet answers for; empty: no services
  bool allow_faults = false;               ///< on command, by parameters
  bool remote_raw = true;  ///< false: raw images stay on this host (TopicSettings::raw)
  SecuritySettings security = {};
};

/// One process on DDS, seen by ROS 2 as one node. Makes all writers and readers, by the topic
/// table. Must outlive them. Not thread-safe.
class Participant {
 public:
  /// Where CYCLONEDDS_URI is not set, config/cyclonedds/default.xml holds. Throws RunError where
  /// DDS refuses (no network interface, too many processes, bad CYCLONEDDS_URI), InputError for
  /// names and rules that are none (TopicNames), for settings of Cyclone DDS that contradict each
  /// other (domain_settings.hpp), and for files that do not allow a secured start (SetSecurity).
  Participant(const ParticipantSettings& settings, TopicTable table);
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  dds_entity_t handle() const { return entity_.handle(); }
  const TopicTable& table() const { return table_; }
  const std::string& node_name() const { return names_.node_name(); }
  /// The time by which this node stamps and judges ages. Shared with what outlives a call.
  const std::shared_ptr<RosClock>& clock() const { return clock_; }
  /// What its parameters are asked by; nullptr: none, or DDS Security does not allow them.
  ParameterServices* parameters() const { return parameters_.get(); }
  /// The fault that writers of data have on command; nullptr: none is allowed.
  CommandedFault* fault() const { return fault_.get(); }
  /// ns since 1970 by that clock.
  std::int64_t Now_ns() const { return clock_->Now_ns(); }
  uint32_t domain_id() const { return domain_id_; }

  /// `name` takes the place of "<name>" in the topic's name. `on_change`: see EndpointCounters.
  /// Throws InputError where the table has no such topic or another type, RunError where DDS
  /// refuses.
  template <typename T>
  Writer<T> CreateWriter(const Topic<T>& topic, std::function<void()> on_change = {},
                         const std::string& name = {}) {
    Writer<T> writer(handle(), table_.At(topic.name), RosName(topic.name, name),
                     std::move(on_change));
    graph_.AddWriter(writer.handle());
    if (fault_ && IsData(topic.name)) writer.Follow(fault_);
    written_.push_back({writer.ros_name(), table_.At(topic.name).sole_writer});
    return writer;
  }
  template <typename T>
  Reader<T> CreateReader(const Topic<T>& topic, std::function<void()> on_change = {},
                         const std::string& name = {}) {
    return CreateReaderAs(topic, table_.At(topic.name), std::move(on_change), name);
  }
  /// With another QoS than the table's.
  template <typename T>
  Reader<T> CreateReaderAs(const Topic<T>& topic, const TopicSettings& qos,
                           std::function<void()> on_change = {}, const std::string& name = {}) {
    Reader<T> reader(handle(), qos, RosName(topic.name, name), std::move(on_change));
    graph_.AddReader(reader.handle());
    return reader;
  }

  /// A writer of messages of any type. `topic.dds_topic` is taken as it is. Throws RunError where
  /// DDS refuses.
  std::unique_ptr<RawWriter> CreateRawWriter(const RawWriterTopic& topic,
                                             std::function<void()> on_change = {}) {
    auto writer = std::make_unique<RawWriter>(handle(), KeptHere(topic), std::move(on_change));
    graph_.AddWriter(writer->handle());
    return writer;
  }

  /// A topic for which CreateWriter was called.
  struct Written {
    std::string ros_name;
    bool sole_writer = false;
  };
  const std::vector<Written>& written() const { return written_; }

  /// Where lines of the log go that concern the whole node; NodeLog sets it.
  using Log = std::function<void(Severity, std::string_view)>;
  void SetLog(Log log) { log_ = std::move(log); }
  void WriteLog(Severity severity, std::string_view text) const {
    if (log_) log_(severity, text);
  }

  /// The name under which this node uses a topic of the table. Throws InputError where the table
  /// has no such topic.
  std::string ResolvedName(std::string_view topic_name) const { return RosName(topic_name, {}); }

 private:
  /// Whether a topic has data, in contrast to what says how processes fare.
  bool IsData(std::string_view topic_name) const;
  RawWriterTopic KeptHere(RawWriterTopic topic) const;
  std::string RosName(std::string_view topic_name, const std::string& name) const {
    return names_.Resolve(table_.At(topic_name), name);
  }

  uint32_t domain_id_;
  TopicTable table_;
  TopicNames names_;
  std::shared_ptr<Entity> domain_;  ///< goes after the entities in it
  Entity entity_;
  RosGraph graph_;
  std::vector<Written> written_;
  Log log_;
  std::shared_ptr<RosClock> clock_;
  std::shared_ptr<CommandedFault> fault_;
  std::unique_ptr<ParameterServices> parameters_;
};

}  // namespace palpate::dds
