// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>

namespace palpate::experiment {

/// Files of motion capture, told apart by their first bytes.
enum class CaptureKind {
  kNone,
  kC3d,
  kMotive,    ///< CSV of OptiTrack Motive
  kNexus,     ///< CSV of Vicon Nexus
  kQualisys,  ///< TSV of Qualisys Track Manager
  kTrc,       ///< Track Row Column
  kTable,     ///< a row for each time and marker; only by the ending .csv, .tsv or .txt
};

/// Throws InputError where the file cannot be read.
CaptureKind KindOfCapture(const std::filesystem::path& file);

/// "CSV of OptiTrack Motive", for people; not of kNone.
std::string ToString(CaptureKind kind);

}  // namespace palpate::experiment
