// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

namespace palpate::app {

/// Keeps freed memory of large messages for the next ones. Memory that is given back to the system
/// costs a page fault for every 4 kB. To be called before other threads begin.
void KeepLargeBlocks();

/// Asks the system to wake the calling thread at once, even while all cores are busy: as a thread
/// in real time where that is permitted (root, CAP_SYS_NICE or `ulimit -r`), else by short turns
/// (Linux 6.12). For threads that mostly sleep: others do not run on its core meanwhile. Threads
/// that it starts later are as before.
void PreferPromptWakeUps();
/// Takes PreferPromptWakeUps() back.
void EndPromptWakeUps();

}  // namespace palpate::app
