// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/recorder/status_table.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace palpate::recorder {

namespace {

std::string Totals(const RecorderStatus& status) {
  std::uint64_t messages = 0;
  std::uint64_t lost = 0;
  double rate_B_s = 0.0;
  for (const TopicRow& row : status.topics) {
    messages += row.messages;
    lost += row.lost;
    rate_B_s += row.bytes_per_s;
  }
  return fmt::format("{:.1f} s, {} topics, {} messages, {} lost, {}/s", status.duration_s,
                     status.topics.size(), messages, lost, SizeText(rate_B_s));
}

}  // namespace

std::string SizeText(double bytes) {
  if (bytes >= 1e9) return fmt::format("{:.2f} GB", bytes * 1e-9);
  if (bytes >= 1e6) return fmt::format("{:.1f} MB", bytes * 1e-6);
  if (bytes >= 1e3) return fmt::format("{:.1f} kB", bytes * 1e-3);
  return fmt::format("{:.0f} B", bytes);
}

std::string StatusLine(const RecorderStatus& status) {
  std::string line = Totals(status);
  if (!status.file.empty()) {
    line +=
        fmt::format(", {} in {}", SizeText(static_cast<double>(status.written_bytes)), status.file);
  }
  if (status.waiting_bytes > 0) {
    line +=
        fmt::format(", {} wait for the disk", SizeText(static_cast<double>(status.waiting_bytes)));
  }
  return line;
}

std::string StatusTable(const RecorderStatus& status) {
  std::size_t width = 5;
  for (const TopicRow& row : status.topics) width = std::max(width, row.topic.size());
  std::string text = fmt::format("{:{}}  {:>8}  {:>9}  {:>9}  {:>11}  {:>6}  {:>7}\n", "topic",
                                 width, "rate Hz", "messages", "size", "per s", "lost", "last s");
  for (const TopicRow& row : status.topics) {
    text += fmt::format("{:{}}  {:>8.1f}  {:>9}  {:>9}  {:>11}  {:>6}  {:>7.1f}{}\n", row.topic,
                        width, row.rate_hz, row.messages, SizeText(static_cast<double>(row.bytes)),
                        SizeText(row.bytes_per_s), row.lost, row.age_s,
                        row.has_schema ? "" : "  no definition");
  }
  text += StatusLine(status) + "\n";
  if (status.recent_s > 0.0) {
    text += fmt::format("in memory for a snapshot: the last {:.1f} s of every topic{}\n",
                        status.recent_s,
                        status.recent_slot_s > 0.0
                            ? fmt::format(", of the largest one message in {} s but the last 1 s",
                                          status.recent_slot_s)
                            : "");
  }
  return text;
}

}  // namespace palpate::recorder
