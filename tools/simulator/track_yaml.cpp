#include "tools/simulator/track_yaml.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "common/config.hpp"
#include "tools/simulator/track_draft.hpp"

namespace hairpin {

namespace {

constexpr double kLargest = 1e6;  // m or rad; no track is as large

std::string Quoted(const YAML::Node& node) {
  if (node.IsScalar()) return "`" + node.Scalar() + "`";
  return node.IsSequence() ? "a list" : node.IsMap() ? "a section" : "nothing";
}

}  // namespace

std::optional<double> ParseNumber(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if (!(std::abs(value) <= kLargest)) return std::nullopt;
  return value;
}

TrackYaml::TrackYaml(const YAML::Node& node, std::string file, std::string what, int line)
    : node_(node), file_(std::move(file)), what_(std::move(what)), line_(line) {}

TrackYaml TrackYaml::Parse(const std::string& text, const std::string& file) {
  try {
    return TrackYaml(YAML::Load(text), file, "the file", 1);
  } catch (const YAML::Exception& error) {
    RefuseTrack(file, error.mark.line + 1, "no YAML: " + error.msg);
  }
}

bool TrackYaml::Has(const std::string& key) const { return node_.IsMap() && node_[key]; }

TrackYaml TrackYaml::Get(const std::string& key) const {
  if (!node_.IsMap()) Refuse(what_ + " must be a section, not " + Quoted(node_));
  for (const auto& entry : node_) {
    if (!entry.first.IsScalar() || entry.first.Scalar() != key) continue;
    // Block lists begin a line after their key; a problem of the whole is told at the key.
    return TrackYaml(entry.second, file_, key, entry.first.Mark().line + 1);
  }
  Refuse(what_ + " has no key " + key);
}

void TrackYaml::RefuseOtherKeys(const std::vector<std::string>& known) const {
  if (!node_.IsMap()) Refuse(what_ + " must be a section, not " + Quoted(node_));
  std::set<std::string> seen;
  for (const auto& entry : node_) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "?";
    const int at = entry.first.Mark().line + 1;
    if (!seen.insert(key).second) RefuseTrack(file_, at, key + " stands twice");
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    const std::string nearest = Nearest(key, known);
    RefuseTrack(file_, at,
                "no such key: " + key + (nearest.empty() ? "" : "; did you mean " + nearest + "?"));
  }
}

std::vector<TrackYaml> TrackYaml::Elements() const {
  if (node_.IsNull()) return {};
  if (!node_.IsSequence()) Refuse(what_ + " must be a list, not " + Quoted(node_));
  std::vector<TrackYaml> elements;
  for (const YAML::Node& element : node_) {
    elements.push_back(
        TrackYaml(element, file_, "an element of " + what_, element.Mark().line + 1));
  }
  return elements;
}

double TrackYaml::Number() const {
  const auto value = node_.IsScalar() ? ParseNumber(node_.Scalar()) : std::nullopt;
  if (!value) Refuse(what_ + " must be a finite number, not " + Quoted(node_));
  return *value;
}

bool TrackYaml::Flag() const {
  if (node_.IsScalar() && node_.Scalar() == "true") return true;
  if (node_.IsScalar() && node_.Scalar() == "false") return false;
  Refuse(what_ + " must be true or false, not " + Quoted(node_));
}

std::string TrackYaml::Text() const {
  if (!node_.IsScalar()) Refuse(what_ + " must be a text, not " + Quoted(node_));
  return node_.Scalar();
}

std::vector<double> TrackYaml::Numbers(size_t min, size_t max) const {
  if (!node_.IsSequence() || node_.size() < min || node_.size() > max) {
    Refuse(what_ + " must be a list of " + std::to_string(min) +
           (min == max ? "" : " to " + std::to_string(max)) + " numbers, not " + Quoted(node_));
  }
  std::vector<double> numbers;
  for (const TrackYaml& element : Elements()) numbers.push_back(element.Number());
  return numbers;
}

Eigen::Vector2d TrackYaml::Point() const {
  const std::vector<double> numbers = Numbers(2, 3);
  return {numbers[0], numbers[1]};
}

void TrackYaml::Refuse(const std::string& reason) const { RefuseTrack(file_, line_, reason); }

}  // namespace hairpin
