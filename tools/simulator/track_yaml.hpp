#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hairpin {

/// A finite decimal number and nothing else; empty where `text` is none, or is beyond 1e6 in size.
std::optional<double> ParseNumber(std::string_view text);

/// A value of a track file's YAML that knows its place. All reads throw TrackError "file:line:
/// reason".
class TrackYaml {
 public:
  /// The whole of a file.
  static TrackYaml Parse(const std::string& text, const std::string& file);

  int line() const { return line_; }
  const std::string& file() const { return file_; }

  bool Has(const std::string& key) const;
  /// The value of a key that must be there.
  TrackYaml Get(const std::string& key) const;
  /// Refuses keys that are not among `known`, and keys that stand twice.
  void RefuseOtherKeys(const std::vector<std::string>& known) const;

  /// The elements of a list; none where there is nothing.
  std::vector<TrackYaml> Elements() const;
  double Number() const;
  bool Flag() const;
  std::string Text() const;
  /// A list of `min` to `max` numbers.
  std::vector<double> Numbers(size_t min, size_t max) const;
  /// A list of two numbers, or three of which the third, the height, is passed over.
  Eigen::Vector2d Point() const;

  [[noreturn]] void Refuse(const std::string& reason) const;

 private:
  TrackYaml(const YAML::Node& node, std::string file, std::string what, int line);
  YAML::Node node_;
  std::string file_;
  std::string what_;  // the key, for messages
  int line_ = 1;
};

}  // namespace hairpin
