#include "tools/report/chart.hpp"

#include <algorithm>
#include <cmath>

namespace hairpin {
namespace {

// Margins about the plot, in picture units.
constexpr double kLeft = 52.0;
constexpr double kRight = 16.0;
constexpr double kTop = 56.0;
constexpr double kBottom = 44.0;
constexpr int kTickCount = 6;

std::string TickText(double value, double step) {
  const int digits = step >= 1.0 ? 0 : static_cast<int>(std::ceil(-std::log10(step) - 1e-9));
  return Fixed(value, digits);
}

}  // namespace

std::vector<double> NiceTicks(const AxisRange& range, int count) {
  const double raw = (range.max - range.min) / count;
  if (!(raw > 0.0) || !std::isfinite(raw)) return {};
  const double magnitude = std::pow(10.0, std::floor(std::log10(raw)));
  double step = 10.0 * magnitude;
  for (const double factor : {5.0, 2.0, 1.0}) {
    if (factor * magnitude >= raw * (1.0 - 1e-9)) step = factor * magnitude;
  }
  std::vector<double> ticks;
  const double first = std::ceil(range.min / step - 1e-9);
  for (double i = first; i * step <= range.max + 1e-9 * step; i += 1.0) ticks.push_back(i * step);
  return ticks;
}

Chart::Chart(double width, double height, const ChartText& text, const AxisRange& x,
             const AxisRange& y)
    : svg_(width, height, text.title + ". " + text.provenance), x_(x), y_(y) {
  svg_.Text({kLeft, 22.0}, text.title, "title");
  svg_.Text({kLeft, 40.0}, text.provenance, "faint");
  svg_.Text({kLeft + (width - kLeft - kRight) / 2.0, height - 8.0}, text.x_label, "faint middle");
  svg_.Text({14.0, kTop + (height - kTop - kBottom) / 2.0}, text.y_label, "faint middle", -90.0);
  const auto ticks = NiceTicks(y_, kTickCount);
  for (const double tick : ticks) {
    svg_.Line(At(x_.min, tick), At(x_.max, tick), tick == 0.0 ? "axis" : "grid");
    const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : 1.0;
    svg_.Text(At(x_.min, tick) + Eigen::Vector2d(-7.0, 4.0), TickText(tick, step), "faint end");
  }
}

Eigen::Vector2d Chart::At(double x, double y) const {
  const double share_x = (x - x_.min) / (x_.max - x_.min);
  const double share_y = (std::clamp(y, y_.min, y_.max) - y_.min) / (y_.max - y_.min);
  return {kLeft + share_x * (svg_.width() - kLeft - kRight),
          svg_.height() - kBottom - share_y * (svg_.height() - kTop - kBottom)};
}

void Chart::XTicks() {
  const auto ticks = NiceTicks(x_, 2 * kTickCount);
  const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : 1.0;
  for (const double tick : ticks) {
    const Eigen::Vector2d foot = At(tick, y_.min);
    svg_.Line(foot, foot + Eigen::Vector2d(0.0, 4.0), "axis");
    LabelBelow(tick, TickText(tick, step));
  }
}

void Chart::LabelBelow(double x, std::string_view text) {
  svg_.Text(At(x, y_.min) + Eigen::Vector2d(0.0, 17.0), text, "faint middle");
}

void Chart::Line(const std::vector<Eigen::Vector2d>& values, std::string_view look) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(values.size());
  for (const Eigen::Vector2d& value : values) points.push_back(At(value.x(), value.y()));
  svg_.Polyline(points, look);
}

void Chart::LevelLine(double y, std::string_view look) {
  svg_.Line(At(x_.min, y), At(x_.max, y), look);
}

void Chart::Bar(double x, double width, double top, std::string_view look,
                std::string_view tooltip) {
  const Eigen::Vector2d upper_left = At(x, top);
  const Eigen::Vector2d lower_right = At(x + width, y_.min);
  svg_.Rectangle(upper_left, lower_right.x() - upper_left.x(), lower_right.y() - upper_left.y(),
                 look, tooltip);
}

void Chart::Band(double from_x, double to_x, std::string_view look, std::string_view tooltip) {
  const Eigen::Vector2d upper_left = At(std::max(from_x, x_.min), y_.max);
  const Eigen::Vector2d lower_right = At(std::min(to_x, x_.max), y_.min);
  if (lower_right.x() <= upper_left.x()) return;
  svg_.Rectangle(upper_left, lower_right.x() - upper_left.x(), lower_right.y() - upper_left.y(),
                 look, tooltip);
}

void Chart::Legend(const std::vector<LegendEntry>& entries) {
  double x = svg_.width() - kRight;
  for (auto entry = entries.rbegin(); entry != entries.rend(); ++entry) {
    x -= LegendTextWidth(entry->text);
    svg_.Text({x, 22.0}, entry->text, "small");
    x -= 22.0;
    if (entry->is_line) {
      svg_.Line({x, 18.0}, {x + 16.0, 18.0}, entry->look);
    } else {
      svg_.Rectangle({x + 4.0, 12.0}, 12.0, 12.0, entry->look);
    }
    x -= 14.0;
  }
}

}  // namespace hairpin
