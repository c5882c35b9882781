// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "libs/gige_vision/protocol.hpp"
#include "libs/gige_vision/wire.hpp"

namespace palpate::gige_vision {

/// A piece of the device's memory that has a name.
struct Register {
  std::string name;
  std::uint32_t address = 0;
  bool writable = false;
  /// The register whose value says which of `values` is seen here; empty: the first.
  std::string selector;
  std::vector<std::size_t> slots;  ///< selector's value -> index in `values`; empty: the same
  std::vector<Bytes> values;       ///< all of the same length, a multiple of 4
};

/// The memory of a device: registers with gaps between them. Not thread-safe.
class RegisterBank {
 public:
  /// Fills in the value that is about to be read.
  using Reader = std::function<void(Bytes* value)>;
  /// Judges a value that is about to be written, and may change it; not kSuccess: not written.
  using Writer = std::function<ErrorCode(Bytes* value)>;
  /// What a client gets to see of a register (see DescriptionFaults).
  using Falsifier = std::function<void(const std::string& name, Bytes* value)>;

  void Add(Register added);
  /// Registers are named by where they are (bootstrap registers) or by their names (features).
  std::uint32_t AddressOf(const std::string& name) const;
  void OnRead(std::uint32_t address, Reader reader);
  void OnWrite(std::uint32_t address, Writer writer);
  void set_falsifier(Falsifier falsifier) { falsifier_ = std::move(falsifier); }

  /// As clients do it, by address. `size` and `address` are multiples of 4 (else kBadAlignment);
  /// what touches a gap is kInvalidAddress.
  ErrorCode Read(std::uint32_t address, std::size_t size, Bytes* value) const;
  ErrorCode Write(std::uint32_t address, ByteView value);

  /// As the device does it: the value that is selected now, without readers, judges, falsifiers.
  const Bytes& GetBytes(std::uint32_t address) const;
  std::uint32_t Get(std::uint32_t address) const { return Get32(GetBytes(address), 0); }
  std::uint32_t Get(const std::string& name) const { return Get(AddressOf(name)); }
  double GetDouble(const std::string& name) const {
    return DecodeDouble(GetBytes(AddressOf(name)));
  }
  /// For one value of the register's selector, whatever is selected.
  std::uint32_t GetSelected(const std::string& name, std::size_t selected) const;
  void Set(std::uint32_t address, std::uint32_t value);

  /// `size` bytes from 0 with zeros in the gaps, as discovery shows them.
  Bytes Bootstrap(std::size_t size) const;

 private:
  const Register* Find(std::uint32_t address) const;
  const Register& At(std::uint32_t address) const;
  std::size_t SelectedSlot(const Register& of) const;
  Bytes Shown(const Register& of) const;

  std::map<std::uint32_t, Register> registers_;
  std::map<std::string, std::uint32_t> addresses_;
  std::map<std::uint32_t, Reader> readers_;
  std::map<std::uint32_t, Writer> writers_;
  Falsifier falsifier_;
};

}  // namespace palpate::gige_vision
