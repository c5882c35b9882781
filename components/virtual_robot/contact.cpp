// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/contact.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate::virtual_robot {

double ContactLaw::Pressure_Pa(double depth_m) const {
  if (depth_m <= 0.0) return 0.0;
  if (depth_m < 2.0 * onset_m) return stiffness_Pa_m * depth_m * depth_m / (4.0 * onset_m);
  return stiffness_Pa_m * (depth_m - onset_m);
}

double ContactLaw::Slope_Pa_m(double depth_m) const {
  return stiffness_Pa_m * std::clamp(depth_m / (2.0 * onset_m), 0.0, 1.0);
}

Contact::Contact(std::string name, const RigidShape& shape, double friction, const ContactLaw& law)
    : name_(std::move(name)), shape_(shape), friction_(friction), law_(law) {}

void Contact::Reset() {
  present_ = false;
  was_present_ = false;
  stuck_m_.clear();
  touches_.clear();
}

void Contact::Evaluate(const ContactSurface& surface, const Eigen::VectorXd& x_m) {
  touches_.clear();
  if (!present_) return;
  const Eigen::Isometry3d T_thing_robot = T_robot_thing_.inverse();
  const Eigen::Isometry3d T_thing_robot_before = T_robot_thing_before_.inverse();
  for (int face = 0; face < surface.FaceCount(); ++face) {
    if (!surface.MayTouch(face, x_m, T_robot_thing_.translation(), shape_.bounding_radius_m())) {
      continue;
    }
    for (int k = 0; k < surface.PointsPerFace(); ++k) {
      const Eigen::Vector3d point_m = T_thing_robot * surface.Position_m(face, k, x_m);
      const Clearance clearance = shape_.Measure(point_m);
      if (clearance.distance_m >= 0.0) continue;
      Eigen::Vector3d moved_m = Eigen::Vector3d::Zero();
      if (was_present_) {
        moved_m = point_m - T_thing_robot_before * surface.Position_m(face, k, x_before_m_);
      }
      const auto stuck = stuck_m_.find(Number(face, k));
      if (stuck != stuck_m_.end()) moved_m += stuck->second;
      Touch touch;
      touch.face = face;
      touch.point = k;
      Press(clearance, moved_m, surface.Area_m2(face, k), &touch);
      touches_.push_back(touch);
    }
  }
}

void Contact::Press(const Clearance& clearance, const Eigen::Vector3d& moved_m, double area_m2,
                    Touch* touch) const {
  const Eigen::Vector3d& n = clearance.normal;
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - n * n.transpose();
  touch->depth_m = -clearance.distance_m;
  touch->pressure_N = area_m2 * law_.Pressure_Pa(touch->depth_m);
  Eigen::Vector3d force_N = touch->pressure_N * n;
  touch->slope_N_m = area_m2 * law_.Slope_Pa_m(touch->depth_m);
  Eigen::Matrix3d stiffness_N_m =
      touch->slope_N_m * n * n.transpose() - touch->pressure_N * clearance.curvature;
  touch->stretch_m.setZero();
  if (friction_ > 0.0 && !frictionless_) {
    const double spring_N_m = area_m2 * law_.TangentialStiffness_Pa_m();
    const double most_N = friction_ * touch->pressure_N;
    Eigen::Vector3d stretch_m = across * moved_m;
    const double trial_N = spring_N_m * stretch_m.norm();
    if (trial_N <= most_N) {
      stiffness_N_m += spring_N_m * across;
    } else {
      const Eigen::Vector3d along = stretch_m.normalized();
      const double share = most_N / trial_N;
      stiffness_N_m += share * spring_N_m * (across - along * along.transpose());
      stretch_m *= share;
    }
    force_N -= spring_N_m * stretch_m;
    touch->stretch_m = stretch_m;
  }
  const Eigen::Matrix3d R = T_robot_thing_.linear();
  touch->force_N = R * force_N;
  touch->stiffness_N_m = R * stiffness_N_m * R.transpose();
}

void Contact::AddForces(const ContactSurface& surface, Eigen::VectorXd& nodal) const {
  for (const Touch& touch : touches_) {
    const auto nodes = surface.faces().col(touch.face);
    const auto N = surface.Shape(touch.point);
    for (Eigen::Index a = 0; a < nodes.size(); ++a) {
      nodal.segment<3>(3 * nodes[a]) += N[a] * touch.force_N;
    }
  }
}

