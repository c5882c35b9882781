// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <map>
#include <string>
#include <vector>

#include "components/force_estimation/node/frame_input.hpp"
#include "components/force_estimation/node/wrench_slots.hpp"
#include "libs/dds/participant.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::force_estimation {

/// The writers of the node. All calls come from the node's loop.
class Outputs {
 public:
  /// Publishes the mesh and the robot's description, which are latched. `body` must outlive this.
  /// `answer_always`: every frame is answered on /robot/mesh_state, too, if need be without
  /// positions; else only those that were estimated. `given_contacts`: names of the contacts that
  /// the settings give.
  Outputs(dds::Participant& participant, const robot::RobotBody& body, bool answer_always,
          std::vector<std::string> given_contacts);

  void Publish(const FrameResult& result);
  /// Publishes the posture on /robot/mesh_state: perception predicts the first image from it.
  void PublishPosture(const FrameResult& result);
  /// Publishes on /forces why a frame has no estimate.
  void PublishRefusal(const FrameHead& head, const Status& status);
  /// Publishes on /forces that no frame has come since the last answer.
  void PublishSilence(const Status& status);
  /// Publishes the last answer again where it is that of `head`.
  void Repeat(const FrameHead& head);

  uint64_t published() const { return forces_.sent_count(); }
  /// Messages that DDS refused, and wrenches beyond the 64 contacts that may be there at once.
  uint64_t failed() const;
  uint32_t readers() const { return forces_.matched(); }
  /// Times from taking a frame to publishing since the last call, s.
  std::vector<double> TakeLatencies();

 private:
  void Answer(const FrameHead& head, dds::Message<idl::palpate_msgs::ForceArray> message);
  void Send(const FrameHead& head, dds::Message<idl::palpate_msgs::ForceArray>& message);
  void SendMeshState(dds::Message<idl::palpate_msgs::MeshState> message);
  void PublishWrenches(const FrameHead& head, const std::vector<ContactForce>& contacts);
  /// Returns the topic; empty: no slot is free.
  std::string PublishWrench(int64_t stamp_ns, const ContactForce& contact);

  dds::Participant& participant_;
  const robot::RobotBody& body_;
  bool answer_always_;
  dds::Writer<idl::palpate_msgs::ForceArray> forces_;
  dds::Writer<idl::palpate_msgs::MeshState> mesh_state_;
  dds::Writer<idl::palpate_msgs::Mesh> mesh_;
  dds::Writer<idl::palpate_msgs::ModelGap> model_gap_;
  dds::Writer<idl::palpate_msgs::WrenchArray> wrench_array_;
  dds::Writer<idl::std_msgs::String> description_;
  WrenchSlots wrench_slots_;
  std::map<std::string, dds::Writer<idl::geometry_msgs::WrenchStamped>> wrenches_;  ///< by <name>
  FrameHead last_head_;
  dds::Message<idl::palpate_msgs::ForceArray> last_forces_;
  bool answered_ = false;
  uint64_t failed_ = 0;
  uint64_t mesh_state_counter_ = 0;
  uint64_t model_gap_counter_ = 0;
  uint64_t forces_counter_ = 0;
  uint64_t wrench_array_counter_ = 0;
  std::vector<double> latencies_s_;
};

}  // namespace palpate::force_estimation
