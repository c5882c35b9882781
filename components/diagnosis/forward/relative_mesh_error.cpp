// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/relative_mesh_error.hpp"

#include <cmath>

#include "components/diagnosis/forward/mesh_part.hpp"
#include "libs/core/index.hpp"
#include "libs/fem/embedding.hpp"
#include "libs/fem/shape_functions.hpp"

namespace palpate::diagnosis {

namespace {

/// The forces of one newton of tension, at rest.
void AddCable(const robot::BodyCable& cable, const fem::PointLocator& locator,
              Eigen::Ref<Eigen::VectorXd> nodal_N) {
  Eigen::Vector3d from_m = cable.pull_point_m;
  fem::InterpolationWeights before;  // none: the pull point is fixed to the ground
  for (const fem::BodyPoint& eyelet : cable.eyelets) {
    const fem::BodyPoint point = locator.EmbedBall(eyelet.rest_m, cable.guide_radius_m);
    const Eigen::Vector3d along = (from_m - eyelet.rest_m).normalized();
    AddPointLoad(point.weights, along, nodal_N);
    AddPointLoad(before, -along, nodal_N);
    from_m = eyelet.rest_m;
    before = point.weights;
  }
}

/// [3 points x loads] motion of markers and surface points, m.
std::optional<Eigen::MatrixXd> PointMotion_m(const MeshPart& part, const robot::RobotBody& body) {
  PartAtRest at_rest(part, fem::ElementType::kTet10, body);
  const fem::TetMesh& mesh = at_rest.mesh();
  const fem::PointLocator locator(mesh);
  const Eigen::Index cables = std::ssize(body.cables);
  Eigen::MatrixXd loads = Eigen::MatrixXd::Zero(3 * mesh.NodeCount(), cables + 1);
  for (Eigen::Index c = 0; c < cables; ++c) {
    AddCable(body.cables[At(c)], locator, loads.col(c));
  }
  const Eigen::VectorXd density = Eigen::VectorXd::Ones(mesh.CellCount());
  loads.col(cables) =
      (body.gravity_m_s2 * fem::ConsistentNodalMass_kg(mesh, density).transpose()).reshaped();
  const auto motion_m = at_rest.MotionUnder(loads);
  if (!motion_m) return std::nullopt;
  std::vector<Eigen::Vector3d> points_m;
  for (const robot::BodyMarker& marker : body.markers) points_m.push_back(marker.point.rest_m);
  for (const fem::BodyPoint& point : body.feature_points) points_m.push_back(point.rest_m);
  Eigen::MatrixXd of_points_m(3 * std::ssize(points_m), loads.cols());
  for (Eigen::Index k = 0; k < loads.cols(); ++k) {
    for (Eigen::Index p = 0; p < std::ssize(points_m); ++p) {
      of_points_m.col(k).segment<3>(3 * p) =
          locator.Embed(points_m[At(p)]).weights.Position(motion_m->col(k));
    }
  }
  return of_points_m;
}

}  // namespace

std::optional<double> RelativeMeshError(const robot::RobotBody& body) {
  constexpr int kMostNodes = 8000;  // eight times as many take some seconds and 1 GB
  if (body.mesh.NodeCount() > kMostNodes) return std::nullopt;
  const MeshPart part = WholeMesh(body);
  const auto coarse_m = PointMotion_m(part, body);
  const auto fine_m = PointMotion_m(Refined(part), body);
  if (!coarse_m || !fine_m) return std::nullopt;
  double sum = 0.0;
  int loads = 0;
  for (Eigen::Index k = 0; k < fine_m->cols(); ++k) {
    const double moved_m2 = fine_m->col(k).squaredNorm();
    if (moved_m2 == 0.0) continue;
    sum += (fine_m->col(k) - coarse_m->col(k)).squaredNorm() / moved_m2;
    ++loads;
  }
  if (loads == 0) return std::nullopt;
  return std::sqrt(sum / loads);
}

}  // namespace palpate::diagnosis
