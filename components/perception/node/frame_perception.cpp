// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/frame_perception.hpp"

#include "components/perception/perception.hpp"

namespace palpate::perception {

namespace {

class RealPerception : public FramePerception {
 public:
  explicit RealPerception(const Config& config) : perception_(config) {}
  void SetCamera(const rgbd::RgbdCamera& camera) override { perception_.SetCamera(camera); }
  const Observation& Update(const rgbd::RgbdFrame& frame,
                            const PredictedSurface* predicted) override {
    return perception_.Update(frame, predicted);
  }

 private:
  Perception perception_;
};

}  // namespace

std::unique_ptr<FramePerception> MakeFramePerception(const Config& config) {
  return std::make_unique<RealPerception>(config);
}

}  // namespace palpate::perception
