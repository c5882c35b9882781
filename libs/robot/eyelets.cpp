// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/eyelets.hpp"

#include <Eigen/Geometry>
#include <set>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"

namespace palpate::robot {

namespace {

using AxisBox = Eigen::AlignedBox3d;

/// Of elements that a point in the box may lie in.
void AddNodesOfCells(const fem::TetMesh& mesh, const AxisBox& box, std::set<int>* nodes) {
  for (const auto& cell : mesh.cells.colwise()) {
    AxisBox of_cell;
    for (const int node : cell) of_cell.extend(mesh.nodes_m.col(node));
    if (of_cell.intersects(box)) nodes->insert(cell.begin(), cell.end());
  }
}

/// Of elements that points in the box are extrapolated from.
void AddNodesOfPoints(const fem::PointLocator& locator, const AxisBox& box, std::set<int>* nodes) {
  constexpr int kPoints = 9;
  for (int k = 0; k < kPoints * kPoints * kPoints; ++k) {
    const Eigen::Array3d share =
        Eigen::Array3d(k % kPoints, k / kPoints % kPoints, k / (kPoints * kPoints)) / (kPoints - 1);
    const Eigen::Vector3d point_m = box.min() + (share * box.sizes().array()).matrix();
    const std::vector<int> found = locator.Embed(point_m).weights.nodes;
    nodes->insert(found.begin(), found.end());
  }
}

}  // namespace

Eigen::Vector3d EyeletMoved_m(const BodyCable& cable, int eyelet) {
  if (cable.eyelets_moved_m.empty()) return Eigen::Vector3d::Zero();
  return cable.eyelets_moved_m.at(At(eyelet));
}

Eigen::Vector3d EyeletPlace_m(const BodyCable& cable, double scale, int eyelet) {
  return cable.eyelets.at(At(eyelet)).rest_m - scale * EyeletMoved_m(cable, eyelet);
}

void MoveEyelet(const fem::PointLocator& locator, double scale, int eyelet,
                const Eigen::Vector3d& moved_m, BodyCable* cable) {
  const auto index = static_cast<size_t>(eyelet);
  const Eigen::Vector3d place_m = EyeletPlace_m(*cable, scale, eyelet);
  cable->eyelets[index] = locator.EmbedBall(place_m + scale * moved_m, cable->guide_radius_m);
  cable->eyelets_moved_m.resize(cable->eyelets.size(), Eigen::Vector3d::Zero());
  cable->eyelets_moved_m[index] = moved_m;
}

void GiveEyeletsRoom(double reach_m, RobotBody* body) {
  PALPATE_CHECK(reach_m >= 0.0, reach_m);
  const fem::PointLocator locator(body->mesh);
  for (BodyCable& cable : body->cables) {
    const Eigen::Vector3d reach_of_ball_m =
        Eigen::Vector3d::Constant(reach_m + cable.guide_radius_m);
    for (fem::BodyPoint& eyelet : cable.eyelets) {
      const AxisBox box(eyelet.rest_m - reach_of_ball_m, eyelet.rest_m + reach_of_ball_m);
      std::set<int> nodes;
      AddNodesOfCells(body->mesh, box, &nodes);
      AddNodesOfPoints(locator, box, &nodes);
      const fem::InterpolationWeights room{{nodes.begin(), nodes.end()},
                                           std::vector<double>(nodes.size(), 0.0)};
      eyelet.weights = fem::Combine({eyelet.weights, room}, {1.0, 1.0});
    }
  }
  body->eyelet_room_m = reach_m;
}

}  // namespace palpate::robot
