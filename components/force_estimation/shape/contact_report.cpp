// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/contact_report.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "components/force_estimation/shape/temporal_correlation.hpp"
#include "libs/core/index.hpp"
#include "libs/core/statistics.hpp"

namespace palpate::force_estimation {

namespace {

/// At the contact's location.
Eigen::Matrix3d CovarianceOf(const ShapeFitter& fit, std::size_t site) {
  const auto row = ToIndex(3 * site);
  const Eigen::Matrix3d unfitted_N2 = UnfittedCovariance_N2(
      fit.fitter().fit(), site, [&](std::size_t other) { return fit.TangentialSigma_N(other); });
  return fit.Covariance_N2().block<3, 3>(row, row) + unfitted_N2;
}

/// What a bias that was fitted along adds to the covariance.
Eigen::Matrix3d ShareOfBias(const ShapeFitter& fit, std::size_t site) {
  const auto row = ToIndex(3 * site);
  return fit.Covariance_N2().block<3, 3>(row, row) -
         fit.fitter().fit().covariance_N2.block<3, 3>(row, row);
}

/// With the uncertainty of the location.
Eigen::Matrix3d WholeCovariance(const ShapeFitter& fit, std::size_t site) {
  const ShapeSite& followed = fit.sites()[site];
  if (followed.hidden) return CovarianceOf(fit, site) + followed.place_force_covariance_N2;
  if (site < fit.located().size()) {
    return fit.located()[site].force_covariance_N2 + ShareOfBias(fit, site);
  }
  return CovarianceOf(fit, site);
}

/// Along the two tangents of the undeformed surface.
Eigen::Matrix2d LocationCovariance_m2(const ShapeFitter& fit, std::size_t site, double inflation) {
  const ShapeSite& followed = fit.sites()[site];
  if (followed.hidden) {
    const Eigen::Matrix<double, 3, 2> tangents = Tangents(followed.patch.normal);
    return tangents.transpose() * followed.place_covariance_m2 * tangents;
  }
  if (site < fit.located().size()) return inflation * fit.located()[site].location_covariance_m2;
  return followed.seen_sigma_m * followed.seen_sigma_m * Eigen::Matrix2d::Identity();
}

/// Of covariances, where the fit leaves more than they say.
double InflationOf(const ShapeFitter& fit) {
  const int freedom = DegreesOfFreedom(fit);
  return freedom > 0 ? std::max(1.0, fit.fitter().fit().chi_squared / freedom) : 1.0;
}

/// Whether no force is within the 95 % ellipsoid about this one.
bool IsZeroWithin(const Eigen::Vector3d& force_N, const Eigen::Matrix3d& covariance_N2) {
  const Eigen::LLT<Eigen::Matrix3d> spread(covariance_N2);
  return spread.info() == Eigen::Success &&
         force_N.dot(spread.solve(force_N)) <= ChiSquaredQuantile(0.95, 3);
}

/// The part of a force's covariance that comes from the depth noise, and so differs from frame to
/// frame: of the estimator A = C G' S^-1, A N A'.
Eigen::Matrix3d RandomCovariance(const ShapeFitter& fit, std::size_t site) {
  const auto row = ToIndex(3 * site);
  const Eigen::MatrixXd estimator = fit.fitter().fit().covariance_N2.middleRows<3>(row) *
                                    fit.fitter().Response().transpose() *
                                    fit.targets().targets().weight.asDiagonal();
  return estimator * fit.targets().noise_m().array().square().matrix().asDiagonal() *
         estimator.transpose();
}

/// The random part after filtering. The filter is given the variance of a single frame times
/// kTemporalCorrelation. Of a mean over n frames it computes kTemporalCorrelation / n of the
/// variance, which is right for many frames and too much for few.
Eigen::Matrix3d RandomLeft(const Eigen::Matrix3d& single_N2, const Eigen::Matrix3d& filtered_N2) {
  const double averaged = filtered_N2.trace() / (kTemporalCorrelation * single_N2.trace());
  return filtered_N2 / (1.0 + (kTemporalCorrelation - 1.0) * std::min(1.0, averaged));
}

/// What filtering takes from a force's covariance.
Eigen::Matrix3d AveragedAway(const ShapeFitter& fit, std::size_t site) {
  const Eigen::Matrix3d single_N2 = RandomCovariance(fit, site);
  return single_N2 - RandomLeft(single_N2, fit.sites()[site].filter.covariance_N2());
}

}  // namespace

double Strength(const Eigen::Vector3d& force_N, const Eigen::Matrix3d& covariance_N2,
                const Eigen::Vector3d& normal, bool hidden, double chance) {
  const double pressed_N = -normal.dot(force_N);
  const double sigma_N = std::sqrt(std::max(0.0, normal.dot(covariance_N2 * normal)));
  const double along = pressed_N / (NormalQuantile(1.0 - chance) * sigma_N);
  if (!hidden || !(pressed_N > 0.0)) return along;
  const Eigen::LLT<Eigen::Matrix3d> spread(covariance_N2);
  if (spread.info() != Eigen::Success) return along;
  const double whole = force_N.dot(spread.solve(force_N));
  return std::max(along, std::sqrt(whole / ChiSquaredQuantile(1.0 - chance, 3)));
}

ContactReport::ContactReport(const ShapeConfig& config, double force_relative_sigma,
                             int candidate_locations, const ContactReportTuning& tuning)
    : config_(config),
      tuning_(tuning),
      force_relative_sigma_(force_relative_sigma),
      search_places_(candidate_locations) {}

/// At its location: the test is against no force, where a location has no meaning. A hidden contact
/// is the best of many candidates, so that the chance is divided by their number.
/// Where the body is fixed, a push is not determined. Its force and variance of zero would give no
/// number, which is never quiet.
double ContactReport::StrengthOf(const ShapeFitter& fit, std::size_t site) const {
  if (fit.fitter().fit().observability[site] == Observability::kNone) return 0.0;
  const bool hidden = fit.sites()[site].hidden;
  const double seen = fit.IsBiasFittedAlong() ? tuning_.significance_along : config_.significance;
  const double chance = hidden ? config_.hidden_significance / search_places_ : seen;
  if (!hidden) {
    return Strength(fit.ForceAt(site), CovarianceOf(fit, site), fit.NormalAt(site), false, chance);
  }
  const ForceFilter& filter = fit.sites()[site].filter;
  return Strength(filter.force_N(), CovarianceOf(fit, site) - AveragedAway(fit, site),
                  fit.NormalAt(site), true, chance);
}

void ContactReport::Judge(double t_s, bool begins, ShapeFitter* fit) const {
  for (std::size_t s = 0; s < fit->sites().size(); ++s) {
    fit->tracks().filter(s).Update(t_s, fit->ForceAt(s),
                                   kTemporalCorrelation * RandomCovariance(*fit, s));
    const double strength = StrengthOf(*fit, s);
    const auto evidence = strength > tuning_.clear_strength ? ContactTracks::Evidence::kBeyondDoubt
                          : strength > 1.0                  ? ContactTracks::Evidence::kSignificant
                                                            : ContactTracks::Evidence::kNone;
    const ShapeSite& site = fit->sites()[s];
    const double largest_place_m = tuning_.largest_place_share * fit->scale().length_m;
    const bool at_once = begins && !(site.hidden && site.place_ci95_m > largest_place_m);
    fit->tracks().Judge(s, evidence, strength < tuning_.quiet_strength, at_once);
  }
}

bool ContactReport::HoldsZero(const ShapeFitter& fit, std::size_t site) const {
  return IsZeroWithin(fit.ForceAt(site), InflationOf(fit) * WholeCovariance(fit, site));
}

std::vector<ContactForce> ContactReport::Contacts(const ShapeFitter& fit) const {
  const double inflation = InflationOf(fit);
  std::vector<ContactForce> contacts;
  for (std::size_t s = 0; s < fit.sites().size(); ++s) {
    const ShapeSite& site = fit.sites()[s];
    if (!site.acts || site.quiet_frames > 0) continue;
    ContactForce contact = ContactAt(fit, s, inflation);
    if (site.hidden && IsZeroWithin(contact.force_N, contact.covariance_N2)) {
      const bool is_only_one = fit.sites().size() == 1;
      if (!is_only_one || !site.is_beyond_doubt) continue;
      contact.status = Status(StatusCode::kUncertain, {});
    }
    contacts.push_back(std::move(contact));
  }
  return contacts;
}

Status ContactReport::WithoutContacts(const ShapeFitter& fit) const {
  const auto pushes_somewhere = [](const ShapeSite& site) {
    return site.hidden && site.quiet_frames == 0 && (site.acts || site.is_beyond_doubt);
  };
  if (std::none_of(fit.sites().begin(), fit.sites().end(), pushes_somewhere)) {
    return Status(StatusCode::kNoContact, {});
  }
  return {StatusCode::kUnobservable,
          "something out of view pushes: the images do not tell yet where, or how hard"};
}

Status ContactReport::StatusOf(const ShapeFitter& fit, std::size_t site) const {
  if (fit.sites()[site].hidden) return {StatusCode::kHidden, {}};
  const Eigen::Matrix<double, 3, 2> tangents = Tangents(fit.NormalAt(site));
  const Eigen::Matrix2d left = tangents.transpose() * CovarianceOf(fit, site) * tangents;
  const double prior_sigma_N = fit.TangentialSigma_N(site);
  const bool observed =
      left.trace() < 2.0 * tuning_.observed_variance * prior_sigma_N * prior_sigma_N;
  return observed ? Status::Ok() : Status(StatusCode::kTangentialUnobservable, {});
}

/// The filtered force. Filtering reduces the random part of its covariance; the constant part
/// (bias, model, location) stays.
ContactForce ContactReport::ContactAt(const ShapeFitter& fit, std::size_t site,
                                      double inflation) const {
  const ShapeSite& followed = fit.sites()[site];
  ContactForce contact;
  contact.name = followed.name;
  contact.status = StatusOf(fit, site);
  contact.position_m = followed.patch.weights.Position(fit.state().x_m);
  contact.force_N = followed.filter.force_N();
  const Eigen::Matrix3d whole = WholeCovariance(fit, site);
  const Eigen::Vector3d shared_N = force_relative_sigma_ * contact.force_N;
  contact.covariance_N2 =
      inflation * (whole - AveragedAway(fit, site)) + shared_N * shared_N.transpose();
  contact.ci95_N = HalfWidth95_N(contact.force_N, contact.covariance_N2);
  const bool wide = contact.ci95_N > tuning_.uncertain_share * contact.force_N.norm();
  if (wide && !followed.hidden) contact.status = Status(StatusCode::kUncertain, {});
  const Eigen::Matrix2d along_m2 = LocationCovariance_m2(fit, site, inflation);
  const Eigen::Matrix<double, 3, 2> tangents =
      fit.SurfaceGradientAt(site) * Tangents(followed.patch.normal);
  contact.location_covariance_m2 = tangents * along_m2 * tangents.transpose();
  contact.location_ci95_m = followed.hidden
                                ? followed.place_ci95_m
                                : std::sqrt(0.5 * ChiSquaredQuantile(0.95, 2) * along_m2.trace());
  return contact;
}

int DegreesOfFreedom(const ShapeFitter& fit) {
  return fit.targets().Count() - static_cast<int>(3 * fit.sites().size());
}

}  // namespace palpate::force_estimation
