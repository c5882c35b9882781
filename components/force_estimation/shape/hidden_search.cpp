// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/hidden_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "components/force_estimation/shape/hidden_problem.hpp"
#include "libs/core/check.hpp"
#include "libs/core/index.hpp"

namespace palpate::force_estimation {

namespace {

/// Unknowns of a contact: location on the surface and force.
constexpr int kUnknowns = 5;

/// Unit sensitivities of the candidates that may be a contact.
struct Tests {
  Eigen::MatrixXd directions;   ///< [m x tests]
  std::vector<int> candidates;  ///< [tests]
  Eigen::VectorXd statistic;    ///< [tests] standard normal without a contact
};

/// `pushes_m`: response of all rows to unit forces along the candidates' inward normals.
Tests MakeTests(const HiddenProblem& problem, const CandidateLocations& places,
                const Eigen::MatrixXd& pushes_m, const std::vector<bool>& usable,
                double unobserved_response) {
  const Eigen::MatrixXd along = problem.Whitened(pushes_m);
  const Eigen::RowVectorXd size = along.colwise().norm();
  Tests tests;
  const double least = unobserved_response * size.maxCoeff();
  for (int c = 0; c < places.CandidateCount(); ++c) {
    const auto place = static_cast<size_t>(places.PlaceOfCandidate(c));
    if (usable[place] && size[c] > least) tests.candidates.push_back(c);
  }
  tests.directions =
      along(Eigen::all, tests.candidates) * size(tests.candidates).cwiseInverse().asDiagonal();
  tests.statistic = tests.directions.transpose() * problem.residual();
  return tests;
}

/// Weights that include the error of the linearisation.
Eigen::VectorXd FirstOrderWeights(const Unexplained& data, double first_order_error) {
  const Eigen::VectorXd& left_m = data.left_m.size() > 0 ? data.left_m : data.residual_m;
  const Eigen::ArrayXd squared_m2 = left_m.array().square();
  const Eigen::ArrayXd error_m2 =
      0.5 * first_order_error * first_order_error * (squared_m2 + squared_m2.mean());
  return data.weight.array() / (1.0 + data.weight.array() * error_m2);
}

/// The two candidates that together reduce chi-squared most, both pushing.
std::pair<int, int> BestPair(const Tests& tests) {
  const Eigen::MatrixXd alike = tests.directions.transpose() * tests.directions;
  const Eigen::VectorXd& t = tests.statistic;
  std::pair<int, int> best{-1, -1};
  double best_gain = 0.0;
  for (Eigen::Index i = 0; i < t.size(); ++i) {
    if (!(t[i] > 0.0)) continue;
    for (Eigen::Index j = 0; j < t.size(); ++j) {
      const double rho = alike(i, j);
      const bool push = t[i] > rho * t[j] && t[j] > rho * t[i];
      if (i == j || !push || rho > 1.0 - 1e-9) continue;
      const double gain = (t[i] * t[i] + t[j] * t[j] - 2.0 * rho * t[i] * t[j]) / (1.0 - rho * rho);
      if (gain <= best_gain) continue;
      best_gain = gain;
      best = {tests.candidates[At(i)], tests.candidates[At(j)]};
    }
  }
  return best;
}

}  // namespace

struct HiddenSearch::Parts {
  Parts(const robot::RobotModel& robot_model, const ShapeConfig& config,
        const BodyScale& scale_of_robot, const HiddenSearchTuning& search_tuning)
      : tuning(search_tuning),
        scale(scale_of_robot),
        places(robot_model, std::max(config.contact_radius_m, tuning.least_patch_radius_m),
               tuning.places),
        false_alarm(tuning.false_alarm) {}

