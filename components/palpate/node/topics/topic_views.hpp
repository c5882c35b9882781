// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/app/verbs.hpp"

namespace palpate::command {

/// `palpate topic list` and `palpate topic info`, in the lines of `ros2 topic`.
app::Verb TopicListVerb();
app::Verb TopicInfoVerb();

}  // namespace palpate::command
