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

/// What one camera sees of the robot.
struct CameraCloud {
  rgbd::SensedCloud cloud;         ///< camera frame; empty: the camera is missing
  geometry::DepthPicture picture;  ///< of the depth image
};

/// Cloud of the robot without contacts.
struct SeenCloud {
  std::int64_t stamp_ns = 0;
  rgbd::SensedCloud cloud;                ///< of the first camera, in its frame
  geometry::DepthPicture picture;         ///< of its depth image
  std::vector<CameraCloud> further = {};  ///< of the cameras beside it
};

struct CollectorSettings {
  RestSettings rest;
  robot::CableInput cable_input = robot::CableInput::kDisplacement;
  /// Smallest change of a cable that makes a new setting.
  double new_setting_m = 1e-3;
  double new_setting_N = 0.1;
  int marker_pictures = 20;    ///< messages whose mean makes one frame
  double marker_bias_m = 0.0;  ///< standard deviation that averaging does not reduce
};

/// Collects frames for a calibration from live data: of a robot with cables one per setting at
/// which they rest, otherwise one in every still_s.
class FrameCollector {
 public:
  FrameCollector(const robot::RobotModel& model, const CollectorSettings& settings);

  /// Clears the frames and starts to collect `count` new ones.
  void Begin(int count);
  void Add(CableReading reading);
  void Add(SeenCloud seen) { Add(Seen(std::move(seen))); }
  void Add(SeenMarkers seen) { Add(Seen(std::move(seen))); }

  int taken() const { return static_cast<int>(settings_taken_.size()); }
  bool IsComplete() const { return wanted_ > 0 && taken() >= wanted_; }
  /// Why there is no further frame yet, as text for the user.
  const std::string& waits_for() const { return waits_for_; }
  /// The collected frames, all of one kind.
  const std::vector<CloudFrame>& clouds() const { return clouds_; }
  const std::vector<CalibrationFrame>& markers() const { return markers_; }
  /// Markers without names, where the first collected frame has none.
  const std::vector<UnlabelledFrame>& points() const { return points_; }
  /// Size and lens of the depth images of all clouds; nullopt where they differ.
  std::optional<geometry::DepthPicture> picture() const;
  /// The same of the cameras beside the first, each with the frames in which it saw the robot.
  struct OfCamera {
    std::vector<CloudFrame> clouds;
    std::vector<geometry::DepthPicture> pictures;  ///< [clouds]

    std::optional<geometry::DepthPicture> picture() const;
  };
  const std::vector<OfCamera>& further() const { return further_; }

 private:
  using Seen = std::variant<SeenCloud, SeenMarkers>;
  struct Setting {
    std::int64_t stamp_ns = 0;
    std::vector<robot::ActuatorCommand> cables;
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
  std::deque<Seen> waiting_;        ///< until the cable readings of their time are there
  std::vector<SeenMarkers> group_;  ///< of this rest
  std::vector<Setting> settings_taken_;
  std::vector<CloudFrame> clouds_;
  std::vector<geometry::DepthPicture> pictures_;  ///< [clouds]
  std::vector<OfCamera> further_;
  std::vector<CalibrationFrame> markers_;
  std::vector<UnlabelledFrame> points_;
  std::string waits_for_;
};

}  // namespace palpate::calibration
