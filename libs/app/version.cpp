// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/version.hpp"

namespace palpate::app {

const char* Version() { return PALPATE_VERSION; }

}  // namespace palpate::app
