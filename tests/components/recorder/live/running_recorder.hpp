// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <thread>
#include <utility>

#include "components/recorder/node/node.hpp"
#include "libs/core/error.hpp"
#include "libs/dds/qos.hpp"
#include "tests/libs/dds/test_participant.hpp"

namespace palpate::recorder {

/// A recorder in a thread of its own.
class RunningRecorder {
 public:
  RunningRecorder(const NodeConfig& config, RecordPlan plan)
      : node_(config, std::move(plan), static_cast<int>(dds::TestDomain()), dds::BuiltInTable(),
              {}),
        thread_([this] { Run(); }) {}
  explicit RunningRecorder(const std::filesystem::path& file)
      : RunningRecorder({}, PlanFor(file)) {}
  ~RunningRecorder() { Stop(); }
  RunningRecorder(const RunningRecorder&) = delete;
  RunningRecorder& operator=(const RunningRecorder&) = delete;

  static RecordPlan PlanFor(const std::filesystem::path& file) {
    RecordPlan plan;
    plan.file = file;
    return plan;
  }

  RecorderNode& node() { return node_; }

  /// All that was received before is then in the file. Returns the error of Run(), or "".
  std::string Stop() {
    node_.Stop();
    if (thread_.joinable()) thread_.join();
    return error_;
  }

 private:
  void Run() {
    try {
      node_.Run();
    } catch (const RunError& error) {
      error_ = error.what();
    }
  }

  RecorderNode node_;
  std::string error_;
  std::thread thread_;
};

/// A writer of any generated type on any topic.
class PlainWriter {
 public:
  PlainWriter(const dds::TestNode& node, const dds_topic_descriptor_t& descriptor,
              const std::string& dds_topic, const dds::TopicSettings& qos)
      : topic_(dds_create_topic(node.participant.handle(), &descriptor, dds_topic.c_str(), nullptr,
                                nullptr),
               dds_topic),
        writer_(dds_create_writer(node.participant.handle(), topic_.handle(),
                                  dds::WriterQos(qos).get(), nullptr),
                dds_topic) {}

  bool is_read() const {
    dds_publication_matched_status_t status{};
    dds_get_publication_matched_status(writer_.handle(), &status);
    return status.current_count > 0;
  }
  bool WaitUntilReceived() {
    return dds_wait_for_acks(writer_.handle(), DDS_SECS(5)) == DDS_RETCODE_OK;
  }
  bool Write(const void* message) { return dds_write(writer_.handle(), message) == DDS_RETCODE_OK; }

 private:
  dds::Entity topic_;
  dds::Entity writer_;
};

}  // namespace palpate::recorder
