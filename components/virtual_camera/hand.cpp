// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_camera/hand.hpp"

#include <array>

namespace palpate::virtual_camera {

namespace {

struct Bone {
  std::array<double, 3> from_mm;
  std::array<double, 3> to_mm;
  double radius_mm;
};

// Lengths of an adult's hand.
constexpr std::array<Bone, 19> kBones = {{
    {{-35.0, -26.0, 0.0}, {38.0, -30.0, 2.0}, 12.0},   // palm, from the little finger's side
    {{-38.0, -9.0, 0.0}, {42.0, -10.0, 3.0}, 13.0},    //
    {{-38.0, 9.0, 0.0}, {43.0, 11.0, 3.0}, 13.0},      //
    {{-35.0, 24.0, -2.0}, {40.0, 31.0, 2.0}, 12.0},    //
    {{-38.0, 0.0, 0.0}, {-420.0, 0.0, 20.0}, 27.0},    // wrist and forearm
    {{-28.0, 28.0, -6.0}, {8.0, 52.0, -14.0}, 13.0},   // thumb
    {{8.0, 52.0, -14.0}, {36.0, 58.0, -22.0}, 10.5},   //
    {{36.0, 58.0, -22.0}, {60.0, 56.0, -30.0}, 9.0},   //
    {{38.0, -30.0, 2.0}, {66.0, -37.0, -4.0}, 8.5},    // little finger
    {{66.0, -37.0, -4.0}, {84.0, -40.0, -16.0}, 7.5},  //
    {{84.0, -40.0, -16.0}, {96.0, -41.0, -31.0}, 7.0},
    {{42.0, -10.0, 3.0}, {80.0, -13.0, -1.0}, 9.5},  // ring finger
    {{80.0, -13.0, -1.0}, {104.0, -14.0, -12.0}, 8.5},
    {{104.0, -14.0, -12.0}, {119.0, -15.0, -29.0}, 7.5},
    {{43.0, 11.0, 3.0}, {85.0, 12.0, 0.0}, 9.5},  // middle finger
    {{85.0, 12.0, 0.0}, {113.0, 13.0, -9.0}, 8.5},
    {{113.0, 13.0, -9.0}, {130.0, 13.0, -26.0}, 8.0},
    {{40.0, 31.0, 2.0}, {80.0, 37.0, 1.0}, 9.5},  // forefinger
    {{80.0, 37.0, 1.0}, {122.0, 41.0, -14.0}, 8.0},
}};

Eigen::Vector3d Metres(const std::array<double, 3>& mm) {
  return 1e-3 * Eigen::Vector3d(mm[0], mm[1], mm[2]);
}

}  // namespace

std::vector<DrawnRound> MakeHand(const Eigen::Isometry3d& T_robot_tool, int paint) {
  std::vector<DrawnRound> hand;
  for (const Bone& bone : kBones) {
    const Eigen::Vector3d from = Metres(bone.from_mm);
    const Eigen::Vector3d along = Metres(bone.to_mm) - from;
    Eigen::Isometry3d T_tool_bone = Eigen::Isometry3d::Identity();
    T_tool_bone.translation() = from + 0.5 * along;
    T_tool_bone.linear() =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), along).toRotationMatrix();
    hand.push_back({.radius_m = 1e-3 * bone.radius_mm,
                    .half_length_m = 0.5 * along.norm(),
                    .round_ends = true,
                    .T_robot_shape = T_robot_tool * T_tool_bone,
                    .paint = paint});
  }
  return hand;
}

}  // namespace palpate::virtual_camera
