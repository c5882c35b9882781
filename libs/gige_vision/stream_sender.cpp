// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/gige_vision/stream_sender.hpp"

#include <sys/prctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <utility>

namespace palpate::gige_vision {
namespace {

using std::chrono::nanoseconds;
using std::chrono::steady_clock;

constexpr std::size_t kKeptFrames = 8;
// Of its period, that a frame's packets are spread over: whoever waits for the last one waits so
// long. A client that wants more room asks for a packet delay.
constexpr double kShareOfPeriod = 0.25;
constexpr std::int64_t kPieceTime_ns = 1'000'000;  // each piece wakes sender and client
constexpr int kSendBuffer_B = 1 << 20;
constexpr unsigned long kTimerSlack_ns = 1000;
constexpr std::uint32_t kMostRefusals = 64;  // for one request

/// A number in [0, 1) that depends on nothing but the arguments (splitmix64).
double Uniform(std::uint64_t seed, std::uint64_t a, std::uint64_t b, std::uint64_t c) {
  std::uint64_t state = seed;
  for (const std::uint64_t word : {a, b, c}) {
    state = (state ^ word) + 0x9e37'79b9'7f4a'7c15;
    state = (state ^ (state >> 30)) * 0xbf58'476d'1ce4'e5b9;
    state = (state ^ (state >> 27)) * 0x94d0'49bb'1331'11eb;
    state ^= state >> 31;
  }
  return static_cast<double>(state >> 11) * 0x1p-53;
}

}  // namespace

StreamSender::StreamSender(const Interface& interface, double rate_hz, const Impairment& impairment)
    : period_s_{1.0 / rate_hz}, impairment_{impairment}, socket_{interface.address, 0, false} {
  setsockopt(socket_.descriptor(), SOL_SOCKET, SO_SNDBUF, &kSendBuffer_B, sizeof kSendBuffer_B);
  thread_ = std::thread([this] { Run(); });
}

StreamSender::~StreamSender() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void StreamSender::Reset() {
  const std::lock_guard lock(mutex_);
  ++generation_;
  last_id_ = 0;
  last_plan_ = {};
  kept_.clear();
  next_.reset();
  changed_.notify_all();
}

std::uint64_t StreamSender::NextId(bool extended_ids) {
  ++last_id_;
  if (!extended_ids && (last_id_ & 0xffff) == 0) ++last_id_;  // 0 is no id
  return last_id_;
}

std::shared_ptr<StreamBlock> StreamSender::EmptyBlock() {
  if (kept_.size() < kKeptFrames) return std::make_shared<StreamBlock>();
  const std::shared_ptr<StreamBlock> oldest = std::move(kept_.front().block);
  kept_.pop_front();
  const bool unused = oldest.use_count() == 1;  // else a resend is under way
  return unused ? oldest : std::make_shared<StreamBlock>();
}

std::optional<StreamSender::Ticket> StreamSender::Ask() {
  const std::lock_guard lock(mutex_);
  if (!next_) return generation_;
  ++counters_.frames_skipped;
  return std::nullopt;
}

void StreamSender::Offer(Ticket ticket, const StreamPlan& plan, const rgbd::RgbdFrame& frame,
                         std::uint64_t timestamp_ns) {
  std::unique_lock lock(mutex_);
  if (ticket != generation_) return;  // the client has gone meanwhile
  last_plan_ = plan;
  const std::uint64_t id = NextId(plan.extended_ids);
  const std::shared_ptr<StreamBlock> block = EmptyBlock();
  lock.unlock();
  block->Fill(plan, frame, id, timestamp_ns);
  lock.lock();
  if (ticket != generation_) return;
  next_ = block;
  changed_.notify_all();
}

void StreamSender::Run() {
  prctl(PR_SET_TIMERSLACK, kTimerSlack_ns);
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stop_ || next_; });
    if (stop_) return;
    const std::shared_ptr<StreamBlock> block = std::exchange(next_, nullptr);
    kept_.push_back({block, 0});
    const Ticket generation = generation_;
    lock.unlock();
    const bool sent = Transmit(*block, generation);
    lock.lock();
    if (sent) ++counters_.frames_sent;
  }
}

