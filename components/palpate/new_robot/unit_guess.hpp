// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "components/palpate/new_robot/decision.hpp"
#include "components/palpate/new_robot/source_mesh.hpp"

namespace palpate::command {

/// 1, 0.01 or 0.001 for m, cm or mm. Throws InputError for anything else.
double MetresPerUnit(const std::string& unit);

/// The unit of a mesh file: what its comment says, else the one in which the body is nearest to
/// the size of a soft robot. `given` m, cm or mm; empty: not given.
Decision DecideUnit(const SourceMesh& source, const std::string& given);

/// "120 mm" or "1.2 m": three digits in a unit that fits.
std::string LengthText(double length_m);

}  // namespace palpate::command
