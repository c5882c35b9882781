// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "libs/core/config_node.hpp"
#include "libs/core/key_table.hpp"
#include "libs/experiment/recording.hpp"

namespace palpate::experiment {

/// The keys of recording.yaml.
const KeyTable& RecordingKeys();

/// Reads recording.yaml strictly into the settings of `recording`; the tables are left alone.
/// Returns `frame_rate_Hz`, for the names of images and clouds. Throws InputError with
/// file:line:column.
std::optional<double> ReadRecordingSettings(const std::filesystem::path& file,
                                            const ConfigLoader& load, Recording& recording);

/// The text of recording.yaml.
std::string FormatRecordingSettings(const Recording& recording);

}  // namespace palpate::experiment
