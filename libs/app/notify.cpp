// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/notify.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include "libs/core/error.hpp"

namespace palpate::app {

namespace {

[[noreturn]] void Fail(const std::string& path, const std::string& cause) {
  throw RunError("environment variable NOTIFY_SOCKET (" + path + "): " + cause);
}

void Notify(std::string_view state) {
  const char* variable = std::getenv("NOTIFY_SOCKET");
  const std::string path = variable == nullptr ? "" : variable;
  if (path.empty()) return;
  sockaddr_un address{};
  if (path.front() != '/' && path.front() != '@')
    Fail(path, "must begin with / or @, as systemd sets it");
  if (path.size() >= sizeof(address.sun_path))
    Fail(path, "is longer than the path of a socket may be");
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, path.size());
  if (path.front() == '@') address.sun_path[0] = '\0';  // a name outside the file system

  const int handle = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (handle < 0) Fail(path, std::strerror(errno));
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + path.size());
  const ssize_t sent = sendto(handle, state.data(), state.size(), MSG_NOSIGNAL,
                              reinterpret_cast<const sockaddr*>(&address), length);
  const int cause = errno;
  close(handle);
  if (sent != static_cast<ssize_t>(state.size())) Fail(path, std::strerror(cause));
}

}  // namespace

void NotifyReady() { Notify("READY=1"); }

void NotifyStopping() { Notify("STOPPING=1"); }

void NotifyWatchdog() { Notify("WATCHDOG=1"); }

}  // namespace palpate::app
