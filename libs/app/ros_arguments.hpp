// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

namespace palpate::app {

/// A command line as users of ROS 2 write it, in the options of our own programs: what stands
/// between --ros-args and -- (or the end) is translated, the rest stays.
///
///   -r RULE, --remap RULE            --remap RULE
///   -p NAME:=VALUE, --param ...      --set NAME=VALUE; use_sim_time is dds.use_sim_time
///   --log-level LEVEL                --log-level LEVEL, with warn and fatal in our words
///
/// Throws InputError for another option there, and for one without its value.
std::vector<std::string> WithoutRosArguments(const std::vector<std::string>& words);

}  // namespace palpate::app
