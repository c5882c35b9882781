// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/pose/marker_assignment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "components/calibration/pose/assignment_hypotheses.hpp"
#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/fem/bounded_qp.hpp"
#include "libs/geometry/rigid_registration.hpp"

namespace palpate::calibration {

namespace {

using Eigen::Index;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// More rounds and steps refine worse hypotheses, and cost time for each.
struct AssignmentTuning {
  int max_rounds = 12;           ///< of matching and fit
  int steps = 4;                 ///< of Gauss-Newton in each fit
  double distance_sigmas = 3.0;  ///< error of a distance between points in hypotheses
};
constexpr AssignmentTuning kAssignmentTuning;

/// Matches with their pose and tensions.
struct Explanation {
  geometry::RigidTransform T_robot_camera;
  Eigen::VectorXd tension_N;
  std::vector<int> marker_of_point;
  int matches = 0;
  double cost = kInfinity;
};

/// Fits pose and tensions to matches, and matches to them.
class Refiner {
 public:
  Refiner(const MarkerShapes& shapes, const Eigen::Matrix3Xd& points_m,
          const AssignmentSettings& settings)
      : shapes_(shapes),
        points_m_(points_m),
        settings_(settings),
        sigma_m_(std::hypot(settings.sigma_m, shapes.error_m() / std::sqrt(3.0))) {}

  double sigma_m() const { return sigma_m_; }
  double gate_m() const { return settings_.gate_sigmas * sigma_m_; }
  Explanation Refine(const geometry::RigidTransform& T_robot_camera) const;

 private:
  bool Match(double gate_m, Explanation* explanation) const;
  bool Fit(Explanation* explanation) const;
  bool Step(Explanation* explanation) const;
  void Rate(Explanation* explanation) const;

