// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/joint/misfit_reasons.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "components/calibration/joint/model_snapshot.hpp"
#include "components/calibration/size_comparison.hpp"
#include "libs/core/index.hpp"
#include "libs/geometry/rigid_registration.hpp"

namespace palpate::calibration {

namespace {

struct MisfitTuning {
  /// Residual over that of the data as they are below which a mistake counts as the reason.
  double explains = 0.5;
  double alone = 3.0;          ///< ratio of the residuals of one recording and of the others
  double other_modulus = 5.0;  ///< factor on the motion that no sound modulus is off by
  double near_rest = 0.2;      ///< residual of the undeformed body over the markers' spread
};
constexpr MisfitTuning kMisfitTuning;

using Reason = MisfitReason::Kind;

/// Markers that were seen from one place.
struct Group {
  const PosePrior* given = nullptr;  ///< nullptr: the pose is unknown
  std::vector<int> marker;           ///< [n]
  std::vector<std::size_t> frame;    ///< [n]
  Eigen::Matrix3Xd seen_m;           ///< [3 x n] measurement frame
  Eigen::Matrix3Xd model_m;          ///< [3 x n] robot frame, at the frame's equilibrium
  Eigen::Matrix3Xd rest_m;           ///< [3 x n] undeformed
};

/// Sum of squares (m^2) and count of distances.
struct Squares {
  double sum_m2 = 0.0;
  double count = 0.0;

  double Rms_m() const { return std::sqrt(sum_m2 / std::max(1.0, count)); }
};

Squares SquaresOf(double rms_m, Eigen::Index count) {
  return {rms_m * rms_m * static_cast<double>(count), static_cast<double>(count)};
}

void Add(const Squares& more, Squares* squares) {
  squares->sum_m2 += more.sum_m2;
  squares->count += more.count;
}

class Misfit {
 public:
  Misfit(robot::RobotModel& model, const std::vector<CalibrationFrame>& frames,
         const JointRequest& request)
      : names_(model.MarkerNames()), frames_(frames) {
    MakeGroups(ShapesOf(model), model, request);
  }

  MisfitReasons Find();

 private:
  std::vector<Eigen::VectorXd> ShapesOf(robot::RobotModel& model);
  void MakeGroups(const std::vector<Eigen::VectorXd>& shapes_m, const robot::RobotModel& model,
                  const JointRequest& request);
  double RegisteredRms_m(double scale = 1.0, int exchanged_a = -1, int exchanged_b = -1) const;
  void TryLabels();
  void TryPose(const Group& group);
  void TryMirror();
  void TrySize();
  void TryModulus();
  void RegisterWithout(const std::string& recording, Squares* others, Squares* own) const;
  void TryRecordings();
  void Take(Reason kind, double rms_m, const std::string& text);

