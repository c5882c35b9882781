// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <utility>

#include "libs/core/status.hpp"

namespace palpate::dds {

/// What becomes of a message that cannot be used: `reason` names the field and its value.
inline Status Invalid(std::string reason) { return {StatusCode::kInvalidInput, std::move(reason)}; }

}  // namespace palpate::dds
