// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "libs/core/index.hpp"
#include "libs/core/status.hpp"
#include "libs/rgbd/rgbd_camera.hpp"
#include "libs/rgbd/rgbd_frame.hpp"

namespace palpate::perception {

/// Depth in metres and the colour of each depth pixel.
struct RegisteredFrame {
  rgbd::RangeImage z_m;    ///< NaN: no depth, or the ray of the pixel is unknown
  rgbd::ColorImage color;  ///< size of the depth image; black where not known
  std::vector<char>
      color_known;  ///< [pixels] 0: out of the colour camera's view, or hidden from it
};

struct RegistrationTuning {
  /// Edge of the z-buffer's cells, in steps of depth pixels in the colour image. Smaller: slanted
  /// surfaces leave open cells, through which farther pixels take their colour; larger: more pixels
  /// near edges lose their colour.
  double cell_steps = 1.5;
  /// Parallax of two surfaces, in colour pixels, from which the nearer occludes the farther.
  /// Larger: wrong colours at edges; smaller: pixels lose their colour by noise.
  float occluded_parallax_px = 1.0f;
  /// Border of a window within which occluding surfaces are considered. Larger: slower; smaller:
  /// near objects beside the window occlude nothing.
  int reach_px = 48;
};

/// Registers depth and colour of one camera: forward warp of the depth pixels into the colour image
/// with a z-buffer, so that a farther surface does not have the colour of a nearer one.
class Registration {
 public:
  explicit Registration(const rgbd::RgbdCamera& camera, const RegistrationTuning& tuning = {});

  /// A part of the depth image: first pixels, and one past the last.
  struct Window {
    int u_begin = 0;
    int v_begin = 0;
    int u_end = 0;
    int v_end = 0;
  };

  /// kInvalidInput for images of another size than the camera's. Buffers are used again.
  Status Register(const rgbd::RgbdFrame& frame, RegisteredFrame* registered);
  /// The first half of it: the depth without colours.
  Status RegisterDepth(const rgbd::RgbdFrame& frame, RegisteredFrame* registered) const;
  /// The second half, after the first: the colours in a part of the image. Occluding surfaces more
  /// than reach_px beside that part are not considered. Outside, `registered` is unchanged.
  void RegisterColor(const rgbd::RgbdFrame& frame, const Window& window,
                     RegisteredFrame* registered);

  /// (x, y, 1) that is the ray of the depth pixel; NaN where the lens model has no inverse.
  Eigen::Vector3f Ray(int u_px, int v_px) const {
    return rays_.col(ToIndex(v_px) * camera_.depth.width_px + u_px);
  }
  /// What RegisterDepth gives one pixel of a frame of the camera's size.
  float Depth_m(const rgbd::RgbdFrame& frame, int u_px, int v_px) const;
  const rgbd::RgbdCamera& camera() const { return camera_; }

 private:
  void LayColorRays();
  void MapColor(const rgbd::ColorImage& color, const Window& window, RegisteredFrame* registered);
  template <bool kDistorted>
  void ProjectRow(int v, const Window& window, const float* z_m);
  void Splat(int v, const Window& window);
  void TakeColors(const rgbd::ColorImage& color, int v, const Window& window,
                  RegisteredFrame* registered) const;

  rgbd::RgbdCamera camera_;
  RegistrationTuning tuning_;
  Eigen::Matrix3Xf rays_;           ///< [3 x depth pixels]
  std::vector<std::size_t> blind_;  ///< pixels without a ray
  // Of a colour camera of its own:
  Eigen::Isometry3d T_color_depth_ = Eigen::Isometry3d::Identity();
  Eigen::Array<float, Eigen::Dynamic, 3> color_rays_;  ///< [depth pixels x 3] in its frame
  int cell_px_ = 1;  ///< colour pixels along each side of a cell of the z-buffer
  int cell_columns_ = 0;
  std::vector<int> color_pixel_;    ///< [depth pixels] in the colour image; kNowhere
  std::vector<int> cell_;           ///< [depth pixels] of the z-buffer
  std::vector<float> color_z_m_;    ///< [depth pixels] in the colour camera's frame
  std::vector<float> nearest_z_m_;  ///< [cells]
};

}  // namespace palpate::perception
