// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/operator_keys.hpp"

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "libs/core/error.hpp"

namespace palpate::app {

namespace {

termios g_before{};

/// Keys come at once and are not shown; Ctrl-C stays a signal.
bool SetKeyMode() {
  if (isatty(STDIN_FILENO) == 0 || tcgetpgrp(STDIN_FILENO) != getpgrp()) return false;
  if (tcgetattr(STDIN_FILENO, &g_before) != 0) return false;
  termios keys = g_before;
  keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  return tcsetattr(STDIN_FILENO, TCSANOW, &keys) == 0;
}

}  // namespace

std::optional<OperatorKey> OperatorKeyDecoder::Add(char byte) {
  constexpr char kEscape = '\033';
  if (byte == kEscape) {
    sequence_ = byte;
    return std::nullopt;
  }
  if (sequence_.empty()) return OperatorKeyOf(byte);
  sequence_ += byte;
  // "ESC [ A" or "ESC O A"; others may have numbers before their last letter.
  const bool begins = sequence_.size() == 2 && (byte == '[' || byte == 'O');
  if (begins || std::isdigit(static_cast<unsigned char>(byte)) != 0 || byte == ';') {
    return std::nullopt;
  }
  const bool is_arrow = sequence_.size() == 3 && byte >= 'A' && byte <= 'D';
  sequence_.clear();
  if (!is_arrow) return std::nullopt;
  return static_cast<OperatorKey>(static_cast<int>(OperatorKey::kUp) + (byte - 'A'));
}

OperatorKeys::OperatorKeys(std::function<void(OperatorKey)> on_key) : on_key_(std::move(on_key)) {
  if (!SetKeyMode()) return;
  if (pipe2(quit_.data(), O_CLOEXEC) != 0) {
    throw RunError(std::string("cannot read keys: ") + std::strerror(errno));
  }
  thread_ = std::thread([this] { Run(); });
}

OperatorKeys::~OperatorKeys() {
  if (!thread_.joinable()) return;
  close(quit_[1]);
  thread_.join();
  close(quit_[0]);
  tcsetattr(STDIN_FILENO, TCSANOW, &g_before);
}

void OperatorKeys::Run() {
  std::array<pollfd, 2> ends{pollfd{STDIN_FILENO, POLLIN, 0}, pollfd{quit_[0], POLLIN, 0}};
  OperatorKeyDecoder decoder;
  while (true) {
    if (poll(ends.data(), ends.size(), -1) < 0 && errno != EINTR) return;
    if (ends[1].revents != 0) return;
    char key = 0;
    if ((ends[0].revents & POLLIN) == 0) continue;
    if (read(STDIN_FILENO, &key, 1) != 1) return;
    if (const std::optional<OperatorKey> whole = decoder.Add(key)) on_key_(*whole);
  }
}

}  // namespace palpate::app
