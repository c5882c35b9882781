// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/geometry/pose_text.hpp"

#include <cmath>
#include <vector>

#include "libs/core/config_reader.hpp"
#include "libs/core/text.hpp"

namespace palpate::geometry {

namespace {

constexpr double kNormTolerance = 1e-3;

const KeyTable& QuaternionKeys() {
  static const KeyTable keys{.title = "quaternion",
                             .about = "A rotation as a unit quaternion.",
                             .keys = {{"x", value::Real(), kRequired, "Component x."},
                                      {"y", value::Real(), kRequired, "Component y."},
                                      {"z", value::Real(), kRequired, "Component z."},
                                      {"w", value::Real(), kRequired, "Scalar component."}}};
  return keys;
}

Eigen::Quaterniond ReadQuaternion(const ConfigNode& node) {
  Eigen::Quaterniond rotation;
  if (node.kind == ConfigNode::Kind::kList) {
    const std::vector<double> xyzw = ReadNumbers(node);
    if (xyzw.size() != 4) Refuse(node, "must be [x, y, z, w] or {x, y, z, w}");
    rotation = Eigen::Quaterniond(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
  } else {
    MapReader reader(node, QuaternionKeys());
    reader.Read("x", &rotation.x());
    reader.Read("y", &rotation.y());
    reader.Read("z", &rotation.z());
    reader.Read("w", &rotation.w());
    reader.Finish();
  }
  if (std::abs(rotation.norm() - 1.0) > kNormTolerance) {
    Refuse(node, "a rotation is a quaternion of norm 1, not " + FormatNumber(rotation.norm()));
  }
  return rotation.normalized();
}

}  // namespace

const KeyTable& PoseKeys() {
  static const KeyTable keys{
      .title = "pose",
      .about = "`T_target_source`: p_target = T p_source.",
      .keys = {
          {"translation_m", value::Vector3(), kRequired,
           "Origin of the source frame, in the target frame."},
          {"rotation_xyzw", value::Either({value::Numbers({}, 4, 4), value::Map(QuaternionKeys())}),
           kRequired,
           "Unit quaternion `[x, y, z, w]` or `{x, y, z, w}`. Its norm may be off 1 by 0.001."}}};
  return keys;
}

Eigen::Isometry3d ReadPose(const ConfigNode& node) {
  MapReader reader(node, PoseKeys());
  Eigen::Vector3d translation_m;
  reader.Read("translation_m", &translation_m);
  const Eigen::Quaterniond rotation = ReadQuaternion(reader.Require("rotation_xyzw"));
  reader.Finish();
  return Eigen::Translation3d(translation_m) * rotation;
}

std::string FormatVector(const Eigen::VectorXd& vector) {
  std::string text = "[";
  for (Eigen::Index i = 0; i < vector.size(); ++i) {
    text += (i == 0 ? "" : ", ") + FormatNumber(vector[i]);
  }
  return text + "]";
}

std::string FormatPose(const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond rotation(pose.rotation());
  return "{translation_m: " + FormatVector(pose.translation()) +
         ", rotation_xyzw: {x: " + FormatNumber(rotation.x()) +
         ", y: " + FormatNumber(rotation.y()) + ", z: " + FormatNumber(rotation.z()) +
         ", w: " + FormatNumber(rotation.w()) + "}}";
}

}  // namespace palpate::geometry
