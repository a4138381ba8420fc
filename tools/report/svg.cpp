#include "tools/report/svg.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace hairpin {
namespace {

std::string Number(double value) { return Fixed(value, 1); }

std::string Points(const std::vector<Eigen::Vector2d>& points) {
  std::string text;
  for (const Eigen::Vector2d& point : points) {
    if (!text.empty()) text += ' ';
    text += Number(point.x()) + ',' + Number(point.y());
  }
  return text;
}

std::string Attribute(std::string_view name, std::string_view value) {
  return " " + std::string(name) + "=\"" + Escaped(value) + "\"";
}

std::string Attribute(std::string_view name, double value) {
  return Attribute(name, Number(value));
}

std::string Look(std::string_view look) { return Attribute("class", look); }

}  // namespace

const char* const kPictureStyle = R"(
:root { color-scheme: light dark;
  --ink: #17202b; --faint: #6b7684; --paper: #ffffff; --card: #f6f7f9; --rule: #dde2e8; --asphalt: #3a424d;
  --ours: #1f6feb; --theirs: #a9b4c2; --good: #1a8f4c; --fair: #b26a00; --bad: #d1242f; --target: #8a94a1; }
@media (prefers-color-scheme: dark) { :root {
  --ink: #e7ecf2; --faint: #93a0af; --paper: #12161c; --card: #1a2028; --rule: #2c343f; --asphalt: #39424e;
  --ours: #58a0ff; --theirs: #667382; --good: #3fb871; --fair: #e0a03c; --bad: #ff6b6b; --target: #7b8794; } }
svg.picture { font: 12px system-ui, "Segoe UI", "DejaVu Sans", sans-serif; }
svg.picture text { fill: var(--ink); }
svg.picture .backdrop { fill: var(--card); }
svg.picture .title { font-weight: 600; font-size: 14px; }
svg.picture text.faint { fill: var(--faint); font-size: 11px; }
svg.picture text.small { font-size: 11px; }
svg.picture text.badge { fill: #fff; font-size: 11px; font-weight: 600; }
svg.picture .middle { text-anchor: middle; }
svg.picture .end { text-anchor: end; }
svg.picture .grid { stroke: var(--rule); stroke-width: 1; }
svg.picture .axis { stroke: var(--faint); stroke-width: 1; }
svg.picture polyline { fill: none; stroke-linejoin: round; stroke-linecap: round; }
svg.picture .ours { stroke: var(--ours); stroke-width: 1.8; }
svg.picture .target { stroke: var(--target); stroke-width: 1.4; stroke-dasharray: 5 4; stroke-linecap: butt; }
svg.picture rect.bar-ours { fill: var(--ours); }
svg.picture rect.bar-theirs { fill: var(--theirs); }
svg.picture .mode { opacity: 0.28; }
svg.picture .mode.FUSION { fill: var(--rule); opacity: 0.6; }
svg.picture .LIDAR_AND_CAMERA { fill: #1fb488; }
svg.picture .LIDAR_ONLY { fill: #8250df; }
svg.picture .CAMERA_ONLY { fill: #e08a00; }
svg.picture .NONE, svg.picture .UNKNOWN { fill: #d1242f; }
svg.picture .asphalt { fill: var(--asphalt); fill-rule: nonzero; }
svg.picture .driven { stroke-width: 3.4; }
svg.picture .gate { stroke: #ffffff; stroke-width: 3; stroke-dasharray: 4 4; }
svg.picture .rim { stroke: var(--card); stroke-width: 0.9; }
svg.picture .blue { fill: #2f80ff; }
svg.picture .yellow { fill: #ffcc00; }
svg.picture .orange { fill: #ff6a00; }
svg.picture .orange_large { fill: #ff6a00; }
svg.picture .clutter { fill: none; stroke: var(--faint); stroke-width: 1.2; }
svg.picture .mapped { fill: none; stroke-width: 1.3; }
svg.picture .mapped.as_blue { stroke: #2f80ff; }
svg.picture .mapped.as_yellow { stroke: #d9a400; }
svg.picture .mapped.as_orange, svg.picture .mapped.as_orange_large { stroke: #ff6a00; }
svg.picture .mapped.as_unknown { stroke: var(--faint); }
svg.picture .mapped.wrong { stroke: var(--bad); stroke-width: 2.2; }
svg.picture .raceline { fill: none; stroke: #7df9ff; stroke-width: 1.2; }
svg.picture .boundary { stroke-width: 1.3; }
svg.picture .boundary.of_left { stroke: #5aa2ff; }
svg.picture .boundary.of_right { stroke: #e6b800; }
svg.picture .boundary.of_path { stroke: #2ecc8f; stroke-width: 1.8; stroke-dasharray: 3 3; stroke-linecap: butt; }
svg.picture .moment { fill: #ffffff; stroke: #17202b; stroke-width: 1; }
svg.picture .hit { stroke: var(--bad); stroke-width: 3.4; }
svg.picture .off { fill: none; stroke: var(--bad); stroke-width: 2.6; }
)";

std::string Escaped(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string Fixed(double value, int digits) {
  if (!std::isfinite(value)) return "–";
  std::array<char, 512> buffer;  // the largest double has 309 digits before the point
  const double unsigned_zero = value == 0.0 ? 0.0 : value;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), unsigned_zero,
                                 std::chars_format::fixed, digits);
  return {buffer.data(), end.ptr};
}

double LegendTextWidth(std::string_view text) {
  constexpr double kSmall = 6.6;  // mean advance of 11 px letters in the widest font of the style
  constexpr double kCapital = 8.2;
  double width = 0.0;
  for (const char c : text) width += (c >= 'A' && c <= 'Z') ? kCapital : kSmall;
  return width;
}

Svg::Svg(double width, double height, std::string_view title)
    : width_(width), height_(height), title_(title) {
  Rectangle({0.0, 0.0}, width, height, "backdrop");
}

void Svg::Line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, std::string_view look) {
  body_ += "<line" + Attribute("x1", from.x()) + Attribute("y1", from.y()) +
           Attribute("x2", to.x()) + Attribute("y2", to.y()) + Look(look) + "/>\n";
}

void Svg::Polyline(const std::vector<Eigen::Vector2d>& points, std::string_view look,
                   std::string_view colour) {
  if (points.size() < 2) return;
  body_ += "<polyline" + Attribute("points", Points(points)) + Look(look);
  if (!colour.empty()) body_ += Attribute("stroke", colour);
  body_ += "/>\n";
}

void Svg::Area(const std::vector<std::vector<Eigen::Vector2d>>& rings, std::string_view look) {
  std::string path;
  for (const auto& ring : rings) {
    if (!ring.empty()) path += "M" + Points(ring) + "Z";
  }
  body_ += "<path" + Attribute("d", path) + Look(look) + "/>\n";
}

void Svg::Circle(const Eigen::Vector2d& centre, double radius, std::string_view look) {
  body_ += "<circle" + Attribute("cx", centre.x()) + Attribute("cy", centre.y()) +
           Attribute("r", radius) + Look(look) + "/>\n";
}

void Svg::Rectangle(const Eigen::Vector2d& corner, double width, double height,
                    std::string_view look, std::string_view tooltip, std::string_view colour) {
  body_ += "<rect" + Attribute("x", corner.x()) + Attribute("y", corner.y()) +
           Attribute("width", width) + Attribute("height", height) + Look(look);
  if (!colour.empty()) body_ += Attribute("fill", colour);
  body_ += tooltip.empty() ? "/>\n" : "><title>" + Escaped(tooltip) + "</title></rect>\n";
}

void Svg::Text(const Eigen::Vector2d& position, std::string_view text, std::string_view look,
               double turn_deg) {
  body_ += "<text" + Attribute("x", position.x()) + Attribute("y", position.y()) + Look(look);
  if (turn_deg != 0.0) {
    body_ += Attribute("transform", "rotate(" + Number(turn_deg) + " " + Number(position.x()) +
                                        " " + Number(position.y()) + ")");
  }
  body_ += ">" + Escaped(text) + "</text>\n";
}

std::string Svg::Head(bool standalone) const {
  const std::string view_box = "0 0 " + Number(width_) + " " + Number(height_);
  std::string head = "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"picture\" role=\"img\"" +
                     Attribute("viewBox", view_box);
  if (standalone) head += Attribute("width", width_) + Attribute("height", height_);
  return head + ">\n<title>" + Escaped(title_) + "</title>\n";
}

std::string Svg::Inline() const { return Head(false) + body_ + "</svg>\n"; }

std::string Svg::Standalone() const {
  return Head(true) + "<style>" + kPictureStyle + "</style>\n" + body_ + "</svg>\n";
}

}  // namespace hairpin
