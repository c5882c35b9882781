// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/contact_surface.hpp"

#include <Eigen/Geometry>

namespace palpate::virtual_robot {

namespace {

/// [2 x 12] and weights that add up to 1: exact to degree 6 (D. A. Dunavant, High degree efficient
/// symmetrical Gaussian quadrature rules for the triangle, Int. J. Numer. Methods Eng. 21, 1985).
struct FaceRule {
  Eigen::Matrix2Xd points{2, 12};
  Eigen::VectorXd weights{12};
};

FaceRule TwelvePoints() {
  FaceRule rule;
  Eigen::Index next = 0;
  const auto add = [&](double a, double b, double weight) {
    rule.points.col(next) << a, b;
    rule.weights[next++] = weight;
  };
  for (const auto& [a, weight] :
       {std::pair{0.063089014491502, 0.050844906370207}, {0.249286745170910, 0.116786275726379}}) {
    add(a, a, weight);
    add(a, 1.0 - 2.0 * a, weight);
    add(1.0 - 2.0 * a, a, weight);
  }
  const double a = 0.053145049844817;
  const double b = 0.310352451033784;
  const double c = 1.0 - a - b;
  for (const auto& [s, t] : {std::pair{a, b}, {b, a}, {a, c}, {c, a}, {b, c}, {c, b}}) {
    add(s, t, 0.082851075618374);
  }
  rule.weights /= rule.weights.sum();
  return rule;
}

/// Nodes of a face: corners, then mid-edge nodes of 01, 12, 20.
Eigen::VectorXd FaceShape(Eigen::Index nodes, const Eigen::Vector2d& point) {
  const Eigen::Vector3d L(1.0 - point.sum(), point.x(), point.y());
  if (nodes == 3) return L;
  Eigen::VectorXd N(6);
  for (Eigen::Index i = 0; i < 3; ++i) {
    N[i] = L[i] * (2.0 * L[i] - 1.0);
    N[3 + i] = 4.0 * L[i] * L[(i + 1) % 3];
  }
  return N;
}

/// [nodes x 2] derivatives by the two coordinates; the shape functions are quadratic, so that
/// central differences are exact.
Eigen::MatrixXd FaceGradients(Eigen::Index nodes, const Eigen::Vector2d& point) {
  constexpr double kStep = 0.125;
  Eigen::MatrixXd gradients(nodes, 2);
  for (Eigen::Index i = 0; i < 2; ++i) {
    const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(i);
    gradients.col(i) =
        (FaceShape(nodes, point + step) - FaceShape(nodes, point - step)) / (2.0 * kStep);
  }
  return gradients;
}

}  // namespace

ContactSurface::ContactSurface(const fem::TetMesh& mesh, const fem::BoundarySurface& boundary,
                               const Eigen::Matrix<bool, 3, Eigen::Dynamic>& fixed) {
  std::vector<int> movable;
  for (int face = 0; face < boundary.FaceCount(); ++face) {
    bool held = true;
    for (const int node : boundary.faces.col(face)) held = held && fixed.col(node).all();
    if (!held) movable.push_back(face);
  }
  faces_ = boundary.faces(Eigen::all, movable);
  const Eigen::Index nodes = faces_.rows();
  const FaceRule rule = TwelvePoints();
  shape_.resize(nodes, rule.weights.size());
  area_m2_.resize(rule.weights.size(), faces_.cols());
  for (Eigen::Index k = 0; k < rule.weights.size(); ++k) {
    shape_.col(k) = FaceShape(nodes, rule.points.col(k));
    const Eigen::MatrixXd gradients = FaceGradients(nodes, rule.points.col(k));
    for (Eigen::Index face = 0; face < faces_.cols(); ++face) {
      const Eigen::Matrix<double, 3, 2> tangents =
          mesh.nodes_m(Eigen::all, faces_.col(face)) * gradients;
      area_m2_(k, face) = 0.5 * rule.weights[k] * tangents.col(0).cross(tangents.col(1)).norm();
    }
  }
}

Eigen::Vector3d ContactSurface::Position_m(int face, int k, const Eigen::VectorXd& x_m) const {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  for (Eigen::Index a = 0; a < faces_.rows(); ++a) {
    position_m += shape_(a, k) * x_m.segment<3>(3 * faces_(a, face));
  }
  return position_m;
}

/// The points lie in the hull of the nodes, but for a quarter of the bulge of a curved edge.
bool ContactSurface::MayTouch(int face, const Eigen::VectorXd& x_m, const Eigen::Vector3d& centre_m,
                              double radius_m) const {
  Eigen::Vector3d lower_m = x_m.segment<3>(3 * faces_(0, face));
  Eigen::Vector3d upper_m = lower_m;
  for (Eigen::Index a = 1; a < faces_.rows(); ++a) {
    const auto node_m = x_m.segment<3>(3 * faces_(a, face));
    lower_m = lower_m.cwiseMin(node_m);
    upper_m = upper_m.cwiseMax(node_m);
  }
  const double slack_m = 0.25 * (upper_m - lower_m).maxCoeff();
  const Eigen::Vector3d beyond_m = (lower_m - centre_m).cwiseMax(centre_m - upper_m).cwiseMax(0.0);
  return beyond_m.squaredNorm() <= (radius_m + slack_m) * (radius_m + slack_m);
}

}  // namespace palpate::virtual_robot
