// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/worker.hpp"

#include <memory>
#include <utility>

namespace palpate::perception {

namespace {

std::vector<CameraFrame> FramesOf(const PerceptionJob& job) {
  std::vector<CameraFrame> frames(job.cameras.size());
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const CameraJob& camera = job.cameras[k];
    frames[k].T_robot_camera = camera.T_robot_camera;
    if (!job.outcome.cameras[k].status.ok()) continue;
    frames[k].images = &camera.images;
    if (camera.prediction) frames[k].predicted = &camera.prediction->surface;
  }
  return frames;
}

}  // namespace

std::function<PerceptionResult(PerceptionJob&)> MakePerceive(const Config& config,
                                                             FramePerceptionMaker maker) {
  std::shared_ptr<FramePerception> perception = maker(config);
  return [perception, config,
          maker = std::move(maker)](PerceptionJob& job) mutable -> PerceptionResult {
    // The first camera's settings are those of all, until each is started again with its own.
    if (job.cameras[0].reset) {
      perception = maker(*job.cameras[0].reset);
    } else if (job.begins) {
      perception = maker(config);
    }
    for (std::size_t k = 0; k < job.cameras.size(); ++k) {
      const CameraJob& camera = job.cameras[k];
      if (k > 0 && camera.reset) perception->Restart(k, *camera.reset);
      if (camera.camera) perception->SetCamera(k, *camera.camera);
    }
    std::vector<CameraOrigin>& origins = job.outcome.cameras;
    job.outcome.observation = perception->Update(job.outcome.stamp_ns, FramesOf(job));
    for (std::size_t k = 0; k < origins.size(); ++k) {
      if (!origins[k].status.ok()) {
        job.outcome.observation.views[k].frame.status = origins[k].status;
      }
    }
    return {std::move(job.outcome), job.taken};
  };
}

}  // namespace palpate::perception
