#pragma once

#include <string>
#include <vector>

#include "tools/surveying/survey.hpp"

namespace hairpin {

/// Every point and every undo, a line of JSON each, on the disk before the call returns. A line
/// that a dead battery cut short is left out when the file is read again, and overwritten by the
/// next.
class SurveyJournal {
 public:
  /// Opens or makes the file. Throws InputError where it cannot, or where a whole line is
  /// no entry.
  explicit SurveyJournal(const std::string& file);
  ~SurveyJournal();
  SurveyJournal(const SurveyJournal&) = delete;
  SurveyJournal& operator=(const SurveyJournal&) = delete;

  /// The points of earlier sittings that were not taken back.
  const std::vector<SurveyedPoint>& points() const { return points_; }
  void Append(const SurveyedPoint& point);
  void AppendUndo();

 private:
  void Write(const std::string& line);
  void Read(const std::string& text);

  std::string file_;
  int descriptor_ = -1;
  std::vector<SurveyedPoint> points_;
};

}  // namespace hairpin
