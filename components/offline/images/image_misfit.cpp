// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/images/image_misfit.hpp"

#include <fmt/core.h>

namespace palpate::offline {

calibration::DepthMisfit FindImageMisfit(const std::vector<ImageSample>& samples,
                                         const rgbd::DepthNoise& noise,
                                         const calibration::DepthMisfitRequest& request,
                                         robot::RobotModel* model) {
  const std::vector<Eigen::VectorXd> shapes_m = ShapesOf(samples, model);
  std::vector<calibration::DepthSight> sights;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    rgbd::RgbdFrame frame;
    samples[k].images->Read(samples[k].index, &frame);
    sights.push_back({.name = samples[k].frame.name,
                      .camera = samples[k].images->camera,
                      .noise = noise,
                      .depth = std::move(frame.depth),
                      .x_m = shapes_m[k]});
  }
  return calibration::FindDepthMisfit(*model, sights, request);
}

std::string MisfitText(const calibration::MisfitReasons& reasons, const std::string& consequence) {
  return fmt::format(
      "the images do not fit the robot (misfit {:.0f} %); {}. Likely reasons, the best first:\n{}",
      100.0 * reasons.residual, consequence, reasons.Text());
}

}  // namespace palpate::offline
