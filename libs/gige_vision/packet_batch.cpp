// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/gige_vision/packet_batch.hpp"

#include <arpa/inet.h>
#include <poll.h>

#include <cerrno>

#include "libs/core/check.hpp"

namespace palpate::gige_vision {
namespace {

constexpr int kPatience_ms = 20;  // with a link that is slower than the frames

void SetFragmentation(const UdpSocket& socket, bool forbidden) {
  const int discover = forbidden ? IP_PMTUDISC_DO : IP_PMTUDISC_DONT;
  setsockopt(socket.descriptor(), IPPROTO_IP, IP_MTU_DISCOVER, &discover, sizeof discover);
}

/// iovec is not const-correct; the kernel only reads.
iovec Piece(const std::uint8_t* data, std::size_t size) {
  return {const_cast<std::uint8_t*>(data), size};
}

bool WaitForRoom(const UdpSocket& socket) {
  pollfd waiting{socket.descriptor(), POLLOUT, 0};
  return poll(&waiting, 1, kPatience_ms) > 0;
}

}  // namespace

PacketBatch::PacketBatch(const StreamPlan& plan) : do_not_fragment_{plan.do_not_fragment} {
  to_.sin_family = AF_INET;
  to_.sin_addr.s_addr = htonl(plan.address);
  to_.sin_port = htons(plan.port);
}

StreamPacket* PacketBatch::Add() {
  PALPATE_CHECK(!full());
  return &packets_[size_++];
}

std::size_t PacketBatch::Send(const UdpSocket& socket) {
  SetFragmentation(socket, do_not_fragment_);
  std::array<std::array<iovec, 2>, kCapacity> pieces{};
  std::array<mmsghdr, kCapacity> messages{};
  for (std::size_t i = 0; i < size_; ++i) {
    const StreamPacket& packet = packets_[i];
    pieces[i] = {Piece(packet.head.data(), packet.head_size),
                 Piece(packet.pixels.data(), packet.pixels.size())};
    messages[i].msg_hdr.msg_name = &to_;
    messages[i].msg_hdr.msg_namelen = sizeof to_;
    messages[i].msg_hdr.msg_iov = pieces[i].data();
    messages[i].msg_hdr.msg_iovlen = 2;
  }
  std::size_t taken = 0;
  for (std::size_t next = 0; next < size_;) {
    const int count = sendmmsg(socket.descriptor(), &messages[next],
                               static_cast<unsigned>(size_ - next), MSG_DONTWAIT);
    if (count > 0) {
      next += static_cast<std::size_t>(count);
      taken += static_cast<std::size_t>(count);
      continue;
    }
    const bool full_link = errno == EAGAIN || errno == EWOULDBLOCK || errno == ENOBUFS;
    if (!full_link || !WaitForRoom(socket)) ++next;
  }
  size_ = 0;
  return taken;
}

}  // namespace palpate::gige_vision
