// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/estimate/forces_table.hpp"

#include "libs/core/file.hpp"
#include "libs/core/text.hpp"

namespace palpate::command {

namespace {

std::string Field(const std::string& name) {
  return name.find(',') == std::string::npos ? name : "\"" + name + "\"";
}

/// The upper triangle by rows, each number after a comma; empty where it is not `known`.
std::string CovarianceFields(const Eigen::Matrix3d& covariance, bool known) {
  std::string text;
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = row; column < 3; ++column) {
      text += "," + (known ? FormatNumber(covariance(row, column)) : std::string());
    }
  }
  return text;
}

std::string ContactFields(const force_estimation::ContactForce& contact) {
  std::string text = Field(contact.name);
  for (const double value : contact.position_m) {
    text += "," + FormatNumber(value);
  }
  const bool known = contact.status.code() != StatusCode::kUnobservable;
  for (const double value : contact.force_N) {
    text += "," + (known ? FormatNumber(value) : std::string());
  }
  text += "," + (known ? FormatNumber(contact.ci95_N) : std::string());
  text += "," + FormatNumber(contact.location_ci95_m) + "," +
          std::string(ToString(contact.status.code()));
  return text + CovarianceFields(contact.covariance_N2, known) +
         CovarianceFields(contact.location_covariance_m2, true);
}

}  // namespace

void ForcesTable::Add(const std::string& recording,
                      const force_estimation::ForceEstimate& estimate) {
  empty_ = false;
  const std::string head = Field(recording) + "," + FormatNumber(estimate.t_s) + ",";
  if (!estimate.status.ok() || estimate.contacts.empty()) {
    text_ += head + ",,,,,,,,," + std::string(ToString(estimate.status.code())) + ",,,,,,,,,,,,\n";
    return;
  }
  for (const force_estimation::ContactForce& contact : estimate.contacts) {
    text_ += head + ContactFields(contact) + "\n";
  }
}

void ForcesTable::Write(const std::filesystem::path& file) const { WriteFile(file, text_); }

}  // namespace palpate::command
