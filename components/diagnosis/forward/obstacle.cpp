// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/obstacle.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <set>

#include "libs/core/index.hpp"
#include "libs/robot/sensitivity/equilibrium_point.hpp"

namespace palpate::diagnosis {

namespace {

/// Depth at the pressure of the body's modulus.
constexpr double kDepthAtModulus_m = 1e-5;

/// An obstacle that moves while the body stands.
class ObstacleMotionParameter final : public robot::Parameter {
 public:
  ObstacleMotionParameter(const Obstacle& obstacle, const Eigen::VectorXd& force_N,
                          const Eigen::Vector3d& normal_change, double offset_change_m)
      : obstacle_(obstacle),
        force_N_(force_N),
        normal_change_(normal_change),
        offset_change_m_(offset_change_m) {}

  void Describe(const robot::EquilibriumPoint& at, robot::ParameterColumn* column) const override {
    const ObstacleSurface& surface = *obstacle_.surface;
    for (Eigen::Index k = 0; k < force_N_.size(); ++k) {
      if (force_N_[k] <= 0.0) continue;
      const int node = surface.nodes[At(k)];
      const double deeper = offset_change_m_ - normal_change_.dot(at.x_m().segment<3>(3 * node));
      column->distributed_force_N().segment<3>(3 * node) +=
          surface.stiffness_N_m * deeper * obstacle_.normal + force_N_[k] * normal_change_;
    }
  }

 private:
  Obstacle obstacle_;
  Eigen::VectorXd force_N_;
  Eigen::Vector3d normal_change_;
  double offset_change_m_;
};

}  // namespace

ObstacleSurface SurfaceForObstacles(const robot::RobotBody& body) {
  std::set<int> nodes;
  double area_m2 = 0.0;
  const Eigen::Matrix3Xd& X_m = body.mesh.nodes_m;
  for (const auto& face : body.boundary.faces.colwise()) {
    bool held = true;
    for (const int node : face) held = held && body.fixed.col(node).all();
    if (held) continue;
    nodes.insert(face.begin(), face.end());
    const Eigen::Vector3d along_m = X_m.col(face[1]) - X_m.col(face[0]);
    area_m2 += 0.5 * along_m.cross(X_m.col(face[2]) - X_m.col(face[0])).norm();
  }
  double modulus_Pa = 0.0;
  for (const fem::Material& material : body.materials) {
    modulus_Pa = std::max(modulus_Pa, material.youngs_modulus_Pa);
  }
  const double share_m2 = area_m2 / static_cast<double>(std::max<std::size_t>(1, nodes.size()));
  return {.nodes = {nodes.begin(), nodes.end()},
          .stiffness_N_m = modulus_Pa * share_m2 / kDepthAtModulus_m};
}

double NearestAlong(const ObstacleSurface& surface, const Eigen::Vector3d& normal,
                    const Eigen::VectorXd& x_m) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const int node : surface.nodes) {
    nearest_m = std::min(nearest_m, normal.dot(x_m.segment<3>(3 * node)));
  }
  return nearest_m;
}

Eigen::VectorXd NodalForces_N(const Obstacle& obstacle, const Eigen::VectorXd& force_N,
                              Eigen::Index size) {
  Eigen::VectorXd nodal_N = Eigen::VectorXd::Zero(size);
  for (Eigen::Index k = 0; k < force_N.size(); ++k) {
    const int node = obstacle.surface->nodes[At(k)];
    nodal_N.segment<3>(3 * node) = force_N[k] * obstacle.normal;
  }
  return nodal_N;
}

robot::ParameterPtr ObstacleMotion(const Obstacle& obstacle, const Eigen::VectorXd& force_N,
                                   const Eigen::Vector3d& normal_change, double offset_change_m) {
  return std::make_unique<ObstacleMotionParameter>(obstacle, force_N, normal_change,
                                                   offset_change_m);
}

double ObstacleContact::Value(const Eigen::VectorXd& x_m) const {
  double energy_J = 0.0;
  for (const int node : obstacle_.surface->nodes) {
    const double depth_m = obstacle_.Depth_m(node, x_m);
    energy_J += 0.5 * depth_m * obstacle_.surface->Force_N(depth_m);
  }
  return energy_J / kThere_N;
}

void ObstacleContact::AddGradient(const Eigen::VectorXd& x_m, double factor,
                                  Eigen::VectorXd& nodal) const {
  for (const int node : obstacle_.surface->nodes) {
    const double depth_m = obstacle_.Depth_m(node, x_m);
    if (depth_m <= 0.0) continue;
    nodal.segment<3>(3 * node) -=
        factor / kThere_N * obstacle_.surface->Force_N(depth_m) * obstacle_.normal;
  }
}

void ObstacleContact::BindTo(const fem::StiffnessMatrix& stiffness) {
  slots_.clear();
  for (const int node : obstacle_.surface->nodes) slots_.push_back(stiffness.Slot(node, node));
}

void ObstacleContact::AddCurvature(const Eigen::VectorXd& x_m, double multiplier,
                                   fem::StiffnessMatrix& stiffness) const {
  const Eigen::Matrix3d along = obstacle_.normal * obstacle_.normal.transpose();
  for (std::size_t k = 0; k < slots_.size(); ++k) {
    const double depth_m = obstacle_.Depth_m(obstacle_.surface->nodes[k], x_m);
    if (depth_m <= 0.0) continue;
    const Eigen::Matrix3d block = multiplier / kThere_N * obstacle_.surface->stiffness_N_m * along;
    stiffness.Add(slots_[k], block);
  }
}

}  // namespace palpate::diagnosis
