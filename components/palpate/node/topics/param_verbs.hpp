// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/app/verbs.hpp"

namespace palpate::command {

/// `palpate param`: list, get, set and describe, in the lines of `ros2 param`.
app::Verb ParamVerb();

}  // namespace palpate::command
