#include "common/config.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>

#include "common/crc32c.hpp"

namespace hairpin {

struct Config::Level {
  std::string file;
  std::string path;  // "" or "section."
  int line = 0;
  std::map<std::string, std::pair<YAML::Node, int>> values;  // node and line
  std::set<std::string> asked;
};

struct Config::Document {
  std::string directory;
  std::vector<std::shared_ptr<Level>> levels;
  std::vector<std::string> problems;

  std::shared_ptr<Level> AddLevel(const YAML::Node& node, const std::string& file,
                                  const std::string& path);
  void Report(const Level& level, int line, const std::string& what) {
    problems.push_back(level.file + ":" + std::to_string(line) + ": " + what);
  }
};

namespace {

std::string Describe(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

std::string Describe(const Range& range) {
  if (std::isinf(range.max)) return ">= " + Describe(range.min);
  if (std::isinf(range.min)) return "<= " + Describe(range.max);
  return "from " + Describe(range.min) + " to " + Describe(range.max);
}

std::string Describe(const YAML::Node& node) {
  if (node.IsScalar()) return "`" + node.Scalar() + "`";
  return node.IsSequence() ? "a list" : node.IsMap() ? "a section" : "nothing";
}

double Within(const Range& range) {
  return std::isfinite(range.min) ? range.min : std::isfinite(range.max) ? range.max : 0.0;
}

YAML::Node Parse(const std::string& text, const std::string& file) {
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.size() > 1) throw ConfigError(file + ": more than one YAML document");
    return documents.empty() ? YAML::Node() : documents.front();
  } catch (const YAML::Exception& error) {
    throw ConfigError(file + ":" + std::to_string(error.mark.line + 1) + ": no YAML: " + error.msg);
  }
}

std::string ReadFile(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) throw ConfigError(file + ": cannot be read");
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

void Override(const YAML::Node& root, const std::string& assignment) {
  const size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0)
    throw ConfigError("--set " + assignment + ": is not key=value");
  std::istringstream keys(assignment.substr(0, equals));
  YAML::Node node = root;
  for (std::string key; std::getline(keys, key, '.');) {
    if (!node.IsMap() || !node[key])
      throw ConfigError("--set " + assignment + ": the file has no key " + key);
    node.reset(node[key]);
  }
  node = Parse(assignment.substr(equals + 1), "--set " + assignment);
}

}  // namespace

std::string Nearest(std::string_view word, const std::vector<std::string>& candidates) {
  std::string nearest;
  size_t least = std::max<size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    std::vector<size_t> row(candidate.size() + 1);
    for (size_t j = 0; j < row.size(); ++j) row[j] = j;
    for (size_t i = 1; i <= word.size(); ++i) {
      size_t diagonal = std::exchange(row[0], i);
      for (size_t j = 1; j < row.size(); ++j) {
        const size_t replaced = diagonal + (word[i - 1] == candidate[j - 1] ? 0 : 1);
        diagonal = std::exchange(row[j], std::min({row[j] + 1, row[j - 1] + 1, replaced}));
      }
    }
    if (row.back() < least) {
      least = row.back();
      nearest = candidate;
    }
  }
  return nearest;
}

std::shared_ptr<Config::Level> Config::Document::AddLevel(const YAML::Node& node,
                                                          const std::string& file,
                                                          const std::string& path) {
  auto level = std::make_shared<Level>();
  level->file = file;
  level->path = path;
  level->line = node.Mark().line + 1;
  levels.push_back(level);
  for (const auto& entry : node) {
    const int line = entry.first.Mark().line + 1;
    if (!entry.first.IsScalar()) {
      Report(*level, line, path + Describe(entry.first) + " is no key");
      continue;
    }
    const std::string key = entry.first.Scalar();
    if (!level->values.emplace(key, std::pair(entry.second, line)).second) {
      Report(*level, line, path + key + ": stands twice");
    }
  }
  return level;
}

