// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/app/verbs.hpp"

namespace palpate::command {

/// `palpate view`: shows the running system, or a recording, in the browser.
app::Verb ViewVerb();

}  // namespace palpate::command
