// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/node/shown_mesh.hpp"

#include "components/view/frames/binary_frame.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/invalid_message.hpp"
#include "libs/dds/message.hpp"
#include "libs/dds/stamp.hpp"

namespace palpate::view {

Status ShownMesh::Take(const idl::palpate_msgs::Mesh& message) {
  Eigen::Matrix3Xd nodes_m;
  Eigen::Matrix3Xi triangles;
  if (Status read = dds::FromMesh(message, &nodes_m, &triangles); !read.ok()) return read;
  surface_ = MakePageSurface(std::string(dds::Text(message.mesh_hash)), nodes_m, triangles);
  positions_m_.clear();
  robot_ = dds::Text(message.robot);
  mesh_stamp_ns_ = dds::StampNs(message.header.stamp);
  return Status::Ok();
}

OutMessage ShownMesh::MeshMessage(const std::vector<float>& stiffness_Pa) const {
  BinaryFrame frame(
      kind_,
      {{"robot", robot_}, {"hash", surface_.hash}, {"stamp_ns", std::to_string(mesh_stamp_ns_)}});
  frame.Add("rest_m", surface_.rest_m);
  frame.Add("triangles", surface_.triangles);
  if (!stiffness_Pa.empty()) frame.Add("stiffness_Pa", stiffness_Pa);
  return BinaryMessage(kind_, frame.Bytes());
}

Status ShownMesh::Take(const idl::palpate_msgs::MeshState& message) {
  if (surface_.empty()) return dds::Invalid("the mesh of this state has not come yet");
  if (dds::Text(message.mesh_hash) != surface_.hash) {
    return dds::Invalid("a state of mesh '" + std::string(dds::Text(message.mesh_hash)) +
                        "' instead of '" + surface_.hash + "'");
  }
  Status read = dds::FromMeshState(message, surface_.node_count, &nodes_m_);
  if (!read.ok()) return read;
  positions_m_ = PositionsOf(surface_, nodes_m_);
  stamp_ns_ = dds::StampNs(message.header.stamp);
  counter_ = message.counter;
  status_ = dds::Text(message.status);
  return Status::Ok();
}

OutMessage ShownMesh::StateMessage(const std::vector<float>& residual_m) const {
  const std::string kind = kind_ + "_state";
  BinaryFrame frame(kind, {{"stamp_ns", std::to_string(stamp_ns_)},
                           {"counter", counter_},
                           {"status", status_},
                           {"hash", surface_.hash}});
  frame.Add("positions_m", positions_m_);
  if (!residual_m.empty()) frame.Add("residual_m", residual_m);
  return BinaryMessage(kind, frame.Bytes());
}

}  // namespace palpate::view
