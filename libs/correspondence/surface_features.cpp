// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/correspondence/surface_features.hpp"

#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/geometry/closest_point.hpp"
#include "libs/geometry/triangle_surface.hpp"

namespace palpate::correspondence {

namespace {

std::vector<std::vector<int>> TrianglesOfNodes(const Eigen::Matrix3Xi& triangles,
                                               Eigen::Index nodes) {
  std::vector<std::vector<int>> found(static_cast<size_t>(nodes));
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    for (const int node : triangles.col(t)) {
      found[At(node)].push_back(static_cast<int>(t));
    }
  }
  return found;
}

}  // namespace

SurfaceFeatures::SurfaceFeatures(const robot::RobotBody& body)
    : triangles_(body.boundary.DrawnTriangles()) {
  const std::vector<fem::BodyPoint>& points = body.feature_points;
  if (points.empty()) {
    throw InputError("robot \"" + body.name +
                     "\": without feature_points its surface cannot be measured");
  }
  rest_m_.resize(3, ToIndex(points.size()));
  for (const fem::BodyPoint& point : points) {
    rest_m_.col(Count()) = point.rest_m;
    points_.push_back(point.weights);
  }
  FindParts(body.mesh.nodes_m);
  ShareOut(body.mesh.nodes_m);
}

void SurfaceFeatures::FindParts(const Eigen::Matrix3Xd& nodes_m) {
  const geometry::SurfaceIndex index({nodes_m, triangles_});
  const std::vector<std::vector<int>> of_node = TrianglesOfNodes(triangles_, nodes_m.cols());
  parts_of_feature_.resize(points_.size());
  for (int feature = 0; feature < Count(); ++feature) {
    const geometry::SurfacePoint at = index.Closest(rest_m_.col(feature));
    for (int corner = 0; corner < 3; ++corner) {
      const auto node = static_cast<size_t>(triangles_(corner, at.triangle));
      for (const int triangle : of_node[node]) {
        parts_of_feature_[At(feature)].push_back({triangle, at.barycentric[corner]});
      }
    }
  }
}

/// Directions that are opposite count like a distance of one feature's spacing.
void SurfaceFeatures::ShareOut(const Eigen::Matrix3Xd& nodes_m) {
  const geometry::TriangleSurface surface{nodes_m, triangles_};
  const double spacing_squared_m2 = geometry::SurfaceArea_m2(surface) / Count();
  const Eigen::Matrix3Xd normals =
      Normals(Eigen::Map<const Eigen::VectorXd>(nodes_m.data(), nodes_m.size()));
  feature_of_triangle_.resize(static_cast<size_t>(triangles_.cols()));
  for (int t = 0; t < surface.TriangleCount(); ++t) {
    const Eigen::Vector3d centre_m =
        (surface.Corner(t, 0) + surface.Corner(t, 1) + surface.Corner(t, 2)) / 3.0;
    const Eigen::RowVectorXd cosines = geometry::TriangleNormal(surface, t).transpose() * normals;
    Eigen::Index nearest = 0;
    ((rest_m_.colwise() - centre_m).colwise().squaredNorm().array() +
     0.5 * spacing_squared_m2 * (1.0 - cosines.array()))
        .minCoeff(&nearest);
    feature_of_triangle_[At(t)] = static_cast<int>(nearest);
  }
}

Eigen::Matrix3Xd SurfaceFeatures::Normals(const Eigen::VectorXd& x_m) const {
  Eigen::Matrix3Xd normals = Eigen::Matrix3Xd::Zero(3, Count());
  for (int feature = 0; feature < Count(); ++feature) {
    for (const Part& part : parts_of_feature_[At(feature)]) {
      const Eigen::Vector3i corners = triangles_.col(part.triangle);
      const Eigen::Vector3d a = x_m.segment<3>(3 * corners[0]);
      const Eigen::Vector3d b = x_m.segment<3>(3 * corners[1]);
      const Eigen::Vector3d c = x_m.segment<3>(3 * corners[2]);
      normals.col(feature) += part.weight * (b - a).cross(c - a);
    }
    normals.col(feature).normalize();
  }
  return normals;
}

}  // namespace palpate::correspondence
