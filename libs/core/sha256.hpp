// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <string_view>

namespace palpate {

/// SHA-256 (FIPS 180-4) of `bytes` as 64 lower-case hexadecimal digits, as `sha256sum` prints it.
/// Says which file a result came from; not used for secrets.
std::string Sha256Hex(std::string_view bytes);

}  // namespace palpate
