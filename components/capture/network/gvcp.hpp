// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

namespace palpate::capture {

/// UDP port of a camera's control channel (GVCP of GigE Vision).
inline constexpr int kGvcpPort = 3956;

}  // namespace palpate::capture