Config::Config(std::shared_ptr<Document> document, std::shared_ptr<Level> level)
    : document_(std::move(document)), level_(std::move(level)) {}

namespace {

std::shared_ptr<Config::Document> NewDocument(const std::string& directory) {
  auto document = std::make_shared<Config::Document>();
  document->directory = directory;
  return document;
}

YAML::Node MappingOf(const std::string& text, const std::string& file) {
  const YAML::Node root = Parse(text, file);
  if (!root.IsMap()) throw ConfigError(file + ":1: no mapping of keys to values");
  return root;
}

}  // namespace

Config Config::Load(const std::string& directory, const std::string& name,
                    const std::vector<std::string>& overrides) {
  const std::string file = directory + "/" + name + ".yaml";
  const YAML::Node root = MappingOf(ReadFile(file), file);
  for (const std::string& assignment : overrides) Override(root, assignment);
  auto document = NewDocument(directory);
  return Config(document, document->AddLevel(root, file, ""));
}

Config Config::FromText(const std::string& text, const std::string& file,
                        const std::string& directory) {
  auto document = NewDocument(directory);
  return Config(document, document->AddLevel(MappingOf(text, file), file, ""));
}

Config Config::Sibling(const std::string& name) const {
  const std::string file = document_->directory + "/" + name + ".yaml";
  return Config(document_, document_->AddLevel(MappingOf(ReadFile(file), file), file, ""));
}

int64_t Config::SiblingHash(const std::string& name) const {
  std::ifstream stream(document_->directory + "/" + name + ".yaml", std::ios::binary);
  if (!stream) return 0;
  const std::string text((std::istreambuf_iterator<char>(stream)),
                         std::istreambuf_iterator<char>());
  const auto* bytes = reinterpret_cast<const uint8_t*>(text.data());
  return int64_t{1} << 32 | int64_t{Crc32c(bytes, text.size())};
}

bool Config::Has(const std::string& key) const { return level_->values.contains(key); }

namespace {

// The node of `key`, or null with the problem reported.
template <class Document, class Level>
YAML::Node Find(Document& document, Level& level, const std::string& key, int* line) {
  level.asked.insert(key);
  const auto found = level.values.find(key);
  if (found == level.values.end()) {
    document.Report(level, level.line, level.path + key + ": is missing");
    return YAML::Node(YAML::NodeType::Undefined);
  }
  *line = found->second.second;
  return found->second.first;
}

template <class T>
bool Read(const YAML::Node& node, T* value) {
  return node.IsScalar() && YAML::convert<T>::decode(node, *value);
}

}  // namespace

double Config::Number(const std::string& key, const Range& range) const {
  int line = 0;
  const YAML::Node node = Find(*document_, *level_, key, &line);
  if (!node.IsDefined()) return Within(range);
  double value = 0.0;
  if (!Read(node, &value) || !std::isfinite(value)) {
    document_->Report(*level_, line,
                      level_->path + key + ": " + Describe(node) + " is no finite number");
    return Within(range);
  }
  if (value < range.min || value > range.max) {
    document_->Report(*level_, line,
                      level_->path + key + ": " + Describe(node) + " must be " + Describe(range));
    return Within(range);
  }
  return value;
}

int Config::Integer(const std::string& key, int min, int max) const {
  int line = 0;
  const YAML::Node node = Find(*document_, *level_, key, &line);
  if (!node.IsDefined()) return min;
  int value = 0;
  if (!Read(node, &value)) {
    document_->Report(*level_, line, level_->path + key + ": " + Describe(node) + " is no integer");
    return min;
  }
  if (value < min || value > max) {
    const Range range{static_cast<double>(min), static_cast<double>(max)};
    document_->Report(*level_, line,
                      level_->path + key + ": " + Describe(node) + " must be " + Describe(range));
    return min;
  }
  return value;
}

