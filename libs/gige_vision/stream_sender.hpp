// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "libs/gige_vision/control_channel.hpp"
#include "libs/gige_vision/device.hpp"
#include "libs/gige_vision/packet_batch.hpp"
#include "libs/gige_vision/stream_block.hpp"
#include "libs/gige_vision/udp_socket.hpp"

namespace palpate::gige_vision {

/// GVSP: sends frames in a thread of its own, a few packets at a time, spread over the time of a
/// frame (or as the client's packet delay says), and keeps the last ones for resends. Thread-safe.
class StreamSender {
 public:
  using Ticket = std::uint64_t;

  StreamSender(const Interface& interface, double rate_hz, const Impairment& impairment);
  ~StreamSender();

  std::uint16_t source_port() const { return socket_.port(); }
  /// The client has opened the channel: block ids begin with 1; or closed it: what is being sent
  /// ends, what is kept is forgotten.
  void Reset();
  /// Leave to offer a frame to the present client; nothing where a frame waits already,
  /// which is counted as skipped.
  std::optional<Ticket> Ask();
  /// Takes a copy of the frame. Only one thread asks and offers. Never waits for the network: one
  /// frame may wait while another is being sent.
  void Offer(Ticket ticket, const StreamPlan& plan, const rgbd::RgbdFrame& frame,
             std::uint64_t timestamp_ns);
  void Resend(const ResendRequest& asked);
  /// One packet of the size of `plan`.
  void SendTest(const StreamPlan& plan);
  DeviceCounters counters() const;

 private:
  using Time = std::chrono::steady_clock::time_point;
  struct Kept {
    std::shared_ptr<StreamBlock> block;
    std::uint32_t sent = 0;  ///< packets that have had their turn
  };

  void Run();
  /// False: given up.
  bool Transmit(const StreamBlock& block, Ticket generation);
  void SendPiece(const StreamBlock& block, std::uint32_t first, std::uint32_t count);
  bool Pause(Time until, Ticket generation);
  std::shared_ptr<StreamBlock> EmptyBlock();
  std::uint64_t NextId(bool extended_ids);
  void Refuse(const ResendRequest& asked);
  bool Withheld(double share, std::uint64_t block_id, std::uint64_t packet_id,
                std::uint64_t attempt) const;

  const double period_s_;
  const Impairment impairment_;
  UdpSocket socket_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool stop_ = false;
  Ticket generation_ = 0;              ///< changes when no client wants what is being sent
  std::shared_ptr<StreamBlock> next_;  ///< waits for the one that is being sent
  std::deque<Kept> kept_;              ///< the oldest first
  StreamPlan last_plan_;
  std::uint64_t last_id_ = 0;
  std::uint64_t resends_ = 0;
  DeviceCounters counters_;
  std::thread thread_;
};

}  // namespace palpate::gige_vision
