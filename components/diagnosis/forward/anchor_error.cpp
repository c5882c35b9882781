// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/anchor_error.hpp"

#include <cmath>

#include "components/diagnosis/forward/mesh_part.hpp"
#include "libs/core/index.hpp"
#include "libs/fem/embedding.hpp"

namespace palpate::diagnosis {

namespace {

/// The force of a cable's end.
struct End {
  std::vector<Eigen::Vector3d> places_m;  ///< the anchor first
  Eigen::Vector3d direction;              ///< unit, along the cable
  double guide_radius_m = 0.0;
};

double ElementSize_m(const fem::TetMesh& mesh, int cell) {
  const auto corner = [&](int k) -> Eigen::Vector3d {
    return mesh.nodes_m.col(mesh.cells(k, cell));
  };
  const Eigen::Vector3d a = corner(1) - corner(0);
  const Eigen::Vector3d b = corner(2) - corner(0);
  const Eigen::Vector3d c = corner(3) - corner(0);
  return std::cbrt(a.cross(b).dot(c) / 6.0);
}

/// [places] m/N, along the cable; 0 where the part can move as a whole.
Eigen::VectorXd Compliances_m_N(const MeshPart& part, const robot::RobotBody& body,
                                const End& end) {
  PartAtRest at_rest(part, body.mesh.element_type(), body);
  const fem::PointLocator locator(at_rest.mesh());
  const Eigen::Index count = std::ssize(end.places_m);
  Eigen::MatrixXd loads = Eigen::MatrixXd::Zero(3 * at_rest.mesh().NodeCount(), count);
  for (Eigen::Index p = 0; p < count; ++p) {
    const fem::BodyPoint point = locator.EmbedBall(end.places_m[At(p)], end.guide_radius_m);
    AddPointLoad(point.weights, end.direction, loads.col(p));
  }
  const auto motion_m = at_rest.MotionUnder(loads);
  if (!motion_m) return Eigen::VectorXd::Zero(count);
  return loads.cwiseProduct(*motion_m).colwise().sum();
}

/// The anchor, and places half an edge from it that lie as near to the body as it does.
End EndOf(const robot::RobotBody& body, const robot::BodyCable& cable, const MeshPart& part) {
  const fem::BodyPoint& anchor = cable.eyelets.back();
  const std::size_t eyelets = cable.eyelets.size();
  const Eigen::Vector3d from_m =
      eyelets > 1 ? cable.eyelets[eyelets - 2].rest_m : cable.pull_point_m;
  End end{.places_m = {anchor.rest_m},
          .direction = (from_m - anchor.rest_m).normalized(),
          .guide_radius_m = cable.guide_radius_m};
  const fem::PointLocator locator(part.mesh);
  const double size_m = ElementSize_m(body.mesh, anchor.cell);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      const Eigen::Vector3d place_m = anchor.rest_m + sign * size_m * Eigen::Vector3d::Unit(axis);
      if (locator.Distance_m(place_m) <= anchor.distance_m) end.places_m.push_back(place_m);
    }
  }
  return end;
}

AnchorError FindAnchorError(const robot::RobotBody& body, const robot::BodyCable& cable) {
  constexpr int kMostRefinements = 2;
  const int cell = cable.eyelets.back().cell;
  const MeshPart part = PartAbout(body, cell);
  const End end = EndOf(body, cable, part);
  MeshPart finer = Refined(part);
  double size_m = 0.5 * ElementSize_m(body.mesh, cell);
  for (int k = 1; k < kMostRefinements && size_m > cable.guide_radius_m; ++k) {
    finer = Refined(finer);
    size_m *= 0.5;
  }
  const Eigen::VectorXd more_m_N =
      Compliances_m_N(finer, body, end) - Compliances_m_N(part, body, end);
  AnchorError error{.mean_m_N = more_m_N.mean(), .scatter_m_N = std::abs(more_m_N.mean())};
  const Eigen::Index others = more_m_N.size() - 1;
  if (others > 0)
    error.scatter_m_N = (more_m_N.array() - error.mean_m_N).matrix().norm() /
                        std::sqrt(static_cast<double>(others));
  return error;
}

}  // namespace

std::vector<AnchorError> FindAnchorErrors(const robot::RobotBody& body) {
  std::vector<AnchorError> errors;
  for (const robot::BodyCable& cable : body.cables) {
    errors.push_back(FindAnchorError(body, cable));
  }
  return errors;
}

}  // namespace palpate::diagnosis
