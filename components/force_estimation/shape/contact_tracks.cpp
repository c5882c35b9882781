// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/contact_tracks.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "components/force_estimation/shape/location_step.hpp"
#include "libs/fem/bounded_qp.hpp"
#include "libs/geometry/box.hpp"

namespace palpate::force_estimation {

namespace {

constexpr std::size_t kMostSites = fem::kMaxQpVariables / 3;
/// Radius that contains 95 % of a normal distribution in two directions.
constexpr double kSigmas95InPlane = 2.448;

/// Largest sigma along the surface with this normal.
double TangentialSigma_m(const Eigen::Matrix3d& covariance_m2, const Eigen::Vector3d& normal) {
  const Eigen::Matrix<double, 3, 2> tangents = Tangents(normal);
  const Eigen::Matrix2d along = tangents.transpose() * covariance_m2 * tangents;
  const double mean = 0.5 * along.trace();
  const double spread = std::sqrt(std::max(0.0, mean * mean - along.determinant()));
  return std::sqrt(std::max(0.0, mean + spread));
}

/// Location and uncertainty of the search.
void TakePlace(const HiddenContact& found, ShapeSite* site) {
  site->seen_rest_m = site->centre.rest_m;
  site->place_mean_m = site->centre.rest_m + found.mean_off_m;
  site->place_covariance_m2 = found.location_covariance_m2;
  site->place_ci95_m = found.location_ci95_m;
  site->place_force_covariance_N2 = found.force_covariance_N2;
}

}  // namespace

ContactTracks::ContactTracks(const robot::RobotModel& model, const ShapeConfig& config,
                             const ContactTracksTuning& tuning)
    : model_(model),
      config_(config),
      tuning_(tuning),
      length_m_(geometry::BoundingBox(model.body().mesh.nodes_m).Diagonal_m()),
      map_(model, tuning.map) {}

bool ContactTracks::IsSame(const ShapeSite& site, const Eigen::Vector3d& rest_m) const {
  return (site.centre.rest_m - rest_m).norm() < tuning_.same_contact_share * length_m_;
}

bool ContactTracks::See(const std::vector<SeenContact>& contacts, const Eigen::VectorXd& x_m) {
  if (!contacts.empty()) map_.Deform(x_m);
  bool changed = LoseSight(contacts);
  for (const SeenContact& contact : contacts) {
    if (ShapeSite* site = Find(contact.name)) {
      changed = DropHiddenNear(site->centre.rest_m) || changed;
      site = Find(contact.name);
      Refresh(contact, site);
      changed = PlaceAgainIfFar(site) || changed;
      continue;
    }
    const MaterialPoint centre = map_.NearestNow(contact.position_m);
    if (centre.distance_m > tuning_.farthest_m || IsTaken(centre, SigmaOf_m(contact, centre)))
      continue;
    ShapeSite site = NewSiteAt(centre.rest_m);
    changed = DropHiddenNear(centre.rest_m) || changed;
    if (full()) continue;
    site.name = contact.name;
    site.radius_m = std::clamp(tuning_.patch_share_of_extent * contact.extent_m.maxCoeff(),
                               config_.contact_radius_m,
                               std::max(config_.contact_radius_m, tuning_.largest_radius_m));
    Place(centre, &site);
    Refresh(contact, &site);
    sites_.push_back(std::move(site));
    changed = true;
  }
  return changed;
}

/// Contacts that are no longer visible: those that push go on as hidden, the others are removed.
/// True where there were any.
bool ContactTracks::LoseSight(const std::vector<SeenContact>& contacts) {
  bool changed = false;
  for (ShapeSite& site : sites_) {
    const bool seen = std::any_of(contacts.begin(), contacts.end(),
                                  [&](const auto& contact) { return contact.name == site.name; });
    if (site.hidden || seen) continue;
    changed = site.hidden = true;
    site.name = site.acts && site.quiet_frames == 0 ? HiddenName() : std::string();
    const double known_m = std::max(tuning_.least_lost_sigma_m, site.seen_sigma_m);
    site.place_mean_m = site.centre.rest_m;
    site.place_covariance_m2 = known_m * known_m * Eigen::Matrix3d::Identity();
    site.place_ci95_m = kSigmas95InPlane * known_m;
    site.seen_sigma_m = tuning_.hidden_sigma_share * length_m_;
  }
  std::erase_if(sites_, [](const ShapeSite& site) { return site.name.empty(); });
  return changed;
}

/// With the history of a hidden contact at that location: its force goes on.
ShapeSite ContactTracks::NewSiteAt(const Eigen::Vector3d& rest_m) const {
  ShapeSite site;
  site.filter = ForceFilter(config_.force_rate_N_s, tuning_.filter);
  for (const ShapeSite& other : sites_) {
    if (!other.hidden || !other.acts || !IsSame(other, rest_m)) continue;
    site.filter = other.filter;
    site.significant_frames = other.significant_frames;
    site.quiet_frames = other.quiet_frames;
    site.acts = true;
  }
  return site;
}

/// A hidden contact close to a visible one is the same.
bool ContactTracks::DropHiddenNear(const Eigen::Vector3d& rest_m) {
  return std::erase_if(sites_, [&](const ShapeSite& site) {
           return site.hidden && IsSame(site, rest_m);
         }) > 0;
}

void ContactTracks::Refresh(const SeenContact& contact, ShapeSite* site) {
  const MaterialPoint seen = map_.NearestNow(contact.position_m + site->turned_m);
  site->seen_rest_m = seen.rest_m;
  site->seen_sigma_m = SigmaOf_m(contact, seen);
}

/// A visible contact that may lie at the location of another, by both uncertainties, is a part of
/// it: their forces are not identifiable.
bool ContactTracks::IsTaken(const MaterialPoint& place, double sigma_m) const {
  return std::any_of(sites_.begin(), sites_.end(), [&](const ShapeSite& site) {
    const double near_m = std::max(
        tuning_.one_contact_m, tuning_.one_contact_sigmas * std::hypot(sigma_m, site.seen_sigma_m));
    return !site.hidden && (site.centre.rest_m - place.rest_m).norm() < near_m;
  });
}

double ContactTracks::SigmaOf_m(const SeenContact& contact, const MaterialPoint& place) const {
  return std::max(tuning_.least_visible_sigma_m,
                  TangentialSigma_m(contact.covariance_m2, map_.NormalNow(place)));
}

/// Before the first fit of a large push the nearest surface may be that of the body's other side.
bool ContactTracks::PlaceAgainIfFar(ShapeSite* site) const {
  const double limit_m =
      std::max(tuning_.far_from_visible_m, tuning_.far_sigmas * site->seen_sigma_m);
  if ((site->seen_rest_m - site->centre.rest_m).norm() <= limit_m) return false;
  Place(map_.NearestAtRest(site->seen_rest_m), site);
  return true;
}

bool ContactTracks::TurnOver(std::size_t index, const Eigen::Vector3d& force_N) {
  ShapeSite& site = sites_[index];
  if (site.hidden || !site.turned_m.isZero(0.0)) return false;
  const bool is_sure = site.seen_sigma_m <= tuning_.least_visible_sigma_m;
  const std::optional<MaterialPoint> other = map_.OtherSideNow(
      site.centre, -force_N.normalized(),
      is_sure ? 0.0 : std::max(tuning_.thin_limb_m, tuning_.far_sigmas * site.seen_sigma_m));
  if (!other) return false;
  site.turned_m = map_.PositionNow_m(*other) - map_.PositionNow_m(site.centre);
  site.seen_rest_m = other->rest_m;
  Place(*other, &site);
  return true;
}

void ContactTracks::ReplaceHidden(const std::vector<HiddenContact>& found) {
  std::vector<ShapeSite> old;
  for (const ShapeSite& site : sites_) {
    if (site.hidden) old.push_back(site);
  }
  std::erase_if(sites_, [](const ShapeSite& site) { return site.hidden; });
  for (std::size_t k = 0; k < found.size() && !full(); ++k) {
    if (k >= old.size()) {
      AddHidden(found[k]);
      continue;
    }
    ShapeSite site = old[k];
    Place(map_.NearestAtRest(found[k].rest_position_m), &site);
    TakePlace(found[k], &site);
    sites_.push_back(std::move(site));
  }
}

void ContactTracks::AddHidden(const HiddenContact& found) {
  ShapeSite site;
  site.name = HiddenName();
  site.hidden = true;
  site.filter = ForceFilter(config_.force_rate_N_s, tuning_.filter);
  site.radius_m = config_.contact_radius_m;
  Place(map_.NearestAtRest(found.rest_position_m), &site);
  site.seen_sigma_m = tuning_.hidden_sigma_share * length_m_;
  TakePlace(found, &site);
  sites_.push_back(std::move(site));
}

bool ContactTracks::Follow(std::size_t index, const HiddenContact& found) {
  ShapeSite& site = sites_[index];
  const MaterialPoint moved = map_.NearestAtRest(found.rest_position_m);
  const bool far = (moved.rest_m - site.centre.rest_m).norm() >= tuning_.least_move_m;
  if (far) Place(moved, &site);
  TakePlace(found, &site);
  return far;
}

bool ContactTracks::Move(std::size_t index, const Eigen::Vector3d& step_rest_m) {
  ShapeSite& site = sites_[index];
  const MaterialPoint moved = map_.NearestAtRest(site.centre.rest_m + step_rest_m);
  if ((moved.rest_m - site.centre.rest_m).norm() < tuning_.least_move_m) return false;
  Place(moved, &site);
  return true;
}

void ContactTracks::Place(const MaterialPoint& centre, ShapeSite* site) const {
  site->centre = centre;
  site->patch = model_.Patch(centre.rest_m, site->radius_m);
  site->triangles = map_.TrianglesAround(centre, site->radius_m);
}

void ContactTracks::Judge(std::size_t index, Evidence evidence, bool quiet, bool begins) {
  ShapeSite& site = sites_[index];
  ++site.frames;
  site.is_beyond_doubt = evidence == Evidence::kBeyondDoubt;
  site.significant_frames += evidence == Evidence::kBeyondDoubt ? 2 : 1;
  if (evidence == Evidence::kNone) site.significant_frames = 0;
  site.quiet_frames = quiet ? site.quiet_frames + 1 : 0;
  const int wanted = site.hidden ? tuning_.frames_to_appear_hidden : tuning_.frames_to_appear;
  const bool at_once = begins && evidence != Evidence::kNone;
  if (at_once || site.significant_frames >= wanted) site.acts = true;
  if (site.quiet_frames >= tuning_.quiet_frames_to_vanish) site.acts = false;
}

void ContactTracks::ForgetHidden() {
  std::erase_if(sites_, [](const ShapeSite& site) { return site.hidden; });
}

bool ContactTracks::ForgetQuiet() {
  return std::erase_if(sites_, [this](const ShapeSite& site) {
           return site.hidden && site.quiet_frames >= tuning_.quiet_frames_to_vanish;
         }) > 0;
}

bool ContactTracks::full() const { return sites_.size() >= kMostSites; }

ShapeSite* ContactTracks::Find(const std::string& name) {
  const auto found = std::find_if(sites_.begin(), sites_.end(),
                                  [&](const ShapeSite& site) { return site.name == name; });
  return found == sites_.end() ? nullptr : &*found;
}

}  // namespace palpate::force_estimation
