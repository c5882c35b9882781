// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gmock/gmock.h>

#include <map>
#include <string>
#include <thread>
#include <vector>

#include "components/force_estimation/node/node.hpp"
#include "diagnostic_msgs/msg/DiagnosticStatus.hpp"
#include "tests/components/force_estimation/node/scripted_pipeline.hpp"
#include "tests/components/force_estimation/node/test_robot.hpp"
#include "tests/support/perception_sender.hpp"

namespace palpate::force_estimation {

inline constexpr double kCable_m = 0.002;

inline NodeConfig TestConfig() {
  NodeConfig config;
  config.camera_pose = "{translation_m: [0, 0, 0.5], rotation_xyzw: [1, 0, 0, 0]}";
  config.cable_wait_s = 0.05;
  config.silence_s = 0.2;
  return config;
}

using Seen = test_support::SeenFrame;

/// The node in a thread of its own, and a participant that plays perception, robot and reader.
class ShapeNodeTest : public testing::Test {
 protected:
  explicit ShapeNodeTest(const NodeConfig& config = TestConfig(),
                         const std::vector<dds::FurtherCamera>& cameras = {})
      : node_(config, NodeTestRobot(), {}, static_cast<int>(dds::TestDomain()), ManyClouds(), {},
              script_.Maker(), cameras),
        test_("test", ManyClouds()),
        perception_(test_),
        forces_(test_.participant.CreateReader(dds::kForcesTopic, test_.Waker())),
        mesh_states_(test_.participant.CreateReader(dds::kMeshStateTopic, test_.Waker())),
        health_(test_.participant.CreateReader(dds::kComponentStatusTopic)),
        diagnostics_(test_.participant.CreateReader(dds::kDiagnosticsTopic)),
        thread_([this] { node_.Run(); }) {
    test_.loop.Attach(forces_, [this] { TakeForces(); });
    test_.loop.Attach(health_, [this] {
      for (const auto& message : health_.Take()) received_ = message.received;
    });
    test_.loop.Attach(diagnostics_, [this] {
      for (const auto& message : diagnostics_.Take()) TakeDiagnostics(message.status._buffer[0]);
    });
    test_.loop.Attach(mesh_states_, [this] {
      for (const auto& message : mesh_states_.Take()) {
        mesh_state_ns_ = dds::StampNs(message.header.stamp);
        mesh_state_numbers_ = message.positions_m._length;
        mesh_state_stamps_ns_.push_back(mesh_state_ns_);
      }
    });
    EXPECT_TRUE(test_.WaitFor([this] {
      return perception_.IsMatched(true) && forces_.matched() == 1 && mesh_states_.matched() == 1;
    }));
  }
  ~ShapeNodeTest() override {
    script_.Hold(false);
    node_.Stop();
    thread_.join();
  }

  /// Clouds wait for slow readers, so that tests see what the node does, not what DDS drops.
  static dds::TopicTable ManyClouds() {
    return dds::TableWith("/perception/robot_cloud",
                          [](dds::TopicSettings& topic) { topic.depth = 32; });
  }

  struct Answer {
    std::int64_t stamp_ns = 0;
    std::string status, reason, device;
    std::vector<double> force_z_N;
    double age_s = 0.0, latency_s = 0.0;
  };

  void SendCable(std::int64_t stamp_ns) { perception_.SendCable(stamp_ns, kCable_m); }
  /// Sends the frame with its cable input and waits for the answer.
  Answer Ask(const Seen& seen) {
    SendCable(seen.stamp_ns);
    return AskWithoutCable(seen);
  }
  Answer AskWithoutCable(const Seen& seen) {
    const std::size_t before = answers_.size();
    perception_.Send(seen);
    EXPECT_TRUE(test_.WaitFor([&] {
      return answers_.size() > before && answers_.back().stamp_ns == seen.stamp_ns;
    })) << seen.stamp_ns;
    return answers_.empty() ? Answer() : answers_.back();
  }

  void TakeForces() {
    for (const auto& message : forces_.Take()) {
      Answer answer{dds::StampNs(message.header.stamp),
                    std::string(dds::Text(message.status)),
                    std::string(dds::Text(message.reason)),
                    std::string(dds::Text(message.recording)),
                    {},
                    message.age_s,
                    message.latency_s};
      for (const auto& force : dds::Elements(message.forces)) {
        answer.force_z_N.push_back(force.force_n.z);
      }
      answers_.push_back(std::move(answer));
    }
  }

  void TakeDiagnostics(const idl::diagnostic_msgs::DiagnosticStatus& status) {
    said_ = dds::Text(status.message);
    for (const auto& value : dds::Elements(status.values)) {
      values_[std::string(dds::Text(value.key))] = dds::Text(value.value);
    }
  }

  Script script_;
  ForceEstimationNode node_;
  dds::TestNode test_;
  test_support::PerceptionSender perception_;
  dds::Reader<idl::palpate_msgs::ForceArray> forces_;
  dds::Reader<idl::palpate_msgs::MeshState> mesh_states_;
  dds::Reader<idl::palpate_msgs::ComponentStatus> health_;
  dds::Reader<idl::diagnostic_msgs::DiagnosticArray> diagnostics_;
  std::uint64_t received_ = 0;  ///< by the node, as it says once a second
  std::vector<Answer> answers_;
  std::int64_t mesh_state_ns_ = 0;
  std::uint32_t mesh_state_numbers_ = 0;
  std::vector<std::int64_t> mesh_state_stamps_ns_;
  std::string said_;                           ///< on /diagnostics, last
  std::map<std::string, std::string> values_;  ///< there
  std::thread thread_;
};

}  // namespace palpate::force_estimation
