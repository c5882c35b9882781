// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/app/verbs.hpp"

namespace palpate::command {

/// `palpate play`: palpate-player in this process.
app::Verb PlayVerb();

}  // namespace palpate::command
