// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "components/palpate/node/topics/mailbox.hpp"
#include "components/palpate/node/topics/topic_stream.hpp"
#include "components/palpate/node/topics/topic_verbs.hpp"
#include "components/palpate/topics/message_value.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/stop_signal.hpp"
#include "libs/core/error.hpp"
#include "libs/core/seconds.hpp"
#include "libs/core/text.hpp"

namespace palpate::command {

namespace {

/// As ROS 2 cuts lists and texts.
constexpr std::uint64_t kTruncateLength = 128;
/// So many wait while one is printed.
constexpr std::size_t kMostWaiting = 1000;
constexpr int kMost = std::numeric_limits<int>::max();

struct EchoOptions : StreamOptions {
  std::string field;
  bool csv = false;
  bool once = false;
  int count = 0;
  int truncate_length = 0;  ///< 0: not given
  bool full_length = false;
  bool no_lists = false;
  bool no_texts = false;
  double timeout_s = 0.0;
};

class EchoPrinter {
 public:
  EchoPrinter(const EchoOptions& options, const ReadableTopic& topic)
      : options_(options), topic_(topic) {
    print_.no_lists = options.no_lists;
    print_.no_texts = options.no_texts;
    // Programs want all of it.
    const bool whole = options.full_length || options.json;
    print_.truncate_length = options.truncate_length > 0
                                 ? static_cast<std::uint64_t>(options.truncate_length)
                                 : (whole ? 0 : kTruncateLength);
  }

  /// False where it does not fit its type.
  [[nodiscard]] bool Show(const dds::RawMessage& message) const {
    const auto decoded = DecodeMessage(message.cdr(), topic_.type, topic_.definitions);
    if (!decoded) return false;
    const MessageValue& value = SelectField(*decoded, options_.field);
    if (options_.json) {
      fmt::print("{}", JsonText(value, print_));
    } else if (options_.csv) {
      fmt::print("{}", CsvText(value, print_));
    } else {
      fmt::print("{}---\n", YamlText(value, print_));
    }
    std::fflush(stdout);
    return true;
  }

 private:
  const EchoOptions& options_;
  const ReadableTopic& topic_;
  PrintOptions print_;
};

void CheckOptions(EchoOptions* options) {
  if (options->csv && options->json) throw InputError("give --csv or --json, not both");
  if (options->once && options->count > 0) throw InputError("give --once or --count, not both");
  if (options->full_length && options->truncate_length > 0) {
    throw InputError("give --full-length or --truncate-length, not both");
  }
  if (options->timeout_s < 0.0) {
    throw InputError("--timeout must be 0 or above, not " + FormatNumber(options->timeout_s));
  }
  if (options->once) options->count = 1;
  options->decodes = true;
}

int Echo(const EchoOptions& options) {
  TopicStream stream(options);
  const EchoPrinter printer(options, stream.topic());
  Mailbox mailbox(kMostWaiting);
  const app::StopSignal stop([&] { mailbox.Close(); });
  const auto reader = stream.Start([&](const dds::RawMessage& message) { mailbox.Put(message); });
  constexpr auto kLook = std::chrono::milliseconds(100);
  auto last = Mailbox::Clock::now();
  int shown = 0;
  bool told = false;
  while (!mailbox.closed() && (options.count == 0 || shown < options.count)) {
    const auto message = mailbox.Next(Mailbox::Clock::now() + kLook);
    if (const std::string mismatch = stream.TakeMismatch(*reader); !mismatch.empty()) {
      fmt::print(stderr, "palpate: warning: {}\n", mismatch);
    }
    if (!message) {
      if (options.timeout_s == 0.0 || SecondsSince(last) < options.timeout_s) continue;
      throw RunError(fmt::format("no message on '{}' for {} s", stream.topic().name,
                                 FormatNumber(options.timeout_s)));
    }
    last = Mailbox::Clock::now();
    ++shown;
    if (printer.Show(*message) || std::exchange(told, true)) continue;
    fmt::print(stderr, "palpate: warning: a message of {} bytes does not fit the type {}\n",
               message->cdr().size(), stream.topic().type);
  }
  if (mailbox.dropped() > 0) {
    fmt::print(stderr, "palpate: warning: {} messages came faster than they were printed\n",
               mailbox.dropped());
  }
  return told && shown == options.count ? app::kExitFailed : app::kExitDone;
}

}  // namespace

app::Verb TopicEchoVerb() {
  return {"echo", "Print the messages of a topic",
          [](app::Arguments& arguments) -> app::Verb::Action {
            const auto options = std::make_shared<EchoOptions>();
            arguments.Positional("TOPIC", &options->topic, "Name of the topic, like /forces");
            arguments.Positional("TYPE", &options->type,
                                 "Type like std_msgs/msg/String; without it the publisher's",
                                 app::Need::kOptional);
            DeclareGraph(arguments, options.get());
            arguments.Option("--field FIELD", &options->field,
                             "Print this part of the message only: header.stamp, markers[0]");
            arguments.Flag("--csv", &options->csv, "Print each message as one line of values");
            arguments.Flag("--once", &options->once, "Print one message and exit");
            arguments.Option("--count N", &options->count, 0, kMost,
                             "Exit after this number of messages; 0: at Ctrl-C");
            arguments.Option("--timeout S", &options->timeout_s,
                             "Exit with 1 after this time without a message, s; 0: never");
            arguments.Option("--truncate-length,-l N", &options->truncate_length, 1, kMost,
                             "Longest list and text that is printed whole; without it 128, with "
                             "--json any");
            arguments.Flag("--full-length,-f", &options->full_length,
                           "Print lists and texts of any length");
            arguments.Flag("--no-arr", &options->no_lists, "Print type and length of lists only");
            arguments.Flag("--no-str", &options->no_texts, "Print the length of texts only");
            arguments.Choice("--qos-reliability WORD", &options->reliability,
                             {"auto", "reliable", "best_effort"},
                             "Reliability that is asked for; auto: that of the publishers");
            arguments.Choice("--qos-durability WORD", &options->durability,
                             {"auto", "transient_local", "volatile"},
                             "Durability that is asked for; auto: that of the publishers");
            return [options] {
              SettleGraph(options.get());
              CheckOptions(options.get());
              return Echo(*options);
            };
          }};
}

}  // namespace palpate::command
