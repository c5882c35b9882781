// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/capture_streams.hpp"

#include <utility>

#include "components/perception/node/image_size.hpp"
#include "libs/core/seconds.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/stamp.hpp"

namespace palpate::perception {

CaptureStreams::CaptureStreams(dds::Participant& participant, dds::WaitSet& loop, double wait_s,
                               StreamEvents events, const std::string& camera)
    : of_(dds::TopicsOf(camera)),
      wait_s_(wait_s),
      events_(std::move(events)),
      setups_(participant.CreateReader(of_.setup, {}, camera)),
      depth_lenses_(participant.CreateReader(of_.depth_lens, {}, camera)),
      color_lenses_(participant.CreateReader(of_.color_lens, {}, camera)),
      depths_(participant.CreateReader(of_.depth, {}, camera)),
      colors_(participant.CreateReader(of_.color, {}, camera)),
      infos_(participant.CreateReader(of_.frame_info, {}, camera)),
      camera_(of_.prefix),
      pairing_(FromSeconds(wait_s)) {
  loop.Attach(setups_, [this] { TakeCamera(); });
  loop.Attach(depth_lenses_, [this] { TakeCamera(); });
  loop.Attach(color_lenses_, [this] { TakeCamera(); });
  loop.Attach(depths_, [this] { TakeDepth(); });
  loop.Attach(colors_, [this] { TakeColor(); });
  loop.Attach(infos_, [this] { TakeFacts(); });
}

/// Colour is no needed input: a camera may have none.
void CaptureStreams::ExpectInputs(dds::InputMonitor& inputs) {
  const std::string capture = "palpate-capture";
  inputs.Expect(setups_, capture, dds::InputKind::kLatched);
  inputs.Expect(depth_lenses_, capture, dds::InputKind::kLatched);
  inputs.Expect(depths_, capture);
  inputs.Expect(infos_, capture);
}

/// Comes before the frames that are taken with it: who takes frames asks for it first.
void CaptureStreams::TakeCamera() {
  for (const auto& message : setups_.Take()) {
    camera_.SetSetup(message);
    pairing_.Restart(dds::StampNs(message.header.stamp), message.epoch);
  }
  for (const auto& message : depth_lenses_.Take()) camera_.SetDepthLens(message);
  for (const auto& message : color_lenses_.Take()) camera_.SetColorLens(message);
}

/// Where the part belongs; nullptr, and counted, where it is too late.
template <typename Message>
FrameSet* CaptureStreams::PartOf(const Message& message) {
  FrameSet* set = pairing_.At(dds::StampNs(message.header.stamp), std::chrono::steady_clock::now());
  if (!set) ++dropped_;
  return set;
}

void CaptureStreams::TakeDepth() {
  TakeCamera();
  for (const auto& message : depths_.Take()) {
    CountDepth();
    const std::int64_t stamp_ns = dds::StampNs(message.header.stamp);
    if (stamp_ns == pairing_.last_stamp_ns()) {
      events_.repeated(stamp_ns);
      continue;
    }
    FrameSet* set = PartOf(message);
    if (!set) continue;
    const Status status = FromDepthImage(message, of_, &set->depth.emplace());
    if (!status.ok()) set->status = {status.code(), depths_.ros_name() + ": " + status.message()};
  }
  events_.changed();
}

void CaptureStreams::TakeColor() {
  TakeCamera();
  for (const auto& message : colors_.Take()) {
    if (dds::StampNs(message.header.stamp) == pairing_.last_stamp_ns()) continue;
    FrameSet* set = PartOf(message);
    if (!set) continue;
    const Status status = FromColorImage(message, of_, &set->color.emplace());
    if (!status.ok()) set->status = {status.code(), colors_.ros_name() + ": " + status.message()};
  }
  events_.changed();
}

void CaptureStreams::TakeFacts() {
  TakeCamera();
  for (const auto& message : infos_.Take()) {
    if (dds::StampNs(message.header.stamp) == pairing_.last_stamp_ns()) continue;
    if (FrameSet* set = PartOf(message))
      set->facts = {message.counter, message.epoch, message.stamp_receive_ns};
  }
  events_.changed();
}

std::optional<FrameSet> CaptureStreams::Take(Time now) {
  return pairing_.Take([this](const FrameSet& set) { return IsWhole(set); }, now);
}

bool CaptureStreams::IsWhole(const FrameSet& set) const {
  if (!set.status.ok()) return true;
  if (!set.depth || !set.facts) return false;
  rgbd::RgbdCamera camera;
  const Status known = camera_.CameraOf(set.facts->epoch, &camera);
  if (!known.ok()) return known.code() == StatusCode::kInvalidInput;
  if (camera_.has_color_lens()) return set.color.has_value();
  // A camera without colour: so it was found to be when the first frame of the epoch was overdue.
  return colorless_setup_ == camera_.setups() && !set.color;
}

Status CaptureStreams::Examine(const FrameSet& set, rgbd::RgbdCamera* camera) {
  if (!set.status.ok()) return set.status;
  const auto late = [&](const std::string& topic) {
    return Status(StatusCode::kStale,
                  "nothing of this stamp on " + topic + " within " + FormatNumber(wait_s_) + " s");
  };
  if (!set.facts) return late(infos_.ros_name());
  if (Status known = camera_.CameraOf(set.facts->epoch, camera); !known.ok()) return known;
  if (Status size = CheckDepthSize(*set.depth, camera->depth); !size.ok()) return size;
  if (!camera_.has_color_lens()) {
    if (set.color) {
      return {StatusCode::kNoCalibration,
              "no " + color_lenses_.ros_name() + " of this epoch has come"};
    }
    colorless_setup_ = camera_.setups();
    return Status::Ok();
  }
  if (!set.color) return late(colors_.ros_name());
  return CheckColorSize(*set.color, camera->color);
}

}  // namespace palpate::perception
