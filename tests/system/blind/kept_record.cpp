// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/blind/kept_record.hpp"

#include <nlohmann/json.hpp>

#include "libs/core/file.hpp"

namespace palpate::blind {

void KeepRecord(const CaseRecord& record, const std::string& how,
                const std::filesystem::path& file) {
  const nlohmann::json json = {{"how", how},
                               {"sizes_m", record.sizes_m},
                               {"not_made", record.not_made},
                               {"no_verdict", record.no_verdict},
                               {"diagnosis_s", record.diagnosis_s}};
  WriteFile(file, json.dump(1) + "\n");
}

bool ReadKeptRecord(const std::filesystem::path& file, const std::string& how, CaseRecord* record) {
  if (!std::filesystem::exists(file)) return false;
  const auto json = nlohmann::json::parse(ReadFile(file), nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) return false;
  CaseRecord kept = *record;
  try {
    if (json.at("how").get<std::string>() != how) return false;
    json.at("sizes_m").get_to(kept.sizes_m);
    json.at("not_made").get_to(kept.not_made);
    json.at("no_verdict").get_to(kept.no_verdict);
    json.at("diagnosis_s").get_to(kept.diagnosis_s);
  } catch (const nlohmann::json::exception&) {
    return false;
  }
  *record = std::move(kept);
  return true;
}

}  // namespace palpate::blind
