// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

namespace palpate::app {

/// Notifies systemd (Type=notify) that this process is ready, stopping, or alive: one datagram to
/// the socket that NOTIFY_SOCKET names (sd_notify(3)); nothing where it is unset. Each throws
/// RunError with the cause where the datagram cannot be sent.
void NotifyReady();
void NotifyStopping();
void NotifyWatchdog();

}  // namespace palpate::app