  std::vector<std::string> names_;
  const std::vector<CalibrationFrame>& frames_;
  std::string unsolved_;  ///< a frame without an equilibrium; empty: none
  std::vector<Group> groups_;
  MisfitReasons result_;
};

std::vector<Eigen::VectorXd> Misfit::ShapesOf(robot::RobotModel& model) {
  const ModelSnapshot kept(model);
  std::vector<Eigen::VectorXd> shapes_m;
  for (const CalibrationFrame& frame : frames_) {
    model.SetGravity(frame.gravity_m_s2);
    fem::StaticState state = model.RestState();
    if (!model.Solve(frame.cables, frame.loads, &state).status.ok()) {
      state = model.RestState();
      unsolved_ = frame.name;
    }
    shapes_m.push_back(state.x_m);
  }
  kept.RestoreGravity();
  return shapes_m;
}

void Misfit::MakeGroups(const std::vector<Eigen::VectorXd>& shapes_m,
                        const robot::RobotModel& model, const JointRequest& request) {
  std::map<int, std::vector<std::size_t>> frames_of;
  for (std::size_t f = 0; f < frames_.size(); ++f) frames_of[frames_[f].own_pose].push_back(f);
  for (const auto& [own_pose, frames] : frames_of) {
    Group& group = groups_.emplace_back();
    if (own_pose >= 0) {
      group.given = &request.own_poses.at(At(own_pose));
    } else if (request.pose_prior) {
      group.given = &*request.pose_prior;
    }
    std::vector<Eigen::Vector3d> seen, there, rest;
    for (const std::size_t f : frames) {
      for (const MarkerSighting& sighting : frames_[f].markers) {
        const auto& point = model.body().markers.at(At(sighting.marker)).point;
        group.marker.push_back(sighting.marker);
        group.frame.push_back(f);
        seen.push_back(sighting.position_m);
        there.push_back(point.weights.Position(shapes_m[f]));
        rest.push_back(point.rest_m);
      }
    }
    const auto count = ToIndex(seen.size());
    group.seen_m = Eigen::Map<Eigen::Matrix3Xd>(seen.data()->data(), 3, count);
    group.model_m = Eigen::Map<Eigen::Matrix3Xd>(there.data()->data(), 3, count);
    group.rest_m = Eigen::Map<Eigen::Matrix3Xd>(rest.data()->data(), 3, count);
  }
}

/// The model's markers with two labels exchanged.
Eigen::Matrix3Xd Exchanged(const Group& group, int a, int b) {
  Eigen::Matrix3Xd model_m = group.model_m;
  std::map<std::size_t, std::array<Eigen::Index, 2>> columns;
  for (std::size_t k = 0; k < group.marker.size(); ++k) {
    auto& pair =
        columns.try_emplace(group.frame[k], std::array<Eigen::Index, 2>{-1, -1}).first->second;
    if (group.marker[k] == a) pair[0] = ToIndex(k);
    if (group.marker[k] == b) pair[1] = ToIndex(k);
  }
  for (const auto& [frame, pair] : columns) {
    if (pair[0] >= 0 && pair[1] >= 0) model_m.col(pair[0]).swap(model_m.col(pair[1]));
  }
  return model_m;
}

double Misfit::RegisteredRms_m(double scale, int exchanged_a, int exchanged_b) const {
  Squares squares;
  for (const Group& group : groups_) {
    const Eigen::Matrix3Xd model_m =
        exchanged_a < 0 ? group.model_m : Exchanged(group, exchanged_a, exchanged_b);
    const Eigen::Matrix3Xd seen_m = scale * group.seen_m;
    Add(SquaresOf(geometry::RegisterRigid(seen_m, model_m).rms_m, seen_m.cols()), &squares);
  }
  return squares.Rms_m();
}

void Misfit::Take(Reason kind, double rms_m, const std::string& text) {
  result_.reasons.push_back({kind, text + FormatReason(" (then %.2f mm RMS)", 1e3 * rms_m), rms_m});
}

void Misfit::TryLabels() {
  const int count = static_cast<int>(names_.size());
  double best_m = result_.residual;
  std::pair<int, int> best;
  for (int a = 0; a < count; ++a) {
    for (int b = a + 1; b < count; ++b) {
      const double rms_m = RegisteredRms_m(1.0, a, b);
      if (rms_m >= best_m) continue;
      best_m = rms_m;
      best = {a, b};
    }
  }
  if (best_m > kMisfitTuning.explains * result_.residual) return;
  Take(Reason::kLabels, best_m,
       "labels: the markers " + names_[At(best.first)] + " and " + names_[At(best.second)] +
           " have each other's names; exchange them in markers.csv");
}

/// The pose that was given against the one by which the markers fit.
void Misfit::TryPose(const Group& group) {
  if (group.given == nullptr) return;
  const geometry::RigidTransform& given = group.given->T_robot_camera;
  const double given_m = (given.Apply(group.seen_m) - group.model_m).norm() /
                         std::sqrt(static_cast<double>(group.seen_m.cols()));
  const geometry::Registration found = geometry::RegisterRigid(group.seen_m, group.model_m);
  if (!found.status.ok() || found.rms_m > kMisfitTuning.explains * given_m) return;
  const PoseDifference off =
      DifferenceOf(given, found.T_target_source, group.seen_m.rowwise().mean());
  const std::string what = group.given->name + " puts the markers " + off.Text();
  const auto axes = AxesText(off.turn);
  Take(Reason::kPose, found.rms_m,
       "pose, frame and axes: " + what + (axes ? "; " + *axes : std::string()) +
           "; import the markers with --register, or give the pose of this camera");
}

void Misfit::TryMirror() {
  Squares squares;
  for (const Group& group : groups_) {
    const geometry::Registration found = geometry::RegisterRigid(group.seen_m, group.model_m);
    Add(SquaresOf(found.mirrored_rms_m, group.seen_m.cols()), &squares);
  }
  if (squares.Rms_m() > kMisfitTuning.explains * result_.residual) return;
  Take(Reason::kMirrored, squares.Rms_m(),
       "axes: the markers are a mirror image of the robot's, so that one axis has the wrong sign "
       "(a left-handed frame) or left and right labels are exchanged");
}

/// RMS distance of the columns from their mean.
Squares SpreadOf(const Eigen::Matrix3Xd& points_m) {
  const Eigen::Vector3d middle_m = points_m.rowwise().mean();
  return {(points_m.colwise() - middle_m).squaredNorm(), static_cast<double>(points_m.cols())};
}

void Misfit::TrySize() {
  Squares seen, there;
  for (const Group& group : groups_) {
    Add(SpreadOf(group.seen_m), &seen);
    Add(SpreadOf(group.model_m), &there);
  }
  if (seen.Rms_m() == 0.0) return;
  const double ratio = seen.Rms_m() / there.Rms_m();
  const double rms_m = RegisteredRms_m(1.0 / ratio);
  if (rms_m > kMisfitTuning.explains * result_.residual) return;
  const auto markers = UnitOfRatio(ratio);
  const auto mesh = UnitOfRatio(1.0 / ratio);
  const std::string sizes =
      FormatReason("the markers are %.4g times as far apart as the robot file's", ratio);
  if (markers) {
    Take(Reason::kUnit, rms_m,
         "unit: " + sizes + "; are the columns x_m, y_m, z_m " + *markers + "?");
  } else if (mesh) {
    Take(Reason::kUnit, rms_m,
         "unit: " + sizes + "; is the robot file's mesh: unit: " + *mesh + ", not metres?");
  } else {
    SizeComparison comparison;
    for (const Group& group : groups_) comparison.Add(group.seen_m, group.model_m);
    Take(Reason::kSize, rms_m, "size: " + comparison.Text());
  }
}

/// The undeformed body fits far better than the model's equilibria, or those do not exist.
void Misfit::TryModulus() {
  double both_m2 = 0.0, model_m2 = 0.0;
  Squares squares, spread;
  for (const Group& group : groups_) {
    const geometry::Registration rest = geometry::RegisterRigid(group.seen_m, group.rest_m);
    if (!rest.status.ok()) return;
    const Eigen::Matrix3Xd motion_m = group.model_m - group.rest_m;
    both_m2 += motion_m.cwiseProduct(rest.T_target_source.Apply(group.seen_m) - group.rest_m).sum();
    model_m2 += motion_m.squaredNorm();
    Add(SquaresOf(rest.rms_m, group.seen_m.cols()), &squares);
    Add(SpreadOf(group.seen_m), &spread);
  }
  const std::string unit =
      "; is youngs_modulus_Pa of the robot file in kPa or MPa, or is a column of actuation.csv in "
      "another unit?";
  if (!unsolved_.empty()) {
    if (squares.Rms_m() > kMisfitTuning.near_rest * spread.Rms_m()) return;
    Take(Reason::kModulus, squares.Rms_m(),
         "stiffness: the model has no equilibrium in " + unsolved_ +
             ", and the markers are near those of the undeformed body" + unit);
    return;
  }
  if (squares.Rms_m() > kMisfitTuning.explains * result_.residual) return;
  if (std::abs(both_m2) * kMisfitTuning.other_modulus > model_m2) return;
  Take(Reason::kModulus, squares.Rms_m(),
       "stiffness: the markers hardly move where the model bends far" + unit);
}

/// "hold_1 at 3 s" is a frame of hold_1.
std::string RecordingOf(const std::string& frame) { return frame.substr(0, frame.find(' ')); }

/// Registers the other recordings alone: `others` and `own` get the distances then.
void Misfit::RegisterWithout(const std::string& recording, Squares* others, Squares* own) const {
  for (const Group& group : groups_) {
    std::vector<int> of_others, of_own;
    for (std::size_t k = 0; k < group.marker.size(); ++k) {
      const bool is_own = RecordingOf(frames_[group.frame[k]].name) == recording;
      (is_own ? of_own : of_others).push_back(static_cast<int>(k));
    }
    if (of_others.empty()) continue;
    const Eigen::Matrix3Xd seen_m = group.seen_m(Eigen::all, of_others);
    const Eigen::Matrix3Xd model_m = group.model_m(Eigen::all, of_others);
    const geometry::Registration found = geometry::RegisterRigid(seen_m, model_m);
    Add(SquaresOf(found.rms_m, seen_m.cols()), others);
    const Eigen::Matrix3Xd own_m = group.seen_m(Eigen::all, of_own);
    const Eigen::Matrix3Xd off_m =
        found.T_target_source.Apply(own_m) - group.model_m(Eigen::all, of_own);
    Add({off_m.squaredNorm(), static_cast<double>(off_m.cols())}, own);
  }
}

void Misfit::TryRecordings() {
  std::set<std::string> names;
  for (const CalibrationFrame& frame : frames_) names.insert(RecordingOf(frame.name));
  if (names.size() < 3) return;
  double best_m = kMisfitTuning.explains * result_.residual;
  double alone_m = 0.0;
  std::string best;
  for (const std::string& name : names) {
    Squares others, own;
    RegisterWithout(name, &others, &own);
    if (others.Rms_m() > best_m || own.Rms_m() < kMisfitTuning.alone * others.Rms_m()) continue;
    best_m = others.Rms_m();
    alone_m = own.Rms_m();
    best = name;
  }
  if (best.empty()) return;
  Take(Reason::kRecording, best_m,
       "load: " + best +
           FormatReason(" alone is %.1f mm off: does something touch the robot there, or does its "
                        "loads.csv lack a load?",
                        1e3 * alone_m));
}

MisfitReasons Misfit::Find() {
  result_.where_none =
      "no pose, mirror image, unit or exchange of two labels explains it: another robot or other "
      "markers, a load that loads.csv lacks, or a contact";
  result_.not_excluded = "another robot, a load that loads.csv lacks";
  result_.residual = RegisteredRms_m();
  if (result_.residual == 0.0) return result_;  // too few markers to register
  TryLabels();
  for (const Group& group : groups_) TryPose(group);
  TryMirror();
  TrySize();
  TryModulus();
  TryRecordings();
  result_.SortBestFirst();
  return result_;
}

}  // namespace

MisfitReasons FindMisfitReasons(robot::RobotModel& model,
                                const std::vector<CalibrationFrame>& frames,
                                const JointRequest& request) {
  return Misfit(model, frames, request).Find();
}

}  // namespace palpate::calibration
