// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "libs/core/parameter.hpp"

namespace palpate::command {

/// "double array", in the words of `ros2 param describe`.
std::string ParameterTypeName(const ParameterValue& value);

/// "Double value is: 0.5", the line of `ros2 param get`; `hide_type`: "0.5".
std::string ParameterLine(const ParameterValue& value, bool hide_type);

/// As JSON; null where it is not set.
std::string ParameterJson(const ParameterValue& value);

/// The lines of `ros2 param describe`. Of the value only its type counts.
std::string ParameterDescription(const Parameter& parameter);

/// Reads what was typed on the command line as a value of the type of `like`; where that is not
/// set, as YAML has it. Throws InputError ("must be ...").
ParameterValue ParseParameter(const std::string& text, const ParameterValue& like);

}  // namespace palpate::command
