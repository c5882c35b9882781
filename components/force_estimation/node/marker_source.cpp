// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/node/marker_source.hpp"

#include <utility>

#include "components/force_estimation/node/convert.hpp"

namespace palpate::force_estimation {

MarkerSource::MarkerSource(dds::Participant& participant, dds::WaitSet& loop,
                           std::vector<std::string> names, FrameEvents events)
    : FrameSource(std::move(events)),
      names_(std::move(names)),
      markers_(participant.CreateReader(dds::kMarkersTopic)) {
  loop.Attach(markers_, [this] {
    for (const auto& message : markers_.Take()) Accept(message);
  });
}

void MarkerSource::Accept(const idl::palpate_msgs::MarkerArray3& message) {
  events().came();
  FrameInput input{HeadOf(message, dds::WaitSet::Clock::now()), false, MarkerFrame()};
  using Verdict = FrameGate::Verdict;
  const Verdict verdict = gate_.Judge(input.head);
  if (verdict == Verdict::kRepeated) return events().repeated(input.head);
  if (verdict == Verdict::kStale) {
    return events().refused(input.head,
                            {StatusCode::kStale, "the stamp is not newer than the last one's"});
  }
  if (verdict != Verdict::kNext) events().sequence(verdict == Verdict::kTimeWentBack, true);
  const Status status = FromMarkerArray(message, names_, &std::get<MarkerFrame>(input.frame));
  if (!status.ok()) return events().refused(input.head, status);
  events().accepted(std::move(input));
}

}  // namespace palpate::force_estimation