bool StreamSender::Transmit(const StreamBlock& block, Ticket generation) {
  const std::uint32_t count = block.packet_count();
  const double spread_ns = period_s_ * 1e9 * kShareOfPeriod / count;
  const std::int64_t spacing_ns = std::max<std::int64_t>(
      1, block.plan().packet_delay_ns > 0 ? block.plan().packet_delay_ns
                                          : static_cast<std::int64_t>(spread_ns));
  const auto piece = static_cast<std::uint32_t>(
      std::clamp<std::int64_t>(kPieceTime_ns / spacing_ns, 1, PacketBatch::kCapacity));
  const Time start = steady_clock::now();
  for (std::uint32_t next = 0; next < count; next += piece) {
    SendPiece(block, next, std::min(piece, count - next));
    // Who is late hurries, but not so that a small receive buffer overflows.
    const Time due = start + nanoseconds(spacing_ns * (next + piece));
    const Time least = steady_clock::now() + nanoseconds(spacing_ns * piece / 2);
    if (next + piece < count && !Pause(std::max(due, least), generation)) return false;
  }
  return true;
}

bool StreamSender::Pause(Time until, Ticket generation) {
  std::unique_lock lock(mutex_);
  return !changed_.wait_until(lock, until, [&] { return stop_ || generation != generation_; });
}

void StreamSender::SendPiece(const StreamBlock& block, std::uint32_t first, std::uint32_t count) {
  PacketBatch batch(block.plan());
  std::uint64_t withheld = 0;
  for (std::uint32_t packet = first; packet < first + count; ++packet) {
    if (Withheld(impairment_.loss, block.id(), packet, 0)) {
      ++withheld;
    } else {
      block.MakePacket(packet, false, batch.Add());
    }
  }
  const std::size_t sent = batch.Send(socket_);
  const std::lock_guard lock(mutex_);
  counters_.packets_withheld += withheld;
  counters_.packets_sent += sent;
  for (Kept& kept : kept_) {
    if (kept.block.get() == &block) kept.sent = first + count;
  }
}

bool StreamSender::Withheld(double share, std::uint64_t block_id, std::uint64_t packet_id,
                            std::uint64_t attempt) const {
  return share > 0.0 && Uniform(impairment_.seed, block_id, packet_id, attempt) < share;
}

void StreamSender::Resend(const ResendRequest& asked) {
  std::unique_lock lock(mutex_);
  const std::uint64_t mask = asked.extended_ids ? ~std::uint64_t{0} : 0xffff;
  const auto found = std::find_if(kept_.begin(), kept_.end(), [&](const Kept& kept) {
    return (kept.block->id() & mask) == asked.block_id;
  });
  if (found == kept_.end()) {
    lock.unlock();
    Refuse(asked);
    return;
  }
  const std::shared_ptr<StreamBlock> block = found->block;
  const std::uint32_t end =
      std::min(found->sent, asked.last_packet == 0xffff'ffff ? found->sent : asked.last_packet + 1);
  lock.unlock();
  const double share = impairment_.resend_loss < 0.0 ? impairment_.loss : impairment_.resend_loss;
  PacketBatch batch(block->plan());
  std::uint64_t withheld = 0;
  std::uint64_t sent = 0;
  for (std::uint32_t packet = asked.first_packet; packet < end; ++packet) {
    if (Withheld(share, block->id(), packet, ++resends_)) {
      ++withheld;
      continue;
    }
    block->MakePacket(packet, true, batch.Add());
    if (batch.full()) sent += batch.Send(socket_);
  }
  sent += batch.Send(socket_);
  lock.lock();
  counters_.packets_withheld += withheld;
  counters_.packets_resent += sent;
}

void StreamSender::Refuse(const ResendRequest& asked) {
  std::unique_lock lock(mutex_);
  if (last_plan_.port == 0 || asked.first_packet > asked.last_packet) return;
  const std::uint32_t count =
      std::min(kMostRefusals - 1, asked.last_packet - asked.first_packet) + 1;
  counters_.resend_refused += count;
  PacketBatch batch(last_plan_);
  lock.unlock();
  for (std::uint32_t i = 0; i < count; ++i) {
    if (batch.full()) batch.Send(socket_);
    StreamBlock::MakeRefusal(asked.block_id, asked.first_packet + i, asked.extended_ids,
                             batch.Add());
  }
  batch.Send(socket_);
}

void StreamSender::SendTest(const StreamPlan& plan) {
  if (plan.port == 0 || plan.address == 0) return;
  const Bytes filling(plan.packet_size - kUdpOverhead);
  PacketBatch batch(plan);
  batch.Add()->pixels = filling;
  batch.Send(socket_);
}

DeviceCounters StreamSender::counters() const {
  const std::lock_guard lock(mutex_);
  return counters_;
}

}  // namespace palpate::gige_vision
