// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "libs/recording/ros2msg/cdr_reader.hpp"

namespace palpate::recording {

/// A message as columns and values: "header.stamp_ns", "markers[0].position_m.x". Fields of ROS's
/// own types get their unit: "wrench.force_N.x". Times become ns. Numbers that are not finite are
/// empty. Of sequences with more than 100 values only the length is told: "data.length".
using FlatMessage = std::vector<std::pair<std::string, std::string>>;

/// nullopt where the bytes do not fit the definition.
std::optional<FlatMessage> Flatten(std::string_view cdr, const std::string& ros_type,
                                   const Definitions& definitions);

/// A reader that stands before the field `name` at the top of a message. Its ok() is false where
/// there is none.
CdrReader AtField(std::string_view cdr, const std::string& ros_type, const std::string& name,
                  const Definitions& definitions);

}  // namespace palpate::recording
