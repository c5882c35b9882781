// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/link/connection.hpp"

#include <algorithm>
#include <utility>

#include "libs/core/seconds.hpp"
#include "libs/core/text.hpp"

namespace palpate::capture {

namespace {

constexpr double kPeriodsUntilStale = 5.0;
constexpr double kAccessRetry_s = 0.2;

std::int64_t Ns(double seconds) { return static_cast<std::int64_t>(seconds * 1e9); }
}  // namespace

double Connection::StaleAfter_s() const {
  return std::max(times_.stale_s, kPeriodsUntilStale * period_s_);
}

Step Connection::Next(std::int64_t now_ns) {
  if (state_ == SourceState::kStream || state_ == SourceState::kStale) WatchFrames(now_ns);
  switch (state_) {
    case SourceState::kStream: return Step::kStream;
    case SourceState::kStale: return Step::kProbe;
    case SourceState::kConfigure: return now_ns < wake_ns_ ? Step::kWait : Step::kConfigure;
    case SourceState::kLost:
      if (std::exchange(open_, false)) return Step::kRelease;
      state_ = SourceState::kDiscover;
      break;
    default: break;
  }
  if (now_ns < wake_ns_) return Step::kWait;
  state_ = SourceState::kOpen;
  return Step::kOpen;
}

void Connection::WatchFrames(std::int64_t now_ns) {
  if (state_ == SourceState::kStream) {
    if (NsToSeconds(now_ns - last_frame_ns_) < StaleAfter_s()) return;
    state_ = SourceState::kStale;
    stale_since_ns_ = last_answer_ns_ = now_ns;
    reason_ = "no frame for " + FormatNumber(StaleAfter_s()) + " s";
  }
  if (NsToSeconds(now_ns - stale_since_ns_) >= times_.lost_s) {
    Lose(now_ns, frame_seen_ ? "frames stopped though the camera answers"
                             : "the camera is open but not one frame came: is its trigger on, or "
                               "do its packets not get through?");
  }
}

void Connection::OnOpened(std::int64_t now_ns) {
  state_ = SourceState::kConfigure;
  open_ = true;
  wake_ns_ = now_ns;
  denied_since_ns_ = -1;
}

void Connection::OnConfigured(std::int64_t now_ns, double period_s) {
  state_ = SourceState::kStream;
  reason_.clear();
  ++epoch_;
  period_s_ = period_s;
  frame_seen_ = false;
  last_frame_ns_ = now_ns;
  denied_since_ns_ = -1;
}

void Connection::OnFailed(std::int64_t now_ns, std::string reason) {
  Lose(now_ns, std::move(reason));
}

void Connection::OnAccessDenied(std::int64_t now_ns) {
  if (denied_since_ns_ < 0) denied_since_ns_ = now_ns;
  if (NsToSeconds(now_ns - denied_since_ns_) >= times_.access_denied_s) {
    Lose(now_ns, "another program controls the camera");
    return;
  }
  reason_ = "another program controls the camera, or did until just now: waiting";
  wake_ns_ = now_ns + Ns(kAccessRetry_s);
}

void Connection::OnFrame(std::int64_t now_ns) {
  if (state_ != SourceState::kStream && state_ != SourceState::kStale) return;
  state_ = SourceState::kStream;
  reason_.clear();
  last_frame_ns_ = now_ns;
  frame_seen_ = true;
  fruitless_streams_ = 0;
  back_off_s_ = 0.0;
}

void Connection::OnControlLost(std::int64_t now_ns) {
  if (state_ == SourceState::kStream || state_ == SourceState::kStale) {
    Lose(now_ns, "the control of the camera was lost");
  }
}

void Connection::OnProbe(std::int64_t now_ns, Probe probe) {
  if (state_ != SourceState::kStale) return;
  if (probe == Probe::kFree) {
    Lose(now_ns, "the camera has been off and on again");
  } else if (probe == Probe::kControlled) {
    last_answer_ns_ = now_ns;
  } else if (NsToSeconds(now_ns - last_answer_ns_) >= times_.silent_s) {
    Lose(now_ns, "the camera does not answer");
  }
}

void Connection::OnReturn(std::int64_t now_ns) {
  if (state_ == SourceState::kDiscover) wake_ns_ = std::min(wake_ns_, now_ns);
}

void Connection::Lose(std::int64_t now_ns, std::string reason) {
  if (state_ == SourceState::kStream || state_ == SourceState::kStale) {
    fruitless_streams_ = frame_seen_ ? 0 : fruitless_streams_ + 1;
  }
  state_ = SourceState::kLost;
  reason_ = std::move(reason);
  back_off_s_ = std::clamp(2.0 * back_off_s_, times_.first_back_off_s, times_.longest_back_off_s);
  wake_ns_ = now_ns + Ns(back_off_s_);
  denied_since_ns_ = -1;
}

}  // namespace palpate::capture
