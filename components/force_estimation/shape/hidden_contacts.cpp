// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/hidden_contacts.hpp"

#include <algorithm>
#include <utility>

#include "libs/core/index.hpp"

namespace palpate::force_estimation {

namespace {

/// Of a track that goes on from an earlier shape.
PlacePrior PriorOf(const ShapeSite& site, const HiddenContactsTuning& tuning) {
  const Eigen::Matrix3d slide_m2 = tuning.slide_m * tuning.slide_m * Eigen::Matrix3d::Identity();
  return {.mean_m = site.place_mean_m,
          .information_m2 = (tuning.prior_fading * site.place_covariance_m2 + slide_m2).inverse()};
}

/// The model error is a share of the displacement that varies smoothly over the body: one column
/// for each axis.
Eigen::MatrixXd ModelErrors_m(const ShapeFitter& fit, const Eigen::VectorXd& motion_m,
                              double model_error) {
  const auto& features = fit.targets().features();
  Eigen::MatrixXd along(motion_m.size(), 3);
  for (Eigen::Index r = 0; r < along.rows(); ++r) {
    along.row(r) = fit.features().point(features[At(r)]).Position(fit.state().x_m).transpose();
  }
  along.rowwise() -= along.colwise().mean().eval();
  const double size_m = std::sqrt(along.rowwise().squaredNorm().mean());
  return model_error / size_m * motion_m.asDiagonal() * along;
}

}  // namespace

HiddenContacts::HiddenContacts(robot::RobotModel& model, const ShapeConfig& config,
                               ShapeFitter& fit, const HiddenContactsTuning& tuning)
    : config_(config),
      tuning_(tuning),
      model_(model),
      fit_(fit),
      search_(model, config, fit.scale(), tuning.search),
      taken_radius_m_(tuning.taken_radius_share * fit.scale().length_m),
      pause_(tuning.frames_between_searches),
      average_(tuning.average) {}

Status HiddenContacts::Find(const ShapeFrame& frame, const CameraBiases& bias) {
  if (before_) return Decide(frame, bias);
  Status status = Status::Ok();
  if (!bias.known()) return status;
  if (HiddenSites().empty()) {
    AverageLeftOver(frame.t_s);
    if (fit_.IsWorkUsedUp() || fit_.tracks().full() || !IsTimeToSearch()) return status;
    if (!IsMisfitLarge() && LeavesToNextFrame()) {
      frames_since_search_ = pause_;
      return status;
    }
    status = Search(frame, bias);
  }
  for (int round = 0; round < tuning_.follow_rounds && status.ok() && !HiddenSites().empty();
       ++round) {
    if (before_ || (round > 0 && fit_.IsWorkUsedUp())) break;
    const int linearisations = fit_.linearisations();
    status = Follow(frame, bias);
    if (linearisations == fit_.linearisations()) break;
  }
  return status;
}

Status HiddenContacts::Search(const ShapeFrame& frame, const CameraBiases& bias) {
  fit_.AddWork(tuning_.search_work);
  if (!Respond(frame.cables).ok()) return Status::Ok();
  const Unexplained data = LeftOver();
  std::vector<Eigen::Vector3d> taken_m = SeenPlaces();
  Status status = Status::Ok();
  const int most = fit_.IsWorkLimited() ? 1 : tuning_.most_tried;
  int tried = 0;
  for (; tried < most && status.ok(); ++tried) {
    const std::vector<HiddenContact> found = search_.Find(
        data, tuning_.most_at_once, config_.hidden_significance, taken_m, taken_radius_m_);
    if (found.empty()) break;
    if (Try(found, frame, bias, &status)) {
      pause_ = tuning_.frames_between_searches;
      return status;
    }
    for (const HiddenContact& contact : found) taken_m.push_back(contact.rest_position_m);
  }
  if (tried > 0) CountAsFailed();
  return status;
}

void HiddenContacts::CountAsFailed() {
  pause_ = std::min(2 * pause_, tuning_.longest_pause_frames);
}

bool HiddenContacts::IsMisfitLarge() const {
  return fit_.fitter().fit().chi_squared >= tuning_.large_misfit * fit_.targets().Count();
}

/// Every few frames, and at once where the misfit is large and no attempt has failed yet.
bool HiddenContacts::IsTimeToSearch() {
  const bool is_large = IsMisfitLarge();
  if (!is_large) pause_ = tuning_.frames_between_searches;
  const bool has_failed = pause_ > tuning_.frames_between_searches;
  if (++frames_since_search_ < pause_ && (!is_large || has_failed)) return false;
  frames_since_search_ = 0;
  return true;
}

Status HiddenContacts::Follow(const ShapeFrame& frame, const CameraBiases& bias) {
  AddToAverage();
  if (!(left_over_ || IsTimeToFollow()) || LeavesToNextFrame()) return Status::Ok();
  fit_.AddWork(tuning_.search_work);
  if (!Respond(frame.cables).ok()) return Status::Ok();
  const Unexplained data = OfHidden();
  const std::vector<HiddenContact> found =
      search_.Follow(data, priors_, SeenPlaces(), taken_radius_m_);
  if (found.empty()) return Status::Ok();
  const Status status = MoveTo(found, frame, bias);
  if (!status.ok() || !IsMisfitLarge() || fit_.IsWorkUsedUp() || !IsTimeToSearch()) return status;
  return FindOthers(data, frame, bias);
}

/// The remaining residual may come from another contact, or from wrong locations of all.
Status HiddenContacts::FindOthers(const Unexplained& data, const ShapeFrame& frame,
                                  const CameraBiases& bias) {
  const std::vector<HiddenContact> found = search_.Find(
      data, tuning_.most_at_once, config_.hidden_significance, SeenPlaces(), taken_radius_m_);
  Status status = Status::Ok();
  if (found.empty() || AreWhereTheyWere(found)) return status;
  const bool better = Try(found, frame, bias, &status);
  pause_ =
      better ? tuning_.frames_between_searches : std::min(2 * pause_, tuning_.longest_pause_frames);
  return status;
}

Status HiddenContacts::MoveTo(const std::vector<HiddenContact>& found, const ShapeFrame& frame,
                              const CameraBiases& bias) {
  const std::vector<std::size_t> hidden = HiddenSites();
  bool moved = false;
  bool far = false;
  ShapeFitter::Attempt before;
  fit_.KeepIn(&before);
  for (std::size_t k = 0; k < hidden.size(); ++k) {
    const Eigen::Vector3d was_m = fit_.sites()[hidden[k]].centre.rest_m;
    far = far || (found[k].rest_position_m - was_m).norm() > tuning_.same_location_m;
    moved = fit_.tracks().Follow(hidden[k], found[k]) || moved;
  }
  if (!moved) return Status::Ok();
  const Status status = fit_.FitAtNewLocations(frame, bias);
  const bool worse = !status.ok() || fit_.fitter().fit().chi_squared > before.chi_squared;
  if (!far || !worse) return status;
  fit_.GoBack(before);
  return fit_.MatchAndFit(frame, bias);
}

bool HiddenContacts::IsTimeToFollow() const {
  const std::vector<std::size_t> hidden = HiddenSites();
  return average_.frames() == 1 || std::any_of(hidden.begin(), hidden.end(), [&](std::size_t s) {
           const int frames = fit_.sites()[s].frames;
           return frames < tuning_.young_frames || frames % tuning_.frames_between_locations == 0;
         });
}

/// Adds the displacement due to hidden contacts, by the fit's own responses, to the average.
void HiddenContacts::AddToAverage() {
  const std::vector<std::size_t> hidden = HiddenSites();
  Eigen::VectorXd motion_m = fit_.fitter().fit().residual_m;
  for (const std::size_t s : hidden) {
    motion_m += fit_.fitter().Response().middleCols<3>(ToIndex(3 * s)) * fit_.ForceAt(s);
  }
  if (averaged_about_ != fit_.linearisations() || priors_.size() != hidden.size()) {
    average_.Forget();
    averaged_about_ = fit_.linearisations();
  }
  average_.Add(fit_.targets(), motion_m);
  if (average_.frames() > 1) return;
  priors_.clear();
  for (const std::size_t s : hidden) {
    const ShapeSite& site = fit_.sites()[s];
    priors_.push_back(are_new_ ? PlacePrior{.mean_m = site.centre.rest_m} : PriorOf(site, tuning_));
  }
  are_new_ = false;
}

/// The same without hidden contacts: what is too weak for one frame shows in many. Rounds of one
/// frame have one noise, so that the last one counts alone.
void HiddenContacts::AverageLeftOver(double t_s) {
  if (t_s == averaged_t_s_ || !priors_.empty()) average_.Forget();
  priors_.clear();
  averaged_t_s_ = t_s;
  average_.Add(fit_.targets(), fit_.fitter().fit().residual_m);
}

/// New responses would delay a frame: they are solved for once its forces are published, and used
/// by the next one, which is not postponed again.
bool HiddenContacts::LeavesToNextFrame() {
  if (!fit_.IsWorkLimited()) return false;
  left_over_ = linearisations_ != fit_.linearisations() && !left_over_;
  return left_over_;
}

void HiddenContacts::PrepareNext(const std::vector<robot::ActuatorCommand>& cables) {
  if (left_over_ && !Respond(cables).ok()) left_over_ = false;
}

/// Responses of this frame's surface points about the present shape.
Status HiddenContacts::Respond(const std::vector<robot::ActuatorCommand>& cables) {
  if (linearisations_ != fit_.linearisations()) {
    responses_.Clear();
    row_of_match_.clear();
    linearisations_ = fit_.linearisations();
  }
  std::vector<robot::ObservationRow> rows;
  std::vector<std::size_t> matches;
  row_of_match_.resize(std::max(row_of_match_.size(), fit_.targets().MostRows()), -1);
  for (std::size_t r = 0; r < fit_.targets().matched().size(); ++r) {
    const std::size_t match = fit_.targets().matched()[r];
    if (row_of_match_[match] >= 0) continue;
    rows.push_back(fit_.targets().rows()[r]);
    matches.push_back(match);
  }
  search_.SetShape(fit_.state().x_m);
  if (rows.empty()) return Status::Ok();
  fit_.AddWork(tuning_.row_work * static_cast<double>(rows.size()));
  const ModelState& state = fit_.state();
  int row = responses_.Count();
  Status status = responses_.Add(model_, rows, state.x_m, cables, state.lambda_a_N);
  if (!status.ok()) return status;
  for (const std::size_t match : matches) row_of_match_[match] = row++;
  return status;
}

std::vector<int> HiddenContacts::RowsOfTargets() const {
  std::vector<int> rows;
  for (const std::size_t match : fit_.targets().matched()) rows.push_back(row_of_match_[match]);
  return rows;
}

Unexplained HiddenContacts::LeftOver() const {
  return {.residual_m = average_.motion_m(),
          .weight = average_.weight(),
          .known = fit_.fitter().Response(),
          .left_m = fit_.fitter().fit().residual_m,
          .responses = &responses_,
          .row = RowsOfTargets()};
}

/// The mean displacement due to hidden contacts, for a search about the present shape.
Unexplained HiddenContacts::OfHidden() const {
  Unexplained data{.residual_m = average_.motion_m(),
                   .weight = average_.weight(),
                   .known = Eigen::MatrixXd(fit_.targets().Count(), 0),
                   .left_m = fit_.fitter().fit().residual_m,
                   .responses = &responses_,
                   .row = RowsOfTargets()};
  data.errors_m = ModelErrors_m(fit_, data.residual_m, tuning_.model_error);
  for (std::size_t s = 0; s < fit_.sites().size(); ++s) {
    if (fit_.sites()[s].hidden) continue;
    data.known.conservativeResize(Eigen::NoChange, data.known.cols() + 3);
    data.known.rightCols<3>() = fit_.fitter().Response().middleCols<3>(ToIndex(3 * s));
  }
  return data;
}

/// Keeps the fit with these hidden contacts where it is better than the one before.
bool HiddenContacts::Try(const std::vector<HiddenContact>& contacts, const ShapeFrame& frame,
                         const CameraBiases& bias, Status* status) {
  ShapeFitter::Attempt before;
  fit_.KeepIn(&before);
  fit_.ReplaceHidden(contacts);
  average_.Forget();
  priors_.clear();
  are_new_ = true;
  const Status tried = fit_.MatchAndFitFromFar(frame, bias);
  if (tried.code() == StatusCode::kBudgetReached) {
    before_ = std::move(before);
    *status = tried;
    return false;
  }
  if (tried.ok() && fit_.fitter().fit().chi_squared < tuning_.better_misfit * before.chi_squared)
    return true;
  fit_.GoBack(before);
  *status = fit_.MatchAndFit(frame, bias);
  return false;
}

/// In the frame in which the attempt has been fitted.
Status HiddenContacts::Decide(const ShapeFrame& frame, const CameraBiases& bias) {
  const ShapeFitter::Attempt before = std::move(*before_);
  before_.reset();
  if (fit_.fitter().fit().chi_squared < tuning_.better_misfit * before.chi_squared)
    return Status::Ok();
  fit_.GoBack(before);
  return fit_.MatchAndFit(frame, bias);
}

void HiddenContacts::Begin() {
  Forget();
  frames_since_search_ = pause_ = tuning_.frames_between_searches;
  left_over_ = false;
}

void HiddenContacts::Forget() {
  before_.reset();
  average_.Forget();
  priors_.clear();
  fit_.tracks().ForgetHidden();
}

bool HiddenContacts::AreWhereTheyWere(const std::vector<HiddenContact>& found) const {
  const std::vector<std::size_t> hidden = HiddenSites();
  return hidden.size() == found.size() &&
         std::all_of(found.begin(), found.end(), [&](const HiddenContact& contact) {
           return std::any_of(hidden.begin(), hidden.end(), [&](std::size_t s) {
             return (fit_.sites()[s].centre.rest_m - contact.rest_position_m).norm() <
                    tuning_.same_location_m;
           });
         });
}

std::vector<std::size_t> HiddenContacts::HiddenSites() const {
  std::vector<std::size_t> hidden;
  for (std::size_t s = 0; s < fit_.sites().size(); ++s) {
    if (fit_.sites()[s].hidden) hidden.push_back(s);
  }
  return hidden;
}

std::vector<Eigen::Vector3d> HiddenContacts::SeenPlaces() const {
  std::vector<Eigen::Vector3d> places_m;
  for (const ShapeSite& site : fit_.sites()) {
    if (!site.hidden) places_m.push_back(site.centre.rest_m);
  }
  return places_m;
}

}  // namespace palpate::force_estimation
