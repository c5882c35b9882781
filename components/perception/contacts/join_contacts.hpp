// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/perception/observation.hpp"

namespace palpate::perception {

struct JoinContactsTuning {
  /// Contacts of two cameras that are closer are one. Larger: two contacts become one; smaller: one
  /// contact of a large object counts twice.
  double same_contact_m = 0.010;
  /// The same where their covariances allow it, up to a largest distance: squared distance over the
  /// covariance of the difference, of a normal distribution in 99 % of cases.
  double chi_squared = 11.3;
  double farthest_m = 0.025;
};

/// Adds the contacts of a further camera to those of other cameras, all in one frame. A contact
/// that both see is one, by covariance intersection (Julier and Uhlmann, Proc. ACC (1997) 2369):
/// both are placed on the same predicted surface, so that their errors have something in common.
/// Its extent and name are those of the more certain one.
void JoinContacts(const std::vector<DetectedContact>& further,
                  std::vector<DetectedContact>* contacts, const JoinContactsTuning& tuning = {});

}  // namespace palpate::perception
