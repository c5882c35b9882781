// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/bench_contacts.hpp"

#include <algorithm>
#include <limits>

#include "libs/core/error.hpp"

namespace palpate::virtual_robot {

namespace {

double LargestModulus_Pa(const BenchBody& body) {
  double largest_Pa = 0.0;
  for (const fem::Material& material : body.materials) {
    largest_Pa = std::max(largest_Pa, material.youngs_modulus_Pa);
  }
  return largest_Pa;
}

}  // namespace

std::vector<scenario::Tool> TouchingTools(const std::vector<scenario::Tool>& tools) {
  std::vector<scenario::Tool> touching;
  for (const scenario::Tool& tool : tools) {
    if (tool.shape != scenario::ToolShape::kHand) touching.push_back(tool);
  }
  return touching;
}

std::vector<Contact> MakeContacts(const BenchBody& body, const ContactSurface& surface,
                                  const std::vector<scenario::Tool>& tools,
                                  const Effects& effects) {
  ContactLaw law;
  law.stiffness_Pa_m = LargestModulus_Pa(body) / kPenetrationAtModulus_m;
  std::vector<Contact> contacts;
  for (const scenario::Tool& tool : tools) {
    if (!(tool.friction_coefficient >= 0.0)) {
      throw InputError("tool " + tool.name + ": friction_coefficient must not be negative");
    }
    contacts.emplace_back(tool.name, RigidShape(tool), tool.friction_coefficient, law);
  }
  for (size_t k = 0; k < ObstaclePoses(body, surface, effects).size(); ++k) {
    contacts.emplace_back("hidden_obstacle", RigidShape::HalfSpace(), 0.0, law);
  }
  return contacts;
}

std::vector<Eigen::Isometry3d> ObstaclePoses(const BenchBody& body, const ContactSurface& surface,
                                             const Effects& effects) {
  const Eigen::VectorXd rest_m = body.rest_m();
  std::vector<Eigen::Isometry3d> poses;
  for (const auto* effect : OfKind(effects, "hidden_obstacle")) {
    const Eigen::Vector3d along = Values(*effect, "nx", "ny", "nz");
    if (!(along.norm() > 0.0)) {
      throw InputError("effect hidden_obstacle: nx, ny, nz are all 0; a direction is expected");
    }
    const Eigen::Vector3d n = along.normalized();
    double nearest_m = std::numeric_limits<double>::infinity();
    for (int face = 0; face < surface.FaceCount(); ++face) {
      for (int k = 0; k < surface.PointsPerFace(); ++k) {
        nearest_m = std::min(nearest_m, n.dot(surface.Position_m(face, k, rest_m)));
      }
    }
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), n).toRotationMatrix();
    pose.translation() = (nearest_m - Value(*effect, "gap_m")) * n;
    poses.push_back(pose);
  }
  return poses;
}

}  // namespace palpate::virtual_robot
