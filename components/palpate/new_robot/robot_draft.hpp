// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "components/palpate/new_robot/body_shape.hpp"
#include "components/palpate/new_robot/cable_routes.hpp"
#include "components/palpate/new_robot/channels.hpp"
#include "components/palpate/new_robot/decision.hpp"
#include "components/palpate/new_robot/fixed_region.hpp"
#include "components/palpate/new_robot/questions.hpp"
#include "components/palpate/new_robot/source_mesh.hpp"
#include "libs/robot/robot_description.hpp"

namespace palpate::command {

/// What is known of a new robot before anything is guessed; empty: not given.
struct KnownOfRobot {
  std::string name;
  std::string unit;                 ///< m, cm, mm
  std::vector<std::string> fixed;   ///< see FixedByWords
  std::string up;                   ///< x, y, z, minus_x, minus_y, minus_z
  std::string material;             ///< see Silicones
  std::vector<std::string> cables;  ///< see ParseCable
  int markers = 8;                  ///< places that are suggested where the mesh names none
};

/// A robot file to be written, with the reason of each value.
struct RobotDraft {
  robot::RobotDescription description;  ///< `mesh.file` as it was given
  BodyShape shape;
  FixedRegion fixed;
  std::vector<CableRoute> cables;
  std::vector<Channel> channels;
  std::vector<std::string> regions;  ///< groups of the mesh that may have moduli of their own
  std::vector<Decision> decisions;   ///< unit, up, fixed, material, then cables and markers

  const Decision& Of(const std::string& what) const;
};

/// Decides what is not known by the mesh, and by what the user answers. Throws InputError for
/// what cannot be.
RobotDraft DraftRobot(const SourceMesh& source, const KnownOfRobot& known, Questions* questions);

}  // namespace palpate::command
