// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/virtual_robot/bench_body.hpp"
#include "components/virtual_robot/contact.hpp"
#include "components/virtual_robot/contact_surface.hpp"
#include "components/virtual_robot/effects.hpp"
#include "libs/scenario/scenario.hpp"

namespace palpate::virtual_robot {

/// At a pressure of E the body goes this deep into a tool.
inline constexpr double kPenetrationAtModulus_m = 100e-6;

/// The tools that can touch: all but hands.
std::vector<scenario::Tool> TouchingTools(const std::vector<scenario::Tool>& tools);

/// A contact for each of `tools`, then one for each hidden_obstacle: the half-space that n = (nx,
/// ny, nz) points out of, `gap_m` away from the surface at rest that can move. Those stay where
/// they are. Throws InputError.
std::vector<Contact> MakeContacts(const BenchBody& body, const ContactSurface& surface,
                                  const std::vector<scenario::Tool>& tools, const Effects& effects);

/// Poses of the obstacles among them.
std::vector<Eigen::Isometry3d> ObstaclePoses(const BenchBody& body, const ContactSurface& surface,
                                             const Effects& effects);

}  // namespace palpate::virtual_robot
