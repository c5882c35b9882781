// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/estimate/frame_progress.hpp"

#include <fmt/core.h>

#include <string>

namespace palpate::command {

namespace {

std::string AdviceWhereSlow(const robot::RobotBody& body) {
  std::string advice =
      fmt::format("palpate estimate: slow with a mesh of {} nodes: --rate HZ leaves frames out",
                  body.mesh.NodeCount());
  if (body.mesh.element_type() == fem::ElementType::kTet10) {
    advice += "; element: tet4 is faster and stiffer (calibrate it again)";
  }
  return advice;
}

}  // namespace

void FrameProgress::Update(int done, int total) {
  if (done == 0 || !line_) {
    line_.emplace("frames", total);
    line_->SetAdvice(AdviceWhereSlow(body_));
  }
  if (done > 0) line_->Update(done);
}

}  // namespace palpate::command
