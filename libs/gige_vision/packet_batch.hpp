// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cstddef>

#include "libs/gige_vision/stream_block.hpp"
#include "libs/gige_vision/udp_socket.hpp"

namespace palpate::gige_vision {

/// Stream packets for one client that are given to the kernel in one call, pixels uncopied.
class PacketBatch {
 public:
  static constexpr std::size_t kCapacity = 32;

  explicit PacketBatch(const StreamPlan& plan);

  bool full() const { return size_ == kCapacity; }
  std::size_t size() const { return size_; }
  /// A packet to be filled in, which belongs to the batch from now on; its pixels must live until
  /// Send. Not where the batch is full.
  StreamPacket* Add();
  /// Empties the batch; how many packets the network took. One that it does not take (too large
  /// for the link, no receiver) is lost, as on a wire.
  std::size_t Send(const UdpSocket& socket);

 private:
  bool do_not_fragment_ = false;
  sockaddr_in to_{};
  std::size_t size_ = 0;
  std::array<StreamPacket, kCapacity> packets_;
};

}  // namespace palpate::gige_vision
