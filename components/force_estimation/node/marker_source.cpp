// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/node/marker_source.hpp"

#include <utility>

#include "components/force_estimation/node/convert.hpp"

namespace palpate::force_estimation {

MarkerSource::MarkerSource(dds::Participant& participant, dds::WaitSet& loop,
                           std::vector<std::string> names, std::string hint, TakeArrival take)
    : FrameSource(std::move(take)),
      names_(std::move(names)),
      hint_(std::move(hint)),
      markers_(participant.CreateReader(dds::kMarkersTopic)) {
  loop.Attach(markers_, [this] {
    for (const auto& message : markers_.Take()) HandOver(ArrivalOf(message));
  });
}

FrameArrival MarkerSource::ArrivalOf(const idl::palpate_msgs::MarkerArray3& message) {
  using Verdict = FrameGate::Verdict;
  FrameInput input{HeadOf(message, dds::WaitSet::Clock::now()), false, MarkerFrame()};
  const Verdict verdict = gate_.Judge(input.head);
  if (verdict == Verdict::kRepeated) return {RepeatedFrame{input.head}};
  if (verdict == Verdict::kStale) {
    return {RefusedFrame{input.head,
                         {StatusCode::kStale, "the stamp is not newer than the last one's"}}};
  }
  FrameArrival arrival;
  if (verdict != Verdict::kNext) {
    arrival.sequence = SequenceStart{verdict == Verdict::kTimeWentBack, /*unrelated=*/true};
  }
  const Status status = FromMarkerArray(message, names_, &std::get<MarkerFrame>(input.frame));
  if (status.ok()) {
    arrival.frame = std::move(input);
  } else {
    arrival.frame = RefusedFrame{input.head, status};
  }
  return arrival;
}

}  // namespace palpate::force_estimation
