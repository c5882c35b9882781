// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "libs/experiment/recording.hpp"

namespace palpate::experiment {

/// How the names of images and clouds tell their times.
struct FrameNames {
  std::vector<std::string> extensions;  ///< ".png", ...; the case of letters does not matter
  bool skip_others = false;             ///< files of other extensions are left alone, not refused
  /// The last digits of a name are the number of a frame, t_s = number / rate. Absent: a name is a
  /// time, whole nanoseconds (1712.png is 1712 ns) or seconds with a point (1.712.png).
  std::optional<double> frame_rate_Hz;
};

/// The files of a folder by rising time; none where there is no such folder. Throws InputError for
/// a name that is no time, two of one time, and whole numbers so near to each other that they count
/// frames or another unit than nanoseconds.
std::vector<StampedFile> ListStampedFiles(const std::filesystem::path& folder,
                                          const FrameNames& names);

/// "1305031453.374112" or "1.305031453374112e+09" in nanoseconds, without the rounding of a double;
/// false for anything else.
bool ParseSeconds_ns(std::string_view text, std::int64_t* t_ns);

}  // namespace palpate::experiment
