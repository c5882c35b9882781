// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/replay/replay_source.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "libs/core/clock.hpp"
#include "libs/core/error.hpp"

namespace palpate::capture {

namespace {

constexpr std::int64_t kUsualStep_ns = 33'333'333;

double ValidRatio(const rgbd::DepthImage& depth, int invalid_value) {
  if (depth.empty()) return 0.0;
  const auto valid = std::count_if(depth.values.begin(), depth.values.end(),
                                   [&](std::uint16_t z) { return z != invalid_value; });
  return static_cast<double>(valid) / static_cast<double>(depth.values.size());
}

}  // namespace

ReplaySource::ReplaySource(const ReplayConfig& config, std::size_t queue_frames,
                           const ConfigLoader& load)
    : config_{config},
      pool_{queue_frames + 4},
      queue_{config.clock == "step" ? 1 : queue_frames},
      clock_{config.rate} {
  if (config.folder.empty()) throw InputError("replay.folder: which recording shall be played?");
  sequences_ = experiment::OpenRgbdSequences(config.folder, load);
  for (const experiment::RgbdSequence& sequence : sequences_) {
    health_.notes.insert(health_.notes.end(), sequence.notes.begin(), sequence.notes.end());
  }
  offset_ns_ = std::llround(config.stamp_offset_s * 1e9);
  health_.device = config.folder.filename().string();
  health_.model = "recording";
  health_.reason = "no frame was requested yet";
}

ReplaySource::~ReplaySource() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  stopping_.notify_all();
  queue_.Close();
  if (thread_.joinable()) thread_.join();
}

FramePtr ReplaySource::Next(double timeout_s) {
  if (!std::exchange(started_, true)) thread_ = std::thread([this] { Run(); });
  return queue_.Pop(timeout_s);
}

SourceHealth ReplaySource::Health() const {
  const std::lock_guard lock(mutex_);
  SourceHealth health = health_;
  health.frames_dropped += queue_.dropped();
  if (queue_.drained()) {
    health.state = SourceState::kEnded;
    health.reason = "the recording has ended";
    if (health.frames_failed > 0) {
      health.reason += "; " + std::to_string(health.frames_failed) +
                       " frames could not be read, the first: " + first_failure_;
    }
  }
  return health;
}

void ReplaySource::Run() {
  do {
    for (const experiment::RgbdSequence& sequence : sequences_) {
      if (!PlaySequence(sequence)) return;
    }
  } while (config_.loop);
  queue_.Close();
}

void ReplaySource::BeginEpoch(const experiment::RgbdSequence& sequence) {
  camera_ = std::make_shared<rgbd::RgbdCamera>(sequence.camera);
  const std::int64_t first_ns = sequence.frames.front().t_ns;
  if (health_.epoch > 0 && first_ns + offset_ns_ <= last_stamp_ns_) {
    const std::int64_t step_ns = last_step_ns_ > 0 ? last_step_ns_ : kUsualStep_ns;
    offset_ns_ = last_stamp_ns_ + step_ns - first_ns;
  }
  last_step_ns_ = 0;
  clock_.Restart(MonotonicNow_ns(), first_ns);
  const std::lock_guard lock(mutex_);
  ++health_.epoch;
  health_.state = SourceState::kStream;
  health_.reason.clear();
}

bool ReplaySource::PlaySequence(const experiment::RgbdSequence& sequence) {
  BeginEpoch(sequence);
  for (std::size_t i = 0; i < sequence.frames.size(); ++i) {
    if (real_time() && !WaitUntil(clock_.DueAt_ns(sequence.frames[i].t_ns))) return false;
    if (!PlayFrame(sequence, i)) return false;
  }
  return true;
}

bool ReplaySource::WaitUntil(std::int64_t due_ns) {
  std::unique_lock lock(mutex_);
  const auto wait = std::chrono::nanoseconds(std::max<std::int64_t>(0, due_ns - MonotonicNow_ns()));
  return !stopping_.wait_for(lock, wait, [this] { return stop_; });
}

bool ReplaySource::PlayFrame(const experiment::RgbdSequence& sequence, std::size_t index) {
  auto frame = pool_.Take();
  // Readers hold all frames: at real time this one is dropped, else it waits for them.
  while (!frame && !real_time()) {
    if (!WaitUntil(MonotonicNow_ns() + 1'000'000)) return false;
    frame = pool_.Take();
  }
  if (!frame) {
    const std::lock_guard lock(mutex_);
    ++health_.frames_dropped;
    return !stop_;
  }
  try {
    sequence.Read(index, &frame->images);
  } catch (const InputError& error) {
    CountFailure(error.what());
    return WaitUntil(0);
  }
  frame->camera = camera_;
  FrameFacts& facts = frame->facts;
  facts.frame_id = index;
  facts.stamp_device_ns = sequence.frames[index].t_ns;
  facts.stamp_host_ns = facts.stamp_device_ns + offset_ns_;
  facts.stamp_receive_ns = WallNow_ns();
  facts.clock_source = ClockSource::kReplay;
  facts.valid_ratio = ValidRatio(frame->images.depth, camera_->invalid_value);
  frame->images.stamp_ns = facts.stamp_host_ns;
  if (index > 0) last_step_ns_ = facts.stamp_host_ns - last_stamp_ns_;
  last_stamp_ns_ = facts.stamp_host_ns;
  {
    const std::lock_guard lock(mutex_);
    facts.epoch = health_.epoch;
    ++health_.frames;
  }
  if (!real_time()) return queue_.PushWhenRoom(std::move(frame));
  queue_.Push(std::move(frame));
  return true;
}

void ReplaySource::CountFailure(const std::string& reason) {
  const std::lock_guard lock(mutex_);
  if (health_.frames_failed == 0) first_failure_ = reason;
  ++health_.frames_failed;
  health_.last_failure = reason;
}

}  // namespace palpate::capture
