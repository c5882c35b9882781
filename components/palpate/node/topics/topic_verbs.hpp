// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/app/verbs.hpp"

namespace palpate::command {

/// `palpate topic`: list, info, echo, hz, bw, delay.
app::Verb TopicVerb();

/// Its verbs that read messages.
app::Verb TopicEchoVerb();
app::Verb TopicHzVerb();
app::Verb TopicBwVerb();
app::Verb TopicDelayVerb();

}  // namespace palpate::command
