#include <map>
#include <optional>
#include <sstream>

#include "tools/simulator/track_draft.hpp"
#include "tools/simulator/track_formats.hpp"

namespace hairpin {

namespace {

constexpr const char* kHeading = "tag,x,y,direction";
constexpr const char* kStartTag = "car_start";
constexpr size_t kColumnsUsed = 4;

struct Row {
  std::string tag;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  double direction = 0.0;
  int line = 0;
};

std::optional<Row> ReadRow(std::string text, const std::string& file, int line) {
  if (text.ends_with('\r')) text.pop_back();
  if (text.empty()) return std::nullopt;
  std::vector<std::string> cells;
  std::istringstream stream(text);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  if (cells.size() < kColumnsUsed) {
    RefuseTrack(file, line, "a row must have at least the columns " + std::string(kHeading));
  }
  const auto number = [&](size_t column, const char* name) {
    const auto value = ParseNumber(cells[column]);
    if (!value)
      RefuseTrack(file, line,
                  std::string(name) + " must be a finite number, not `" + cells[column] + "`");
    return *value;
  };
  return Row{cells[0], {number(1, "x"), number(2, "y")}, number(3, "direction"), line};
}

std::vector<Row> ReadRows(const std::string& text, const std::string& file) {
  if (!text.starts_with(kHeading))
    RefuseTrack(file, 1, "the heading must begin with " + std::string(kHeading));
  std::vector<Row> rows;
  std::istringstream stream(text);
  int line = 0;
  for (std::string row; std::getline(stream, row);) {
    if (++line == 1) continue;
    if (auto parsed = ReadRow(row, file, line)) rows.push_back(*parsed);
  }
  return rows;
}

void Sort(const std::vector<Row>& rows, TrackDraft& draft) {
  static const std::map<std::string, ConeColour> kTags{{"blue", ConeColour::kBlue},
                                                       {"yellow", ConeColour::kYellow},
                                                       {"orange", ConeColour::kOrange},
                                                       {"big_orange", ConeColour::kOrangeLarge},
                                                       {"unknown", ConeColour::kUnknown}};
  bool has_start = false;
  for (const Row& row : rows) {
    if (row.tag == kStartTag) {
      if (has_start) RefuseTrack(draft.file, row.line, "car_start stands twice");
      has_start = true;
      draft.start = {row.position.x(), row.position.y(), row.direction};
      draft.start_line_number = row.line;
      continue;
    }
    const auto tag = kTags.find(row.tag);
    if (tag == kTags.end()) RefuseTrack(draft.file, row.line, "unknown tag: " + row.tag);
    const LocatedCone cone{{row.position, tag->second}, row.line};
    const bool left = tag->second == ConeColour::kBlue;
    const bool right = tag->second == ConeColour::kYellow;
    (left ? draft.left : right ? draft.right : draft.others).push_back(cone);
  }
  if (!has_start) RefuseTrack(draft.file, 1, "no row car_start");
}

}  // namespace

Track ReadEufsTrack(const std::string& text, const std::string& file) {
  TrackDraft draft;
  draft.file = file;
  Sort(ReadRows(text, file), draft);
  return ArrangeUnordered(std::move(draft));
}

}  // namespace hairpin
