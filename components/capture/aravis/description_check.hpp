// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <arv.h>

#include "libs/core/status.hpp"

namespace palpate::capture {

/// Not ok where a device's GenICam description would send Aravis in circles: a value that is
/// computed from itself. Aravis follows such links by calling itself until the stack is full.
Status CheckDescription(ArvDevice* device);

}  // namespace palpate::capture