  HiddenProblem ProblemOf(const Unexplained& data, const Eigen::VectorXd& weight);
  void PushAt(const ObservationJacobian& responses);
  std::vector<bool> Usable(const std::vector<Eigen::Vector3d>& taken, double taken_radius_m) const;
  bool Stands(const HiddenProblem& problem, const std::vector<bool>& usable, double significance);
  HiddenProblem Without(const HiddenProblem& problem,
                        const ContactLocationPosterior& contact) const;
  std::vector<ContactLocationPosterior> FindPair(const HiddenProblem& problem,
                                                 const std::vector<bool>& usable, int known) const;
  PlaceFit FitAt(const HiddenProblem& problem, int place) const;
  void Report(const Unexplained& data, const std::vector<ContactLocationPosterior>& contacts);

  HiddenSearchTuning tuning;
  BodyScale scale;
  CandidateLocations places;
  FalseAlarm false_alarm;
  Eigen::Matrix3Xd normals;  ///< [3 x places] in the shape of the last SetShape
  Eigen::MatrixXd pushes_m;  ///< [rows x candidates] of unit forces along the inward normals
  const ObservationJacobian* pushed = nullptr;  ///< whose rows these are,
  int pushed_version = 0;                       ///< and as they were then
  std::vector<HiddenContact> found;
};

HiddenProblem HiddenSearch::Parts::ProblemOf(const Unexplained& data,
                                             const Eigen::VectorXd& weight) {
  const Eigen::Index m = data.residual_m.size();
  PALPATE_CHECK(normals.cols() == places.Count(), "no shape was set yet");
  PALPATE_CHECK(weight.size() == m, weight.size(), m);
  PALPATE_CHECK(data.responses != nullptr && std::ssize(data.row) == m, data.row.size(), m);
  PALPATE_CHECK(data.known.rows() == m || data.known.cols() == 0, data.known.rows(), m);
  PALPATE_CHECK(data.left_m.size() == m || data.left_m.size() == 0, data.left_m.size(), m);
  PushAt(*data.responses);
  const Eigen::VectorXd root_weight = weight.cwiseSqrt();
  HiddenProblem problem(places, *data.responses, data.row, root_weight, data.residual_m);
  if (data.errors_m.cols() > 0) problem.Absorb(root_weight.asDiagonal() * data.errors_m);
  problem.Ignore(root_weight.asDiagonal() * data.known);
  return problem;
}

/// The candidates serve every search about one shape.
void HiddenSearch::Parts::PushAt(const ObservationJacobian& responses) {
  if (pushed == &responses && pushed_version == responses.version()) return;
  pushed = &responses;
  pushed_version = responses.version();
  pushes_m.resize(responses.Count(), places.CandidateCount());
  for (int c = 0; c < places.CandidateCount(); ++c) {
    const int place = places.PlaceOfCandidate(c);
    pushes_m.col(c).noalias() = -responses.To(places.Patch(place)) * normals.col(place);
  }
}

std::vector<bool> HiddenSearch::Parts::Usable(const std::vector<Eigen::Vector3d>& taken,
                                              double taken_radius_m) const {
  std::vector<bool> usable(static_cast<size_t>(places.Count()), true);
  for (int place = 0; place < places.Count(); ++place) {
    usable[At(place)] =
        std::none_of(taken.begin(), taken.end(), [&](const Eigen::Vector3d& taken_m) {
          return (places.positions_m().col(place) - taken_m).norm() <= taken_radius_m;
        });
  }
  return usable;
}

/// Whether the best candidate is significant.
bool HiddenSearch::Parts::Stands(const HiddenProblem& problem, const std::vector<bool>& usable,
                                 double significance) {
  const Tests tests = MakeTests(problem, places, pushes_m, usable, tuning.unobserved_response);
  return !tests.candidates.empty() &&
         false_alarm.Significant(tests.directions, tests.statistic.maxCoeff(), significance);
}

/// The problem with `contact` absorbed: of any size, with friction, and an uncertain location.
HiddenProblem HiddenSearch::Parts::Without(const HiddenProblem& problem,
                                           const ContactLocationPosterior& contact) const {
  const Eigen::Vector3d normal = normals.col(contact.place);
  const auto push_at = [&](const HiddenProblem& any, int place) -> Eigen::VectorXd {
    return -any.Place(place) * normals.col(place);
  };
  const Eigen::VectorXd push = push_at(problem, contact.place);
  Eigen::MatrixXd prior(push.size(), 3 + tuning.neighbours);
  prior.leftCols<3>() =
      tuning.friction * (problem.Place(contact.place) + push * normal.transpose());
  Eigen::VectorXd distance_m2 =
      (places.positions_m().colwise() - places.positions_m().col(contact.place))
          .colwise()
          .squaredNorm()
          .transpose();
  int beside = contact.place;
  for (int k = 0; k < tuning.neighbours; ++k) {
    distance_m2[beside] = std::numeric_limits<double>::infinity();
    distance_m2.minCoeff(&beside);
    prior.col(3 + k) = tuning.off_places * (push_at(problem, beside) - push);
  }
  HiddenProblem without = problem;
  without.Absorb(contact.fit.force_N * prior);
  without.Ignore(push_at(without, contact.place));
  return without;
}

/// Without friction.
PlaceFit HiddenSearch::Parts::FitAt(const HiddenProblem& problem, int place) const {
  return FitPush(problem.EquationsAt(place), normals.col(place), 0.0);
}

/// Starts from the best pair of candidates, and locates each in turn while the other is absorbed.
std::vector<ContactLocationPosterior> HiddenSearch::Parts::FindPair(const HiddenProblem& problem,
                                                                    const std::vector<bool>& usable,
                                                                    int known) const {
  const auto [first, second] =
      BestPair(MakeTests(problem, places, pushes_m, usable, tuning.unobserved_response));
  if (first < 0) return {};
  std::vector<ContactLocationPosterior> pair(2);
  pair[0].place = places.PlaceOfCandidate(first);
  pair[1].place = places.PlaceOfCandidate(second);
  for (ContactLocationPosterior& contact : pair) contact.fit = FitAt(problem, contact.place);
  for (int round = 0; round < tuning.pair_rounds; ++round) {
    for (size_t k = 0; k < 2; ++k) {
      pair[k] =
          Locate(Without(problem, pair[1 - k]), places, normals, usable,
                 {.scale = scale, .friction = tuning.friction, .unknowns = known + 2 * kUnknowns},
                 tuning.location);
      if (pair[k].place < 0) return {};
    }
  }
  return pair;
}

/// Gains are those of the given weights, with the other contacts' forces refitted.
void HiddenSearch::Parts::Report(const Unexplained& data,
                                 const std::vector<ContactLocationPosterior>& contacts) {
  const HiddenProblem given = ProblemOf(data, data.weight);
  for (size_t k = 0; k < contacts.size(); ++k) {
    const ContactLocationPosterior& contact = contacts[k];
    HiddenProblem rest = given;
    for (size_t j = 0; j < contacts.size(); ++j) {
      const int other = contacts[j].place;
      if (j != k) rest.Ignore(rest.Place(other) * normals.col(other));
    }
    const PlaceFit fit =
        FitPush(rest.EquationsAt(contact.place), normals.col(contact.place), tuning.friction);
    found.push_back({.rest_position_m = contact.centre_m,
                     .mean_off_m = contact.mean_m - contact.centre_m,
                     .normal = normals.col(contact.place),
                     .force_N = contact.fit.force_N,
                     .tangential_N = contact.fit.tangential_N,
                     .chi_squared_gain = fit.gain,
                     .location_covariance_m2 = contact.covariance_m2,
                     .location_ci95_m = contact.ci95_m,
                     .force_covariance_N2 = contact.force_covariance_N2});
  }
}

HiddenSearch::HiddenSearch(const robot::RobotModel& model, const ShapeConfig& config,
                           const BodyScale& scale, const HiddenSearchTuning& tuning)
    : parts_(std::make_unique<Parts>(model, config, scale, tuning)) {}

HiddenSearch::~HiddenSearch() = default;

void HiddenSearch::SetShape(const Eigen::VectorXd& x_m) {
  parts_->normals = parts_->places.Normals(x_m);
  parts_->pushed = nullptr;
}

int HiddenSearch::CandidateCount() const { return parts_->places.CandidateCount(); }

double HiddenSearch::SigmaOfForce_N(const Unexplained& data,
                                    const Eigen::Vector3d& rest_position_m) const {
  Parts& parts = *parts_;
  const HiddenProblem problem = parts.ProblemOf(data, data.weight);
  const int place = parts.places.Nearest(rest_position_m);
  const Eigen::Vector3d normal = parts.normals.col(place);
  return 1.0 / (problem.Place(place) * normal).norm();
}

double HiddenSearch::Threshold_sigmas(const Unexplained& data, double significance) const {
  Parts& parts = *parts_;
  const std::vector<bool> usable(static_cast<size_t>(parts.places.Count()), true);
  const Tests tests = MakeTests(parts.ProblemOf(data, data.weight), parts.places, parts.pushes_m,
                                usable, parts.tuning.unobserved_response);
  return parts_->false_alarm.Threshold(tests.directions, significance);
}

const std::vector<HiddenContact>& HiddenSearch::Find(const Unexplained& data, int most,
                                                     double significance,
                                                     const std::vector<Eigen::Vector3d>& taken,
                                                     double taken_radius_m) {
  PALPATE_CHECK(most == 1 || most == 2, most);
  Parts& parts = *parts_;
  parts.found.clear();
  const std::vector<bool> usable = parts.Usable(taken, taken_radius_m);
  if (!parts.Stands(parts.ProblemOf(data, data.weight), usable, significance)) return parts.found;
  const auto known = static_cast<int>(data.known.cols());
  const HiddenProblem problem =
      parts.ProblemOf(data, FirstOrderWeights(data, parts.tuning.first_order_error));
  const ContactLocationPosterior single = Locate(
      problem, parts.places, parts.normals, usable,
      {.scale = parts.scale, .friction = parts.tuning.friction, .unknowns = known + kUnknowns},
      parts.tuning.location);
  if (single.place < 0) return parts.found;
  std::vector<ContactLocationPosterior> contacts = {single};
  if (most == 2 && parts.Stands(parts.Without(problem, single), usable, significance)) {
    const std::vector<ContactLocationPosterior> pair = parts.FindPair(problem, usable, known);
    if (!pair.empty()) contacts = pair;
  }
  parts.Report(data, contacts);
  return parts.found;
}

const std::vector<HiddenContact>& HiddenSearch::Follow(const Unexplained& data,
                                                       const std::vector<PlacePrior>& before,
                                                       const std::vector<Eigen::Vector3d>& taken,
                                                       double taken_radius_m) {
  PALPATE_CHECK(!before.empty());
  Parts& parts = *parts_;
  parts.found.clear();
  const std::vector<bool> usable = parts.Usable(taken, taken_radius_m);
  const HiddenProblem problem =
      parts.ProblemOf(data, FirstOrderWeights(data, parts.tuning.first_order_error));
  const auto known = static_cast<int>(data.known.cols());
  const int unknowns = known + static_cast<int>(before.size()) * kUnknowns;
  std::vector<ContactLocationPosterior> contacts(before.size());
  for (size_t k = 0; k < contacts.size(); ++k) {
    contacts[k].place = parts.places.Nearest(before[k].mean_m);
    contacts[k].fit = parts.FitAt(problem, contacts[k].place);
  }
  const int rounds = contacts.size() == 1 ? 1 : parts.tuning.follow_rounds;
  for (int round = 0; round < rounds; ++round) {
    for (size_t k = 0; k < contacts.size(); ++k) {
      HiddenProblem rest = problem;
      for (size_t other = 0; other < contacts.size(); ++other) {
        if (other != k) rest = parts.Without(rest, contacts[other]);
      }
      contacts[k] = Locate(rest, parts.places, parts.normals, usable,
                           {.scale = parts.scale,
                            .friction = parts.tuning.friction,
                            .unknowns = unknowns,
                            .prior = before[k]},
                           parts.tuning.location);
      if (contacts[k].place < 0) return parts.found;
    }
  }
  parts.Report(data, contacts);
  return parts.found;
}

}  // namespace palpate::force_estimation
