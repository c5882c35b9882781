// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/core.h>

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <deque>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "components/palpate/node/topics/topic_stream.hpp"
#include "components/palpate/node/topics/topic_verbs.hpp"
#include "components/palpate/topics/sliding_window.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/stop_signal.hpp"
#include "libs/core/error.hpp"
#include "libs/core/seconds.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/recording/ros2msg/flatten.hpp"

namespace palpate::command {

namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

constexpr auto kPeriod = std::chrono::seconds(1);

struct RateOptions : StreamOptions {
  int window = 0;
  bool once = false;
  int count = 0;
  double timeout_s = 0.0;
};

/// What is measured, as lines for people and as JSON.
struct Report {
  std::string lines;
  Json json;
};

/// Measures something of the messages of a topic. Thread-safe.
class Meter {
 public:
  virtual ~Meter() = default;

  void Take(const dds::RawMessage& message) {
    const Clock::time_point now = Clock::now();
    const std::lock_guard lock(mutex_);
    Add(message, now);
    last_ = now;
    ++taken_;
  }

  /// nullopt: not enough messages, or none since the last report.
  std::optional<Report> Next() {
    const std::lock_guard lock(mutex_);
    if (taken_ == reported_) return std::nullopt;
    auto report = Make();
    if (report) reported_ = taken_;
    return report;
  }

 protected:
  virtual void Add(const dds::RawMessage& message, Clock::time_point now) = 0;
  virtual std::optional<Report> Make() const = 0;
  Clock::time_point last() const { return last_; }
  std::uint64_t taken() const { return taken_; }

 private:
  std::mutex mutex_;
  Clock::time_point last_;
  std::uint64_t taken_ = 0;
  std::uint64_t reported_ = 0;
};

class RateMeter : public Meter {
 public:
  explicit RateMeter(std::size_t window) : intervals_s_(window) {}

 private:
  void Add(const dds::RawMessage&, Clock::time_point now) override {
    if (taken() > 0) intervals_s_.Add(ToSeconds(now - last()));
  }
  std::optional<Report> Make() const override {
    if (intervals_s_.values().empty()) return std::nullopt;
    const WindowStatistics s = intervals_s_.Statistics();
    return Report{RateLines(s),
                  {{"rate_hz", s.mean > 0.0 ? 1.0 / s.mean : 0.0},
                   {"min_s", s.min},
                   {"max_s", s.max},
                   {"std_dev_s", s.standard_deviation},
                   {"window", s.count}}};
  }

  SlidingWindow intervals_s_;
};

class BandwidthMeter : public Meter {
 public:
  explicit BandwidthMeter(std::size_t window) : sizes_(window) {}

 private:
  void Add(const dds::RawMessage& message, Clock::time_point now) override {
    sizes_.Add(static_cast<double>(message.cdr().size()));
    times_.push_back(now);
    if (times_.size() > sizes_.values().size()) times_.pop_front();
  }
  std::optional<Report> Make() const override {
    if (times_.size() < 2) return std::nullopt;
    const WindowStatistics s = sizes_.Statistics();
    const double duration_s = SecondsSince(times_.front());
    const double bytes_per_s = s.mean * static_cast<double>(s.count) / duration_s;
    return Report{BandwidthLines(bytes_per_s, s),
                  {{"bytes_per_s", bytes_per_s},
                   {"messages", s.count},
                   {"mean_bytes", s.mean},
                   {"min_bytes", s.min},
                   {"max_bytes", s.max}}};
  }

  SlidingWindow sizes_;
  std::deque<Clock::time_point> times_;
};

class DelayMeter : public Meter {
 public:
  DelayMeter(std::size_t window, const ReadableTopic& topic) : ages_s_(window), topic_(topic) {}

 private:
  void Add(const dds::RawMessage& message, Clock::time_point) override {
    auto reader = recording::AtField(message.cdr(), topic_.type, "header", topic_.definitions);
    const std::int64_t stamp_ns = reader.Stamp_ns();
    if (reader.ok()) ages_s_.Add(NsToSeconds(dds::WallClockNs() - stamp_ns));
  }
  std::optional<Report> Make() const override {
    if (ages_s_.values().empty()) return std::nullopt;
    const WindowStatistics s = ages_s_.Statistics();
    return Report{DelayLines(s),
                  {{"mean_s", s.mean},
                   {"min_s", s.min},
                   {"max_s", s.max},
                   {"std_dev_s", s.standard_deviation},
                   {"window", s.count}}};
  }

