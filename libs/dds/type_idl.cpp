// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/type_idl.hpp"

#include <dds/features.h>

#include <dds/ddsi/ddsi_xt_typeinfo.h>

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace palpate::dds {

namespace {

using TypeId = DDS_XTypes_TypeIdentifier;

/// Of a writer on another host, which has to answer.
constexpr dds_duration_t kAnswerWait = DDS_SECS(1);
/// A type that uses itself must end.
constexpr int kMaxNesting = 30;

/// The structs behind these names have one member, the struct of XTypes; the header that says so is
/// not C++.
const dds_typeid_t* Wrapped(const TypeId& id) { return reinterpret_cast<const dds_typeid_t*>(&id); }
const DDS_XTypes_TypeObject& Unwrapped(const dds_typeobj_t& object) {
  return reinterpret_cast<const DDS_XTypes_TypeObject&>(object);
}
const DDS_XTypes_TypeInformation& Unwrapped(const dds_typeinfo_t& info) {
  return reinterpret_cast<const DDS_XTypes_TypeInformation&>(info);
}

/// What cannot be said; the schema is then left out.
struct Unknown : std::runtime_error {
  using std::runtime_error::runtime_error;
};

std::string_view PrimitiveName(std::uint8_t kind) {
  switch (kind) {
    case DDS_XTypes_TK_BOOLEAN: return "boolean";
    case DDS_XTypes_TK_BYTE: return "octet";
    case DDS_XTypes_TK_INT16: return "short";
    case DDS_XTypes_TK_INT32: return "long";
    case DDS_XTypes_TK_INT64: return "long long";
    case DDS_XTypes_TK_UINT16: return "unsigned short";
    case DDS_XTypes_TK_UINT32: return "unsigned long";
    case DDS_XTypes_TK_UINT64: return "unsigned long long";
    case DDS_XTypes_TK_FLOAT32: return "float";
    case DDS_XTypes_TK_FLOAT64: return "double";
    case DDS_XTypes_TK_CHAR8: return "char";
    default: return {};
  }
}

struct TypeName {
  std::string name;
  std::string bounds;  ///< "[3][4]" of an array, behind the member's name
};

std::string Bounded(const std::string& type, std::uint32_t bound) {
  return bound == 0 ? type : type + ", " + std::to_string(bound);
}

class IdlWriter {
 public:
  explicit IdlWriter(dds_entity_t participant) : participant_(participant) {}

  std::string Write(const TypeId& id) && {
    NameOf(id);
    return std::move(text_);
  }

 private:
  struct FreeObject {
    void operator()(ddsi_typeobj* object) const { dds_free_typeobj(object); }
  };

  TypeName NameOf(const TypeId& id) {
    if (const std::string_view name = PrimitiveName(id._d); !name.empty()) {
      return {std::string(name), {}};
    }
    switch (id._d) {
      case DDS_XTypes_TI_STRING8_SMALL: return StringOf(id._u.string_sdefn.bound);
      case DDS_XTypes_TI_STRING8_LARGE: return StringOf(id._u.string_ldefn.bound);
      case DDS_XTypes_TI_PLAIN_SEQUENCE_SMALL:
        return SequenceOf(*id._u.seq_sdefn.element_identifier, id._u.seq_sdefn.bound);
      case DDS_XTypes_TI_PLAIN_SEQUENCE_LARGE:
        return SequenceOf(*id._u.seq_ldefn.element_identifier, id._u.seq_ldefn.bound);
      case DDS_XTypes_TI_PLAIN_ARRAY_SMALL:
        return ArrayOf(*id._u.array_sdefn.element_identifier, id._u.array_sdefn.array_bound_seq);
      case DDS_XTypes_TI_PLAIN_ARRAY_LARGE:
        return ArrayOf(*id._u.array_ldefn.element_identifier, id._u.array_ldefn.array_bound_seq);
      case DDS_XTypes_EK_COMPLETE: return {Named(id), {}};
      default: throw Unknown("a kind of type that this IDL does not have");
    }
  }

  static TypeName StringOf(std::uint32_t bound) {
    return {bound == 0 ? "string" : "string<" + std::to_string(bound) + ">", {}};
  }

  TypeName SequenceOf(const TypeId& element, std::uint32_t bound) {
    const TypeName inner = NameOf(element);
    if (!inner.bounds.empty()) throw Unknown("a sequence of arrays");
    return {"sequence<" + Bounded(inner.name, bound) + ">", {}};
  }

  template <typename Bounds>
  TypeName ArrayOf(const TypeId& element, const Bounds& bounds) {
    TypeName array = NameOf(element);
    std::string own;
    for (std::uint32_t i = 0; i < bounds._length; ++i) {
      own += "[" + std::to_string(bounds._buffer[i]) + "]";
    }
    array.bounds = own + array.bounds;
    return array;
  }

  /// A struct, enumeration or alias: written before what uses it, once.
  std::string Named(const TypeId& id) {
    if (++depth_ > kMaxNesting) throw Unknown("a type that uses itself");
    dds_typeobj_t* found = nullptr;
    if (dds_get_typeobj(participant_, Wrapped(id), kAnswerWait, &found) != DDS_RETCODE_OK) {
      throw Unknown("a type that the writer did not tell");
    }
    const std::unique_ptr<ddsi_typeobj, FreeObject> object(found);
    if (Unwrapped(*object)._d != DDS_XTypes_EK_COMPLETE) throw Unknown("a type without names");
    const DDS_XTypes_CompleteTypeObject& complete = Unwrapped(*object)._u.complete;
    std::string name;
    switch (complete._d) {
      case DDS_XTypes_TK_STRUCTURE: name = Struct(complete._u.struct_type); break;
      case DDS_XTypes_TK_ENUM: name = Enumeration(complete._u.enumerated_type); break;
      case DDS_XTypes_TK_ALIAS: name = Alias(complete._u.alias_type); break;
      default: throw Unknown("a kind of type that this IDL does not have");
    }
    --depth_;
    return name;
  }

  std::string Struct(const DDS_XTypes_CompleteStructType& type) {
    const std::string name = type.header.detail.type_name;
    if (written_.contains(name)) return name;
    std::string members;
    if (type.header.base_type._d == DDS_XTypes_EK_COMPLETE) {
      members = " : " + Named(type.header.base_type);
    }
    members += " {\n";
    for (std::uint32_t i = 0; i < type.member_seq._length; ++i) {
      const DDS_XTypes_CompleteStructMember& member = type.member_seq._buffer[i];
      const TypeName member_type = NameOf(member.common.member_type_id);
      if ((member.common.member_flags & DDS_XTypes_IS_KEY) != 0) members += "  @key\n";
      if ((member.common.member_flags & DDS_XTypes_IS_OPTIONAL) != 0) members += "  @optional\n";
      members += "  " + member_type.name + " " + member.detail.name + member_type.bounds + ";\n";
    }
    const bool mutable_type = (type.struct_flags & DDS_XTypes_IS_MUTABLE) != 0;
    const bool appendable = (type.struct_flags & DDS_XTypes_IS_APPENDABLE) != 0;
    const std::string how =
        mutable_type ? "@mutable\n" : (appendable ? "@appendable\n" : "@final\n");
    Define(name, [&](const std::string& own) { return how + "struct " + own + members + "};\n"; });
    return name;
  }

  std::string Enumeration(const DDS_XTypes_CompleteEnumeratedType& type) {
    const std::string name = type.header.detail.type_name;
    if (written_.contains(name)) return name;
    std::string literals;
    for (std::uint32_t i = 0; i < type.literal_seq._length; ++i) {
      const DDS_XTypes_CompleteEnumeratedLiteral& literal = type.literal_seq._buffer[i];
      literals += std::string(i == 0 ? "" : ",\n") + "  @value(" +
                  std::to_string(literal.common.value) + ") " + literal.detail.name;
    }
    Define(name,
           [&](const std::string& own) { return "enum " + own + " {\n" + literals + "\n};\n"; });
    return name;
  }

  std::string Alias(const DDS_XTypes_CompleteAliasType& type) {
    const std::string name = type.header.detail.type_name;
    if (written_.contains(name)) return name;
    const TypeName target = NameOf(type.body.common.related_type);
    Define(name, [&](const std::string& own) {
      return "typedef " + target.name + " " + own + target.bounds + ";\n";
    });
    return name;
  }

  /// Puts a definition into the modules of its name.
  template <typename Definition>
  void Define(const std::string& name, const Definition& definition) {
    written_.insert(name);
    std::string close;
    std::size_t begin = 0;
    for (std::size_t end = 0; (end = name.find("::", begin)) != name.npos; begin = end + 2) {
      text_ += "module " + name.substr(begin, end - begin) + " {\n";
      close += "};\n";
    }
    text_ += definition(name.substr(begin)) + close;
  }

  dds_entity_t participant_;
  std::string text_;
  std::set<std::string> written_;
  int depth_ = 0;
};

}  // namespace

std::string IdlOfEndpoint(dds_entity_t participant, dds_builtintopic_endpoint_t& endpoint) {
  const dds_typeinfo_t* info = nullptr;
  if (dds_builtintopic_get_endpoint_type_info(&endpoint, &info) != DDS_RETCODE_OK || !info) {
    return {};
  }
  const TypeId& id = Unwrapped(*info).complete.typeid_with_size.type_id;
  if (id._d != DDS_XTypes_EK_COMPLETE) return {};
  try {
    return IdlWriter(participant).Write(id);
  } catch (const Unknown&) {
    return {};
  }
}

}  // namespace palpate::dds
