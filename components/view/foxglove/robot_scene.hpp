// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "components/view/frames/page_surface.hpp"

namespace palpate::view::foxglove {

/// A force as an arrow.
struct SceneForce {
  std::string label;           ///< "0.52 +- 0.04 N"
  Eigen::Vector3d position_m;  ///< where it acts, robot frame
  Eigen::Vector3d force_N;     ///< on the robot; not finite: no arrow
};

/// A foxglove.SceneUpdate as JSON: the deformed surface coloured by displacement, and the
/// arrows, which end where the forces act. Arrows and colours are scaled to the body's size.
/// `positions_m` [3 n] as PositionsOf gives them.
std::string RobotSceneJson(const PageSurface& surface, const std::vector<float>& positions_m,
                           const std::vector<SceneForce>& forces, std::int64_t stamp_ns);

/// Name of its schema, and the schema as JSON Schema.
inline constexpr std::string_view kSceneSchemaName = "foxglove.SceneUpdate";
std::string SceneSchema();

}  // namespace palpate::view::foxglove
