// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/hidden_contacts.hpp"

#include <algorithm>
#include <utility>

namespace palpate::force_estimation {

namespace {

constexpr int kMostAtOnce = 2;
/// Around a contact that is seen nothing is searched: what is left over there is its own doing.
constexpr double kTakenRadius_m = 0.03;
constexpr int kFindAgainRounds = 2;
/// Frames of its life in which a hidden contact is looked for again.
constexpr int kYoungFrames = 5;
constexpr int kFramesBetweenSearches = 3;
/// After attempts that came to nothing, which cost many solves, the pauses double up to this.
constexpr int kLongestPause = 24;
/// Residual over noise, mean square, that calls for a search at once.
constexpr double kMuchLeft = 1.5;
constexpr double kSamePlace_m = 6e-3;
/// Another place must fit by so much better.
constexpr double kBetter = 0.95;
constexpr double kSearchWork = 1.0;

}  // namespace

HiddenContacts::HiddenContacts(robot::RobotModel& model, const ShapeConfig& config, ShapeFit& fit)
    : config_(config), fit_(fit), search_(model, config), pause_(kFramesBetweenSearches) {}

Status HiddenContacts::Prepare(const std::vector<robot::CableCommand>& cables) {
  return search_.Prepare(fit_.state().x_m, cables, fit_.state().lambda_a_N);
}

Status HiddenContacts::Find(const ShapeFrame& frame, const DepthBias& bias) {
  Status status = Status::Ok();
  if (before_) return Decide(frame, bias);
  if (!search_.prepared() || fit_.IsWorkUsedUp()) return status;
  const auto& sites = fit_.sites();
  const auto hidden =
      std::find_if(sites.begin(), sites.end(), [](const ShapeSite& site) { return site.hidden; });
  bool found_any = hidden != sites.end() && hidden->frames < kYoungFrames;
  if (hidden == sites.end() && !fit_.book().full() && IsTimeToSearch()) {
    fit_.AddWork(kSearchWork);
    const std::vector<HiddenContact> found = search_.Find(
        LeftOver(), kMostAtOnce, config_.hidden_significance, SeenPlaces(), kTakenRadius_m);
    if (found.empty()) return status;
    found_any = Try(found, frame, bias, &status);
    pause_ = found_any ? kFramesBetweenSearches : std::min(2 * pause_, kLongestPause);
  }
  for (int round = 0; found_any && status.ok() && round < kFindAgainRounds; ++round) {
    if (fit_.IsWorkUsedUp()) break;
    if (!FindAgain(frame, bias, &status)) break;
  }
  return status;
}

/// Each few frames, and at once where much is left over of which nothing was tried yet.
bool HiddenContacts::IsTimeToSearch() {
  const bool much_left = fit_.fitter().fit().chi_squared >= kMuchLeft * fit_.targets().Count();
  if (!much_left) pause_ = kFramesBetweenSearches;
  const bool tried_in_vain = pause_ > kFramesBetweenSearches;
  if (++frames_since_search_ < pause_ && (!much_left || tried_in_vain)) return false;
  frames_since_search_ = 0;
  return true;
}

/// True where another place was better.
bool HiddenContacts::FindAgain(const ShapeFrame& frame, const DepthBias& bias, Status* status) {
  fit_.AddWork(kSearchWork);
  const std::vector<HiddenContact> found = search_.Find(
      WithoutHidden(), kMostAtOnce, config_.hidden_significance, SeenPlaces(), kTakenRadius_m);
  if (found.empty() || AreWhereTheyWere(found)) return false;
  return Try(found, frame, bias, status);
}

Unexplained HiddenContacts::LeftOver() const {
  return {.rows = fit_.targets().rows(),
          .residual_m = fit_.fitter().fit().residual_m,
          .weight = fit_.targets().targets().weight,
          .known = fit_.fitter().Response()};
}

/// What the known contacts leave over where the hidden ones are taken out, to first order.
Unexplained HiddenContacts::WithoutHidden() const {
  Unexplained data = LeftOver();
  data.left_m = data.residual_m;
  const Eigen::MatrixXd response = data.known;
  Eigen::Index seen = 0;
  for (std::size_t s = 0; s < fit_.sites().size(); ++s) {
    const ShapeSite& site = fit_.sites()[s];
    if (site.hidden) {
      data.residual_m += search_.ResponseAt(data.rows, site.centre.rest_m) * fit_.ForceAt(s);
    } else {
      data.known.middleCols<3>(3 * seen++) =
          response.middleCols<3>(static_cast<Eigen::Index>(3 * s));
    }
  }
  data.known.conservativeResize(Eigen::NoChange, 3 * seen);
  return data;
}

/// The fit with these hidden contacts, where it is better than the one before.
bool HiddenContacts::Try(const std::vector<HiddenContact>& contacts, const ShapeFrame& frame,
                         const DepthBias& bias, Status* status) {
  ShapeFit::Attempt before;
  fit_.KeepIn(&before);
  fit_.ReplaceHidden(contacts);
  Status tried = fit_.MatchAndFit(frame, bias);
  if (tried.ok()) tried = fit_.Locate(frame, bias);
  if (tried.code() == StatusCode::kBudgetReached) {
    before_ = std::move(before);
    *status = tried;
    return false;
  }
  if (tried.ok() && fit_.fitter().fit().chi_squared < kBetter * before.chi_squared) return true;
  fit_.GoBack(before);
  *status = fit_.MatchAndFit(frame, bias);
  return false;
}

/// In a frame in which those that are tried have been fitted.
Status HiddenContacts::Decide(const ShapeFrame& frame, const DepthBias& bias) {
  const ShapeFit::Attempt before = std::move(*before_);
  before_.reset();
  if (fit_.fitter().fit().chi_squared < kBetter * before.chi_squared) return Status::Ok();
  fit_.GoBack(before);
  return fit_.MatchAndFit(frame, bias);
}

void HiddenContacts::Forget() {
  before_.reset();
  fit_.book().ForgetHidden();
}

bool HiddenContacts::AreWhereTheyWere(const std::vector<HiddenContact>& found) const {
  const auto& sites = fit_.sites();
  const auto hidden =
      std::count_if(sites.begin(), sites.end(), [](const ShapeSite& site) { return site.hidden; });
  return hidden == static_cast<std::ptrdiff_t>(found.size()) &&
         std::all_of(found.begin(), found.end(), [&](const HiddenContact& contact) {
           return std::any_of(sites.begin(), sites.end(), [&](const ShapeSite& site) {
             return site.hidden &&
                    (site.centre.rest_m - contact.rest_position_m).norm() < kSamePlace_m;
           });
         });
}

std::vector<Eigen::Vector3d> HiddenContacts::SeenPlaces() const {
  std::vector<Eigen::Vector3d> places_m;
  for (const ShapeSite& site : fit_.sites()) {
    if (!site.hidden) places_m.push_back(site.centre.rest_m);
  }
  return places_m;
}

}  // namespace palpate::force_estimation
