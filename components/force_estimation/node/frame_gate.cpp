// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/node/frame_gate.hpp"

#include "libs/core/text.hpp"

namespace palpate::force_estimation {

FrameGate::Verdict FrameGate::Judge(const FrameHead& head) {
  using Order = dds::GapCounter::Order;
  const bool same_place =
      last_ && head.recording == last_->recording && head.stamp_ns == last_->stamp_ns;
  const bool later = !last_ || head.stamp_ns > last_->stamp_ns;
  const Order order = gaps_.Add(head.counter);
  if (order == Order::kRepeated && same_place) return Verdict::kRepeated;
  const bool new_sequence = order != Order::kNext || head.recording != last_->recording;
  if (!new_sequence && !later) return Verdict::kStale;
  last_ = head;
  if (!new_sequence) return Verdict::kNext;
  return later ? Verdict::kNewSequence : Verdict::kTimeWentBack;
}

Status FrameGate::CheckAge(const FrameHead& head, int64_t now_ns, double max_age_s) {
  const double age_s = 1e-9 * static_cast<double>(now_ns - head.stamp_ns);
  if (max_age_s == 0.0 || age_s <= max_age_s) return Status::Ok();
  return {StatusCode::kStale, "the frame is " + FormatNumber(age_s) +
                                  " s old (max_age_s: " + FormatNumber(max_age_s) + ")"};
}

}  // namespace palpate::force_estimation
