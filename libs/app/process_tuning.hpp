// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

namespace palpate::app {

/// Keeps freed memory of large messages for the next ones. Memory that is given back to the system
/// costs a page fault for every 4 kB. To be called before other threads begin.
void KeepLargeBlocks();

}  // namespace palpate::app
