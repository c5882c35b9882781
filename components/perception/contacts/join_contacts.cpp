// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/contacts/join_contacts.hpp"

#include <Eigen/LU>
#include <cstddef>
#include <limits>

namespace palpate::perception {

namespace {

bool IsSame(const DetectedContact& one, const DetectedContact& other,
            const JoinContactsTuning& tuning) {
  const Eigen::Vector3d apart_m = one.position_m - other.position_m;
  if (apart_m.norm() <= tuning.same_contact_m) return true;
  if (apart_m.norm() > tuning.farthest_m) return false;
  const Eigen::Matrix3d covariance_m2 = one.covariance_m2 + other.covariance_m2;
  return apart_m.dot(covariance_m2.inverse() * apart_m) <= tuning.chi_squared;
}

/// Equal shares of both, or the more certain one alone where that is more certain still.
DetectedContact Joined(const DetectedContact& one, const DetectedContact& other) {
  const bool first = one.covariance_m2.trace() <= other.covariance_m2.trace();
  DetectedContact joined = first ? one : other;
  joined.point_count = one.point_count + other.point_count;
  const Eigen::Matrix3d of_one = 0.5 * one.covariance_m2.inverse();
  const Eigen::Matrix3d of_other = 0.5 * other.covariance_m2.inverse();
  const Eigen::Matrix3d covariance_m2 = (of_one + of_other).inverse();
  if (!(covariance_m2.trace() < joined.covariance_m2.trace())) return joined;
  joined.position_m = covariance_m2 * (of_one * one.position_m + of_other * other.position_m);
  joined.covariance_m2 = covariance_m2;
  return joined;
}

}  // namespace

void JoinContacts(const std::vector<DetectedContact>& further,
                  std::vector<DetectedContact>* contacts, const JoinContactsTuning& tuning) {
  const std::size_t known = contacts->size();
  std::vector<char> is_taken(known, 0);
  for (const DetectedContact& contact : further) {
    std::size_t nearest = known;
    double least_m = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < known; ++k) {
      const double apart_m = ((*contacts)[k].position_m - contact.position_m).norm();
      if (is_taken[k] != 0 || apart_m >= least_m) continue;
      if (!IsSame((*contacts)[k], contact, tuning)) continue;
      nearest = k;
      least_m = apart_m;
    }
    if (nearest == known) {
      contacts->push_back(contact);
      continue;
    }
    is_taken[nearest] = 1;
    (*contacts)[nearest] = Joined((*contacts)[nearest], contact);
  }
}

}  // namespace palpate::perception
