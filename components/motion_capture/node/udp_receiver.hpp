// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace palpate::motion_capture {

/// Receives datagrams in a thread of its own.
class UdpReceiver {
 public:
  using OnDatagram = std::function<void(std::vector<std::uint8_t>)>;

  /// `group`: multicast group to join; empty: none. `on_datagram` is called from the thread. Throws
  /// RunError where the system refuses, InputError for an address that is none.
  UdpReceiver(const std::string& interface_address, const std::string& group, int port,
              OnDatagram on_datagram);
  ~UdpReceiver();
  UdpReceiver(const UdpReceiver&) = delete;
  UdpReceiver& operator=(const UdpReceiver&) = delete;

 private:
  void Receive();

  int socket_;
  OnDatagram on_datagram_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace palpate::motion_capture
