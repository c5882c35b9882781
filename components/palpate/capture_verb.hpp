// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/app/verbs.hpp"

namespace palpate::command {

/// `palpate capture --list [ADDRESS...]`: the GenICam cameras that answer, with model, serial
/// number, address, components and formats; --json for machines.
app::Verb CaptureVerb();

}  // namespace palpate::command
