// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/libs/experiment/c3d_writer.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace palpate::experiment {

namespace {

// Appends numbers as the processor would.
class Output {
 public:
  explicit Output(C3dProcessor processor) : processor_(processor) {}

  void Byte(int value) { bytes_ += static_cast<char>(static_cast<unsigned char>(value)); }

  void Word(int value) {
    const auto word = static_cast<std::uint16_t>(value);
    const bool big_endian = processor_ == C3dProcessor::kMips;
    Byte(big_endian ? word >> 8 : word & 0xff);
    Byte(big_endian ? word & 0xff : word >> 8);
  }

  void Real(double value) {
    auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
    if (processor_ == C3dProcessor::kDec && value != 0.0) bits += 2u << 23;  // excess 128, 0.1...
    const int high = static_cast<int>(bits >> 16);
    const int low = static_cast<int>(bits & 0xffff);
    Word(processor_ == C3dProcessor::kIntel ? low : high);
    Word(processor_ == C3dProcessor::kIntel ? high : low);
  }

  void Text(const std::string& text) { bytes_ += text; }
  void PadToBlock() { bytes_.resize((bytes_.size() + 511) / 512 * 512, '\0'); }
  std::string& bytes() { return bytes_; }

 private:
  C3dProcessor processor_;
  std::string bytes_;
};

class ParameterSection {
 public:
  explicit ParameterSection(const C3dContent& content)
      : content_(content), out_(content.processor) {}

  std::string Write(int data_block) {
    out_.Byte(1);
    out_.Byte(0x50);
    out_.Byte(2);
    out_.Byte(static_cast<int>(content_.processor));
    if (content_.point_group_is_named) Group(1, "POINT");
    Group(2, "TRIAL");
    const auto frame_count = static_cast<int>(content_.frames.size());
    Words(1, "USED", {static_cast<int>(content_.labels.size())});
    Words(1, "FRAMES", {std::min(frame_count, 65535)});
    Words(1, "DATA_START", {content_.data_start_is_zero ? 0 : data_block});
    Reals(1, "SCALE", {content_.real_points ? -content_.scale : content_.scale});
    Reals(1, "RATE", {content_.rate_Hz});
    if (content_.long_frames) Reals(1, "LONG_FRAMES", {static_cast<double>(frame_count)});
    if (content_.unit) Texts(1, "UNITS", {*content_.unit});
    Labels();
    if (content_.trial_fields) {
      const int last = content_.first_frame + frame_count - 1;
      Words(2, "ACTUAL_START_FIELD", {content_.first_frame & 0xffff, content_.first_frame >> 16});
      Words(2, "ACTUAL_END_FIELD", {last & 0xffff, last >> 16});
    }
    if (!content_.angles.empty()) {
      Texts(1, "ANGLES", content_.angles);
      Texts(1, "ANGLE_UNITS", {"deg"});
      Texts(1, "TYPE_GROUPS", {"ANGLES"});
    } else if (!content_.type_groups.empty()) {
      Texts(1, "TYPE_GROUPS", content_.type_groups);
    }
    if (!content_.power_unit.empty()) Texts(1, "POWER_UNITS", {content_.power_unit});
    for (std::size_t k = 0; k < content_.processing.size(); ++k) {
      const int group = 10 + static_cast<int>(k);
      Group(group, "PROCESSING");
      Reals(group, "MASS", {content_.processing[k]});
    }
    if (content_.last_link_leads_nowhere) {
      Words(2, "LAST", {7});
      // Behind the link stand the type, one dimension, its size, the value and the description.
      const std::size_t link = out_.bytes().size() - 2 - 6;
      out_.bytes()[link] = 0x01;
      out_.bytes()[link + 1] = 0x3f;
    }
    out_.Byte(0);
    out_.PadToBlock();
    return out_.bytes();
  }

