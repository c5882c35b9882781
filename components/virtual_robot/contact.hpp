// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <unordered_map>
#include <vector>

#include "components/virtual_robot/contact_surface.hpp"
#include "components/virtual_robot/rigid_shape.hpp"
#include "libs/fem/stiffness_matrix.hpp"

namespace palpate::virtual_robot {

/// How bodies press on each other. A point that lies d deep in a tool is pressed out with
/// p = k d^2 / (4 e) up to d = 2 e, then k (d - e): smooth where contact begins, and a penetration
/// of p / k + e. Coulomb's friction sticks elastically, with k / 2, up to mu p.
struct ContactLaw {
  double stiffness_Pa_m = 0.0;  ///< k
  double onset_m = 10e-6;       ///< e

  double Pressure_Pa(double depth_m) const;
  double Slope_Pa_m(double depth_m) const;
  double TangentialStiffness_Pa_m() const { return 0.5 * stiffness_Pa_m; }
};

/// What a rigid thing does to the body.
struct ContactResult {
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();    ///< on the body, robot frame
  Eigen::Vector3d moment_Nm = Eigen::Vector3d::Zero();  ///< about the robot's origin
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();   ///< of pressure
  Eigen::Vector3d rest_m = Eigen::Vector3d::Zero();     ///< the same material at rest
  double normal_N = 0.0;                                ///< integral of the pressure
  double tangential_N = 0.0;                            ///< integral of the size of the friction
  double deepest_m = 0.0;                               ///< largest penetration
  bool touching = false;
};

/// A rigid thing against the body's surface, and what the surface remembers of it: where each point
/// sticks to it.
class Contact {
 public:
  Contact(std::string name, const RigidShape& shape, double friction, const ContactLaw& law);

  const std::string& name() const { return name_; }
  const RigidShape& shape() const { return shape_; }
  bool touching() const { return !touches_.empty(); }

  /// Nothing sticks; the pose counts from the next Commit on.
  void Reset();
  /// Where the thing is at the end of the step; absent: it is not there.
  void SetPose(const Eigen::Isometry3d& T_robot_thing) {
    present_ = true;
    T_robot_thing_ = T_robot_thing;
  }
  void SetAbsent() { present_ = false; }
  void SetFrictionless(bool frictionless) { frictionless_ = frictionless; }

  /// Pressure and friction with the surface at `x_m`; what follows is of them.
  void Evaluate(const ContactSurface& surface, const Eigen::VectorXd& x_m);
  void AddForces(const ContactSurface& surface, Eigen::VectorXd& nodal) const;
  /// Adds -dforce/dx, but for how friction grows with pressure, which is not symmetric.
  void AddStiffness(const ContactSurface& surface, fem::StiffnessMatrix& stiffness) const;
  /// Adds how the forces evaluated last, with the surface at `x_m`, change where the thing's way
  /// since the last Commit is another than `share` times its way before that, as long as nothing
  /// releases or slips. Returns the largest difference of the slips, m.
  double AddForcesOfTurn(const ContactSurface& surface, const Eigen::VectorXd& x_m, double share,
                         Eigen::VectorXd& nodal) const;
  /// Notes what touches how, and returns how much of that has changed since, relative to the
  /// stiffer of the two: from 0 to 2.
  void Remember();
  double ChangeSinceRemembered() const;
  ContactResult Result(const ContactSurface& surface, const Eigen::VectorXd& x_m,
                       const Eigen::VectorXd& rest_m) const;
  /// What was evaluated last happened, with the surface at `x_m`.
  void Commit(const Eigen::VectorXd& x_m);

 private:
  static constexpr int kPointsAtMost = 16;  ///< on a face

  struct Touch {
    int face = 0;
    int point = 0;
    double pressure_N = 0.0;  ///< of this point
    double slope_N_m = 0.0;   ///< how it grows with depth
    double depth_m = 0.0;
    Eigen::Vector3d force_N;    ///< robot frame
    Eigen::Vector3d stretch_m;  ///< of what sticks, frame of the thing
    Eigen::Matrix3d stiffness_N_m;
  };

  static int Number(int face, int point) { return face * kPointsAtMost + point; }
  static int Number(const Touch& touch) { return Number(touch.face, touch.point); }
  /// Of a point inside the thing that has moved by `moved_m`, in its frame, since it sticks to it.
  void Press(const Clearance& clearance, const Eigen::Vector3d& moved_m, double area_m2,
             Touch* touch) const;

  std::string name_;
  RigidShape shape_;
  double friction_;
  ContactLaw law_;
  bool present_ = false;
  bool was_present_ = false;
  bool frictionless_ = false;
  Eigen::Isometry3d T_robot_thing_ = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_robot_thing_before_ = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d last_way_ = Eigen::Isometry3d::Identity();  ///< up to the last Commit
  Eigen::VectorXd x_before_m_;
  std::unordered_map<int, Eigen::Vector3d> stuck_m_;  ///< by point number; frame of the thing
  std::vector<Touch> touches_;
  std::unordered_map<int, double> assembled_N_m_;  ///< by point number, at the last Remember
};

}  // namespace palpate::virtual_robot
