// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/node/robot_source.hpp"

#include "libs/core/status.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/message.hpp"

namespace palpate::view {

RobotSource::RobotSource(const KnownRobot& robot, PageFeed* feed) : robot_(robot), feed_(feed) {}

void RobotSource::Show(std::int64_t stamp_ns) {
  const robot::RobotBody& body = robot_.body();
  if (!has_told_mesh_) {
    feed_->Take(*dds::ToMesh({body.name, body.mesh_hash, body.mesh.nodes_m, body.mesh.cells,
                              body.boundary.DrawnTriangles()},
                             stamp_ns));
    feed_->TellFixedNodes();
    has_told_mesh_ = true;
  }
  auto state = dds::ToMeshState(body.mesh.nodes_m.reshaped(), body.mesh_hash, stamp_ns);
  state->counter = ++counter_;
  dds::SetText(state->status, ToString(StatusCode::kOk));
  feed_->Take(*state);
}

}  // namespace palpate::view
