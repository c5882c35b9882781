// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/c3d/c3d_layout.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <set>
#include <string_view>

#include "libs/core/text.hpp"
#include "libs/experiment/capture/capture_text.hpp"

namespace palpate::experiment {

namespace {

// Offsets of the header's 16-bit words, counted from 1 in the format's description.
constexpr std::size_t Word(std::size_t number) { return 2 * (number - 1); }
constexpr std::size_t kPointCount = Word(2);
constexpr std::size_t kAnalogPerFrame = Word(3);
constexpr std::size_t kFirstFrame = Word(4);
constexpr std::size_t kLastFrame = Word(5);
constexpr std::size_t kScale = Word(7);
constexpr std::size_t kDataBlock = Word(9);
constexpr std::size_t kRate = Word(11);
constexpr std::uint8_t kMagic = 0x50;
constexpr std::uint16_t kLargestFrameNumber = 65535;

std::size_t OffsetOfBlock(std::size_t number) { return (number - 1) * kC3dBlockSize; }

std::size_t FindParameters(const C3dBytes& bytes) {
  bytes.Require(0, kC3dBlockSize, "the header");
  if (bytes.Byte(1) != kMagic) bytes.Refuse(1, "this is no C3D file (80 is expected here)");
  const std::size_t block = bytes.Byte(0);
  if (block < 2) bytes.Refuse(0, "the parameters cannot begin in block " + std::to_string(block));
  return OffsetOfBlock(block);
}

// A count that header and parameters both hold; where both do they must agree. 0 is none.
std::size_t AgreedCount(const C3dBytes& bytes, const C3dParameters& parameters,
                        const std::string& name, std::size_t header_offset) {
  const std::size_t in_header = bytes.Uint16(header_offset);
  const std::optional<double> in_parameters = parameters.Number(name);
  if (in_header == 0 && in_parameters && *in_parameters > 0.0) {
    return static_cast<std::size_t>(*in_parameters);
  }
  if (in_parameters && *in_parameters != 0.0 && *in_parameters != static_cast<double>(in_header)) {
    bytes.Refuse(parameters.OffsetOf(name), name + " is " + FormatNumber(*in_parameters) +
                                                ", the header has " + std::to_string(in_header));
  }
  return in_header;
}

// A frame number written as two 16-bit halves, low first.
std::optional<double> WideFrameNumber(const C3dParameters& parameters, const std::string& name) {
  const std::vector<double> halves = parameters.Numbers(name);
  if (halves.size() != 2) return std::nullopt;
  return halves[0] + 65536.0 * halves[1];
}

// More frames than the header's 16 bits can count, where a parameter says so.
std::optional<double> WideFrameCount(const C3dParameters& parameters) {
  const auto first = WideFrameNumber(parameters, "TRIAL:ACTUAL_START_FIELD");
  const auto last = WideFrameNumber(parameters, "TRIAL:ACTUAL_END_FIELD");
  if (first && last && *last - *first + 1.0 > kLargestFrameNumber) return *last - *first + 1.0;
  for (const std::string name : {"POINT:LONG_FRAMES", "POINT:FRAMES"}) {
    const std::optional<double> count = parameters.Number(name);
    if (count && *count > kLargestFrameNumber) return count;
  }
  return std::nullopt;
}

std::size_t CountFrames(const C3dBytes& bytes, const C3dParameters& parameters) {
  if (const std::optional<double> wide = WideFrameCount(parameters)) {
    if (*wide > static_cast<double>(bytes.size()) || *wide != std::floor(*wide)) {
      bytes.Refuse(kLastFrame, "there cannot be " + FormatNumber(*wide) + " frames in this file");
    }
    return static_cast<std::size_t>(*wide);
  }
  const int first = bytes.Uint16(kFirstFrame);
  const int last = bytes.Uint16(kLastFrame);
  const int count = last - first + 1;
  if (count <= 0) {
    bytes.Refuse(kFirstFrame,
                 "frames " + std::to_string(first) + " to " + std::to_string(last) + " are none");
  }
  const std::optional<double> in_parameters = parameters.Number("POINT:FRAMES");
  if (in_parameters && *in_parameters != count && last != kLargestFrameNumber) {
    bytes.Refuse(parameters.OffsetOf("POINT:FRAMES"),
                 "POINT:FRAMES is " + FormatNumber(*in_parameters) + ", the header has " +
                     std::to_string(count) + " frames");
  }
  if (last == kLargestFrameNumber && in_parameters.value_or(0.0) >= 1.0) {
    return static_cast<std::size_t>(*in_parameters);
  }
  return static_cast<std::size_t>(count);
}

double ReadScale(const C3dBytes& bytes, const C3dParameters& parameters) {
  const double in_header = bytes.Real(kScale);
  const double in_parameters = parameters.Number("POINT:SCALE").value_or(0.0);
  const double scale = in_parameters == 0.0 ? in_header : in_parameters;
  if (!std::isfinite(scale) || scale == 0.0)
    bytes.Refuse(kScale, "the scale of points is unusable");
  if (std::signbit(scale) != std::signbit(in_header)) {
    bytes.Refuse(kScale, "header and POINT:SCALE disagree whether points are integers");
  }
  return scale;
}

double ReadRate(const C3dBytes& bytes, const C3dParameters& parameters,
                std::vector<std::string>* notes) {
  constexpr double kRounding = 2e-3;  // 59.94 may stand there as 60
  const double in_header = bytes.Real(kRate);
  const double in_parameters = parameters.Number("POINT:RATE").value_or(0.0);
  const double rate_Hz = in_parameters > 0.0 ? in_parameters : in_header;
  if (!std::isfinite(rate_Hz) || rate_Hz <= 0.0) bytes.Refuse(kRate, "the frame rate is unusable");
  if (in_header > 0.0 && std::abs(in_header / rate_Hz - 1.0) > kRounding) {
    notes->push_back("the frame rate is taken from POINT:RATE, " + FormatNumber(rate_Hz) +
                     " Hz; the header has " + FormatNumber(in_header) + " Hz");
  }
  return rate_Hz;
}

double ReadUnit(const C3dBytes& bytes, const C3dParameters& parameters, const C3dOptions& options) {
  const std::vector<std::string> units = parameters.Texts("POINT:UNITS");
  const bool named = !units.empty() && !units.front().empty();
  if (!named && !options.unit_if_absent) {
    bytes.Refuse(0, "the file does not say its unit of length (POINT:UNITS); give it with --unit");
  }
  const std::string unit = named ? units.front() : *options.unit_if_absent;
  if (const std::optional<double> metres = MetresPerUnit(unit)) return *metres;
  bytes.Refuse(parameters.OffsetOf("POINT:UNITS"),
               "unit of length '" + Excerpt(unit) + "' is not known (m, cm or mm)");
}

std::string WithoutBlanks(std::string text) {
  std::erase_if(text, [](unsigned char c) { return std::isspace(c) != 0; });
  return text;
}

// A list that may go on in parameters NAME2, NAME3, ..., its texts without blanks.
std::vector<std::string> LongList(const C3dParameters& parameters, const std::string& name) {
  std::vector<std::string> texts = parameters.Texts(name);
  for (int part = 2; parameters.Has(name + std::to_string(part)); ++part) {
    const auto more = parameters.Texts(name + std::to_string(part));
    texts.insert(texts.end(), more.begin(), more.end());
  }
  for (std::string& text : texts) text = WithoutBlanks(text);
  return texts;
}

std::vector<std::string> ReadLabels(const C3dParameters& parameters, std::size_t count) {
  std::vector<std::string> labels = LongList(parameters, "POINT:LABELS");
  labels.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (HasNoName(labels[i])) labels[i] = std::string(kUnlabelledPrefix) + std::to_string(i + 1);
  }
  return labels;
}

struct OutputType {
  const char* type;  ///< as POINT:TYPE_GROUPS names it
  const char* word;  ///< that ends the labels of such outputs: LKneeAngles
};
constexpr std::array kOutputTypes = std::to_array<OutputType>({{"ANGLES", "Angle"},
                                                               {"FORCES", "Force"},
                                                               {"MOMENTS", "Moment"},
                                                               {"POWERS", "Power"},
                                                               {"SCALARS", "Scalar"},
                                                               {"REACTIONS", "Reaction"}});

// The type whose word ends the label ("LKneeAngles", "knee_angle", not "Rectangle"); nullptr: none.
const OutputType* TypeByLabel(std::string_view label) {
  if (label.ends_with('s') || label.ends_with('S')) label.remove_suffix(1);
  for (const OutputType& output : kOutputTypes) {
    const std::string_view word = output.word;
    if (label.ends_with(word)) return &output;
    if (label.size() <= word.size()) continue;
    const std::string_view end = label.substr(label.size() - word.size());
    const bool same = std::equal(end.begin(), end.end(), word.begin(), [](char a, char b) {
      return std::tolower(static_cast<unsigned char>(a)) ==
             std::tolower(static_cast<unsigned char>(b));
    });
    if (same && label[label.size() - word.size() - 1] == '_') return &output;
  }
  return nullptr;
}

// ANGLES has its unit in ANGLE_UNITS, and so on.
bool HoldsLengths(const C3dParameters& parameters, const std::string& type) {
  const std::string stem = type.ends_with('S') ? type.substr(0, type.size() - 1) : type;
  const std::string name = "POINT:" + stem + "_UNITS";
  if (!parameters.Has(name)) return type == "MODELED_MARKERS";
  const std::vector<std::string> units = parameters.Texts(name);
  return !units.empty() && MetresPerUnit(units.front()).has_value();
}

std::set<std::string> NamedTypes(const C3dParameters& parameters) {
  std::set<std::string> types;
  for (std::string& type : LongList(parameters, "POINT:TYPE_GROUPS")) {
    std::transform(type.begin(), type.end(), type.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    const bool names_no_type = type.empty() || type.ends_with("UNITS") || type == "LABELS";
    if (!names_no_type) types.insert(type);
  }
  return types;
}

// Model outputs are stored as points. Parameters named after their types list the labels of those
// that are no positions.
std::set<std::string> LabelsOfOtherQuantities(const C3dParameters& parameters) {
  std::set<std::string> types = NamedTypes(parameters);
  for (const OutputType& output : kOutputTypes) types.insert(output.type);
  std::set<std::string> labels;
  for (const std::string& type : types) {
    if (!parameters.Has("POINT:" + type) || HoldsLengths(parameters, type)) continue;
    const std::vector<std::string> of_type = LongList(parameters, "POINT:" + type);
    labels.insert(of_type.begin(), of_type.end());
  }
  labels.erase("");
  return labels;
}

// Whether the file says that it holds outputs of this type, but not which: a label that reads like
// one is then enough.
bool HoldsUnlisted(const C3dParameters& parameters, const std::set<std::string>& named,
                   const std::string& type) {
  if (parameters.Has("POINT:" + type)) return false;
  const std::string units = "POINT:" + type.substr(0, type.size() - 1) + "_UNITS";
  return (named.contains(type) || parameters.Has(units)) && !HoldsLengths(parameters, type);
}

void MarkOtherQuantities(const C3dParameters& parameters, C3dLayout* layout) {
  const std::set<std::string> others = LabelsOfOtherQuantities(parameters);
  const std::set<std::string> named = NamedTypes(parameters);
  std::vector<std::string> left_out, doubtful;
  for (const std::string& label : layout->labels) {
    const OutputType* output = TypeByLabel(label);
    const bool is_other = others.contains(label) ||
                          (output != nullptr && HoldsUnlisted(parameters, named, output->type));
    layout->is_length.push_back(!is_other);
    if (is_other) {
      left_out.push_back(label);
    } else if (output != nullptr) {
      doubtful.push_back(label);
    }
  }
  if (!left_out.empty()) {
    layout->notes.push_back("left out, as model outputs that are no positions: " +
                            Listed(left_out));
  }
  if (!doubtful.empty()) {
    layout->notes.push_back("taken as positions, though their labels read like model outputs: " +
                            Excerpt(Listed(doubtful)) +
                            "; if they are none, name the markers to take (--markers)");
  }
}

std::size_t FindData(const C3dBytes& bytes, const C3dParameters& parameters) {
  const std::size_t block = AgreedCount(bytes, parameters, "POINT:DATA_START", kDataBlock);
  if (block < 3) bytes.Refuse(kDataBlock, "points cannot begin in block " + std::to_string(block));
  return OffsetOfBlock(block);
}

}  // namespace

C3dLayout ReadC3dLayout(C3dBytes& bytes, const C3dOptions& options) {
  const C3dParameters parameters(bytes, FindParameters(bytes));
  C3dLayout layout;
  layout.point_count = AgreedCount(bytes, parameters, "POINT:USED", kPointCount);
  if (layout.point_count == 0) bytes.Refuse(kPointCount, "the file holds no points");
  layout.frame_count = CountFrames(bytes, parameters);
  layout.analog_values_per_frame = bytes.Uint16(kAnalogPerFrame);
  layout.data_offset = FindData(bytes, parameters);
  const double scale = ReadScale(bytes, parameters);
  layout.real_points = scale < 0.0;
  layout.scale = std::abs(scale);
  layout.rate_Hz = ReadRate(bytes, parameters, &layout.notes);
  layout.metres_per_unit = ReadUnit(bytes, parameters, options);
  layout.labels = ReadLabels(parameters, layout.point_count);
  MarkOtherQuantities(parameters, &layout);
  bytes.Require(layout.data_offset, layout.frame_count * layout.frame_size(),
                std::to_string(layout.frame_count) + " frames");
  return layout;
}

}  // namespace palpate::experiment
