// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

namespace palpate::capture {

/// Who controls a device, as it answers beside the stream.
enum class Probe {
  kSilent,      ///< nothing
  kControlled,  ///< by a client: by us, if we opened it
  kFree,        ///< by no client: it has been off since we opened it
};

/// Asks a GigE Vision device, beside whatever controls it, for its control privilege (GVCP register
/// 0x0a00) and waits for the answer up to `timeout_s`. Any answer that is not a sound reading, such
/// as "access denied", counts as kControlled: a device is there.
Probe ProbeControl(const std::string& address, double timeout_s);

}  // namespace palpate::capture
