// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "components/perception/observation.hpp"
#include "components/perception/texture/gray_window.hpp"
#include "components/perception/texture/texture_patch.hpp"
#include "components/perception/texture/texture_seeds.hpp"
#include "components/perception/texture_config.hpp"
#include "libs/rgbd/rgbd_camera.hpp"
#include "libs/rgbd/sensed_cloud.hpp"
#include "libs/rgbd/surface_view.hpp"
#include "libs/rgbd/texture_points.hpp"

namespace palpate::perception {

struct TextureTrackerTuning {
  TexturePatchTuning patch = {};
  TextureSeedsTuning seeds = {};
  float worst_sigma_px = 0.3f;  ///< of a place; larger: points that tell little
  /// Cosine of the angle between line of sight and normal, below which a point is not looked for.
  double grazing = 0.35;
  /// Depth before the surface from which something hides it. Smaller: depth noise hides points;
  /// larger: objects count as surface.
  double hidden_m = 8e-3;
  /// Before new points are looked for; where there are none the pause doubles. Fewer: slower.
  int frames_to_look_again = 5;
  int longest_pause_frames = 160;
  /// Frames in a row in which a point was in view but not found, after which it is given up.
  int frames_to_give_up = 90;
  /// Distance about the guess at which a point is looked for where it was not found, px, and how
  /// many points of a frame. Larger: found after greater surprises, slower.
  int search_px = 9;
  int search_step_px = 3;
  int most_searches = 40;
  /// Points that are in view, below which there is no texture to speak of.
  int fewest_points = 12;
  int frames_to_judge = 10;  ///< before it is said
};

/// Follows points of the robot's texture in the colour image. A point is bound to the triangle of
/// the model's surface on which it was first seen, which says where it should be and how its
/// surroundings have turned; the image says where it is. All frames are compared with the first
/// image of a point, so that nothing drifts.
class TextureTracker {
 public:
  /// `camera` must have a colour camera.
  TextureTracker(const TextureConfig& config, const rgbd::RgbdCamera& camera,
                 const TextureTrackerTuning& tuning = {});

  /// `surface`: the predicted surface, fitted to this frame; nullptr: none, nothing is followed.
  /// `objects`: what may hide it, depth camera's frame. The points hold until the next call.
  const rgbd::TexturePoints& Follow(const rgbd::RgbdFrame& frame, const PredictedSurface* surface,
                                    const rgbd::SensedCloud& objects);

  /// What is to be said of the last frame: that the surface has no texture.
  const std::optional<std::string>& note() const { return note_; }

 private:
  struct Track {
    std::uint64_t id;
    int triangle;
    Eigen::Vector3d barycentric;
    TexturePatch patch;
    Eigen::Matrix2d edges_px;  ///< the triangle's edges in the image of the patch
    Eigen::Vector2f surprise_px = Eigen::Vector2f::Zero();  ///< found - expected, in the last frame
    int frames_missed = 0;
    std::optional<FoundPatch> found = {};
  };
  /// Where a track should be.
  struct Expected {
    Eigen::Vector2f place_px;
    Eigen::Matrix2f warp;
  };

  void Look(const PredictedSurface& surface, const rgbd::SensedCloud& objects);
  void TakeObjects(const Eigen::Matrix3Xd& points_m);
  std::optional<Expected> Expect(const Track& track) const;
  Eigen::Matrix2d EdgesAt(int triangle, const Eigen::Vector3d& point_m) const;
  bool IsHidden(const rgbd::RgbdFrame& frame, const Eigen::Vector3d& point_m) const;
  bool IsUnderObject(const Eigen::Vector2d& place_px) const;
  bool IsFacing(int triangle, const Eigen::Vector3d& point_m) const;
  Eigen::Vector3d PointOf(int triangle, const Eigen::Vector3d& barycentric) const;
  void FindTracks(const rgbd::RgbdFrame& frame);
  std::optional<FoundPatch> FindNear(const Track& track, const Expected& expected,
                                     const Eigen::Vector2f& common_px) const;
  std::optional<FoundPatch> Search(const Track& track, const Expected& expected) const;
  void AddTracks(const rgbd::RgbdFrame& frame);
  std::optional<Track> TrackAt(const rgbd::RgbdFrame& frame, const Eigen::Vector2i& seed_px);
  void Judge();
  void Report();

  TextureConfig config_;
  rgbd::RgbdCamera camera_;
  TextureTrackerTuning tuning_;
  rgbd::SurfaceView view_;  ///< of the colour camera
  GrayWindow gray_;
  Eigen::Matrix3Xd vertices_m_;  ///< of the surface, colour camera's frame
  Eigen::Matrix3Xi triangles_;
  std::vector<Eigen::Vector2d> objects_px_;  ///< places of objects on or near the surface
  std::vector<Track> tracks_;
  std::uint64_t next_id_ = 0;
  int frames_to_look_again_ = 1;
  int frames_since_look_ = 0;
  int frames_without_texture_ = 0;
  int in_view_ = 0;  ///< tracks of the last frame that were found
  rgbd::TexturePoints points_;
  std::optional<std::string> note_;
};

}  // namespace palpate::perception
