// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/error.hpp"
#include "libs/experiment/capture/capture_kind.hpp"
#include "libs/experiment/capture/exports.hpp"
#include "libs/experiment/captured_markers.hpp"

namespace palpate::experiment {

namespace {

CapturedMarkers ReadExport(const std::filesystem::path& file,
                           CapturedMarkers (*read)(CaptureText& text)) {
  CaptureText text(file);
  return read(text);
}

CapturedMarkers ReadAsWritten(const std::filesystem::path& file, const C3dOptions& options) {
  switch (KindOfCapture(file)) {
    case CaptureKind::kC3d: return ReadC3d(file, options);
    case CaptureKind::kMotive: return ReadExport(file, ReadMotiveCsv);
    case CaptureKind::kNexus: return ReadExport(file, ReadNexusCsv);
    case CaptureKind::kQualisys: return ReadExport(file, ReadQualisysTsv);
    case CaptureKind::kTrc: return ReadExport(file, ReadTrc);
    case CaptureKind::kTable: return ReadCapturedCsv(file);
    case CaptureKind::kNone: break;
  }
  throw InputError(SourceLocation{file.string()},
                   "is no motion capture that is read (C3D, CSV of Motive or Nexus, TSV of "
                   "Qualisys, TRC, or a table of the columns t_s, marker, x_m, y_m, z_m)");
}

}  // namespace

CapturedMarkers ReadCapture(const std::filesystem::path& file, const C3dOptions& options) {
  CapturedMarkers captured = ReadAsWritten(file, options);
  TakeOutJumpsToOrigin(&captured);
  return captured;
}

}  // namespace palpate::experiment
