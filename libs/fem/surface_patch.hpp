// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "libs/fem/embedding.hpp"
#include "libs/fem/interpolation_weights.hpp"

namespace palpate::fem {

/// Where a load or a contact acts: a force F on it gives the node k the force weights[k] * F, and
/// the mean displacement over it is the weighted sum of the nodes'.
struct SurfacePatch {
  InterpolationWeights weights;  ///< nodes in rising order; the weights add up to 1
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();  ///< where the resultant acts at rest
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();    ///< unit, outward, mean over the area
  double area_m2 = 0.0;                                ///< 0 for a point
  double distance_m =
      0.0;  ///< from the point that was asked for to the surface (0 inside, radius 0)
};

/// Uniform traction over the rest surface within `radius_m` of the surface point nearest to
/// `point_m`: the integrals of the shape functions over that part of the faces, divided by its
/// area (consistent weights; on whole faces of tet10 nothing goes to the corners). Faces at the rim
/// are cut where they cross the sphere, the area good to 0.2 %. Curved faces count as flat.
///
/// radius_m = 0: the point itself as PointLocator::Embed has it, with the nearest face's normal.
SurfacePatch MakeSurfacePatch(const PointLocator& locator, const Eigen::Vector3d& point_m,
                              double radius_m);

}  // namespace palpate::fem
