// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/recording.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <string_view>
#include <utility>

#include "libs/core/check.hpp"
#include "libs/core/text.hpp"

namespace palpate::experiment {

namespace {

constexpr std::array<std::pair<RecordingKind, std::string_view>, 10> kKinds{{
    {RecordingKind::kRest, "rest"},
    {RecordingKind::kRamp, "ramp"},
    {RecordingKind::kHold, "hold"},
    {RecordingKind::kKnownLoad, "known_load"},
    {RecordingKind::kCoContraction, "co_contraction"},
    {RecordingKind::kBaseTilted, "base_tilted"},
    {RecordingKind::kCameraMoved, "camera_moved"},
    {RecordingKind::kSecondSpeed, "second_speed"},
    {RecordingKind::kRepeat, "repeat"},
    {RecordingKind::kFree, "free"},
}};

constexpr std::array<std::pair<MeasurementFrame, std::string_view>, 2> kFrames{{
    {MeasurementFrame::kRobot, "robot"},
    {MeasurementFrame::kCamera, "camera"},
}};

template <typename Table, typename Value>
std::string WordOf(const Table& table, Value value) {
  for (const auto& [entry, word] : table) {
    if (entry == value) return std::string(word);
  }
  PALPATE_CHECK(false, "a value without a word", static_cast<int>(value));
  return {};
}

template <typename Table>
auto ValueOf(const Table& table, const std::string& word, const SourceLocation& where,
             const std::string& what) {
  std::vector<std::string> words;
  for (const auto& [value, known] : table) {
    if (known == word) return value;
    words.emplace_back(known);
  }
  throw InputError(where, what + " '" + Excerpt(word) + "' is not known" + DidYouMean(word, words) +
                              "; it is one of " + Listed(words));
}

void CheckName(const std::string& name, const SourceLocation& where, const std::string& what,
               const std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  throw InputError(where, "the robot has no " + what + " '" + name + "'" + DidYouMean(name, names) +
                              "; it has " + (names.empty() ? "none" : Listed(names)));
}

}  // namespace

std::string ToString(RecordingKind kind) { return WordOf(kKinds, kind); }

std::vector<std::string> RecordingKindWords() {
  std::vector<std::string> words;
  for (const auto& [kind, word] : kKinds) words.emplace_back(word);
  return words;
}

std::string ToString(MeasurementFrame frame) { return WordOf(kFrames, frame); }

RecordingKind ParseRecordingKind(const std::string& word, const SourceLocation& where) {
  return ValueOf(kKinds, word, where, "kind");
}

MeasurementFrame ParseMeasurementFrame(const std::string& word, const SourceLocation& where) {
  return ValueOf(kFrames, word, where, "frame");
}

Eigen::Matrix3d BaseRotation(const Recording& recording) {
  const Eigen::Vector2d tilt_rad =
      recording.base_tilt_deg.value_or(Eigen::Vector2d::Zero()) * (std::numbers::pi / 180.0);
  return (Eigen::AngleAxisd(tilt_rad.y(), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(tilt_rad.x(), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

void CheckMarkers(const Recording& recording, const std::vector<std::string>& names) {
  if (!recording.markers) return;
  for (std::size_t i = 0; i < recording.markers->names.size(); ++i) {
    const std::string& name = recording.markers->names[i];
    if (IsUnlabelled(name)) continue;
    CheckName(name, recording.markers->names_where[i], "marker", names);
  }
}

void CheckActuators(const Recording& recording, const std::vector<std::string>& cables,
                    const std::vector<std::string>& chambers) {
  if (recording.actuation) CheckActuators(*recording.actuation, cables, chambers);
}

}  // namespace palpate::experiment
