// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>

#include "components/force_estimation/marker_force_estimator.hpp"

namespace palpate::command {

/// forces.csv (docs/experiment.md): one row for each frame and contact; a frame without
/// contact, and one without a result, has one row with an empty contact and its status. A force
/// that the markers do not determine at all has empty fields.
class ForcesTable {
 public:
  void Add(const std::string& recording, const force_estimation::ForceEstimate& estimate);

  bool empty() const { return empty_; }
  const std::string& text() const { return text_; }
  /// Throws RunError where the file cannot be written.
  void Write(const std::filesystem::path& file) const;

 private:
  bool empty_ = true;
  std::string text_ =
      "recording,t_s,contact,x_m,y_m,z_m,fx_N,fy_N,fz_N,ci95_N,location_ci95_m,status,"
      "cov_xx_N2,cov_xy_N2,cov_xz_N2,cov_yy_N2,cov_yz_N2,cov_zz_N2,"
      "location_cov_xx_m2,location_cov_xy_m2,location_cov_xz_m2,"
      "location_cov_yy_m2,location_cov_yz_m2,location_cov_zz_m2\n";
};

}  // namespace palpate::command
