#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace hairpin {

/// The layout of messages on the wire, read from their .lcm definitions. LCM's generated decoders
/// trust the array lengths that stand in the bytes; this walks the bytes first, so that a hostile
/// count allocates nothing.
class WireSchema {
 public:
  /// Reads any number of definitions (the text of .lcm files, one after another).
  /// Throws std::invalid_argument where a definition cannot be understood.
  explicit WireSchema(std::string_view definitions);
  WireSchema(const WireSchema&) = delete;
  WireSchema& operator=(const WireSchema&) = delete;

  /// The schema of all of hairpin's messages.
  static const WireSchema& Hairpin();

  /// Checks a payload (behind its 8-byte fingerprint) against `type`, such as "cones_t": every
  /// length within the payload, every float finite, every string terminated, every boolean 0 or 1,
  /// no byte left over. Returns what is wrong, empty if nothing. Throws std::out_of_range for an
  /// unknown type.
  std::string Problem(const std::string& type, const uint8_t* data, size_t size) const;

 private:
  enum class Kind { kInteger, kFloat, kDouble, kBoolean, kString, kStruct };
  struct Dimension {
    int64_t constant;  // used where no field is named
    int length_field;  // index of the field that holds the length, or -1
  };
  struct Field {
    std::string name;
    Kind kind;
    size_t size;  // bytes of one element; 0 for strings and structs
    std::string struct_name;
    const std::vector<Field>* members;  // of a struct: in structs_
    std::vector<Dimension> dimensions;
  };
  struct Cursor {
    const uint8_t* data;
    size_t left;
  };

  void Parse(std::string_view text);
  Field ParseField(const std::string& type, const std::string& declarator,
                   const std::vector<Field>& before) const;
  std::string CheckStruct(const std::vector<Field>& fields, Cursor& cursor, int depth) const;
  std::string CheckField(const Field& field, int64_t count, Cursor& cursor, int depth) const;
  std::string CheckString(Cursor& cursor) const;

  std::map<std::string, std::vector<Field>> structs_;
};

}  // namespace hairpin
