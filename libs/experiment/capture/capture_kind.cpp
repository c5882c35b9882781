// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/capture/capture_kind.hpp"

#include <string_view>

#include "libs/core/check.hpp"
#include "libs/experiment/capture/capture_text.hpp"

namespace palpate::experiment {

namespace {

constexpr char kC3dMagic = 0x50;

bool IsTextEnding(const std::string& ending) {
  return ending == ".csv" || ending == ".tsv" || ending == ".txt" || ending == ".trc";
}

// Sections of Nexus stand one after the other, each with its name alone on a line.
bool IsNexus(CaptureText& text) {
  text.Rewind();
  while (text.NextLine()) {
    if (text.Cell(0) != "Trajectories") continue;
    bool alone = true;
    for (std::size_t column = 1; column < text.cells().size(); ++column) {
      alone = alone && text.Cell(column).empty();
    }
    if (alone) return true;
  }
  return false;
}

}  // namespace

CaptureKind KindOfCapture(const std::filesystem::path& file) {
  const std::string ending = LowerCase(file.extension().string());
  CaptureText text(file);
  const std::string_view bytes = text.bytes();
  if (bytes.size() > 1 && bytes[1] == kC3dMagic && bytes[0] < ' ') return CaptureKind::kC3d;
  if (ending == ".c3d") return CaptureKind::kC3d;  // its reader says what is wrong
  if (!IsTextEnding(ending) || !text.NextLine()) {
    return ending == ".csv" ? CaptureKind::kTable : CaptureKind::kNone;
  }
  const std::string first = LowerCase(text.Cell(0));
  if (first == "format version") return CaptureKind::kMotive;
  if (first == "no_of_frames") return CaptureKind::kQualisys;
  if (first == "pathfiletype") return CaptureKind::kTrc;
  if (IsNexus(text)) return CaptureKind::kNexus;
  return ending == ".trc" ? CaptureKind::kTrc : CaptureKind::kTable;
}

std::string ToString(CaptureKind kind) {
  switch (kind) {
    case CaptureKind::kC3d: return "C3D motion capture";
    case CaptureKind::kMotive: return "CSV of OptiTrack Motive";
    case CaptureKind::kNexus: return "CSV of Vicon Nexus";
    case CaptureKind::kQualisys: return "TSV of Qualisys Track Manager";
    case CaptureKind::kTrc: return "TRC motion capture";
    case CaptureKind::kTable: return "table";
    case CaptureKind::kNone: break;
  }
  PALPATE_CHECK(false, static_cast<int>(kind));
  return {};
}

}  // namespace palpate::experiment
