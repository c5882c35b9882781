// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/texture/texture_tracker.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "libs/core/index.hpp"
#include "libs/core/statistics.hpp"

namespace palpate::perception {

namespace {

/// Of the points that are first seen in a frame. No process that starts again gives the same ones,
/// as it begins with another frame.
std::uint64_t FirstId(std::int64_t stamp_ns) {
  constexpr std::uint64_t kMostPoints = 2048;  // more than TextureConfig allows
  return static_cast<std::uint64_t>(stamp_ns) * kMostPoints;
}

/// A registered colour image has the pixels of the depth image.
const rgbd::CameraModel& LensOf(const rgbd::RgbdCamera& camera) {
  return camera.color_registered ? camera.depth : camera.color;
}

Eigen::Isometry3d PoseOf(const rgbd::RgbdCamera& camera) {
  return camera.color_registered ? Eigen::Isometry3d::Identity() : camera.T_depth_color;
}

/// Derivative of a pinhole's image by the point.
Eigen::Matrix<double, 2, 3> ImageGradient_px(const rgbd::CameraModel& lens,
                                             const Eigen::Vector3d& point_m) {
  Eigen::Matrix<double, 2, 3> gradient;
  gradient << lens.fx_px, 0.0, -lens.fx_px * point_m.x() / point_m.z(),  //
      0.0, lens.fy_px, -lens.fy_px * point_m.y() / point_m.z();
  return gradient / point_m.z();
}

Eigen::Vector2f MedianOf(const std::vector<Eigen::Vector2f>& steps_px) {
  if (steps_px.empty()) return Eigen::Vector2f::Zero();
  std::vector<double> u, v;
  for (const Eigen::Vector2f& step_px : steps_px) {
    u.push_back(step_px.x());
    v.push_back(step_px.y());
  }
  return {static_cast<float>(Median(u)), static_cast<float>(Median(v))};
}

}  // namespace

TextureTracker::TextureTracker(const TextureConfig& config, const rgbd::RgbdCamera& camera,
                               const TextureTrackerTuning& tuning)
    : config_(config), camera_(camera), tuning_(tuning), view_(LensOf(camera)) {
  points_.origin_m = PoseOf(camera).translation();
}

const rgbd::TexturePoints& TextureTracker::Follow(const rgbd::RgbdFrame& frame,
                                                  const PredictedSurface* surface,
                                                  const rgbd::SensedCloud& objects) {
  note_.reset();
  in_view_ = 0;
  for (Track& track : tracks_) track.found.reset();
  const rgbd::CameraModel& lens = view_.camera();
  const bool fits =
      frame.color.width_px == lens.width_px && frame.color.height_px == lens.height_px;
  if (surface != nullptr && fits) {
    Look(*surface, objects);
    gray_.Take(frame.color, view_.bounds(), TexturePatch::kSide_px);
    FindTracks(frame);
    AddTracks(frame);
    Judge();
  }
  Report();
  return points_;
}

void TextureTracker::Look(const PredictedSurface& surface, const rgbd::SensedCloud& objects) {
  const Eigen::Isometry3d T_color_depth = PoseOf(camera_).inverse();
  vertices_m_ = T_color_depth * surface.vertices_m.colwise().homogeneous();
  triangles_ = surface.triangles;
  view_.Look(vertices_m_, triangles_);
  TakeObjects(T_color_depth * objects.points_m.cast<double>().colwise().homogeneous());
}

/// Those that a patch on the drawn surface may show.
void TextureTracker::TakeObjects(const Eigen::Matrix3Xd& points_m) {
  const rgbd::SurfaceView::Bounds& drawn = view_.bounds();
  constexpr int kReach_px = TexturePatch::kHalf_px;
  objects_px_.clear();
  for (const Eigen::Vector3d point_m : points_m.colwise()) {
    const Eigen::Vector2d place_px = Project(view_.camera(), point_m);
    const bool is_near =
        place_px.x() >= drawn.u_begin - kReach_px && place_px.x() < drawn.u_end + kReach_px &&
        place_px.y() >= drawn.v_begin - kReach_px && place_px.y() < drawn.v_end + kReach_px;
    if (is_near) objects_px_.push_back(place_px);
  }
}

/// Whether the patch there shows a part of an object.
bool TextureTracker::IsUnderObject(const Eigen::Vector2d& place_px) const {
  return std::any_of(objects_px_.begin(), objects_px_.end(), [&](const Eigen::Vector2d& object_px) {
    return (object_px - place_px).lpNorm<Eigen::Infinity>() <= TexturePatch::kHalf_px;
  });
}

Eigen::Vector3d TextureTracker::PointOf(int triangle, const Eigen::Vector3d& barycentric) const {
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();
  for (int corner = 0; corner < 3; ++corner) {
    point_m += barycentric[corner] * vertices_m_.col(triangles_(corner, triangle));
  }
  return point_m;
}

Eigen::Matrix2d TextureTracker::EdgesAt(int triangle, const Eigen::Vector3d& point_m) const {
  const Eigen::Vector3i corners = triangles_.col(triangle);
  Eigen::Matrix<double, 3, 2> edges_m;
  edges_m.col(0) = vertices_m_.col(corners[1]) - vertices_m_.col(corners[0]);
  edges_m.col(1) = vertices_m_.col(corners[2]) - vertices_m_.col(corners[0]);
  return ImageGradient_px(view_.camera(), point_m) * edges_m;
}

bool TextureTracker::IsFacing(int triangle, const Eigen::Vector3d& point_m) const {
  const Eigen::Vector3i corners = triangles_.col(triangle);
  const Eigen::Vector3d a_m = vertices_m_.col(corners[0]);
  const Eigen::Vector3d normal =
      (vertices_m_.col(corners[1]) - a_m).cross(vertices_m_.col(corners[2]) - a_m).normalized();
  return -normal.dot(point_m.normalized()) >= tuning_.grazing;
}

/// By another part of the body, by an object, or by something that the depth image shows before it.
bool TextureTracker::IsHidden(const rgbd::RgbdFrame& frame, const Eigen::Vector3d& point_m) const {
  const Eigen::Vector2d place_px = Project(view_.camera(), point_m);
  const int u = static_cast<int>(std::lround(place_px.x()));
  const int v = static_cast<int>(std::lround(place_px.y()));
  if (u < 0 || v < 0 || u >= view_.camera().width_px || v >= view_.camera().height_px) return true;
  if (IsUnderObject(place_px)) return true;
  const double drawn_m = view_.Z_m(u, v);
  if (drawn_m > 0.0 && drawn_m < point_m.z() - tuning_.hidden_m) return true;
  const Eigen::Vector3d in_depth_m = PoseOf(camera_) * point_m;
  const Eigen::Vector2d depth_px = Project(camera_.depth, in_depth_m);
  const int ud = static_cast<int>(std::lround(depth_px.x()));
  const int vd = static_cast<int>(std::lround(depth_px.y()));
  if (ud < 0 || vd < 0 || ud >= frame.depth.width_px || vd >= frame.depth.height_px) return true;
  const int steps = *frame.depth.Pixel(ud, vd);
  if (steps == camera_.invalid_value) return false;
  return steps * camera_.depth_unit_m < in_depth_m.z() - tuning_.hidden_m;
}

std::optional<TextureTracker::Expected> TextureTracker::Expect(const Track& track) const {
  const Eigen::Vector3d point_m = PointOf(track.triangle, track.barycentric);
  if (point_m.z() < rgbd::SurfaceView::kNearest_m || !IsFacing(track.triangle, point_m)) return {};
  const Eigen::Matrix2d warp = EdgesAt(track.triangle, point_m) * track.edges_px.inverse();
  return Expected{.place_px = Project(view_.camera(), point_m).cast<float>(),
                  .warp = warp.cast<float>()};
}

/// Those that are near where they should be first: what they have in common helps the others.
void TextureTracker::FindTracks(const rgbd::RgbdFrame& frame) {
  std::vector<Eigen::Vector2f> surprises_px;
  std::vector<std::pair<Track*, Expected>> missing;
  const auto take = [&](Track& track, const Expected& expected, std::optional<FoundPatch> found) {
    track.found = found;
    track.frames_missed = found ? 0 : track.frames_missed + 1;
    track.surprise_px = found ? Eigen::Vector2f(found->place_px - expected.place_px)
                              : Eigen::Vector2f(Eigen::Vector2f::Zero());
    if (!found) return;
    surprises_px.push_back(track.surprise_px);
    ++in_view_;
  };
  for (Track& track : tracks_) {
    const std::optional<Expected> expected = Expect(track);
    if (!expected || IsHidden(frame, PointOf(track.triangle, track.barycentric))) continue;
    const auto found = FindNear(track, *expected, track.surprise_px);
    if (found) {
      take(track, *expected, found);
    } else {
      missing.emplace_back(&track, *expected);
    }
  }
  const Eigen::Vector2f common_px = MedianOf(surprises_px);
  int searches = 0;
  for (auto& [track, expected] : missing) {
    auto found = FindNear(*track, expected, common_px);
    if (!found && searches++ < tuning_.most_searches) found = Search(*track, expected);
    take(*track, expected, found);
  }
  std::erase_if(tracks_, [this](const Track& track) {
    return track.frames_missed >= tuning_.frames_to_give_up;
  });
}

std::optional<FoundPatch> TextureTracker::FindNear(const Track& track, const Expected& expected,
                                                   const Eigen::Vector2f& step_px) const {
  auto found = track.patch.Find(gray_, expected.warp, expected.place_px + step_px, tuning_.patch);
  if (found && found->sigma_px > tuning_.worst_sigma_px) found.reset();
  return found;
}

/// The best of those that begin around the expected place.
std::optional<FoundPatch> TextureTracker::Search(const Track& track,
                                                 const Expected& expected) const {
  std::optional<FoundPatch> best;
  const int reach = tuning_.search_px;
  for (int dv = -reach; dv <= reach; dv += tuning_.search_step_px) {
    for (int du = -reach; du <= reach; du += tuning_.search_step_px) {
      const auto found = FindNear(track, expected, Eigen::Vector2f(du, dv));
      if (found && (!best || found->correlation > best->correlation)) best = found;
    }
  }
  return best;
}

std::optional<TextureTracker::Track> TextureTracker::TrackAt(const rgbd::RgbdFrame& frame,
                                                             const Eigen::Vector2i& seed_px) {
  const int triangle = view_.Triangle(seed_px.x(), seed_px.y());
  const Eigen::Vector3d ray = Unproject(view_.camera(), seed_px.cast<double>());
  Eigen::Matrix3d corners_m;
  for (int i = 0; i < 3; ++i) corners_m.col(i) = vertices_m_.col(triangles_(i, triangle));
  // The ray is a mix of the corners: shares that add up to 1 are those of its point.
  const Eigen::Vector3d shares = Eigen::PartialPivLU<Eigen::Matrix3d>(corners_m).solve(ray);
  const Eigen::Vector3d barycentric = shares / shares.sum();
  if (!barycentric.allFinite()) return std::nullopt;
  const Eigen::Vector3d point_m = PointOf(triangle, barycentric);
  const Eigen::Matrix2d edges_px = EdgesAt(triangle, point_m);
  if (!IsFacing(triangle, point_m) || IsHidden(frame, point_m)) return std::nullopt;
  if (!(std::abs(edges_px.determinant()) > 0.0)) return std::nullopt;
  return Track{.id = next_id_++,
               .triangle = triangle,
               .barycentric = barycentric,
               .patch = TexturePatch(gray_, seed_px.x(), seed_px.y()),
               .edges_px = edges_px};
}

/// Where the surface has no texture left, new points are looked for ever more seldom.
void TextureTracker::AddTracks(const rgbd::RgbdFrame& frame) {
  const auto most = At(config_.max_points);
  if (tracks_.size() >= most || ++frames_since_look_ < frames_to_look_again_) return;
  frames_since_look_ = 0;
  next_id_ = std::max(next_id_, FirstId(frame.stamp_ns));
  std::vector<Eigen::Vector2d> taken_px;
  for (const Track& track : tracks_) {
    taken_px.push_back(Project(view_.camera(), PointOf(track.triangle, track.barycentric)));
  }
  const std::size_t before = tracks_.size();
  for (const Eigen::Vector2i& seed_px :
       SeedPlaces_px(gray_, view_, taken_px, config_.max_points, tuning_.seeds)) {
    if (tracks_.size() == most) break;
    if (auto track = TrackAt(frame, seed_px)) tracks_.push_back(std::move(*track));
  }
  const bool found = tracks_.size() > before;
  frames_to_look_again_ = found ? tuning_.frames_to_look_again
                                : std::min(2 * frames_to_look_again_, tuning_.longest_pause_frames);
}

void TextureTracker::Judge() {
  frames_without_texture_ = in_view_ < tuning_.fewest_points ? frames_without_texture_ + 1 : 0;
  if (frames_without_texture_ < tuning_.frames_to_judge) return;
  note_ =
      "the robot's surface shows too little texture to follow: its tangential motion is not "
      "measured";
}

void TextureTracker::Report() {
  points_.ids.clear();
  points_.directions.resize(3, in_view_);
  points_.sigma_rad.resize(in_view_);
  const rgbd::CameraModel& lens = view_.camera();
  const auto focal_px = static_cast<float>(std::min(lens.fx_px, lens.fy_px));
  const Eigen::Matrix3d R_depth_color = PoseOf(camera_).linear();
  Eigen::Index k = 0;
  for (const Track& track : tracks_) {
    if (!track.found) continue;
    const Eigen::Vector3d ray = Unproject(lens, track.found->place_px.cast<double>());
    points_.ids.push_back(track.id);
    points_.directions.col(k) = (R_depth_color * ray.normalized()).cast<float>();
    points_.sigma_rad[k++] = track.found->sigma_px / focal_px;
  }
}

}  // namespace palpate::perception
