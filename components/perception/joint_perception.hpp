// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "components/perception/camera_perception.hpp"
#include "components/perception/config.hpp"
#include "components/perception/contacts/contact_tracker.hpp"
#include "components/perception/contacts/join_contacts.hpp"
#include "components/perception/observation.hpp"
#include "libs/rgbd/rgbd_camera.hpp"

namespace palpate::perception {

/// The frame of one camera, as part of a frame of all.
struct CameraFrame {
  const rgbd::RgbdFrame* images = nullptr;      ///< nullptr: the camera has none of this time
  const PredictedSurface* predicted = nullptr;  ///< in its frame; nullptr: unknown
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
};

/// What all cameras show at one time.
struct JointObservation {
  std::int64_t stamp_ns = 0;
  std::vector<CameraView> views;          ///< of each camera
  std::vector<DetectedContact> contacts;  ///< of all, in the frame of the first camera

  /// Ok where a camera sees the robot, else that of the first.
  const Status& status() const;
};

/// Perception with one or more cameras. Each camera's frame is segmented by itself, with its own
/// prediction, intrinsics and noise. Contacts that several cameras see are one, and keep their
/// names over the frames whichever camera sees them. With one camera it is Perception.
class JointPerception {
 public:
  /// Throws InputError for settings that contradict each other.
  explicit JointPerception(const Config& config);
  using SegmenterMaker = std::function<std::unique_ptr<Segmenter>(const Config&)>;
  /// With segmenters that `make_segmenter` makes, one for each camera.
  JointPerception(const Config& config, SegmenterMaker make_segmenter);

  /// Frames from these cameras begin, the first of them as number 0: removes all contacts. nullopt:
  /// that camera has no image at all.
  void Open(const std::vector<std::optional<rgbd::RgbdCamera>>& cameras);

  /// One of the cameras, or the same one reopened. The first removes all contacts; a further one
  /// leaves them: the others have seen them meanwhile.
  void SetCamera(std::size_t number, const rgbd::RgbdCamera& camera);
  /// Makes what is known of one camera's images again, with other settings. SetCamera must follow.
  void Restart(std::size_t number, const Config& config);

  /// A frame of each camera, in the order of Open, of which one at least has images. More cameras
  /// than before are new ones. The observation holds until the next call.
  const JointObservation& Update(std::int64_t stamp_ns, const std::vector<CameraFrame>& frames);

 private:
  void HaveCameras(std::size_t count);

  Config config_;
  SegmenterMaker make_segmenter_;
  std::vector<CameraPerception> cameras_;
  ContactTracker tracker_;
  std::vector<DetectedContact> located_;
  JointObservation observation_;
};

}  // namespace palpate::perception
