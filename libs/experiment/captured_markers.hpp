// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "libs/experiment/marker_table.hpp"
#include "libs/experiment/markers.hpp"

namespace palpate::experiment {

/// Markers as a motion-capture system saw them: metres, the laboratory's frame, time from 0 at the
/// first frame of the file (C3D) or as the file has it (CSV).
struct CapturedMarkers {
  MarkerTracks tracks;
  double rate_Hz = 0.0;   ///< frames a second, > 0 (0: a single frame of a CSV file)
  Residuals residuals_m;  ///< of the reconstruction, [frame][marker]; empty where not known
  /// Bit i: camera i saw the marker, [frame][marker]; empty where not known.
  std::vector<std::vector<std::uint8_t>> cameras;
  std::vector<std::string> notes;  ///< what was left out or renamed, one sentence each
};

struct C3dOptions {
  /// "m", "cm" or "mm", for files without POINT:UNITS; such files are refused without it.
  std::optional<std::string> unit_if_absent;
};

/// Reads the 3-D points of a C3D file (https://www.c3d.org/docs/C3D_User_Guide.pdf): Intel, DEC and
/// SGI/MIPS numbers, integer or real points, more than 65535 frames (TRIAL:ACTUAL_END_FIELD,
/// POINT:LONG_FRAMES) and more than 255 labels (LABELS2, ...). Analog samples are skipped. A
/// negative residual and a coordinate that is NaN are a gap. Labels lose their blanks ("Tip - 1"
/// becomes "Tip-1"); points without a label are called unlabelled_<number from 1>. Left out with a
/// note are points that no frame sees, and model outputs that are no lengths (POINT:ANGLES, FORCES,
/// MOMENTS, POWERS, SCALARS and what POINT:TYPE_GROUPS names besides). Two points that share a
/// label and are both seen are called label_1 and label_2, with a note.
/// Throws InputError with the byte offset for a file that is cut short, contradicts itself, sees no
/// point at all or holds an infinite coordinate.
CapturedMarkers ReadC3d(const std::filesystem::path& file, const C3dOptions& options = {});

/// Reads a plain table of one row for each time and marker: time_s or t_s, marker, x, y, z and
/// optionally residual, lengths as _m, _cm or _mm columns, in any order. Throws InputError as
/// ReadMarkers does. The rate is that of the median time step, 0 for a single frame.
CapturedMarkers ReadCapturedCsv(const std::filesystem::path& file);

/// Takes samples at exactly 0, 0, 0 out where the marker is more than 10 mm away in the nearest
/// frame that sees it elsewhere, with a note: programs write so what was not seen.
void TakeOutJumpsToOrigin(CapturedMarkers* captured);

/// Reads any motion capture: C3D, the text files of Motive, Nexus, Qualisys and Cortex (see
/// capture/exports.hpp), or such a plain table. The first bytes decide (capture/capture_kind.hpp).
/// Jumps to the origin are taken out.
CapturedMarkers ReadCapture(const std::filesystem::path& file, const C3dOptions& options = {});

}  // namespace palpate::experiment
