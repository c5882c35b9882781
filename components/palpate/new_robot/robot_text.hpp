// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "components/palpate/new_robot/robot_draft.hpp"

namespace palpate::command {

/// The robot file of a draft, with a comment at each key: what it means, and what is a guess.
/// `mesh`: its path in the file.
std::string FormatNewRobot(const RobotDraft& draft, const std::string& mesh);

/// The commented lines of a text of any length, at most 100 columns, each with `indent` blanks.
std::string CommentText(const std::string& text, int indent = 0);

}  // namespace palpate::command
