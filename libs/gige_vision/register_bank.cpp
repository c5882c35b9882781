// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/gige_vision/register_bank.hpp"

#include <algorithm>
#include <utility>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"

namespace palpate::gige_vision {

void RegisterBank::Add(Register added) {
  PALPATE_CHECK(!added.values.empty() && !added.values.front().empty(), added.name);
  PALPATE_CHECK(added.address % 4 == 0 && added.values.front().size() % 4 == 0, added.name);
  PALPATE_CHECK(Find(added.address) == nullptr, added.name, added.address);
  const bool named = addresses_.emplace(added.name, added.address).second;
  PALPATE_CHECK(named, added.name);
  const std::uint32_t address = added.address;
  registers_.emplace(address, std::move(added));
}

std::uint32_t RegisterBank::AddressOf(const std::string& name) const {
  const auto found = addresses_.find(name);
  PALPATE_CHECK(found != addresses_.end(), name);
  return found->second;
}

void RegisterBank::OnRead(std::uint32_t address, Reader reader) {
  readers_[At(address).address] = std::move(reader);
}

void RegisterBank::OnWrite(std::uint32_t address, Writer writer) {
  writers_[At(address).address] = std::move(writer);
}

const Register* RegisterBank::Find(std::uint32_t address) const {
  auto after = registers_.upper_bound(address);
  if (after == registers_.begin()) return nullptr;
  const Register& candidate = std::prev(after)->second;
  return address - candidate.address < candidate.values.front().size() ? &candidate : nullptr;
}

const Register& RegisterBank::At(std::uint32_t address) const {
  const auto found = registers_.find(address);
  PALPATE_CHECK(found != registers_.end(), address);
  return found->second;
}

namespace {

std::size_t SlotFor(const Register& of, std::size_t selected) {
  const std::size_t slot =
      of.slots.empty() ? selected : of.slots[std::min(selected, of.slots.size() - 1)];
  return std::min(slot, of.values.size() - 1);
}

}  // namespace

std::size_t RegisterBank::SelectedSlot(const Register& of) const {
  return of.selector.empty() ? 0 : SlotFor(of, Get(of.selector));
}

Bytes RegisterBank::Shown(const Register& of) const {
  Bytes value = of.values[SelectedSlot(of)];
  const std::size_t size = value.size();
  const auto reader = readers_.find(of.address);
  if (reader != readers_.end()) reader->second(&value);
  if (falsifier_) falsifier_(of.name, &value);
  value.resize(size);
  return value;
}

ErrorCode RegisterBank::Read(std::uint32_t address, std::size_t size, Bytes* value) const {
  if (address % 4 != 0 || size % 4 != 0) return ErrorCode::kBadAlignment;
  value->clear();
  while (value->size() < size) {
    const Register* next = Find(address);
    if (next == nullptr) return ErrorCode::kInvalidAddress;
    const Bytes shown = Shown(*next);
    const std::size_t skip = address - next->address;
    const std::size_t count = std::min(shown.size() - skip, size - value->size());
    value->insert(value->end(), shown.begin() + ToIndex(skip),
                  shown.begin() + ToIndex(skip + count));
    address += static_cast<std::uint32_t>(count);
  }
  return ErrorCode::kSuccess;
}

ErrorCode RegisterBank::Write(std::uint32_t address, ByteView value) {
  if (address % 4 != 0 || value.size() % 4 != 0) return ErrorCode::kBadAlignment;
  while (!value.empty()) {
    const Register* found = Find(address);
    if (found == nullptr) return ErrorCode::kInvalidAddress;
    if (!found->writable) return ErrorCode::kWriteProtect;
    const std::size_t slot = SelectedSlot(*found);
    Bytes written = found->values[slot];
    const std::size_t skip = address - found->address;
    const std::size_t count = std::min(written.size() - skip, value.size());
    std::copy_n(value.begin(), count, written.begin() + ToIndex(skip));
    const auto writer = writers_.find(found->address);
    const ErrorCode verdict =
        writer == writers_.end() ? ErrorCode::kSuccess : writer->second(&written);
    if (verdict != ErrorCode::kSuccess) return verdict;
    registers_.at(found->address).values[slot] = std::move(written);
    value = value.subspan(count);
    address += static_cast<std::uint32_t>(count);
  }
  return ErrorCode::kSuccess;
}

const Bytes& RegisterBank::GetBytes(std::uint32_t address) const {
  const Register& of = At(address);
  return of.values[SelectedSlot(of)];
}

std::uint32_t RegisterBank::GetSelected(const std::string& name, std::size_t selected) const {
  const Register& of = At(AddressOf(name));
  return Get32(of.values[SlotFor(of, selected)], 0);
}

void RegisterBank::Set(std::uint32_t address, std::uint32_t value) {
  const Register& of = At(address);
  const std::size_t slot = SelectedSlot(of);
  PALPATE_CHECK(of.values[slot].size() == 4, of.name);
  registers_.at(address).values[slot] = Encode32(value);
}

Bytes RegisterBank::Bootstrap(std::size_t size) const {
  Bytes memory(size);
  for (const auto& [address, piece] : registers_) {
    if (address >= size) break;
    const Bytes shown = Shown(piece);
    std::copy_n(shown.begin(), std::min(shown.size(), size - address),
                memory.begin() + ToIndex(address));
  }
  return memory;
}

}  // namespace palpate::gige_vision
