// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "components/calibration/cloud/cloud_frame.hpp"
#include "components/calibration/joint/calibration_frame.hpp"
#include "components/calibration/live/cable_watch.hpp"
#include "components/calibration/live/marker_means.hpp"
#include "components/calibration/pose/frame_assignment.hpp"
#include "libs/geometry/depth_picture.hpp"

namespace palpate::calibration {

/// The untouched robot's points in one picture.
struct SeenCloud {
  std::int64_t stamp_ns = 0;
  rgbd::SensedCloud cloud;         ///< camera frame
  geometry::DepthPicture picture;  ///< that it was made from
};

struct CollectorSettings {
  RestSettings rest;
  robot::CableInput cable_input = robot::CableInput::kDisplacement;
  /// A cable must be set otherwise by so much for another frame.
  double new_setting_m = 1e-3;
  double new_setting_N = 0.1;
  int marker_pictures = 20;    ///< that a frame of markers is the mean of
  double marker_bias_m = 0.0;  ///< what averaging does not remove, one sigma
};

/// Takes frames for a calibration from what goes by: of a robot with cables one of each setting in
/// which they came to rest, else one in every still_s.
class FrameCollector {
 public:
  FrameCollector(const robot::RobotModel& model, const CollectorSettings& settings);

  /// Forgets the frames; `count` new ones are wanted.
  void Begin(int count);
  void Add(CableReading reading);
  void Add(SeenCloud seen) { Add(Seen(std::move(seen))); }
  void Add(SeenMarkers seen) { Add(Seen(std::move(seen))); }

  int taken() const { return static_cast<int>(settings_taken_.size()); }
  bool IsComplete() const { return wanted_ > 0 && taken() >= wanted_; }
  /// Why there is no further frame yet, for a person.
  const std::string& waits_for() const { return waits_for_; }
  /// What was taken: of one kind.
  const std::vector<CloudFrame>& clouds() const { return clouds_; }
  const std::vector<CalibrationFrame>& markers() const { return markers_; }
  /// Markers without names: where the first picture that was taken had none.
  const std::vector<UnlabelledFrame>& points() const { return points_; }
  /// That all clouds were made from; nullopt where it is not one.
  std::optional<geometry::DepthPicture> picture() const;

 private:
  using Seen = std::variant<SeenCloud, SeenMarkers>;
  struct Setting {
    std::int64_t stamp_ns = 0;
    std::vector<robot::CableCommand> cables;
  };

  void Add(Seen seen);
  void Advance();
  void Look(Seen seen);
  bool IsNew(const Setting& setting) const;
  void Take(SeenCloud seen, Setting setting);
  void Take(SeenMarkers seen, Setting setting);
  std::string NextName() const;

  static constexpr std::size_t kMostWaiting = 256;

  std::vector<std::string> cable_names_;
  Eigen::Vector3d gravity_m_s2_;
  CollectorSettings settings_;
  CableWatch watch_;
  int wanted_ = 0;
  std::deque<Seen> waiting_;        ///< for the cable readings of their time
  std::vector<SeenMarkers> group_;  ///< of this rest
  std::vector<Setting> settings_taken_;
  std::vector<CloudFrame> clouds_;
  std::vector<geometry::DepthPicture> pictures_;  ///< [clouds]
  std::vector<CalibrationFrame> markers_;
  std::vector<UnlabelledFrame> points_;
  std::string waits_for_;
};

}  // namespace palpate::calibration
