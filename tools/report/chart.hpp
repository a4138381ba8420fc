#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "tools/report/svg.hpp"

namespace hairpin {

/// Values of an axis.
struct AxisRange {
  double min = 0.0;
  double max = 1.0;
};

/// What stands around a chart.
struct ChartText {
  std::string title;
  std::string provenance;  // which run made it
  std::string x_label;
  std::string y_label;
};

/// Positions 1, 2 or 5 times a power of ten apart, about `count` of them, all within the range.
std::vector<double> NiceTicks(const AxisRange& range, int count);

/// Axes, grid and labels; draws in the units of its axes.
class Chart {
 public:
  Chart(double width, double height, const ChartText& text, const AxisRange& x, const AxisRange& y);

  /// Picture position of a value.
  Eigen::Vector2d At(double x, double y) const;
  void Line(const std::vector<Eigen::Vector2d>& values, std::string_view look);
  void LevelLine(double y, std::string_view look);
  /// From the axis up to `top`, `width` wide in units of x.
  void Bar(double x, double width, double top, std::string_view look, std::string_view tooltip);
  /// A background over the whole height.
  void Band(double from_x, double to_x, std::string_view look, std::string_view tooltip);
  void LabelBelow(double x, std::string_view text);
  void XTicks();
  /// Entries in a row at the top right, the first one leftmost.
  struct LegendEntry {
    std::string text;
    std::string look;
    bool is_line;
  };
  void Legend(const std::vector<LegendEntry>& entries);

  const Svg& svg() const { return svg_; }

 private:
  Svg svg_;
  AxisRange x_;
  AxisRange y_;
};

}  // namespace hairpin
