// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>

#include "libs/rgbd/image.hpp"

namespace palpate::rgbd {

/// Reads a colour image, PNG or JPEG by its first bytes. Throws InputError naming the file as
/// ReadColorPng and DecodeJpeg do.
ColorImage ReadColorImage(const std::filesystem::path& file);

}  // namespace palpate::rgbd
