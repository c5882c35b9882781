// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "components/perception/node/convert.hpp"

namespace palpate::perception {

/// The camera from its three topics: set-up and two lenses. Lenses older than the set-up are
/// those of a camera that was there before.
class CameraInputs {
 public:
  /// `prefix`: of the camera's topics, for messages.
  explicit CameraInputs(std::string prefix = "/camera") : prefix_(std::move(prefix)) {}

  void SetSetup(const idl::palpate_msgs::CameraSetup& message);
  void SetDepthLens(const idl::sensor_msgs::CameraInfo& message);
  void SetColorLens(const idl::sensor_msgs::CameraInfo& message);

  /// The camera of an epoch's frames. kNoCalibration where something has not come, or the camera is
  /// not calibrated; kInvalidInput where what came is nonsense. Without a colour lens: a camera
  /// without colour.
  Status CameraOf(std::uint32_t epoch, rgbd::RgbdCamera* camera) const;

  bool has_color_lens() const { return BelongsToSetup(color_); }
  /// "vendor-serial" or the replayed folder; empty before the first set-up.
  std::string device() const { return setup_ ? setup_->value.device : std::string(); }
  std::optional<double> subpixel_sigma_px() const {
    return setup_ ? setup_->value.subpixel_sigma_px : std::nullopt;
  }
  std::uint64_t setups() const { return setups_; }  ///< that came

 private:
  template <typename T>
  struct Received {
    std::int64_t stamp_ns = 0;
    Status status;
    T value;
  };
  using Lens = std::optional<Received<rgbd::CameraModel>>;

  void SetLens(const idl::sensor_msgs::CameraInfo& message, Lens* lens);
  bool BelongsToSetup(const Lens& lens) const {
    return lens && setup_ && lens->stamp_ns >= setup_->stamp_ns;
  }
  Status CheckDepthLens() const;
  Status CheckColorLens() const;

  std::string prefix_;
  std::optional<Received<CameraSetup>> setup_;
  Lens depth_;
  Lens color_;
  std::uint64_t setups_ = 0;
};

}  // namespace palpate::perception
