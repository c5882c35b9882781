// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "components/offline/forces/force_replay.hpp"

namespace palpate::python {

/// "recordings", "first" or "none". Throws InputError.
offline::BiasFrom ReadBiasFrames(const std::string& word);

}  // namespace palpate::python
