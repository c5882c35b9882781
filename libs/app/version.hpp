// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

namespace palpate::app {

/// "0.1.0", as the project's CMakeLists.txt says.
const char* Version();

}  // namespace palpate::app
