// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/topics/topic_verbs.hpp"

#include "components/palpate/node/topics/topic_views.hpp"

namespace palpate::command {

app::Verb TopicVerb() {
  return {.name = "topic",
          .purpose = "List topics, show their messages, and measure them, as ros2 topic does",
          .verbs = {TopicListVerb(), TopicInfoVerb(), TopicEchoVerb(), TopicHzVerb(), TopicBwVerb(),
                    TopicDelayVerb()}};
}

}  // namespace palpate::command
