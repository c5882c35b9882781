// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/known_contacts.hpp"

#include <algorithm>
#include <utility>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"

namespace palpate::force_estimation {

namespace {

std::vector<Eigen::Vector3d> DistinctPlaces(const std::vector<experiment::KnownLoad>& loads) {
  std::vector<Eigen::Vector3d> places_m;
  for (const experiment::KnownLoad& load : loads) {
    if (std::find(places_m.begin(), places_m.end(), load.position_m) == places_m.end()) {
      places_m.push_back(load.position_m);
    }
  }
  return places_m;
}

}  // namespace

KnownContacts::KnownContacts(const robot::RobotBody& body, const KnownContactsTuning& tuning)
    : body_(body),
      tuning_(tuning),
      rest_surface_({body.mesh.nodes_m, body.boundary.DrawnTriangles()}) {}

std::vector<SeenContact> KnownContacts::At(const std::vector<ContactSite>& sites,
                                           const Eigen::VectorXd& nodes_m) const {
  PALPATE_CHECK(nodes_m.size() == 0 || nodes_m.size() == body_.mesh.nodes_m.size(), nodes_m.size());
  std::vector<SeenContact> contacts;
  for (const ContactSite& site : sites) {
    const geometry::SurfacePoint rest = rest_surface_.Closest(site.position_m);
    SeenContact contact;
    contact.name = site.name;
    contact.position_m = rest.position_m;
    for (Eigen::Index corner = 0; corner < 3 && nodes_m.size() > 0; ++corner) {
      const int node = rest_surface_.surface().triangles(corner, rest.triangle);
      contact.position_m +=
          rest.barycentric[corner] * (nodes_m.segment<3>(3 * node) - body_.mesh.nodes_m.col(node));
    }
    contact.covariance_m2 =
        tuning_.location_sigma_m * tuning_.location_sigma_m * Eigen::Matrix3d::Identity();
    contact.extent_m.setConstant(2.0 * site.patch_radius_m);
    contacts.push_back(contact);
  }
  return contacts;
}

std::vector<ContactSite> SitesOfLoads(const std::vector<experiment::KnownLoad>& loads, double t_s) {
  const std::vector<Eigen::Vector3d> places_m = DistinctPlaces(loads);
  std::vector<ContactSite> sites;
  for (const experiment::KnownLoad& load : experiment::LoadsAt(loads, t_s)) {
    if (load.force_N.isZero(0.0)) continue;
    const auto place = std::find(places_m.begin(), places_m.end(), load.position_m);
    ContactSite site;
    site.name = "load_" + std::to_string(place - places_m.begin() + 1);
    site.position_m = load.position_m;
    site.patch_radius_m = load.patch_radius_m;
    sites.push_back(site);
  }
  return sites;
}

std::vector<SeenContact> KnownBeforeSeen(std::vector<SeenContact> known,
                                         const std::vector<SeenContact>& seen,
                                         const KnownContactsTuning& tuning) {
  const std::size_t known_count = known.size();
  for (const SeenContact& contact : seen) {
    const bool is_known = std::any_of(
        known.begin(), known.begin() + ToIndex(known_count), [&](const SeenContact& other) {
          const double reach_m = std::max(tuning.same_contact_m, 0.5 * contact.extent_m.maxCoeff());
          return (other.position_m - contact.position_m).norm() <= reach_m;
        });
    if (!is_known) known.push_back(contact);
  }
  return known;
}

}  // namespace palpate::force_estimation
