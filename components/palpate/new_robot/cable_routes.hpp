// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "components/palpate/new_robot/body_shape.hpp"
#include "components/palpate/new_robot/channels.hpp"
#include "components/palpate/new_robot/decision.hpp"
#include "components/palpate/new_robot/source_mesh.hpp"

namespace palpate::command {

/// The route of a cable of a new robot.
struct CableRoute {
  std::string name;
  Eigen::Matrix3Xd path_m;  ///< [3 x >= 2] pull point first, frame of the mesh file
  double guide_radius_m = 0.0;
  double channel_radius_m = 0.0;  ///< of a channel of the mesh; 0: there is none
  Trust trust = Trust::kGiven;
  std::string why = {};
};

/// "NAME=POINT;POINT;...", pull point first; a POINT is x,y,z in the unit of the mesh file or the
/// name of a point of it. A unit behind the last x,y,z ("...;1,2,3 m") is that of all. Throws
/// InputError.
CableRoute ParseCable(const std::string& text, const SourceMesh& source, const BodyShape& shape,
                      double metres_per_unit);

/// Routes that points and curves of the mesh file name, such as "cable_up" or "tendon1_2", and,
/// without any, channels of the body. `fixed_m`: the middle of the fixed region, where routes
/// begin.
std::vector<CableRoute> GuessCables(const SourceMesh& source, const BodyShape& shape,
                                    const std::vector<Channel>& channels,
                                    const Eigen::Vector3d& fixed_m);

/// Gives a route of two points eyelets between them where the straight line runs in the body, and
/// says so in its reason.
void AddEyelets(const BodyShape& shape, CableRoute* route);

/// Throws InputError for an eyelet outside the body by more than its guide reaches, with the
/// distance and the nearest point, in mm and in the unit of the mesh file; and for a pull point
/// farther from the body than twice its diagonal.
void RefuseFarPoints(const BodyShape& shape, const CableRoute& route, double metres_per_unit);

}  // namespace palpate::command
