#include "common/wire_schema.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <regex>
#include <stdexcept>

#include "lcmtypes/definitions.hpp"

namespace hairpin {
namespace {

constexpr int kMaxDepth = 16;
constexpr size_t kMaxFields = 64;  // of one struct

std::string WithoutComments(std::string_view text) {
  static const std::regex kComment(R"(//[^\n]*|/\*[\s\S]*?\*/)");
  return std::regex_replace(std::string(text), kComment, " ");
}

// Big-endian, as LCM writes.
uint64_t ReadUnsigned(const uint8_t* data, size_t size) {
  uint64_t value = 0;
  for (size_t i = 0; i < size; ++i) value = value << 8 | data[i];
  return value;
}

int64_t ReadSigned(const uint8_t* data, size_t size) {
  const int shift = static_cast<int>(64 - 8 * size);
  return static_cast<int64_t>(ReadUnsigned(data, size) << shift) >> shift;
}

bool AllFinite(const uint8_t* data, size_t count, size_t size) {
  for (size_t i = 0; i < count; ++i, data += size) {
    const uint64_t bits = ReadUnsigned(data, size);
    const double value =
        size == 8 ? std::bit_cast<double>(bits) : std::bit_cast<float>(static_cast<uint32_t>(bits));
    if (!std::isfinite(value)) return false;
  }
  return true;
}

}  // namespace

WireSchema::WireSchema(std::string_view definitions) { Parse(WithoutComments(definitions)); }

const WireSchema& WireSchema::Hairpin() {
  static const WireSchema schema(kMessageDefinitions);
  return schema;
}

void WireSchema::Parse(std::string_view text) {
  static const std::regex kStruct(R"(struct\s+(\w+)\s*\{([^}]*)\})");
  static const std::regex kStatement(R"(\s*(const\s+)?([\w.]+)\s+([^;]*?)\s*;)");
  const std::string source(text);
  for (std::sregex_iterator match(source.begin(), source.end(), kStruct), end; match != end;
       ++match) {
    std::vector<Field> fields;
    const std::string body = (*match)[2];
    for (std::sregex_iterator line(body.begin(), body.end(), kStatement); line != end; ++line) {
      if ((*line)[1].matched) continue;  // constants are not on the wire
      fields.push_back(ParseField((*line)[2], (*line)[3], fields));
    }
    if (fields.size() > kMaxFields) {
      throw std::invalid_argument("message " + (*match)[1].str() + " has more than " +
                                  std::to_string(kMaxFields) + " fields");
    }
    structs_[(*match)[1]] = std::move(fields);
  }
  for (auto& [name, fields] : structs_) {
    for (Field& field : fields) {
      if (field.kind != Kind::kStruct) continue;
      const auto members = structs_.find(field.struct_name);
      if (members == structs_.end()) {
        throw std::invalid_argument("message " + name + ": field " + field.name +
                                    " has unknown type " + field.struct_name);
      }
      field.members = &members->second;
    }
  }
}

WireSchema::Field WireSchema::ParseField(const std::string& type, const std::string& declarator,
                                         const std::vector<Field>& before) const {
  static const std::map<std::string, std::pair<Kind, size_t>> kPrimitives{
      {"int8_t", {Kind::kInteger, 1}},  {"int16_t", {Kind::kInteger, 2}},
      {"int32_t", {Kind::kInteger, 4}}, {"int64_t", {Kind::kInteger, 8}},
      {"byte", {Kind::kInteger, 1}},    {"float", {Kind::kFloat, 4}},
      {"double", {Kind::kDouble, 8}},   {"boolean", {Kind::kBoolean, 1}},
      {"string", {Kind::kString, 0}}};
  static const std::regex kDeclarator(R"((\w+)((?:\s*\[\s*\w+\s*\])*))");
  static const std::regex kLength(R"(\w+)");

  std::smatch match;
  if (!std::regex_match(declarator, match, kDeclarator))
    throw std::invalid_argument("message field not understood: " + declarator);
  const auto primitive = kPrimitives.find(type);
  Field field{match[1], Kind::kStruct, 0, type.substr(type.rfind('.') + 1), nullptr, {}};
  if (primitive != kPrimitives.end()) std::tie(field.kind, field.size) = primitive->second;

  const std::string lengths = match[2];
  for (std::sregex_iterator length(lengths.begin(), lengths.end(), kLength), end; length != end;
       ++length) {
    const std::string word = length->str();
    if (std::isdigit(static_cast<unsigned char>(word[0]))) {
      field.dimensions.push_back({std::stoll(word), -1});
      continue;
    }
    int index = -1;
    for (size_t i = 0; i < before.size(); ++i) {
      const bool counts = before[i].kind == Kind::kInteger && before[i].dimensions.empty();
      if (before[i].name == word && counts) index = static_cast<int>(i);
    }
    if (index < 0)
      throw std::invalid_argument("message field " + declarator + ": no integer " + word +
                                  " stands before it");
    field.dimensions.push_back({0, index});
  }
  return field;
}

std::string WireSchema::Problem(const std::string& type, const uint8_t* data, size_t size) const {
  Cursor cursor{data, size};
  std::string problem = CheckStruct(structs_.at(type), cursor, 0);
  if (problem.empty() && cursor.left > 0) problem = std::to_string(cursor.left) + " trailing bytes";
  return problem;
}

std::string WireSchema::CheckStruct(const std::vector<Field>& fields, Cursor& cursor,
                                    int depth) const {
  if (depth > kMaxDepth) return "nested too deeply";
  std::array<int64_t, kMaxFields> values;  // set before they are read: lengths stand before arrays
  for (size_t i = 0; i < fields.size(); ++i) {
    const Field& field = fields[i];
    int64_t count = 1;
    for (const Dimension& dimension : field.dimensions) {
      const int64_t length = dimension.length_field < 0
                                 ? dimension.constant
                                 : values[static_cast<size_t>(dimension.length_field)];
      if (length < 0) return "negative length of " + field.name;
      // Every element takes at least one byte, so more elements than bytes cannot be; this also
      // keeps the product small.
      if (length > static_cast<int64_t>(cursor.left))
        return "length of " + field.name + " exceeds the payload";
      count *= length;
      if (count > static_cast<int64_t>(cursor.left))
        return "length of " + field.name + " exceeds the payload";
    }
    const Cursor start = cursor;
    if (std::string problem = CheckField(field, count, cursor, depth); !problem.empty())
      return problem;
    if (field.kind == Kind::kInteger && field.dimensions.empty())
      values[i] = ReadSigned(start.data, field.size);
  }
  return {};
}

std::string WireSchema::CheckField(const Field& field, int64_t count, Cursor& cursor,
                                   int depth) const {
  const auto elements = static_cast<size_t>(count);
  if (field.kind == Kind::kStruct || field.kind == Kind::kString) {
    for (size_t i = 0; i < elements; ++i) {
      std::string problem = field.kind == Kind::kString
                                ? CheckString(cursor)
                                : CheckStruct(*field.members, cursor, depth + 1);
      if (!problem.empty()) return field.name + ": " + problem;
    }
    return {};
  }
  const size_t bytes = elements * field.size;
  if (bytes > cursor.left) return "truncated at " + field.name;
  const bool real = field.kind == Kind::kFloat || field.kind == Kind::kDouble;
  if (real && !AllFinite(cursor.data, elements, field.size)) return field.name + " is not finite";
  if (field.kind == Kind::kBoolean) {
    for (size_t i = 0; i < elements; ++i) {
      if (cursor.data[i] > 1) return field.name + " is no boolean";
    }
  }
  cursor.data += bytes;
  cursor.left -= bytes;
  return {};
}

std::string WireSchema::CheckString(Cursor& cursor) const {
  if (cursor.left < 4) return "truncated";
  const int64_t length = ReadSigned(cursor.data, 4);  // counts the terminating zero
  if (length < 1 || length > static_cast<int64_t>(cursor.left) - 4)
    return "string length exceeds the payload";
  const auto bytes = static_cast<size_t>(length);
  if (std::memchr(cursor.data + 4, 0, bytes) != cursor.data + 4 + bytes - 1)
    return "string not terminated";
  cursor.data += 4 + bytes;
  cursor.left -= 4 + bytes;
  return {};
}

}  // namespace hairpin
