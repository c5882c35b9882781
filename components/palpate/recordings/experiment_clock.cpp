// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/recordings/experiment_clock.hpp"

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>

namespace palpate::command {

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
/// Stamps above are since the epoch (September 2001), those below since the start of something.
constexpr std::int64_t kEpoch_ns = 1'000'000'000 * kSecond_ns;

using Times = std::vector<MessageTime*>;

template <typename Items>
Times TimesOf(Items* items) {
  Times times;
  for (auto& item : *items) times.push_back(&item.time);
  return times;
}

/// The topics that are sampled: what is sent once has another stamp than what is going on.
std::map<std::string, Times> SampledTimes(CollectedTopics* topics) {
  std::map<std::string, Times> times{
      {"depth images", TimesOf(&topics->depth)},  {"colour images", TimesOf(&topics->color)},
      {"clouds", TimesOf(&topics->points)},       {"markers", TimesOf(&topics->markers)},
      {"joint states", TimesOf(&topics->joints)}, {"loads", TimesOf(&topics->wrenches)}};
  std::erase_if(times, [](const auto& topic) { return topic.second.empty(); });
  return times;
}

/// Whether they run backwards by more than disorder on the way, and are not sent again.
bool RunsBackwards(const Times& times) {
  std::set<std::int64_t> known;
  std::int64_t latest_ns = std::numeric_limits<std::int64_t>::min();
  for (const MessageTime* time : times) {
    const bool again = !known.insert(time->stamp_ns).second;
    if (!again && latest_ns > kSecond_ns && time->stamp_ns < latest_ns - kSecond_ns) return true;
    latest_ns = std::max(latest_ns, time->stamp_ns);
  }
  return false;
}

/// Median of log time minus stamp of `times`, less that of the message of `others` before each.
std::int64_t ClockDifference(const Times& times, const Times& others) {
  std::vector<std::int64_t> differences_ns;
  std::size_t other = 0;
  for (const MessageTime* time : times) {
    while (other + 1 < others.size() && others[other + 1]->log_ns <= time->log_ns) ++other;
    differences_ns.push_back((time->log_ns - time->stamp_ns) -
                             (others[other]->log_ns - others[other]->stamp_ns));
  }
  const auto middle =
      differences_ns.begin() + static_cast<std::ptrdiff_t>(differences_ns.size() / 2);
  std::nth_element(differences_ns.begin(), middle, differences_ns.end());
  return *middle;
}

/// Why the stamps cannot be used; nullopt: they can.
std::optional<std::string> FaultOfStamps(const std::map<std::string, Times>& topics) {
  for (const auto& [name, times] : topics) {
    const bool missing = std::all_of(times.begin(), times.end(),
                                     [](const MessageTime* time) { return time->stamp_ns == 0; });
    if (missing && times.size() > 1) return "the stamps of the " + name + " are 0";
    if (RunsBackwards(times)) return "the stamps of the " + name + " run backwards";
  }
  for (const auto& [name, times] : topics) {
    const auto& [first_name, first] = *topics.begin();
    if (std::llabs(ClockDifference(times, first)) > kSecond_ns) {
      return "the stamps of the " + name + " are of another clock than those of the " + first_name;
    }
  }
  return std::nullopt;
}

template <typename Items>
void OrderByTime(Items* items) {
  std::stable_sort(items->begin(), items->end(),
                   [](const auto& a, const auto& b) { return a.time.t_ns < b.time.t_ns; });
}

template <typename Items>
std::size_t KeepFirstOfEachTime(Items* items) {
  const std::size_t before = items->size();
  const auto same = [](const auto& a, const auto& b) { return a.time.t_ns == b.time.t_ns; };
  items->erase(std::unique(items->begin(), items->end(), same), items->end());
  return before - items->size();
}

}  // namespace

std::int64_t ChooseClock(CollectedTopics* topics, std::vector<std::string>* notes) {
  const std::map<std::string, Times> sampled = SampledTimes(topics);
  const auto fault = FaultOfStamps(sampled);
  if (fault) notes->push_back(*fault + ": the times are those at which messages were recorded");
  const auto clock = [&](const MessageTime& time) { return fault ? time.log_ns : time.stamp_ns; };
  std::int64_t first_ns = std::numeric_limits<std::int64_t>::max();
  for (const auto& [name, times] : sampled) {
    for (const MessageTime* time : times) first_ns = std::min(first_ns, clock(*time));
  }
  const std::int64_t origin_ns = first_ns < kEpoch_ns ? 0 : first_ns / kSecond_ns * kSecond_ns;
  for (const auto& [name, times] : sampled) {
    for (MessageTime* time : times) time->t_ns = clock(*time) - origin_ns;
  }
  // Words without a stamp happened when the stamped message before them did.
  const Times& reference = sampled.begin()->second;
  for (CollectedPhase& phase : topics->phases) {
    const MessageTime* before = reference.front();
    for (const MessageTime* time : reference) {
      if (time->log_ns <= phase.time.log_ns) before = time;
    }
    phase.time.t_ns = before->t_ns + phase.time.log_ns - before->log_ns;
  }
  OrderByTime(&topics->depth);
  OrderByTime(&topics->color);
  OrderByTime(&topics->points);
  OrderByTime(&topics->markers);
  OrderByTime(&topics->joints);
  OrderByTime(&topics->wrenches);
  OrderByTime(&topics->phases);
  const std::size_t again =
      KeepFirstOfEachTime(&topics->depth) + KeepFirstOfEachTime(&topics->color) +
      KeepFirstOfEachTime(&topics->points) + KeepFirstOfEachTime(&topics->markers);
  if (again > 0) {
    notes->push_back(std::to_string(again) +
                     " image(s) or marker frame(s) have the time of one before and are left out");
  }
  return origin_ns;
}

}  // namespace palpate::command