bool Config::Flag(const std::string& key) const {
  int line = 0;
  const YAML::Node node = Find(*document_, *level_, key, &line);
  bool value = false;
  if (node.IsDefined() && !Read(node, &value)) {
    document_->Report(*level_, line,
                      level_->path + key + ": " + Describe(node) + " is neither true nor false");
  }
  return value;
}

std::string Config::Text(const std::string& key) const {
  int line = 0;
  const YAML::Node node = Find(*document_, *level_, key, &line);
  if (!node.IsDefined()) return {};
  if (!node.IsScalar()) {
    document_->Report(*level_, line, level_->path + key + ": " + Describe(node) + " is no text");
    return {};
  }
  return node.Scalar();
}

std::vector<double> Config::Numbers(const std::string& key, size_t size, const Range& range) const {
  int line = 0;
  const YAML::Node node = Find(*document_, *level_, key, &line);
  std::vector<double> values(std::max<size_t>(size, 1), Within(range));
  if (!node.IsDefined()) return values;
  if (!node.IsSequence() || node.size() == 0 || (size > 0 && node.size() != size)) {
    const std::string wanted = size > 0 ? std::to_string(size) : std::string("at least one");
    document_->Report(*level_, line,
                      level_->path + key + ": must be a list of " + wanted + " numbers");
    return values;
  }
  values.resize(node.size());
  for (size_t i = 0; i < node.size(); ++i) {
    if (Read(node[i], &values[i]) && std::isfinite(values[i]) && values[i] >= range.min &&
        values[i] <= range.max)
      continue;
    document_->Report(*level_, node[i].Mark().line + 1,
                      level_->path + key + "[" + std::to_string(i) + "]: " + Describe(node[i]) +
                          " must be a number " + Describe(range));
    values[i] = Within(range);
  }
  return values;
}

std::vector<std::string> Config::Texts(const std::string& key,
                                       const std::vector<std::string>& allowed) const {
  int line = 0;
  const YAML::Node node = Find(*document_, *level_, key, &line);
  if (!node.IsDefined()) return {};
  if (!node.IsSequence()) {
    document_->Report(*level_, line, level_->path + key + ": " + Describe(node) + " is no list");
    return {};
  }
  std::vector<std::string> texts;
  for (const YAML::Node& element : node) {
    const std::string text = element.IsScalar() ? element.Scalar() : "";
    if (std::find(allowed.begin(), allowed.end(), text) != allowed.end()) {
      texts.push_back(text);
      continue;
    }
    const std::string nearest = Nearest(text, allowed);
    const std::string hint = nearest.empty() ? "" : " (did you mean " + nearest + "?)";
    document_->Report(*level_, element.Mark().line + 1,
                      level_->path + key + ": " + Describe(element) + " is unknown" + hint);
  }
  return texts;
}

Config Config::Section(const std::string& key) const {
  int line = level_->line;
  YAML::Node node = Find(*document_, *level_, key, &line);
  if (node.IsDefined() && !node.IsMap()) {
    document_->Report(*level_, line, level_->path + key + ": " + Describe(node) + " is no section");
  }
  if (!node.IsMap()) node.reset(YAML::Node(YAML::NodeType::Map));
  const auto level = document_->AddLevel(node, level_->file, level_->path + key + ".");
  level->line = line;
  return Config(document_, level);
}

void Config::Finish() const {
  std::vector<std::string> problems = document_->problems;
  for (const auto& level : document_->levels) {
    const std::vector<std::string> known(level->asked.begin(), level->asked.end());
    for (const auto& [key, value] : level->values) {
      if (level->asked.contains(key)) continue;
      const std::string nearest = Nearest(key, known);
      const std::string hint = nearest.empty() ? "" : " (did you mean " + nearest + "?)";
      problems.push_back(level->file + ":" + std::to_string(value.second) + ": " + level->path +
                         key + ": unknown key" + hint);
    }
  }
  if (problems.empty()) return;
  std::string text;
  for (const std::string& problem : problems) text += (text.empty() ? "" : "\n") + problem;
  throw ConfigError(text);
}

}  // namespace hairpin