 private:
  void Labels() {
    const std::size_t part_size = content_.labels_in_one_parameter;
    for (std::size_t begin = 0, part = 1; begin < content_.labels.size(); begin += part_size) {
      const std::size_t end = std::min(begin + part_size, content_.labels.size());
      Texts(1, part == 1 ? "LABELS" : "LABELS" + std::to_string(part),
            {content_.labels.begin() + static_cast<std::ptrdiff_t>(begin),
             content_.labels.begin() + static_cast<std::ptrdiff_t>(end)});
      ++part;
    }
  }

  void Head(int group, const std::string& name, int size_behind_link) {
    out_.Byte(static_cast<int>(name.size()));
    out_.Byte(group);
    out_.Text(name);
    out_.Word(2 + size_behind_link);
  }

  void Group(int number, const std::string& name) {
    Head(-number, name, 1);
    out_.Byte(0);
  }

  void Words(int group, const std::string& name, const std::vector<int>& values) {
    Head(group, name, static_cast<int>(3 + 2 * values.size() + 1));
    out_.Byte(2);
    out_.Byte(1);
    out_.Byte(static_cast<int>(values.size()));
    for (const int value : values) out_.Word(value);
    out_.Byte(0);
  }

  void Reals(int group, const std::string& name, const std::vector<double>& values) {
    Head(group, name, static_cast<int>(3 + 4 * values.size() + 1));
    out_.Byte(4);
    out_.Byte(1);
    out_.Byte(static_cast<int>(values.size()));
    for (const double value : values) out_.Real(value);
    out_.Byte(0);
  }

  void Texts(int group, const std::string& name, const std::vector<std::string>& texts) {
    std::size_t length = 1;
    for (const std::string& text : texts) length = std::max(length, text.size());
    Head(group, name, static_cast<int>(4 + length * texts.size() + 1));
    out_.Byte(-1);
    out_.Byte(2);
    out_.Byte(static_cast<int>(length));
    out_.Byte(static_cast<int>(texts.size()));
    for (std::string text : texts) {
      text.resize(length, ' ');
      out_.Text(text);
    }
    out_.Byte(0);
  }

  const C3dContent& content_;
  Output out_;
};

std::string Header(const C3dContent& content, int data_block) {
  Output out(content.processor);
  const int last = content.first_frame + static_cast<int>(content.frames.size()) - 1;
  out.Byte(2);
  out.Byte(0x50);
  out.Word(static_cast<int>(content.labels.size()));
  out.Word(static_cast<int>(content.analog_values_per_frame));
  out.Word(content.first_frame);
  out.Word(std::min(last, 65535));
  out.Word(0);
  out.Real(content.real_points ? -content.scale : content.scale);
  out.Word(data_block);
  out.Word(1);
  out.Real(content.rate_Hz);
  out.PadToBlock();
  return out.bytes();
}

void WritePoint(const C3dContent& content, const C3dContent::Point& point, Output& out) {
  const int word = point.seen ? (point.cameras << 8 | point.residual_steps) : -1;
  for (const double value : {point.x, point.y, point.z}) {
    if (content.real_points) {
      out.Real(value);
    } else {
      out.Word(static_cast<int>(std::lround(value / content.scale)));
    }
  }
  if (content.real_points) {
    out.Real(word);
  } else {
    out.Word(word);
  }
}

}  // namespace

std::string WriteC3d(const C3dContent& content) {
  // The size of the parameters does not depend on the number that is written in them.
  const std::size_t parameter_blocks = ParameterSection(content).Write(0).size() / 512;
  const int data_block = static_cast<int>(parameter_blocks) + 2;
  Output data(content.processor);
  for (const auto& frame : content.frames) {
    for (const C3dContent::Point& point : frame) WritePoint(content, point, data);
    for (std::size_t i = 0; i < content.analog_values_per_frame; ++i) {
      if (content.real_points) {
        data.Real(-77.5);
      } else {
        data.Word(-77);
      }
    }
  }
  data.PadToBlock();
  return Header(content, data_block) + ParameterSection(content).Write(data_block) + data.bytes();
}

}  // namespace palpate::experiment
