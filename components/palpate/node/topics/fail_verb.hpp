// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/app/verbs.hpp"

namespace palpate::command {

/// `palpate fail`: makes the data of a running component faulty.
app::Verb FailVerb();

}  // namespace palpate::command
