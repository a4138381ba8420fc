#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/errors.hpp"

namespace hairpin {

/// Everything wrong with a configuration, a line each: file, line, key, value, rule broken.
class ConfigError : public InputError {
 public:
  using InputError::InputError;
};

/// Closed interval, in the key's own unit.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};

/// Strict reading of a YAML file. Every key must be there, once, of its type and within its range,
/// and every key of the file must have been read. Problems are collected; `Finish()` throws all of
/// them at once. Until then a failed read returns a value within its range, so that reading can go
/// on.
///
///     LocalMapParams LoadLocalMapParams(const Config& config) {
///       LocalMapParams params;
///       params.gate = config.Number("association_gate", {0.1, 10.0});
///       config.Finish();
///       return params;
///     }
class Config {
 public:
  /// Reads `directory/name.yaml`. `overrides` are "key=value", dots between the levels, and replace
  /// values of keys that the file has. Throws ConfigError where the file cannot be read or is no
  /// YAML mapping.
  static Config Load(const std::string& directory, const std::string& name,
                     const std::vector<std::string>& overrides = {});
  /// The same from text; `file` is what problems call it. Siblings are then looked for in
  /// `directory`.
  static Config FromText(const std::string& text, const std::string& file,
                         const std::string& directory = ".");

  /// Another file of the same folder, such as "car". Its problems are reported with these.
  Config Sibling(const std::string& name) const;
  /// Tells one text of such a file from another: CRC32C of its bytes and one more bit, 0 where it
  /// cannot be read.
  int64_t SiblingHash(const std::string& name) const;

  double Number(const std::string& key, const Range& range) const;
  int Integer(const std::string& key, int min, int max) const;
  bool Flag(const std::string& key) const;
  std::string Text(const std::string& key) const;
  /// A list of `size` numbers; any number from 1 on where size is 0.
  std::vector<double> Numbers(const std::string& key, size_t size, const Range& range) const;
  /// A list of any number of texts, each one of `allowed`.
  std::vector<std::string> Texts(const std::string& key,
                                 const std::vector<std::string>& allowed) const;
  Config Section(const std::string& key) const;
  bool Has(const std::string& key) const;

  /// Throws ConfigError with all problems so far and every key, of all files read, that nobody
  /// asked for.
  void Finish() const;

  struct Document;  // for the implementation

 private:
  struct Level;
  Config(std::shared_ptr<Document> document, std::shared_ptr<Level> level);
  std::shared_ptr<Document> document_;
  std::shared_ptr<Level> level_;
};

/// The candidate nearest to `word` by edit distance, if near enough to be a slip of the pen; else
/// empty.
std::string Nearest(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace hairpin
