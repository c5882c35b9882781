// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <map>

#include "components/diagnosis/surface/surface_source.hpp"
#include "components/palpate/images/robot_viewer.hpp"
#include "libs/experiment/experiment.hpp"

namespace palpate::command {

/// The robot's point clouds, segmented from the depth images or clouds of an experiment.
class SurfaceImages final : public diagnosis::SurfaceSource {
 public:
  /// Both must outlive it. Throws InputError for settings that do not go together.
  SurfaceImages(const experiment::Experiment& experiment, const robot::RobotBody& body,
                const perception::Config& config);

  diagnosis::SegmentedCloud Segment(int recording, int frame,
                                    const diagnosis::ExpectedShape& expected) override;
  rgbd::RgbdCamera Camera(int recording) override;

 private:
  const experiment::RgbdSequence& SequenceOf(int recording);

  const experiment::Experiment& experiment_;
  RobotViewer viewer_;
  std::map<int, experiment::RgbdSequence> sequences_;  ///< by recording
};

/// Whether any recording holds depth images or clouds.
bool HasSurfaceImages(const experiment::Experiment& experiment);

}  // namespace palpate::command