void Contact::AddStiffness(const ContactSurface& surface, fem::StiffnessMatrix& stiffness) const {
  for (size_t t = 0; t < touches_.size();) {
    const int face = touches_[t].face;
    size_t end = t;
    while (end < touches_.size() && touches_[end].face == face) ++end;
    const auto nodes = surface.faces().col(face);
    for (Eigen::Index a = 0; a < nodes.size(); ++a) {
      for (Eigen::Index b = 0; b <= a; ++b) {
        Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
        for (size_t k = t; k < end; ++k) {
          const auto N = surface.Shape(touches_[k].point);
          block += N[a] * N[b] * touches_[k].stiffness_N_m;
        }
        stiffness.Add(stiffness.Slot(nodes[a], nodes[b]), block);
      }
    }
    t = end;
  }
}

double Contact::AddForcesOfTurn(const ContactSurface& surface, const Eigen::VectorXd& x_m,
                                double share, Eigen::VectorXd& nodal) const {
  if (!present_ || !was_present_) return 0.0;
  const Eigen::Isometry3d way = T_robot_thing_ * T_robot_thing_before_.inverse();
  double largest_m = 0.0;
  for (const Touch& touch : touches_) {
    const Eigen::Vector3d point_m = surface.Position_m(touch.face, touch.point, x_m);
    const Eigen::Vector3d turn_m =
        (way * point_m - point_m) - share * (point_m - last_way_.inverse() * point_m);
    largest_m = std::max(largest_m, turn_m.norm());
    const Eigen::Vector3d force_N = touch.stiffness_N_m * turn_m;
    const auto nodes = surface.faces().col(touch.face);
    const auto N = surface.Shape(touch.point);
    for (Eigen::Index a = 0; a < nodes.size(); ++a) {
      nodal.segment<3>(3 * nodes[a]) += N[a] * force_N;
    }
  }
  return largest_m;
}

void Contact::Remember() {
  assembled_N_m_.clear();
  for (const Touch& touch : touches_) assembled_N_m_[Number(touch)] = touch.slope_N_m;
}

double Contact::ChangeSinceRemembered() const {
  double change_N_m = 0.0;
  double now_N_m = 0.0;
  double before_N_m = 0.0;
  for (const auto& [number, slope_N_m] : assembled_N_m_) before_N_m += slope_N_m;
  double gone_N_m = before_N_m;
  for (const Touch& touch : touches_) {
    const auto found = assembled_N_m_.find(Number(touch));
    const double slope_N_m = found == assembled_N_m_.end() ? 0.0 : found->second;
    gone_N_m -= slope_N_m;
    now_N_m += touch.slope_N_m;
    change_N_m += std::abs(touch.slope_N_m - slope_N_m);
  }
  const double largest_N_m = std::max(now_N_m, before_N_m);
  return largest_N_m > 0.0 ? (change_N_m + gone_N_m) / largest_N_m : 0.0;
}

ContactResult Contact::Result(const ContactSurface& surface, const Eigen::VectorXd& x_m,
                              const Eigen::VectorXd& rest_m) const {
  ContactResult result;
  result.touching = !touches_.empty();
  for (const Touch& touch : touches_) {
    const Eigen::Vector3d position_m = surface.Position_m(touch.face, touch.point, x_m);
    result.force_N += touch.force_N;
    result.moment_Nm += position_m.cross(touch.force_N);
    result.centre_m += touch.pressure_N * position_m;
    result.rest_m += touch.pressure_N * surface.Position_m(touch.face, touch.point, rest_m);
    result.normal_N += touch.pressure_N;
    result.tangential_N += touch.stretch_m.norm() * law_.TangentialStiffness_Pa_m() *
                           surface.Area_m2(touch.face, touch.point);
    result.deepest_m = std::max(result.deepest_m, touch.depth_m);
  }
  if (result.normal_N > 0.0) {
    result.centre_m /= result.normal_N;
    result.rest_m /= result.normal_N;
  }
  return result;
}

void Contact::Commit(const Eigen::VectorXd& x_m) {
  stuck_m_.clear();
  for (const Touch& touch : touches_) {
    stuck_m_.emplace(Number(touch), touch.stretch_m);
  }
  last_way_ = was_present_ ? T_robot_thing_ * T_robot_thing_before_.inverse()
                           : Eigen::Isometry3d::Identity();
  was_present_ = present_;
  T_robot_thing_before_ = T_robot_thing_;
  x_before_m_ = x_m;
}

}  // namespace palpate::virtual_robot