  const MarkerShapes& shapes_;
  const Eigen::Matrix3Xd& points_m_;
  const AssignmentSettings& settings_;
  double sigma_m_;
};

/// The gate shrinks from the reach of the cables to the error of the fit.
Explanation Refiner::Refine(const geometry::RigidTransform& T_robot_camera) const {
  Explanation one{T_robot_camera, 0.5 * shapes_.most_tension_N(), {}};
  // First matched with the mean shape, which may not be that of any tensions.
  one.marker_of_point =
      MatchNearest(T_robot_camera.Apply(points_m_), shapes_.mean_m(), shapes_.reach_m() + gate_m());
  if (!Fit(&one)) return one;
  double gate = std::max(0.5 * shapes_.reach_m(), gate_m());
  for (int round = 0; round < kAssignmentTuning.max_rounds; ++round) {
    const bool changed = Match(gate, &one);
    if (!changed && gate <= gate_m()) break;
    if (!Fit(&one)) return one;
    gate = std::max(0.5 * gate, gate_m());
  }
  Rate(&one);
  return one;
}

bool Refiner::Match(double gate_m, Explanation* explanation) const {
  std::vector<int> matched = MatchNearest(explanation->T_robot_camera.Apply(points_m_),
                                          shapes_.Positions_m(explanation->tension_N), gate_m);
  const bool changed = matched != explanation->marker_of_point;
  explanation->marker_of_point = std::move(matched);
  return changed;
}

bool Refiner::Fit(Explanation* explanation) const {
  explanation->matches = static_cast<int>(std::count_if(explanation->marker_of_point.begin(),
                                                        explanation->marker_of_point.end(),
                                                        [](int marker) { return marker >= 0; }));
  if (explanation->matches < settings_.least_matches) return false;
  for (int step = 0; step < kAssignmentTuning.steps; ++step) {
    if (!Step(explanation)) return false;
  }
  return true;
}

/// Gauss-Newton in (theta, tau, tensions). Tensions are bounded by their range and have a weak
/// prior at its centre.
bool Refiner::Step(Explanation* explanation) const {
  const Index cables = shapes_.CableCount();
  const Eigen::Matrix3Xd markers_m = shapes_.Positions_m(explanation->tension_N);
  const Eigen::MatrixXd derivative = shapes_.Derivative(explanation->tension_N);
  const Eigen::Matrix3Xd moved_m = explanation->T_robot_camera.Apply(points_m_);
  const Eigen::Vector3d origin_m = explanation->T_robot_camera.translation_m();
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3 * explanation->matches, 6 + cables);
  Eigen::VectorXd e(3 * explanation->matches);
  Index row = 0;
  for (Index p = 0; p < points_m_.cols(); ++p) {
    const int marker = explanation->marker_of_point[At(p)];
    if (marker < 0) continue;
    e.segment<3>(row) = moved_m.col(p) - markers_m.col(marker);
    J.block<3, 3>(row, 0) = -geometry::CrossMatrix(moved_m.col(p) - origin_m);
    J.block<3, 3>(row, 3).setIdentity();
    J.block(row, 6, 3, cables) = -derivative.middleRows<3>(3 * marker);
    row += 3;
  }
  fem::BoundedQp qp;
  qp.H = J.transpose() * J / (sigma_m_ * sigma_m_);
  qp.c = J.transpose() * e / (sigma_m_ * sigma_m_);
  qp.lower = fem::QpVector::Constant(6 + cables, -kInfinity);
  qp.upper = fem::QpVector::Constant(6 + cables, kInfinity);
  for (Index c = 0; c < cables; ++c) {
    const double most_N = shapes_.most_tension_N()[c];
    qp.H(6 + c, 6 + c) += 1.0 / (most_N * most_N);
    qp.c[6 + c] += (explanation->tension_N[c] - 0.5 * most_N) / (most_N * most_N);
    qp.lower[6 + c] = -explanation->tension_N[c];
    qp.upper[6 + c] = most_N - explanation->tension_N[c];
  }
  const fem::BoundedQpResult step = fem::SolveBoundedQp(qp, fem::QpVector::Zero(6 + cables));
  if (!step.status.ok()) return false;
  explanation->T_robot_camera =
      geometry::Perturbed(explanation->T_robot_camera, step.x.head<3>(), step.x.segment<3>(3));
  explanation->tension_N += step.x.tail(cables);
  return true;
}

void Refiner::Rate(Explanation* explanation) const {
  const Eigen::Matrix3Xd moved_m = explanation->T_robot_camera.Apply(points_m_);
  const Eigen::Matrix3Xd markers_m = shapes_.Positions_m(explanation->tension_N);
  const double unmatched = settings_.gate_sigmas * settings_.gate_sigmas;
  explanation->cost = 0.0;
  for (Index p = 0; p < points_m_.cols(); ++p) {
    const int marker = explanation->marker_of_point[At(p)];
    explanation->cost +=
        marker < 0 ? unmatched
                   : (moved_m.col(p) - markers_m.col(marker)).squaredNorm() / (sigma_m_ * sigma_m_);
  }
}

/// Whether a point has different markers in both.
bool Contradict(const std::vector<int>& one, const std::vector<int>& other) {
  for (size_t p = 0; p < one.size(); ++p) {
    if (one[p] >= 0 && other[p] >= 0 && one[p] != other[p]) return true;
  }
  return false;
}

/// The explanations that fit equally well, best first.
std::vector<AssignmentChoice> ChoicesOf(std::vector<Explanation> explanations,
                                        const AssignmentSettings& settings) {
  std::stable_sort(explanations.begin(), explanations.end(),
                   [](const auto& a, const auto& b) { return a.cost < b.cost; });
  std::vector<AssignmentChoice> choices;
  for (const Explanation& one : explanations) {
    if (!(one.cost <= explanations.front().cost + settings.ambiguous_below)) break;
    const bool is_other = std::all_of(choices.begin(), choices.end(), [&](const auto& choice) {
      return Contradict(choice.marker_of_point, one.marker_of_point);
    });
    if (is_other)
      choices.push_back({one.marker_of_point, one.T_robot_camera, one.tension_N, one.cost});
  }
  return choices;
}

MarkerAssignment Judge(const std::vector<Explanation>& explanations,
                       const AssignmentSettings& settings) {
  MarkerAssignment result;
  result.rival_cost = kInfinity;
  const auto best = std::min_element(explanations.begin(), explanations.end(),
                                     [](const auto& a, const auto& b) { return a.cost < b.cost; });
  if (best == explanations.end() || best->cost == kInfinity) {
    result.status = Status(StatusCode::kUnobservable, "no pose and tensions match " +
                                                          std::to_string(settings.least_matches) +
                                                          " of the points with markers");
    return result;
  }
  result.marker_of_point = best->marker_of_point;
  result.T_robot_camera = best->T_robot_camera;
  result.tension_N = best->tension_N;
  result.cost = best->cost;
  result.matches = best->matches;
  for (const Explanation& other : explanations) {
    if (other.cost < result.rival_cost &&
        Contradict(best->marker_of_point, other.marker_of_point)) {
      result.rival_cost = other.cost;
      result.rival = other.marker_of_point;
    }
  }
  const auto points = static_cast<double>(best->marker_of_point.size());
  if (result.matches < settings.least_share * points) {
    result.status = Status(StatusCode::kUnobservable,
                           "only " + std::to_string(result.matches) + " of " +
                               std::to_string(best->marker_of_point.size()) +
                               " points can be markers: another robot, or mirrored points");
    return result;
  }
  result.choices = ChoicesOf(explanations, settings);
  result.ambiguous = result.rival_cost <= result.cost + settings.ambiguous_below;
  result.status = result.ambiguous ? Status(StatusCode::kUnobservable,
                                            "ambiguous: another assignment fits the points as well")
                                   : Status::Ok();
  return result;
}

MarkerAssignment Refusal(StatusCode code, const std::string& reason) {
  MarkerAssignment refusal;
  refusal.status = Status(code, reason);
  return refusal;
}

}  // namespace

MarkerAssignment AssignMarkers(const MarkerShapes& shapes,
                               const Eigen::Ref<const Eigen::Matrix3Xd>& points_m,
                               const AssignmentSettings& settings) {
  PALPATE_CHECK(settings.least_matches >= 4 && settings.sigma_m > 0.0, settings.least_matches,
                settings.sigma_m);
  PALPATE_CHECK(6 + shapes.CableCount() <= fem::kMaxQpVariables, shapes.CableCount());
  if (!points_m.allFinite()) {
    return Refusal(StatusCode::kInvalidInput, "a coordinate is not finite");
  }
  if (points_m.cols() < settings.least_matches) {
    return Refusal(StatusCode::kUnobservable,
                   "an assignment needs " + std::to_string(settings.least_matches) +
                       " points, there are " + std::to_string(points_m.cols()));
  }
  const Eigen::Matrix3Xd points = points_m;
  const Refiner refiner(shapes, points, settings);
  const double distance_error_m =
      kAssignmentTuning.distance_sigmas * std::sqrt(2.0) * refiner.sigma_m();
  std::vector<Explanation> explanations;
  for (const PoseHypothesis& hypothesis : SuggestPoses(
           shapes, points, distance_error_m, settings.most_triplets, settings.most_refined)) {
    explanations.push_back(refiner.Refine(hypothesis.T_robot_camera));
  }
  return Judge(explanations, settings);
}

}  // namespace palpate::calibration
