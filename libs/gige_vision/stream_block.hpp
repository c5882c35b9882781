// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "libs/gige_vision/camera_state.hpp"
#include "libs/rgbd/rgbd_frame.hpp"

namespace palpate::gige_vision {

/// A GVSP packet without IP and UDP: a head of its own and a piece of the block's pixels.
struct StreamPacket {
  static constexpr std::size_t kMaxHead = 256;  ///< a leader with as many parts as we know
  std::array<std::uint8_t, kMaxHead> head{};
  std::size_t head_size = 0;
  ByteView pixels;
};

/// One frame on its way: its pixels in the order of the wire, and how they are cut into packets:
/// 0 is the leader, the last one the trailer. A part begins with a new packet.
class StreamBlock {
 public:
  /// Copies what `plan` asks for. The frame has the sizes of the camera (no colour: black).
  void Fill(const StreamPlan& plan, const rgbd::RgbdFrame& frame, std::uint64_t id,
            std::uint64_t timestamp_ns);

  std::uint64_t id() const { return id_; }
  const StreamPlan& plan() const { return plan_; }
  std::uint32_t packet_count() const { return packet_count_; }
  /// `packet_id` < packet_count. `resent` marks the packet.
  void MakePacket(std::uint32_t packet_id, bool resent, StreamPacket* packet) const;
  /// The answer that a packet is no longer available.
  static void MakeRefusal(std::uint64_t block_id, std::uint32_t packet_id, bool extended_ids,
                          StreamPacket* packet);

 private:
  struct Part {
    StreamPlan::Component component;
    std::size_t offset = 0;  ///< in pixels_
    std::size_t size = 0;
    std::uint32_t first_packet = 0;
  };
  bool multipart() const { return parts_.size() > 1; }
  std::size_t PacketPayload() const;
  void CopyPixels(const rgbd::RgbdFrame& frame, const StreamPlan::Component& component,
                  std::uint8_t* to) const;
  void PutLeader(StreamPacket* packet) const;
  void PutTrailer(StreamPacket* packet) const;
  void PutPixels(std::uint32_t packet_id, StreamPacket* packet) const;

  StreamPlan plan_;
  std::uint64_t id_ = 0;
  std::uint64_t timestamp_ns_ = 0;
  std::uint32_t packet_count_ = 0;
  std::vector<Part> parts_;
  Bytes pixels_;
};

}  // namespace palpate::gige_vision
