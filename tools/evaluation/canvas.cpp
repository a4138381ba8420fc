#include "tools/evaluation/canvas.hpp"

namespace hairpin {

const char* PaintOf(ConeColour colour) {
  switch (colour) {
    case ConeColour::kBlue:
      return "#1f5fd0";
    case ConeColour::kYellow:
      return "#e0b000";
    case ConeColour::kOrange:
    case ConeColour::kOrangeLarge:
      return "#f07000";
    case ConeColour::kUnknown:
      break;
  }
  return "#808080";
}

Canvas::Canvas(const Eigen::Vector2d& centre, double radius, double pixels_per_metre)
    : centre_(centre), radius_(radius), pixels_per_metre_(pixels_per_metre) {
  const double size = 2.0 * radius * pixels_per_metre;
  svg_ << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << size << "\" height=\"" << size
       << "\"><rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
}

void Canvas::Line(const Polyline& line, const char* style) {
  svg_ << "<polyline fill=\"none\" " << style << " points=\"";
  for (const Eigen::Vector2d& point : line) svg_ << X(point) << ',' << Y(point) << ' ';
  svg_ << "\"/>\n";
}

void Canvas::Dot(const Eigen::Vector2d& point, double radius_px, const char* paint) {
  svg_ << "<circle cx=\"" << X(point) << "\" cy=\"" << Y(point) << "\" r=\"" << radius_px
       << "\" fill=\"" << paint << "\"/>\n";
}

void Canvas::Ring(const Eigen::Vector2d& point, double radius_px, const char* style) {
  svg_ << "<circle fill=\"none\" " << style << " cx=\"" << X(point) << "\" cy=\"" << Y(point)
       << "\" r=\"" << radius_px << "\"/>\n";
}

void Canvas::Text(double line, const std::string& text) {
  svg_ << "<text x=\"10\" y=\"" << 20.0 * line << "\" font-family=\"monospace\" font-size=\"14\">"
       << text << "</text>\n";
}

std::string Canvas::Finish() {
  svg_ << "</svg>\n";
  return svg_.str();
}

double Canvas::X(const Eigen::Vector2d& point) const {
  return pixels_per_metre_ * (radius_ + point.x() - centre_.x());
}

double Canvas::Y(const Eigen::Vector2d& point) const {
  return pixels_per_metre_ * (radius_ - point.y() + centre_.y());
}

}  // namespace hairpin