  SlidingWindow ages_s_;
  const ReadableTopic& topic_;
};

using MakeMeter = std::function<std::unique_ptr<Meter>(const RateOptions&, const ReadableTopic&)>;

/// Waits one period; false where a signal has come.
class Pause {
 public:
  void End() {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    changed_.notify_all();
  }
  bool Wait(Clock::time_point until) {
    std::unique_lock lock(mutex_);
    return !changed_.wait_until(lock, until, [&] { return ended_; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool ended_ = false;
};

void Show(const RateOptions& options, const std::string& topic, Report report) {
  if (options.json) {
    Json json = {{"topic", topic}};
    json.update(report.json);
    fmt::print("{}\n", json.dump());
  } else {
    fmt::print("{}", report.lines);
  }
  std::fflush(stdout);
}

int Measure(const RateOptions& options, const MakeMeter& make) {
  TopicStream stream(options);
  const std::unique_ptr<Meter> meter = make(options, stream.topic());
  Pause pause;
  const app::StopSignal stop([&] { pause.End(); });
  const auto reader = stream.Start([&](const dds::RawMessage& message) { meter->Take(message); });
  if (!options.json) fmt::print("Subscribed to [{}]\n", stream.topic().name);
  Clock::time_point next = Clock::now();
  Clock::time_point last = next;
  for (int shown = 0; options.count == 0 || shown < options.count;) {
    next += kPeriod;
    if (!pause.Wait(next)) break;
    if (const std::string mismatch = stream.TakeMismatch(*reader); !mismatch.empty()) {
      fmt::print(stderr, "palpate: warning: {}\n", mismatch);
    }
    if (auto report = meter->Next()) {
      Show(options, stream.topic().name, std::move(*report));
      last = Clock::now();
      ++shown;
      continue;
    }
    if (!options.json) fmt::print("no new messages\n");
    std::fflush(stdout);
    if (options.timeout_s > 0.0 && SecondsSince(last) >= options.timeout_s) {
      throw RunError(fmt::format("nothing to measure on '{}' for {} s", stream.topic().name,
                                 FormatNumber(options.timeout_s)));
    }
  }
  return app::kExitDone;
}

void CheckOptions(RateOptions* options) {
  if (options->once && options->count > 0) throw InputError("give --once or --count, not both");
  if (options->timeout_s < 0.0) {
    throw InputError("--timeout must be 0 or above, not " + FormatNumber(options->timeout_s));
  }
  if (options->once) options->count = 1;
}

app::Verb RateVerb(const char* name, const char* purpose, int window, bool decodes,
                   const MakeMeter& make) {
  return {name, purpose, [window, decodes, make](app::Arguments& arguments) -> app::Verb::Action {
            constexpr int kLargest = std::numeric_limits<int>::max();
            const auto options = std::make_shared<RateOptions>();
            options->window = window;
            options->decodes = decodes;
            // Latched messages are of before.
            options->durability = "volatile";
            arguments.Positional("TOPIC", &options->topic, "Name of the topic, like /forces");
            DeclareGraph(arguments, options.get());
            arguments.Option("--window,-w N", &options->window, 1, kLargest,
                             "Number of messages over which it is averaged");
            arguments.Flag("--once", &options->once, "Print one result and exit");
            arguments.Option("--count N", &options->count, 0, kLargest,
                             "Exit after this number of results, one a second; 0: at Ctrl-C");
            arguments.Option("--timeout S", &options->timeout_s,
                             "Exit with 1 after this time without a result, s; 0: never");
            return [options, make] {
              SettleGraph(options.get());
              CheckOptions(options.get());
              return Measure(*options, make);
            };
          }};
}

std::size_t WindowOf(const RateOptions& options) {
  return static_cast<std::size_t>(options.window);
}

}  // namespace

app::Verb TopicHzVerb() {
  return RateVerb("hz", "Print the rate at which messages of a topic come", 10000, false,
                  [](const RateOptions& options, const ReadableTopic&) {
                    return std::make_unique<RateMeter>(WindowOf(options));
                  });
}

app::Verb TopicBwVerb() {
  return RateVerb("bw", "Print how many bytes of a topic come per second", 100, false,
                  [](const RateOptions& options, const ReadableTopic&) {
                    return std::make_unique<BandwidthMeter>(WindowOf(options));
                  });
}

app::Verb TopicDelayVerb() {
  return RateVerb(
      "delay", "Print the age of messages by header.stamp when they come", 10000, true,
      [](const RateOptions& options, const ReadableTopic& topic) {
        const auto type = topic.definitions.find(recording::ShortTypeName(topic.type));
        const bool has_header = type != topic.definitions.end() && !type->second.fields.empty() &&
                                type->second.fields.front().name == "header" &&
                                type->second.fields.front().type == "std_msgs/Header";
        if (!has_header) {
          throw RunError(fmt::format("the type {} of '{}' has no header, whose stamp says its age",
                                     topic.type, topic.name));
        }
        return std::make_unique<DelayMeter>(WindowOf(options), topic);
      });
}

}  // namespace palpate::command
