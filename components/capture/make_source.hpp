// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <memory>

#include "components/capture/config.hpp"
#include "components/capture/frame_source.hpp"
#include "libs/core/config_node.hpp"

namespace palpate::capture {

/// The source that the settings ask for. Throws InputError for settings that do not fit together,
/// or a recording that cannot be read; a camera that is not there is no error but waited for.
std::unique_ptr<FrameSource> MakeSource(const Config& config, const ConfigLoader& load);

}  // namespace palpate::capture
