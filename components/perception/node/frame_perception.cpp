// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/frame_perception.hpp"

namespace palpate::perception {

namespace {

class RealPerception : public FramePerception {
 public:
  explicit RealPerception(const Config& config) : perception_(config) {}
  void SetCamera(std::size_t number, const rgbd::RgbdCamera& camera) override {
    perception_.SetCamera(number, camera);
  }
  void Restart(std::size_t number, const Config& config) override {
    perception_.Restart(number, config);
  }
  const JointObservation& Update(std::int64_t stamp_ns,
                                 const std::vector<CameraFrame>& frames) override {
    return perception_.Update(stamp_ns, frames);
  }

 private:
  JointPerception perception_;
};

}  // namespace

std::unique_ptr<FramePerception> MakeFramePerception(const Config& config) {
  return std::make_unique<RealPerception>(config);
}

}  // namespace palpate::perception
