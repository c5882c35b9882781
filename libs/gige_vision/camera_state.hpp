// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "libs/core/clock.hpp"
#include "libs/gige_vision/device.hpp"
#include "libs/gige_vision/protocol.hpp"
#include "libs/gige_vision/register_bank.hpp"

namespace palpate::gige_vision {

/// A rectangle of a sensor, px.
struct Region {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t offset_x = 0;
  std::uint32_t offset_y = 0;
};

/// Where frames go to, and what is in them.
struct StreamPlan {
  struct Component {
    ComponentId id = ComponentId::kRange;
    Region region;
  };
  std::uint32_t address = 0;  ///< IPv4 of the client
  std::uint16_t port = 0;
  std::uint32_t packet_size = 0;  ///< with IP and UDP headers
  bool do_not_fragment = false;
  std::uint32_t packet_delay_ns = 0;  ///< 0: up to the device
  bool extended_ids = true;           ///< 64-bit block ids
  std::uint16_t invalid_depth = 0;    ///< of a pixel without depth
  std::vector<Component> components;
};

/// Who the device is on the network.
struct Identity {
  std::uint32_t address = 0;  ///< IPv4
  std::uint32_t mask = 0;
  std::uint64_t mac = 0;
  std::uint16_t stream_source_port = 0;
};

/// The registers of the camera and what they do. Not thread-safe.
class CameraState {
 public:
  CameraState(const DeviceSettings& settings, const rgbd::RgbdCamera& camera,
              const Identity& identity, Clock wall_clock);

  RegisterBank& bank() { return bank_; }
  const RegisterBank& bank() const { return bank_; }
  const Identity& identity() const { return identity_; }
  const std::string& description() const { return description_; }

  /// While a client has started acquisition and named a destination: what to send.
  std::optional<StreamPlan> Plan() const;
  /// Whether the client wants a frame that comes now; counts frames (SingleFrame, MultiFrame) and
  /// leaves out some where a lower rate is asked for.
  bool TakeFrame();
  /// On the device's clock, of a stamp on the wall clock.
  std::uint64_t Timestamp_ns(std::int64_t stamp_ns) const;
  /// The client has left: acquisition ends, the channels are closed.
  void ForgetClient();

  std::function<void(const StreamPlan&)> on_test_packet;  ///< is asked for
  std::function<void(bool open)> on_stream_channel;       ///< was opened or closed

 private:
  struct BootstrapLine {
    const char* name;
    std::uint32_t address;
    std::uint32_t value;
    bool writable = false;
  };
  void AddBootstrap(const std::vector<BootstrapLine>& lines);
  void AddInterface();
  void AddControl(double heartbeat_timeout_s);
  void AddChannels();
  void AddNames(const DeviceSettings& settings);
  void AddDescription(const std::string& text);
  void WireAcquisition();
  void WireClock();
  void WireStreamChannel();
  void WireRegions();
  StreamPlan Destination() const;
  std::uint64_t PayloadSize_B() const;
  Region RegionOf(std::size_t component) const;
  void Latch();

  Clock wall_clock_;
  std::vector<ComponentId> components_;
  Identity identity_;
  RegisterBank bank_;
  std::string description_;
  double rate_hz_ = 0.0;
  std::uint16_t invalid_depth_ = 0;
  std::int64_t started_ns_ = 0;
  bool acquiring_ = false;
  std::uint32_t frames_left_ = 0;  ///< of SingleFrame and MultiFrame
  double rate_credit_ = 0.0;       ///< 1: a frame is due
  std::int64_t clock_zero_ns_ = 0;
  std::uint64_t latched_ns_ = 0;
};

}  // namespace palpate::gige_vision
