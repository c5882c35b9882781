// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/live/frame_collector.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "libs/core/seconds.hpp"
#include "libs/core/text.hpp"

namespace palpate::calibration {

namespace {

using Kind = robot::ActuatorCommand::Kind;
using State = CableWatch::State;

std::int64_t StampOf(const std::variant<SeenCloud, SeenMarkers>& seen) {
  return std::visit([](const auto& one) { return one.stamp_ns; }, seen);
}

/// nullopt where they differ, or are not known.
std::optional<geometry::DepthPicture> TheOneOf(
    const std::vector<geometry::DepthPicture>& pictures) {
  const bool is_one =
      std::adjacent_find(pictures.begin(), pictures.end(), std::not_equal_to<>()) == pictures.end();
  if (pictures.empty() || !is_one || pictures.front().width_px == 0) return std::nullopt;
  return pictures.front();
}

}  // namespace

FrameCollector::FrameCollector(const robot::RobotModel& model, const CollectorSettings& settings)
    : cable_names_(model.ActuatorNames()),
      gravity_m_s2_(model.gravity_m_s2()),
      settings_(settings),
      watch_(cable_names_.size(), settings.cable_input, settings.rest) {}

void FrameCollector::Begin(int count) {
  wanted_ = count;
  waiting_.clear();
  group_.clear();
  settings_taken_.clear();
  clouds_.clear();
  pictures_.clear();
  further_.clear();
  markers_.clear();
  points_.clear();
  waits_for_ = "no cloud or markers of the robot yet";
}

void FrameCollector::Add(CableReading reading) {
  watch_.Add(std::move(reading));
  Advance();
}

void FrameCollector::Add(Seen seen) {
  if (wanted_ == 0 || IsComplete()) return;
  if (waiting_.size() == kMostWaiting) waiting_.pop_front();
  waiting_.push_back(std::move(seen));
  Advance();
}

void FrameCollector::Advance() {
  while (!waiting_.empty() && !IsComplete()) {
    const State state = watch_.At(StampOf(waiting_.front()));
    if (state == State::kNotYet) {
      waits_for_ = watch_.IsEmpty() ? "no cable inputs on /robot/joint_states yet"
                                    : "the cable inputs of that time are not there yet";
      return;
    }
    Seen seen = std::move(waiting_.front());
    waiting_.pop_front();
    if (state == State::kResting) {
      Look(std::move(seen));
    } else {
      group_.clear();
      waits_for_ = "the cables must rest for " + FormatNumber(settings_.rest.still_s) + " s";
    }
  }
}

/// Evaluates a cloud or markers seen while the cables rested.
void FrameCollector::Look(Seen seen) {
  Setting setting{StampOf(seen), watch_.MeanAt(StampOf(seen))};
  if (!IsNew(setting)) {
    group_.clear();
    waits_for_ = cable_names_.empty()
                     ? "one frame is taken in " + FormatNumber(settings_.rest.still_s) + " s"
                     : "this setting was taken: change a cable by " +
                           FormatNumber(settings_.new_setting_m) + " m or " +
                           FormatNumber(settings_.new_setting_N) + " N";
    return;
  }
  std::visit([&](auto&& one) { Take(std::move(one), std::move(setting)); }, std::move(seen));
}

bool FrameCollector::IsNew(const Setting& setting) const {
  return std::all_of(settings_taken_.begin(), settings_taken_.end(), [&](const Setting& taken) {
    if (cable_names_.empty()) {
      return std::abs(NsToSeconds(setting.stamp_ns - taken.stamp_ns)) >= settings_.rest.still_s;
    }
    for (std::size_t c = 0; c < cable_names_.size(); ++c) {
      const robot::ActuatorCommand& now = setting.cables[c];
      const double change = std::abs(now.value - taken.cables[c].value);
      const double enough =
          now.kind == Kind::kTension ? settings_.new_setting_N : settings_.new_setting_m;
      if (now.kind != taken.cables[c].kind || change >= enough) return true;
    }
    return false;
  });
}

void FrameCollector::Take(SeenCloud seen, Setting setting) {
  clouds_.push_back({.name = NextName(),
                     .cloud = std::move(seen.cloud),
                     .cables = setting.cables,
                     .gravity_m_s2 = gravity_m_s2_});
  pictures_.push_back(seen.picture);
  further_.resize(std::max(further_.size(), seen.further.size()));
  for (std::size_t k = 0; k < seen.further.size(); ++k) {
    if (seen.further[k].cloud.Count() == 0) continue;
    further_[k].clouds.push_back({.name = NextName(),
                                  .cloud = std::move(seen.further[k].cloud),
                                  .cables = setting.cables,
                                  .gravity_m_s2 = gravity_m_s2_});
    further_[k].pictures.push_back(seen.further[k].picture);
  }
  settings_taken_.push_back(std::move(setting));
  waits_for_.clear();
}

void FrameCollector::Take(SeenMarkers seen, Setting setting) {
  group_.push_back(std::move(seen));
  if (static_cast<int>(group_.size()) < settings_.marker_pictures) {
    waits_for_ = "averaging " + std::to_string(settings_.marker_pictures) + " marker messages";
    return;
  }
  std::vector<MarkerSighting> means = MeanMarkers(group_, settings_.marker_bias_m);
  group_.clear();
  if (means.empty()) {
    waits_for_ = "no marker of the robot is seen";
    return;
  }
  const bool named = HaveNames(means);
  if (named ? !points_.empty() : !markers_.empty()) {
    waits_for_ = named ? "these markers have names, those of earlier frames had none"
                       : "these markers have no names, those of earlier frames had";
    return;
  }
  CalibrationFrame frame{
      .name = NextName(), .cables = setting.cables, .gravity_m_s2 = gravity_m_s2_};
  if (named) {
    frame.markers = std::move(means);
    markers_.push_back(std::move(frame));
  } else {
    points_.push_back({std::move(frame), std::move(means)});
  }
  settings_taken_.push_back(std::move(setting));
  waits_for_.clear();
}

std::optional<geometry::DepthPicture> FrameCollector::picture() const {
  return TheOneOf(pictures_);
}

std::optional<geometry::DepthPicture> FrameCollector::OfCamera::picture() const {
  return TheOneOf(pictures);
}

std::string FrameCollector::NextName() const { return "frame " + std::to_string(taken() + 1); }

}  // namespace palpate::calibration
