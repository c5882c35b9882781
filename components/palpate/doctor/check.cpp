// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/doctor/check.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

namespace palpate::command {

namespace {

std::string Painted(Grade grade, bool in_color) {
  const std::string text = fmt::format("{:<4}", ToString(grade));
  if (!in_color) return text;
  constexpr std::array<int, 3> kColors = {32, 33, 31};  // green, yellow, red
  return fmt::format("\033[{}m{}\033[0m", kColors.at(static_cast<std::size_t>(grade)), text);
}

}  // namespace

std::string_view ToString(Grade grade) {
  switch (grade) {
    case Grade::kOk: return "ok";
    case Grade::kWarning: return "warn";
    case Grade::kFailure: return "fail";
  }
  return "fail";
}

Grade Worst(const std::vector<Check>& checks) {
  Grade worst = Grade::kOk;
  for (const Check& check : checks) worst = std::max(worst, check.grade);
  return worst;
}

std::string ChecksText(const std::vector<Check>& checks, bool in_color) {
  std::string text;
  std::array<int, 3> count{};
  for (const Check& check : checks) {
    ++count.at(static_cast<std::size_t>(check.grade));
    text += fmt::format("{}  {:<16} {}", Painted(check.grade, in_color), check.name, check.finding);
    if (!check.remedy.empty()) text += "; " + check.remedy;
    text += "\n";
  }
  return text + fmt::format("{} ok, {} warnings, {} failed\n", count[0], count[1], count[2]);
}

std::string ChecksJson(const std::vector<Check>& checks) {
  using Json = nlohmann::ordered_json;
  Json list = Json::array();
  for (const Check& check : checks) {
    list.push_back({{"name", check.name},
                    {"grade", ToString(check.grade)},
                    {"finding", check.finding},
                    {"remedy", check.remedy}});
  }
  const Json json = {{"grade", ToString(Worst(checks))}, {"checks", list}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace palpate::command
