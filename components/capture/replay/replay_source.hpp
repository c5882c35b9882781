// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "components/capture/config.hpp"
#include "components/capture/frame_source.hpp"
#include "components/capture/replay/replay_clock.hpp"
#include "components/capture/stream/frame_pool.hpp"
#include "components/capture/stream/frame_queue.hpp"
#include "libs/core/config_node.hpp"
#include "libs/experiment/images/rgbd_sequence.hpp"

namespace palpate::capture {

/// Frames from disk as if a camera took them now. Stamps are those of the files plus an offset;
/// each recording of an experiment, and each round of a loop, is an epoch of its own, its stamps
/// after those before. Frames that cannot be read are counted as failed, and the next one follows.
class ReplaySource : public FrameSource {
 public:
  /// Throws InputError where the folder holds no frames.
  ReplaySource(const ReplayConfig& config, std::size_t queue_frames, const ConfigLoader& load);
  ~ReplaySource() override;

  /// Begins with the first call.
  FramePtr Next(double timeout_s) override;
  SourceHealth Health() const override;

 private:
  void Run();
  /// False: to be stopped.
  bool PlaySequence(const experiment::RgbdSequence& sequence);
  bool PlayFrame(const experiment::RgbdSequence& sequence, std::size_t index);
  bool WaitUntil(std::int64_t due_ns);
  void BeginEpoch(const experiment::RgbdSequence& sequence);
  void CountFailure(const std::string& reason);
  bool real_time() const { return config_.clock == "real_time"; }

  ReplayConfig config_;
  std::vector<experiment::RgbdSequence> sequences_;
  FramePool pool_;
  FrameQueue queue_;
  ReplayClock clock_;
  std::shared_ptr<const rgbd::RgbdCamera> camera_;
  std::int64_t offset_ns_ = 0;      ///< added to the stamps of the files
  std::int64_t last_stamp_ns_ = 0;  ///< sent; of files plus offset
  std::int64_t last_step_ns_ = 0;   ///< between the last two
  mutable std::mutex mutex_;
  std::condition_variable stopping_;
  bool stop_ = false;
  bool started_ = false;
  SourceHealth health_;
  std::string first_failure_;  ///< why the first of `frames_failed` was not used
  std::thread thread_;
};

}  // namespace palpate::capture
