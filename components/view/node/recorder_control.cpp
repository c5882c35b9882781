// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/node/recorder_control.hpp"

#include <map>
#include <system_error>
#include <utility>

#include "components/view/frames/binary_frame.hpp"
#include "libs/core/clock.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/core/seconds.hpp"
#include "libs/core/utc_text.hpp"

namespace palpate::view {

namespace {

constexpr int kInterrupted = 130;

/// "recording_2026-01-31T12-00-00Z"
std::string NameOfNow() {
  std::string name = "recording_" + UtcText(WallNow_ns() / 1'000'000'000);
  for (char& c : name) c = c == ':' ? '-' : c;
  return name;
}

/// What the recorder said last.
std::string LastLine(const std::filesystem::path& file) {
  try {
    std::string text = ReadFile(file);
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return text.substr(text.rfind('\n') + 1);
  } catch (const std::exception&) {
    return {};
  }
}

}  // namespace

std::string RecorderControl::Set(bool on) {
  if (!settings_.allowed) return "this page may only look: allow_control is false";
  LookAfter();
  if (on) return process_ ? "a recording runs" : Start();
  if (!process_) return "no recording runs";
  if (!stopping_) process_->Interrupt();
  stopping_ = true;
  return {};
}

std::string RecorderControl::Start() {
  const std::string name = NameOfNow();
  file_ = settings_.folder / (name + ".mcap");
  std::vector<std::string> arguments{"--out", file_.string()};
  arguments.insert(arguments.end(), settings_.arguments.begin(), settings_.arguments.end());
  try {
    process_ = std::make_unique<app::ChildProcess>(settings_.program, arguments,
                                                   std::map<std::string, std::string>{},
                                                   settings_.folder / (name + ".log"));
  } catch (const RunError& error) {
    reason_ = error.what();
    return reason_;
  }
  start_ = Clock::now();
  reason_.clear();
  stopping_ = false;
  return {};
}

void RecorderControl::LookAfter() {
  if (!process_) return;
  seconds_ = SecondsSince(start_);
  const auto exit_code = process_->ExitCode();
  if (!exit_code) return;
  const bool well = *exit_code == 0 || (stopping_ && *exit_code == kInterrupted);
  reason_ = well ? std::string() : "the recorder ended: " + LastLine(process_->log());
  std::error_code ignored;
  if (well) std::filesystem::remove(process_->log(), ignored);
  process_.reset();
}

OutMessage RecorderControl::State() {
  LookAfter();
  std::error_code missing;
  const auto bytes = file_.empty() ? 0 : std::filesystem::file_size(file_, missing);
  return TextMessage("recorder", JsonText({{"kind", "recorder"},
                                           {"recording", process_ != nullptr},
                                           {"file", file_.string()},
                                           {"seconds", seconds_},
                                           {"bytes", missing ? 0 : bytes},
                                           {"allowed", settings_.allowed},
                                           {"reason", reason_}}));
}

}  // namespace palpate::view
