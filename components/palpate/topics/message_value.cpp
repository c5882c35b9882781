// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/topics/message_value.hpp"

#include <charconv>

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/recording/ros2msg/cdr_reader.hpp"

namespace palpate::command {

namespace {

using recording::Repeat;

/// No message of ROS nests deeper; a definition that uses itself must end.
constexpr int kDeepest = 50;

class Decoder {
 public:
  Decoder(std::string_view cdr, const recording::Definitions& definitions)
      : cdr_(cdr), most_items_(cdr.size()), definitions_(definitions) {}

  std::optional<MessageValue> Run(const std::string& type) && {
    MessageValue value = One(type);
    if (!cdr_.ok() || failed_) return std::nullopt;
    return value;
  }

 private:
  MessageValue Values(const recording::Field& field) {
    if (field.repeat == Repeat::kOne) return One(field.type);
    MessageValue list;
    list.type = field.type;
    list.is_array = field.repeat == Repeat::kFixed;
    list.count = list.is_array ? field.count : cdr_.Length();
    if (const std::uint32_t size = recording::SizeOfPrimitive(field.type)) {
      list.kind = MessageValue::Kind::kNumbers;
      list.numbers = cdr_.Array(list.count, size);
      list.swaps_bytes = cdr_.swaps_bytes();
      return list;
    }
    list.kind = MessageValue::Kind::kList;
    // Every item has a byte at least: a damaged length must not ask for more.
    failed_ = failed_ || list.count > most_items_;
    for (std::uint64_t i = 0; i < list.count && cdr_.ok() && !failed_; ++i) {
      list.items.push_back(One(field.type));
    }
    return list;
  }

  MessageValue One(const std::string& type) {
    MessageValue value;
    value.type = type;
    if (const std::uint32_t size = recording::SizeOfPrimitive(type)) {
      value.bits = cdr_.Bits(size);
      return value;
    }
    if (type == "string") {
      value.kind = MessageValue::Kind::kText;
      value.text = cdr_.String();
      return value;
    }
    value.kind = MessageValue::Kind::kMessage;
    const auto found = definitions_.find(type);
    if (found == definitions_.end() || depth_ == kDeepest) {
      failed_ = true;
      return value;
    }
    ++depth_;
    for (const recording::Field& field : found->second.fields) {
      if (failed_ || !cdr_.ok()) break;
      value.fields.emplace_back(field.name, Values(field));
    }
    --depth_;
    return value;
  }

  recording::CdrReader cdr_;
  std::uint64_t most_items_;
  const recording::Definitions& definitions_;
  int depth_ = 0;
  bool failed_ = false;
};

/// A single item of a list of numbers, to be named by a path.
MessageValue NumberAt(const MessageValue& list, std::uint64_t index) {
  MessageValue number;
  number.type = list.type;
  number.bits = list.BitsAt(index);
  return number;
}

const MessageValue& FieldOf(const MessageValue& message, const std::string& name,
                            const std::string& path) {
  std::vector<std::string> names;
  for (const auto& [field, value] : message.fields) {
    if (field == name) return value;
    names.push_back(field);
  }
  throw InputError("--field " + path + ": no field '" + name + "'" + DidYouMean(name, names) +
                   (names.empty() ? "" : "; fields: " + Listed(names)));
}

const MessageValue& ItemOf(const MessageValue& list, std::string_view index,
                           const std::string& path) {
  std::uint64_t at = 0;
  const auto read = std::from_chars(index.data(), index.data() + index.size(), at);
  const bool is_list =
      list.kind == MessageValue::Kind::kList || list.kind == MessageValue::Kind::kNumbers;
  if (read.ec != std::errc() || read.ptr != index.data() + index.size() || !is_list ||
      at >= list.count) {
    throw InputError("--field " + path + ": no item [" + std::string(index) + "]" +
                     (is_list ? " of " + std::to_string(list.count) : ": this is no list"));
  }
  if (list.kind == MessageValue::Kind::kList) return list.items[at];
  thread_local MessageValue number;
  number = NumberAt(list, at);
  return number;
}

}  // namespace

std::uint64_t MessageValue::BitsAt(std::uint64_t index) const {
  const std::uint32_t size = recording::SizeOfPrimitive(type);
  std::uint64_t number = 0;
  for (std::uint32_t i = 0; i < size; ++i) {
    const std::uint32_t place = swaps_bytes ? size - 1 - i : i;
    number |= std::uint64_t{static_cast<std::uint8_t>(numbers[index * size + i])} << (8 * place);
  }
  return number;
}

std::optional<MessageValue> DecodeMessage(std::string_view cdr, const std::string& type,
                                          const recording::Definitions& definitions) {
  return Decoder(cdr, definitions).Run(recording::ShortTypeName(type));
}

const MessageValue& SelectField(const MessageValue& message, const std::string& path) {
  const MessageValue* value = &message;
  for (std::size_t begin = 0; begin < path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    const std::string part = path.substr(begin, end - begin);
    const std::size_t bracket = std::min(part.find('['), part.size());
    value = &FieldOf(*value, part.substr(0, bracket), path);
    for (std::size_t open = bracket; open < part.size();) {
      const std::size_t close = part.find(']', open);
      if (part[open] != '[' || close == part.npos) {
        throw InputError("--field " + path + ": must be written as a.b[0].c");
      }
      value = &ItemOf(*value, std::string_view(part).substr(open + 1, close - open - 1), path);
      open = close + 1;
    }
    begin = end + 1;
  }
  return *value;
}

}  // namespace palpate::command
