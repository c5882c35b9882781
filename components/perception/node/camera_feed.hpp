// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "components/perception/node/camera_streams.hpp"
#include "components/perception/node/worker.hpp"
#include "libs/core/repetition_check.hpp"

namespace palpate::perception {

/// One camera of the node: its streams, and what perception knows of it.
class CameraFeed {
 public:
  /// `config`: settings of perception, in which the noise is replaced by what the camera reports.
  /// `name`: empty for the first camera.
  CameraFeed(const Config& config, std::string name, std::unique_ptr<CameraStreams> streams)
      : config_(config), name_(std::move(name)), streams_(std::move(streams)) {}

  const std::string& name() const { return name_; }
  CameraStreams& streams() { return *streams_; }
  const CameraStreams& streams() const { return *streams_; }

  /// What perception knew of the camera is void: the next job says it again.
  void Forget() { is_forgotten_ = true; }
  /// A sequence of frames begins: an image may come that was there before.
  void BeginSequence() { repetition_.Forget(); }
  /// Whether the next job starts the camera's part of perception again.
  bool Resets() const { return is_forgotten_ || streams_->subpixel_sigma_px() != sigma_px_; }

  /// kStale for an image that comes again under a new stamp. It is no measurement: forces of it
  /// would be those of the past.
  Status CheckIsNew(const FrameSet& set);

  /// Where a set is from; nullptr: where the camera's sets are from.
  CameraOrigin OriginOf(const FrameSet* set) const;
  /// The camera's part of the frame of `stamp_ns`, without pose and prediction; takes the images.
  CameraJob MakeJob(FrameSet& set, const rgbd::RgbdCamera& camera, std::int64_t stamp_ns);

 private:
  Config config_;
  std::string name_;
  std::unique_ptr<CameraStreams> streams_;
  bool is_forgotten_ = true;
  std::optional<rgbd::RgbdCamera> set_;  ///< the camera that perception knows
  std::uint64_t set_setups_ = 0;         ///< of streams_, when it was set
  std::optional<double> sigma_px_;       ///< of the disparity, that perception knows
  std::uint32_t last_epoch_ = 0;
  RepetitionCheck repetition_;  ///< of depth images
};

}  // namespace palpate::perception
