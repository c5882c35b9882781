// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace palpate::command {

/// Makes CDR piece by piece, little-endian unless told otherwise.
class Cdr {
 public:
  enum class Order { kLittle, kBig };
  explicit Cdr(Order order = Order::kLittle)
      : bytes_(order == Order::kLittle ? std::string("\0\1\0\0", 4) : std::string(4, '\0')),
        order_(order) {}

  template <typename Number>
  Cdr& Put(Number number) {
    while ((bytes_.size() - 4) % sizeof(number) != 0) bytes_ += '\0';
    std::string bytes(reinterpret_cast<const char*>(&number), sizeof(number));
    if (order_ == Order::kBig) std::reverse(bytes.begin(), bytes.end());
    bytes_ += bytes;
    return *this;
  }
  Cdr& Text(const std::string& text) {
    Put(static_cast<std::uint32_t>(text.size() + 1));
    bytes_ += text + '\0';
    return *this;
  }
  template <typename Number>
  Cdr& Array(const std::vector<Number>& numbers) {
    for (const Number number : numbers) Put(number);
    return *this;
  }
  template <typename Number>
  Cdr& List(const std::vector<Number>& numbers) {
    return Put(static_cast<std::uint32_t>(numbers.size())).Array(numbers);
  }
  Cdr& Header(std::int32_t sec, std::uint32_t nanosec, const std::string& frame_id = "frame") {
    return Put(sec).Put(nanosec).Text(frame_id);
  }
  Cdr& Stamp(std::int64_t t_ns, const std::string& frame_id) {
    return Header(static_cast<std::int32_t>(t_ns / 1'000'000'000),
                  static_cast<std::uint32_t>(t_ns % 1'000'000'000), frame_id);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  Order order_;
};

}  // namespace palpate::command
