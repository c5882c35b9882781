// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <limits>

#include "components/force_estimation/node/convert.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/ros_names.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"

namespace palpate::force_estimation {

namespace {

const Eigen::Vector3d kUnknown =
    Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());

void SetHeader(idl::std_msgs::Header& header, int64_t stamp_ns) {
  dds::SetHeader(header, stamp_ns, geometry::kRobotFrame);
}

void SetWrench(geometry_msgs_msg_dds__Wrench_& target, const ContactForce& contact) {
  dds::SetVector(target.force, contact.force_N);
  dds::SetVector(target.torque, contact.position_m.cross(contact.force_N));
}

void Fill(const ModelGapPart& part, palpate_msgs_msg_dds__ModelGapPart_& target) {
  dds::SetText(target.name, part.name);
  target.residual_rms_m = part.residual_rms_m;
  target.noise_rms_m = part.noise_rms_m;
  target.sample_count = static_cast<uint32_t>(part.sample_count);
}

template <typename Sequence>
void Fill(const std::vector<ModelGapPart>& parts, Sequence& target) {
  dds::Resize(target, parts.size());
  for (size_t i = 0; i < parts.size(); ++i) Fill(parts[i], target._buffer[i]);
}

}  // namespace

dds::Message<idl::palpate_msgs::ForceArray> ToForceArray(
    const FrameHead& head, const Status& status, const std::vector<ContactForce>& contacts) {
  dds::Message<idl::palpate_msgs::ForceArray> message;
  SetHeader(message->header, head.stamp_ns);
  dds::SetText(message->recording, head.recording);
  message->marker_counter = head.counter;
  dds::SetText(message->status, ToString(status.code()));
  dds::SetText(message->reason, status.message());
  dds::Resize(message->forces, contacts.size());
  for (size_t i = 0; i < contacts.size(); ++i) {
    const ContactForce& contact = contacts[i];
    auto& force = message->forces._buffer[i];
    dds::SetText(force.name, contact.name);
    dds::SetVector(force.position_m, contact.position_m);
    const bool known = contact.status.code() != StatusCode::kUnobservable;
    dds::SetVector(force.force_n, known ? contact.force_N : kUnknown);
    force.ci95_n = known ? contact.ci95_N : kUnknown.x();
    Eigen::Matrix3d::Map(force.covariance_n2) =
        known ? contact.covariance_N2 : Eigen::Matrix3d::Constant(kUnknown.x());
    force.location_ci95_m = contact.location_ci95_m;
    Eigen::Matrix3d::Map(force.location_covariance_m2) = contact.location_covariance_m2;
    dds::SetText(force.status, ToString(contact.status.code()));
    dds::SetText(force.reason, contact.status.message());
  }
  return message;
}

dds::Message<idl::geometry_msgs::WrenchStamped> ToWrench(int64_t stamp_ns,
                                                         const ContactForce& contact) {
  dds::Message<idl::geometry_msgs::WrenchStamped> message;
  SetHeader(message->header, stamp_ns);
  SetWrench(message->wrench, contact);
  return message;
}

dds::Message<idl::palpate_msgs::WrenchArray> ToWrenchArray(
    int64_t stamp_ns, const std::vector<ContactWrench>& wrenches) {
  dds::Message<idl::palpate_msgs::WrenchArray> message;
  SetHeader(message->header, stamp_ns);
  dds::Resize(message->wrenches, wrenches.size());
  for (size_t i = 0; i < wrenches.size(); ++i) {
    auto& target = message->wrenches._buffer[i];
    dds::SetText(target.name, wrenches[i].contact.name);
    dds::SetText(target.topic, wrenches[i].topic);
    SetWrench(target.wrench, wrenches[i].contact);
  }
  return message;
}

dds::Message<idl::palpate_msgs::MeshState> ToMeshState(const FrameResult& result,
                                                       const std::string& mesh_hash) {
  auto message = NoMeshState(result.head, result.state, mesh_hash);
  if (!result.state_is_known) return message;
  const Eigen::VectorXd& x_m = result.estimate.x_m;
  dds::SetNumbers(message->positions_m, x_m.data(), static_cast<size_t>(x_m.size()));
  return message;
}

dds::Message<idl::palpate_msgs::MeshState> NoMeshState(const FrameHead& head, const Status& status,
                                                       const std::string& mesh_hash) {
  dds::Message<idl::palpate_msgs::MeshState> message;
  SetHeader(message->header, head.stamp_ns);
  dds::SetText(message->mesh_hash, mesh_hash);
  dds::SetText(message->status, ToString(status.code()));
  return message;
}

dds::Message<idl::palpate_msgs::Mesh> ToMesh(const robot::RobotBody& body, int64_t stamp_ns) {
  return dds::ToMesh({body.name, body.mesh_hash, body.mesh.nodes_m, body.mesh.cells,
                      body.boundary.DrawnTriangles()},
                     stamp_ns);
}

dds::Message<idl::std_msgs::String> ToDescription(const robot::RobotBody& body) {
  const Eigen::Vector3d lowest_m = body.mesh.nodes_m.rowwise().minCoeff();
  const Eigen::Vector3d highest_m = body.mesh.nodes_m.rowwise().maxCoeff();
  const auto numbers = [](const Eigen::Vector3d& v) {
    return FormatNumber(v.x()) + " " + FormatNumber(v.y()) + " " + FormatNumber(v.z());
  };
  dds::Message<idl::std_msgs::String> message;
  dds::SetText(message->data,
               "<?xml version=\"1.0\"?>\n<robot name=\"" + dds::RosNamePart(body.name) +
                   "\">\n  <link name=\"" + std::string(geometry::kRobotFrame) +
                   "\">\n    <visual>\n      <origin xyz=\"" +
                   numbers(0.5 * (lowest_m + highest_m)) + "\"/>\n      <geometry><box size=\"" +
                   numbers(highest_m - lowest_m) +
                   "\"/></geometry>\n      <material name=\"body\"><color "
                   "rgba=\"0.8 0.8 0.8 0.3\"/></material>\n    </visual>\n  "
                   "</link>\n</robot>\n");
  return message;
}

dds::Message<idl::palpate_msgs::ModelGap> ToModelGap(const FrameResult& result) {
  dds::Message<idl::palpate_msgs::ModelGap> message;
  SetHeader(message->header, result.head.stamp_ns);
  message->residual_rms_m = result.gap.whole.residual_rms_m;
  message->noise_rms_m = result.gap.whole.noise_rms_m;
  message->sample_count = static_cast<uint32_t>(result.gap.whole.sample_count);
  Fill(result.gap.regions, message->regions);
  Fill(result.gap.cables, message->cables);
  return message;
}

}  // namespace palpate::force_estimation
