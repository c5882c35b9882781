// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>

#include "components/capture/frame_source.hpp"
#include "components/capture/network/control_probe.hpp"

namespace palpate::capture {

/// Times of a camera's watchdog. docs/architecture.md, "Lost cameras".
struct ConnectionTimes {
  double stale_s = 1.0;             ///< no frame for so long, or for five periods: stale
  double silent_s = 0.4;            ///< stale, and no answer to probes for so long: lost
  double lost_s = 3.0;              ///< stale for so long: lost, whatever it answers
  double access_denied_s = 10.0;    ///< how long another client's control is waited for
  double first_back_off_s = 0.1;    ///< between attempts to open, doubled each time ...
  double longest_back_off_s = 2.0;  ///< ... up to this
};

enum class Step {
  kOpen,       ///< find and open the device, then say OnOpened or OnFailed
  kConfigure,  ///< take control, configure, read the description: OnConfigured or OnFailed
  kStream,     ///< wait for a frame
  kProbe,      ///< wait for a frame, and ask the device (OnProbe)
  kRelease,    ///< hand what was opened to the reaper
  kWait,       ///< nothing until wake_ns()
};

/// The states of one camera: DISCOVER -> OPEN -> CONFIGURE -> STREAM -> STALE -> LOST -> DISCOVER.
/// No device, no thread, no clock: each call says what time it is (monotonic, ns).
class Connection {
 public:
  explicit Connection(const ConnectionTimes& times) : times_(times) {}

  /// What is to be done now.
  Step Next(std::int64_t now_ns);

  void OnOpened(std::int64_t now_ns);
  /// Streaming has begun; `period_s` of the frames, 0: unknown. Raises the epoch.
  void OnConfigured(std::int64_t now_ns, double period_s);
  /// Opening or configuring failed, with the reason. What is open is released.
  void OnFailed(std::int64_t now_ns, std::string reason);
  /// The device is there but controlled by another client: asked again soon, nothing released.
  void OnAccessDenied(std::int64_t now_ns);
  void OnFrame(std::int64_t now_ns);
  void OnControlLost(std::int64_t now_ns);
  void OnProbe(std::int64_t now_ns, Probe probe);
  /// While waiting: the device answers again; try at once.
  void OnReturn(std::int64_t now_ns);

  SourceState state() const { return state_; }
  const std::string& reason() const { return reason_; }
  std::uint32_t epoch() const { return epoch_; }
  std::int64_t wake_ns() const { return wake_ns_; }
  /// Times in a row that the stream brought not one frame: its packets may be too large for the
  /// way.
  int fruitless_streams() const { return fruitless_streams_; }

 private:
  void Lose(std::int64_t now_ns, std::string reason);
  void WatchFrames(std::int64_t now_ns);
  double StaleAfter_s() const;

  ConnectionTimes times_;
  SourceState state_ = SourceState::kDiscover;
  std::string reason_ = "not opened yet";
  std::uint32_t epoch_ = 0;
  double period_s_ = 0.0;
  double back_off_s_ = 0.0;
  bool open_ = false;        ///< something is to be released
  bool frame_seen_ = false;  ///< since configured
  int fruitless_streams_ = 0;
  std::int64_t wake_ns_ = 0;
  std::int64_t last_frame_ns_ = 0;
  std::int64_t stale_since_ns_ = 0;
  std::int64_t last_answer_ns_ = 0;
  std::int64_t denied_since_ns_ = -1;
};

}  // namespace palpate::capture
