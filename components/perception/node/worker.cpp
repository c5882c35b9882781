// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/worker.hpp"

#include <memory>
#include <utility>

namespace palpate::perception {

std::function<PerceptionResult(PerceptionJob&)> MakePerceive(const Config& config,
                                                             FramePerceptionMaker maker) {
  std::shared_ptr<FramePerception> perception = maker(config);
  return [perception, maker = std::move(maker)](PerceptionJob& job) mutable -> PerceptionResult {
    if (job.reset) perception = maker(*job.reset);
    if (job.camera) perception->SetCamera(*job.camera);
    const PredictedSurface* predicted = job.prediction ? &job.prediction->surface : nullptr;
    job.outcome.observation = perception->Update(job.images, predicted);
    return {std::move(job.outcome), job.taken};
  };
}

}  // namespace palpate::perception
