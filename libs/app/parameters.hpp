// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "libs/app/node_options.hpp"
#include "libs/core/parameter.hpp"

namespace palpate::app {

/// The settings of a process as parameters, with the values that they have now. They are read at
/// the start and cannot be changed; the level of the log can. dds.use_sim_time is use_sim_time, as
/// all nodes of ROS 2 have it.
std::vector<Parameter> ParametersOf(const std::string& program,
                                    const std::vector<Setting>& settings,
                                    const NodeOptions& options);

/// Gives the DDS side of a process its parameters, once `command` (a NodeCommand whose config has
/// `dds.parameters`) is complete.
template <typename Command>
void AddParameters(const std::string& program, Command* command) {
  command->config.dds.parameters =
      ParametersOf(program, ListSettings(command->config), command->options);
}

}  // namespace palpate::app
