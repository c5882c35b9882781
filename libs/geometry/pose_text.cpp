// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/geometry/pose_text.hpp"

#include <cmath>
#include <vector>

#include "libs/core/config_reader.hpp"
#include "libs/core/number_rule.hpp"
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

const KeyTable& StandardErrorKeys() {
  static const KeyTable keys{
      .title = "standard error of the camera pose",
      .about = "One standard deviation; an exact pose does not exist.",
      .keys = {{"translation_m", value::Real(kPositive), kRequired,
                "Along each axis of the robot frame."},
               {"rotation_rad", value::Real(kPositive), kRequired,
                "About each axis of the robot frame, through the camera's origin."}}};
  return keys;
}

PoseStandardError ReadStandardError(const ConfigNode& node) {
  MapReader reader(node, StandardErrorKeys());
  PoseStandardError error;
  reader.Read("translation_m", &error.translation_m);
  reader.Read("rotation_rad", &error.rotation_rad);
  reader.Finish();
  return error;
}

std::vector<Key> KeysOfPose() {
  return {{"translation_m", value::Vector3(), kRequired,
           "Origin of the source frame, in the target frame."},
          {"rotation_xyzw", value::Either({value::Numbers({}, 4, 4), value::Map(QuaternionKeys())}),
           kRequired,
           "Unit quaternion `[x, y, z, w]` or `{x, y, z, w}`. Its norm may be off 1 by 0.001."}};
}

Eigen::Isometry3d ReadTransform(MapReader* reader) {
  Eigen::Vector3d translation_m;
  reader->Read("translation_m", &translation_m);
  return Eigen::Translation3d(translation_m) * ReadQuaternion(reader->Require("rotation_xyzw"));
}

}  // namespace

const KeyTable& PoseKeys() {
  static const KeyTable keys{
      .title = "pose", .about = "`T_target_source`: p_target = T p_source.", .keys = KeysOfPose()};
  return keys;
}

const KeyTable& MeasuredPoseKeys() {
  static const KeyTable keys = [] {
    KeyTable table{.title = "camera pose",
                   .about = "`T_robot_camera`: p_robot = T p_camera.",
                   .keys = KeysOfPose()};
    table.keys.push_back({"standard_error", value::Map(StandardErrorKeys()), kOptional,
                          "How well the pose is known. Absent: 0.005 m and 0.01 rad."});
    return table;
  }();
  return keys;
}

Eigen::Isometry3d ReadPose(const ConfigNode& node) {
  MapReader reader(node, PoseKeys());
  const Eigen::Isometry3d pose = ReadTransform(&reader);
  reader.Finish();
  return pose;
}

Eigen::Isometry3d ReadMeasuredPose(const ConfigNode& node,
                                   std::optional<PoseStandardError>* standard_error) {
  MapReader reader(node, MeasuredPoseKeys());
  const Eigen::Isometry3d pose = ReadTransform(&reader);
  standard_error->reset();
  if (const ConfigNode* error = reader.Optional("standard_error")) {
    *standard_error = ReadStandardError(*error);
  }
  reader.Finish();
  return pose;
}

std::string FormatVector(const Eigen::VectorXd& vector) {
  std::string text = "[";
  for (Eigen::Index i = 0; i < vector.size(); ++i) {
    text += (i == 0 ? "" : ", ") + FormatNumber(vector[i]);
  }
  return text + "]";
}

std::string FormatPose(const Eigen::Isometry3d& pose,
                       const std::optional<PoseStandardError>& standard_error) {
  const Eigen::Quaterniond rotation(pose.rotation());
  std::string error;
  if (standard_error) {
    error = ", standard_error: {translation_m: " + FormatNumber(standard_error->translation_m) +
            ", rotation_rad: " + FormatNumber(standard_error->rotation_rad) + "}";
  }
  return "{translation_m: " + FormatVector(pose.translation()) +
         ", rotation_xyzw: {x: " + FormatNumber(rotation.x()) +
         ", y: " + FormatNumber(rotation.y()) + ", z: " + FormatNumber(rotation.z()) +
         ", w: " + FormatNumber(rotation.w()) + "}" + error + "}";
}

}  // namespace palpate::geometry
