// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "components/recorder/status_table.hpp"

namespace palpate::recorder {

/// One line of JSON; names end in their unit.
std::string StatusJson(const RecorderStatus& status);

}  // namespace palpate::recorder
