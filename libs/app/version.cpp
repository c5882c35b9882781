// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/version.hpp"

namespace palpate::app {

const char* Version() { return PALPATE_VERSION; }

std::string VersionLine(const std::string& program) { return program + " " + Version() + "\n"; }

}  // namespace palpate::app
