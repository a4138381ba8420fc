#include "tools/surveying/survey_journal.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "common/errors.hpp"

namespace hairpin {
namespace {

using nlohmann::json;

json ToJson(const SurveyedPoint& point) {
  return {{"kind", NameOf(point.kind)},
          {"utime", point.utime},
          {"latitude_deg", point.position.latitude_deg},
          {"longitude_deg", point.position.longitude_deg},
          {"height_m", point.position.height_m},
          {"sigma_m", {point.sigma.x(), point.sigma.y(), point.sigma.z()}},
          {"fixes", point.fixes}};
}

SurveyedPoint ToPoint(const json& entry) {
  const std::optional<PointKind> kind = PointKindFromName(entry.at("kind"));
  if (!kind) throw std::runtime_error("no such kind");
  SurveyedPoint point;
  point.kind = *kind;
  point.utime = entry.at("utime");
  point.position = {entry.at("latitude_deg").get<double>(), entry.at("longitude_deg").get<double>(),
                    entry.at("height_m").get<double>()};
  const json& sigma = entry.at("sigma_m");
  for (size_t i = 0; i < 3; ++i) point.sigma[static_cast<int>(i)] = sigma.at(i).get<double>();
  point.fixes = entry.at("fixes");
  return point;
}

}  // namespace

SurveyJournal::SurveyJournal(const std::string& file) : file_(file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  const size_t end = text.rfind('\n');
  const size_t whole = end == std::string::npos ? 0 : end + 1;
  Read(text.substr(0, whole));
  descriptor_ = open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
  const bool is_open = descriptor_ >= 0 && ftruncate(descriptor_, static_cast<off_t>(whole)) == 0 &&
                       lseek(descriptor_, 0, SEEK_END) >= 0;
  if (is_open) return;
  const std::string why = std::strerror(errno);
  if (descriptor_ >= 0) close(descriptor_);
  throw InputError(file + ": " + why);
}

SurveyJournal::~SurveyJournal() { close(descriptor_); }

void SurveyJournal::Read(const std::string& text) {
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    try {
      const json entry = json::parse(line);
      if (entry.contains("undo")) {
        if (!points_.empty()) points_.pop_back();
      } else {
        points_.push_back(ToPoint(entry));
      }
    } catch (const std::exception& error) {
      throw InputError(file_ + ":" + std::to_string(number) +
                       ": is no entry of a journal: " + error.what());
    }
  }
}

void SurveyJournal::Write(const std::string& line) {
  const std::string text = line + "\n";
  const bool is_written =
      write(descriptor_, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
      fsync(descriptor_) == 0;
  if (!is_written) throw std::runtime_error(file_ + ": cannot be written: " + std::strerror(errno));
}

void SurveyJournal::Append(const SurveyedPoint& point) {
  Write(ToJson(point).dump());
  points_.push_back(point);
}

void SurveyJournal::AppendUndo() {
  Write(json{{"undo", true}}.dump());
  if (!points_.empty()) points_.pop_back();
}

}  // namespace hairpin
