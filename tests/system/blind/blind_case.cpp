// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/blind/blind_case.hpp"

#include <fmt/core.h>

#include <array>

#include "libs/core/check.hpp"
#include "libs/scenario/effect_places.hpp"
#include "libs/scenario/robot_names.hpp"

namespace palpate::blind {

namespace {

using scenario::ActiveEffect;
using scenario::Random;

}  // namespace

CaseKind KindOf(std::uint64_t seed) {
  constexpr CaseKind kH = CaseKind::kHealthy;
  constexpr CaseKind kO = CaseKind::kOneCause;
  constexpr CaseKind kT = CaseKind::kTwoCauses;
  constexpr CaseKind kU = CaseKind::kOutside;
  constexpr CaseKind kC = CaseKind::kCorrupted;
  constexpr std::array<CaseKind, 20> kMix = {kO, kH, kO, kT, kO, kH, kU, kO, kO, kH,
                                             kC, kO, kT, kH, kO, kO, kU, kH, kT, kO};
  return kMix[seed % kMix.size()];
}

ActiveEffect DrawEffect(const MenuItem& item, const robot::RobotDescription& robot,
                        Random* random) {
  const auto* kind = scenario::FindEffect(item.id);
  PALPATE_CHECK(kind != nullptr, item.id);
  const auto places = scenario::PlacesOn(*kind, scenario::NamesOf(robot));
  return {.id = std::string(item.id),
          .where = places[random->Below(places.size())],
          .parameters = item.draw(random, robot)};
}

BlindCase DrawCase(std::uint64_t seed, const robot::RobotDescription& robot, Measured measured) {
  Random random(seed, "blind case");
  BlindCase drawn{.seed = seed, .kind = KindOf(seed)};
  std::vector<MenuItem> menu = MenuFor(robot);
  if (measured == Measured::kPictures) {
    std::erase_if(menu, [](const MenuItem& item) { return item.id == "marker_misplacement"; });
  }
  const auto add = [&](std::size_t item) {
    drawn.effects.push_back(DrawEffect(menu[item], robot, &random));
  };
  const std::size_t first = random.Below(menu.size());
  switch (drawn.kind) {
    case CaseKind::kHealthy: break;
    case CaseKind::kOneCause: add(first); break;
    case CaseKind::kTwoCauses:
      add(first);
      add((first + 1 + random.Below(menu.size() - 1)) % menu.size());
      break;
    case CaseKind::kOutside:
      add(first);
      drawn.without = CoveredBy(drawn.effects.back());
      drawn.without.insert(drawn.without.begin(), std::string(menu[first].id));
      break;
    case CaseKind::kCorrupted:
      drawn.corruption = static_cast<Corruption>(1 + random.Below(5));
      if (random.Below(2) == 0) add(first);
      break;
  }
  return drawn;
}

std::string ToString(CaseKind kind) {
  switch (kind) {
    case CaseKind::kHealthy: return "healthy";
    case CaseKind::kOneCause: return "one cause";
    case CaseKind::kTwoCauses: return "two causes";
    case CaseKind::kOutside: return "outside";
    case CaseKind::kCorrupted: break;
  }
  return "corrupted";
}

std::string ToString(Corruption corruption) {
  switch (corruption) {
    case Corruption::kNone: return "none";
    case Corruption::kShuffledStamps: return "shuffled stamps";
    case Corruption::kFrozenMarkers: return "frozen markers";
    case Corruption::kNotANumber: return "not a number";
    case Corruption::kMissingActuation: return "missing actuation.csv";
    case Corruption::kOtherRobot: break;
  }
  return "another robot's file";
}

std::string Describe(const ActiveEffect& effect) {
  std::string text = effect.id + " [";
  for (const std::string& where : effect.where) {
    text += (text.back() == '[' ? "" : ", ") + where;
  }
  text += "]";
  for (const auto& [name, value] : effect.parameters)
    text += fmt::format(" {} {:.3g}", name, value);
  return text;
}

}  // namespace palpate::blind
