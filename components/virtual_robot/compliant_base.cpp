// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/compliant_base.hpp"

#include <Eigen/Geometry>

#include "components/virtual_robot/rest_shape.hpp"

namespace palpate::virtual_robot {

CompliantBase::CompliantBase(const BenchBody& body, const Effects& effects)
    : rest_m_(body.rest_m()) {
  for (const auto* effect : OfKind(effects, "base_compliance")) {
    compliance_rad_Nm_ += NonNegativeValue(*effect, "compliance_rad_Nm");
  }
  for (int node = 0; node < body.mesh.NodeCount(); ++node) {
    if (body.fixed.col(node).all()) held_.push_back(node);
  }
  centre_m_ = FindBodyAxis(body.mesh, body.fixed).origin_m;
}

void CompliantBase::Apply(Eigen::VectorXd* x_m) const {
  const double angle_rad = rotation_rad_.norm();
  const Eigen::Matrix3d R =
      angle_rad > 0.0 ? Eigen::AngleAxisd(angle_rad, rotation_rad_ / angle_rad).toRotationMatrix()
                      : Eigen::Matrix3d::Identity();
  for (const int node : held_) {
    const Eigen::Vector3d rest_m = rest_m_.segment<3>(3 * node);
    if (angle_rad > 0.0) {
      x_m->segment<3>(3 * node) = centre_m_ + R * (rest_m - centre_m_);
    } else {
      x_m->segment<3>(3 * node) = rest_m;
    }
  }
}

Eigen::Vector3d CompliantBase::Wanted_rad(const Eigen::VectorXd& x_m,
                                          const Eigen::VectorXd& residual_N) const {
  Eigen::Vector3d moment_Nm = Eigen::Vector3d::Zero();
  for (const int node : held_) {
    const Eigen::Vector3d arm_m = x_m.segment<3>(3 * node) - centre_m_;
    moment_Nm += arm_m.cross(residual_N.segment<3>(3 * node));
  }
  return compliance_rad_Nm_ * moment_Nm;
}

}  // namespace palpate::virtual_robot
