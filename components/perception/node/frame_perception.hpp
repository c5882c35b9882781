// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "components/perception/config.hpp"
#include "components/perception/joint_perception.hpp"
#include "libs/rgbd/rgbd_camera.hpp"

namespace palpate::perception {

/// What the node runs on each frame: JointPerception, or what stands in for it in tests. Its
/// methods are those of JointPerception.
class FramePerception {
 public:
  virtual ~FramePerception() = default;
  virtual void SetCamera(std::size_t number, const rgbd::RgbdCamera& camera) = 0;
  virtual void Restart(std::size_t number, const Config& config) = 0;
  virtual const JointObservation& Update(std::int64_t stamp_ns,
                                         const std::vector<CameraFrame>& frames) = 0;
};

using FramePerceptionMaker = std::function<std::unique_ptr<FramePerception>(const Config&)>;

/// JointPerception itself. Throws InputError for settings that do not go together.
std::unique_ptr<FramePerception> MakeFramePerception(const Config& config);

}  // namespace palpate::perception
