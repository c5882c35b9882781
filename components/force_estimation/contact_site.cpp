// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/contact_site.hpp"

#include <algorithm>
#include <string_view>

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"

namespace palpate::force_estimation {

namespace {

std::string_view Trim(std::string_view text) {
  const size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

constexpr std::string_view kForm =
    "the form is \"name: x, y, z[, patch radius][ along dx, dy, dz]\", in m";

[[noreturn]] void RefuseSite(const std::string& text, const std::string& cause) {
  throw InputError("contact '" + text + "' " + cause + "; " + std::string(kForm));
}

std::vector<double> ParseNumbers(std::string_view numbers_text, const std::string& whole) {
  std::vector<double> numbers;
  while (true) {
    const size_t comma = numbers_text.find(',');
    const std::string_view field = Trim(numbers_text.substr(0, comma));
    double number = 0.0;
    if (!ParseFinite(field, &number)) {
      RefuseSite(whole, "holds '" + std::string(field) + "', which is not a finite number");
    }
    numbers.push_back(number);
    if (comma == std::string_view::npos) return numbers;
    numbers_text.remove_prefix(comma + 1);
  }
}

Eigen::Vector3d ParseDirection(std::string_view direction_text, const std::string& whole) {
  const std::vector<double> numbers = ParseNumbers(direction_text, whole);
  if (numbers.size() != 3) RefuseSite(whole, "has a direction without three components");
  const Eigen::Vector3d direction(numbers[0], numbers[1], numbers[2]);
  if (!(direction.norm() > 1e-9)) RefuseSite(whole, "has a direction of length zero");
  return direction.normalized();
}

ContactSite ParseContactSite(const std::string& text) {
  const size_t colon = text.find(':');
  if (colon == std::string::npos || Trim(std::string_view(text).substr(0, colon)).empty()) {
    RefuseSite(text, "has no name");
  }
  ContactSite site;
  site.name = Trim(std::string_view(text).substr(0, colon));
  std::string_view place = std::string_view(text).substr(colon + 1);
  constexpr std::string_view kAlong = " along ";
  if (const size_t along = place.find(kAlong); along != std::string_view::npos) {
    site.direction = ParseDirection(place.substr(along + kAlong.size()), text);
    place = place.substr(0, along);
  }
  const std::vector<double> numbers = ParseNumbers(place, text);
  if (numbers.size() != 3 && numbers.size() != 4) {
    RefuseSite(text, "has " + std::to_string(numbers.size()) + " numbers for its place");
  }
  site.position_m = {numbers[0], numbers[1], numbers[2]};
  if (numbers.size() == 4) site.patch_radius_m = numbers[3];
  if (site.patch_radius_m < 0.0) RefuseSite(text, "has a negative patch radius");
  return site;
}

}  // namespace

std::vector<ContactSite> ParseContactSites(const std::vector<std::string>& texts) {
  std::vector<ContactSite> sites;
  for (const std::string& text : texts) {
    ContactSite site = ParseContactSite(text);
    const bool known = std::any_of(sites.begin(), sites.end(), [&](const ContactSite& other) {
      return other.name == site.name;
    });
    if (known) throw InputError("contact '" + site.name + "' is given twice");
    sites.push_back(std::move(site));
  }
  return sites;
}

}  // namespace palpate::force_estimation
