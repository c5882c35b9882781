// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/images/see_clouds.hpp"

#include "components/palpate/progress_line.hpp"

namespace palpate::command {

std::vector<calibration::CloudFrame> SeeClouds(const std::vector<offline::ImageSample>& samples,
                                               const perception::Config& config,
                                               const robot::RobotBody& body,
                                               const std::vector<ExpectedNodes>& expected,
                                               std::vector<std::string>* left_out) {
  RobotViewer viewer(config, body);
  std::vector<calibration::CloudFrame> frames;
  ProgressLine progress("images", static_cast<int>(samples.size()));
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const offline::ImageSample& sample = samples[k];
    const perception::SegmentedFrame& seen =
        viewer.Look(*sample.images, sample.index, expected.empty() ? nullptr : &expected[k]);
    if (seen.status.ok()) {
      frames.push_back(sample.frame);
      frames.back().cloud = seen.robot;
    } else {
      left_out->push_back(sample.frame.name + ": " + seen.status.message());
    }
    progress.Update(static_cast<int>(k) + 1);
  }
  return frames;
}

}  // namespace palpate::command
