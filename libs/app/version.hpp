// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

namespace palpate::app {

/// "0.1.0", as the project's CMakeLists.txt says.
const char* Version();

/// The answer of `program` to --version: "palpate 0.1.0" and the end of the line.
std::string VersionLine(const std::string& program);

}  // namespace palpate::app
