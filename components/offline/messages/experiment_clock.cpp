// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/messages/experiment_clock.hpp"

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "libs/core/statistics.hpp"

namespace palpate::offline {

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

/// By log time: what is logged between two segments belongs to the one whose stamps are nearer.
int SegmentByLog(const MessageTime& time, const std::vector<Segment>& segments) {
  std::size_t index = 0;
  while (index + 1 < segments.size()) {
    const MessageTime& last = segments[index].last;
    const MessageTime& next = segments[index + 1].first;
    if (time.log_ns <= last.log_ns) break;
    const bool nearer_to_last =
        std::llabs(time.stamp_ns - last.stamp_ns) <= std::llabs(time.stamp_ns - next.stamp_ns);
    if (time.log_ns < next.log_ns && nearer_to_last) break;
    ++index;
  }
  return static_cast<int>(index);
}

int SegmentByStamp(const MessageTime& time, const std::vector<Segment>& segments) {
  std::size_t index = 0;
  while (index + 1 < segments.size()) {
    const std::int64_t last_ns = segments[index].last.stamp_ns;
    const std::int64_t next_ns = segments[index + 1].first.stamp_ns;
    if (time.stamp_ns <= last_ns + (next_ns - last_ns) / 2) break;
    ++index;
  }
  return static_cast<int>(index);
}

bool RiseByStamp(const std::vector<Segment>& segments) {
  for (std::size_t i = 1; i < segments.size(); ++i) {
    if (segments[i].first.stamp_ns <= segments[i - 1].last.stamp_ns) return false;
  }
  return true;
}

/// A recorder takes topics in bursts, so that log times tell least: the stamps tell where they
/// rise through all segments, then the places where they jump back, and log times last.
void SetSegments(const Times& times, const std::vector<Segment>& segments) {
  if (segments.size() < 2) return;
  std::size_t jumps = 0;
  for (std::size_t i = 1; i < times.size(); ++i) {
    jumps += times[i]->stamp_ns < times[i - 1]->stamp_ns ? 1 : 0;
  }
  const bool by_stamp = RiseByStamp(segments);
  const bool by_jump = jumps + 1 == segments.size();
  int segment = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (i > 0 && times[i]->stamp_ns < times[i - 1]->stamp_ns) ++segment;
    times[i]->segment = by_stamp  ? SegmentByStamp(*times[i], segments)
                        : by_jump ? segment
                                  : SegmentByLog(*times[i], segments);
  }
}

/// Whether they run backwards by more than disorder on the way, and are not sent again.
bool RunsBackwards(const Times& times) {
  std::set<std::pair<int, std::int64_t>> known;
  std::map<int, std::int64_t> latest_ns;
  for (const MessageTime* time : times) {
    const bool again = !known.insert({time->segment, time->stamp_ns}).second;
    const auto [latest, first] = latest_ns.emplace(time->segment, time->stamp_ns);
    if (!again && !first && time->stamp_ns < latest->second - kSecond_ns) return true;
    latest->second = std::max(latest->second, time->stamp_ns);
  }
  return false;
}

/// Shortest and longest of stamps, or log times.
std::pair<std::int64_t, std::int64_t> RangeOf(const Times& times,
                                              std::int64_t MessageTime::*value) {
  const auto [first, last] = std::minmax_element(
      times.begin(), times.end(),
      [&](const MessageTime* a, const MessageTime* b) { return a->*value < b->*value; });
  return {(*first)->*value, (*last)->*value};
}

/// Time between two ranges; 0: they overlap.
std::int64_t GapBetween(const std::pair<std::int64_t, std::int64_t>& a,
                        const std::pair<std::int64_t, std::int64_t>& b) {
  return std::max<std::int64_t>({0, a.first - b.second, b.first - a.second});
}

/// Whether stamps went by as time did: not faster or slower, as where recordings are played.
bool IsRealTime(const Times& times) {
  const auto stamps = RangeOf(times, &MessageTime::stamp_ns);
  const auto logs = RangeOf(times, &MessageTime::log_ns);
  const std::int64_t difference_ns =
      std::llabs((stamps.second - stamps.first) - (logs.second - logs.first));
  return difference_ns < kSecond_ns / 2 && stamps.second - stamps.first > kSecond_ns;
}

std::int64_t MedianDelay(const Times& times) {
  std::vector<std::int64_t> delays_ns;
  for (const MessageTime* time : times) delays_ns.push_back(time->log_ns - time->stamp_ns);
  return UpperMedian(delays_ns);
}

/// Whether the stamps of two topics are not of one clock.
bool AreOfTwoClocks(const Times& a, const Times& b) {
  if (IsRealTime(a) && IsRealTime(b)) {
    return std::llabs(MedianDelay(a) - MedianDelay(b)) > kSecond_ns;
  }
  const std::int64_t stamps_ns =
      GapBetween(RangeOf(a, &MessageTime::stamp_ns), RangeOf(b, &MessageTime::stamp_ns));
  const std::int64_t logs_ns =
      GapBetween(RangeOf(a, &MessageTime::log_ns), RangeOf(b, &MessageTime::log_ns));
  // Played at another rate the gaps differ, but do not lie in another decade.
  return stamps_ns > kSecond_ns + 1000 * logs_ns;
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
    if (AreOfTwoClocks(times, first)) {
      return "the stamps of the " + name + " are of another clock than those of the " + first_name;
    }
  }
  return std::nullopt;
}

template <typename Items>
void OrderByTime(Items* items) {
  std::stable_sort(items->begin(), items->end(), [](const auto& a, const auto& b) {
    return std::pair(a.time.segment, a.time.t_ns) < std::pair(b.time.segment, b.time.t_ns);
  });
}

template <typename Items>
std::size_t KeepFirstOfEachTime(Items* items) {
  const std::size_t before = items->size();
  const auto same = [](const auto& a, const auto& b) {
    return a.time.segment == b.time.segment && a.time.t_ns == b.time.t_ns;
  };
  items->erase(std::unique(items->begin(), items->end(), same), items->end());
  return before - items->size();
}

}  // namespace

std::int64_t ChooseClock(CollectedTopics* topics, std::vector<std::string>* notes) {
  const std::map<std::string, Times> sampled = SampledTimes(topics);
  for (const auto& [name, times] : sampled) SetSegments(times, topics->segments);
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
    phase.time.segment = before->segment;
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

}  // namespace palpate::offline
