// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "libs/rgbd/rgbd_camera.hpp"
#include "libs/rgbd/rgbd_frame.hpp"

namespace palpate::gige_vision {

/// What the network does to packets on their way, to test clients with.
struct Impairment {
  double loss = 0.0;          ///< share of stream packets that are not sent (resends too)
  double resend_loss = -1.0;  ///< share of resends that are not sent; < 0: as `loss`
  std::uint64_t seed = 1;
};

/// Faults in what a camera reports of itself, for tests of clients. Both are called by the device,
/// which they must not call; absent: the truth.
struct DescriptionFaults {
  /// From the sound GenICam XML to the one that clients get (any bytes; edits in
  /// description_faults.hpp).
  std::function<std::string(const std::string& xml)> edit_xml;
  /// Changes what clients read of a feature's register: its bytes, big-endian, as long as they are
  /// (integers, booleans, enumerations 4, floats 8 bytes).
  std::function<void(const std::string& feature, std::vector<std::uint8_t>* value)> edit_value;
};

struct DeviceSettings {
  std::string interface_address = "127.0.0.1";  ///< IPv4 of the interface to answer on
  std::string vendor = "Palpate";
  std::string model = "Virtual RGB-D";
  std::string serial = "VC000001";
  std::string user_name = "virtual camera";
  double rate_hz = 30.0;
  bool confidence = false;  ///< a third part
  double heartbeat_timeout_s = 3.0;
  Impairment impairment;
  DescriptionFaults faults;
};

struct DeviceCounters {
  std::uint64_t frames_sent = 0;
  std::uint64_t frames_skipped = 0;  ///< the client or the network was too slow
  std::uint64_t packets_sent = 0;
  std::uint64_t packets_withheld = 0;
  std::uint64_t packets_resent = 0;
  std::uint64_t resend_refused = 0;  ///< of a frame that is gone
};

/// A GigE Vision 2.0 device on UDP port 3956 of one interface: GVCP (discovery, registers, memory,
/// heartbeat, control privilege, packet resend, timestamp latch) and GVSP (multi-part Range +
/// Intensity (+ Confidence), 64-bit block ids), with a GenICam description of a 3-D camera
/// (Scan3d, components, transport layer). Runs in threads of its own; thread-safe.
class Device {
 public:
  /// Throws RunError where the port is taken or the address is not one of this machine.
  Device(const DeviceSettings& settings, const rgbd::RgbdCamera& camera);
  ~Device();  ///< leaves the network at once, without a word, as a camera that loses power
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  /// True while a client streams.
  bool streaming() const;
  /// Sends the frame if a client streams, copied; never blocks for longer than the copy. A frame
  /// that comes while one is being sent and another waits is skipped and counted. Its stamp is on
  /// the host's wall clock, which is the device's clock (until a client resets that to 0).
  void Send(const rgbd::RgbdFrame& frame);
  DeviceCounters counters() const;
  std::string Describe() const;  ///< the GenICam XML

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace palpate::gige_vision
