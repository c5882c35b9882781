// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <string_view>

#include "libs/rgbd/image.hpp"

namespace palpate::rgbd {

/// Decodes a JPEG image; grey becomes RGB. Throws InputError, `name` in place of the file: no JPEG,
/// damaged, of four colours (CMYK), more than 64 Mpx.
ColorImage DecodeJpeg(std::string_view jpeg, const std::string& name);

}  // namespace palpate::rgbd
