// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "libs/core/config_reader.hpp"

namespace palpate::recorder {

/// Settings of the recorder.
struct Config {
  std::string compression = "none";
  int zstd_level = 1;
  double chunk_MB = 4.0;
  double flush_s = 1.0;
  double split_MB = 0.0;
  double split_s = 0.0;
  double waiting_MB = 128.0;
  double recent_s = 20.0;
  double recent_MB = 128.0;
  bool save_on_error = true;
  double error_pause_s = 20.0;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("compression", compression, {"none", "zstd", "lz4"},
      "Compression of the chunks: none costs least time; lz4 and zstd halve depth images");
    v("zstd_level", zstd_level, {.min = 1, .max = 19}, "Level of zstd, 1 is the fastest");
    v("chunk_MB", chunk_MB, {.min = 0.01, .max = 1000.0},
      "Size at which a chunk is written, 10^6 bytes");
    v("flush_s", flush_s, {.min = 0.0, .min_open = true},
      "Longest time that a message waits for its chunk, s: what kill -9 can cost");
    v("split_MB", split_MB, {.min = 0.0},
      "Size at which the next file begins, 10^6 bytes; 0: none");
    v("split_s", split_s, {.min = 0.0}, "Duration at which the next file begins, s; 0: none");
    v("waiting_MB", waiting_MB, {.min = 1.0},
      "Messages that may wait for a slow disk, 10^6 bytes; more are dropped and counted");
    v("recent_s", recent_s, {.min = 0.0},
      "Messages of the last so many seconds are kept in memory for snapshots, s; 0: none");
    v("recent_MB", recent_MB, {.min = 1.0},
      "Memory for them, 10^6 bytes; when it is full, the largest topics keep all messages of the "
      "last "
      "second, and evenly fewer of the time before");
    v("save_on_error", save_on_error,
      "Save the last seconds when a component reports an error on /diagnostics");
    v("error_pause_s", error_pause_s, {.min = 0.0}, "Least time between two such files, s");
  }
};

}  // namespace palpate::recorder
