// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "libs/gige_vision/register_bank.hpp"

namespace palpate::gige_vision {

/// One line of the table from which both the device's registers and its GenICam description are
/// made. A name beginning with "Gev", "Scan3d", "Device", ... is of the Standard Features Naming
/// Convention (SFNC); "Palpate" is ours.
struct Feature {
  enum class Kind { kInteger, kFloat, kBoolean, kEnumeration, kCommand, kText };

  Feature(Kind its_kind, std::string its_category, std::string its_name);

  // What a table line adds; each gives back the feature itself.
  Feature&& Value(double value) &&;
  Feature&& Values(std::vector<double> its_values) &&;  ///< one for each slot of the selector
  Feature&& Range(double least, double greatest, double step = 1.0) &&;
  Feature&& Entries(std::vector<std::pair<std::string, std::uint32_t>> its_entries) &&;
  Feature&& SelectedBy(std::string its_selector, std::vector<std::size_t> its_slots = {}) &&;
  Feature&& At(std::uint32_t its_address, std::size_t its_size = 4) &&;  ///< a bootstrap register
  Feature&& Bits(int lowest, int highest) &&;  ///< of that register; bit 0 is the least
  Feature&& Command(std::uint32_t written) &&;
  Feature&& Writable() &&;
  Feature&& Locked() &&;  ///< writable while nothing streams
  Feature&& Changing() &&;
  Feature&& Wide() &&;  ///< an integer of 64 bits
  Feature&& MaxFrom(std::string its_max_feature) &&;
  Feature&& Unit(std::string its_unit) &&;
  Feature&& Tip(std::string its_tip) &&;

  Kind kind;
  std::string category;
  std::string name;
  std::vector<double> values = {0.0};
  bool ranged = false;
  double min = 0.0;
  double max = 0.0;
  double increment = 1.0;
  std::vector<std::pair<std::string, std::uint32_t>> entries;
  std::string selector;
  std::vector<std::size_t> slots;
  bool bootstrap = false;  ///< shows a register that the device has anyway
  std::uint32_t address = 0;
  std::size_t size = 4;
  int lowest_bit = -1;  ///< -1: the whole register
  int highest_bit = -1;
  std::uint32_t command_value = 1;
  bool writable = false;
  bool locked = false;
  bool changing = false;  ///< by itself: clients must not keep it
  std::string max_feature;
  std::string unit;
  std::string tip;
};

using FeatureTable = std::vector<Feature>;

/// Gives every feature that is not a view of a bootstrap register an address from `first` on.
void AssignAddresses(FeatureTable* table, std::uint32_t first);

/// The registers of these features, with a judge for range and enumeration entries.
void AddRegisters(const FeatureTable& table, RegisterBank* bank);

}  // namespace palpate::gige_vision
