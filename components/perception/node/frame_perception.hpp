// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>
#include <memory>

#include "components/perception/config.hpp"
#include "components/perception/observation.hpp"
#include "libs/rgbd/rgbd_camera.hpp"

namespace palpate::perception {

/// What the node runs on each frame: Perception, or what stands in for it in tests.
class FramePerception {
 public:
  virtual ~FramePerception() = default;
  virtual void SetCamera(const rgbd::RgbdCamera& camera) = 0;
  virtual const Observation& Update(const rgbd::RgbdFrame& frame,
                                    const PredictedSurface* predicted) = 0;
};

using FramePerceptionMaker = std::function<std::unique_ptr<FramePerception>(const Config&)>;

/// Perception itself. Throws InputError for settings that do not go together.
std::unique_ptr<FramePerception> MakeFramePerception(const Config& config);

}  // namespace palpate::perception
