// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/images/robot_viewer.hpp"

#include <optional>

#include "components/perception/predicted_surface.hpp"

namespace palpate::command {

RobotViewer::RobotViewer(const perception::Config& config, const robot::RobotBody& body)
    : perception_(config), triangles_(body.boundary.DrawnTriangles()) {}

const perception::SegmentedFrame& RobotViewer::Look(const experiment::RgbdSequence& sequence,
                                                    std::size_t index,
                                                    const ExpectedNodes* expected) {
  if (opened_ != &sequence) perception_.SetCamera(sequence.camera);
  opened_ = &sequence;
  sequence.Read(index, &images_);
  images_.stamp_ns = sequence.frames[index].t_ns;
  std::optional<perception::PredictedSurface> surface;
  if (expected != nullptr) {
    surface =
        perception::MakePredictedSurface(expected->nodes_m, triangles_, expected->T_robot_camera);
  }
  return perception_.Update(images_, surface ? &*surface : nullptr).frame;
}

}  // namespace palpate::command
