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

std::vector<double> ParseNumbers(std::string_view text, const std::string& whole) {
  std::vector<double> numbers;
  while (true) {
    const size_t comma = text.find(',');
    double number = 0.0;
    if (!ParseFinite(Trim(text.substr(0, comma)), &number)) {
      throw InputError("contact '" + whole + "': '" + std::string(Trim(text.substr(0, comma))) +
                       "' is not a finite number; the form is \"name: x, y, z[, patch radius]\" "
                       "in m");
    }
    numbers.push_back(number);
    if (comma == std::string_view::npos) return numbers;
    text.remove_prefix(comma + 1);
  }
}

ContactSite ParseContactSite(const std::string& text) {
  const size_t colon = text.find(':');
  if (colon == std::string::npos || Trim(std::string_view(text).substr(0, colon)).empty()) {
    throw InputError("contact '" + text +
                     "' has no name; the form is \"name: x, y, z[, patch radius]\" in m");
  }
  const std::vector<double> numbers = ParseNumbers(std::string_view(text).substr(colon + 1), text);
  if (numbers.size() != 3 && numbers.size() != 4) {
    throw InputError("contact '" + text + "' has " + std::to_string(numbers.size()) +
                     " numbers; it takes x, y, z and, if wanted, the patch radius");
  }
  ContactSite site;
  site.name = Trim(std::string_view(text).substr(0, colon));
  site.position_m = {numbers[0], numbers[1], numbers[2]};
  if (numbers.size() == 4) site.patch_radius_m = numbers[3];
  if (site.patch_radius_m < 0.0) {
    throw InputError("contact '" + text + "': the patch radius must be >= 0");
  }
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
