#pragma once

#include <Eigen/Core>
#include <sstream>
#include <string>

#include "common/cone.hpp"
#include "tools/evaluation/polyline.hpp"

namespace hairpin {

/// Paint for a cone of that colour.
const char* PaintOf(ConeColour colour);

/// A square picture of what lies about `centre`: metres, y up, onto an SVG file. `style` is text of
/// SVG attributes.
class Canvas {
 public:
  /// `radius` [m]: from the centre to each side.
  Canvas(const Eigen::Vector2d& centre, double radius, double pixels_per_metre);

  void Line(const Polyline& line, const char* style);
  void Dot(const Eigen::Vector2d& point, double radius_px, const char* paint);
  void Ring(const Eigen::Vector2d& point, double radius_px, const char* style);
  /// `line`: counted from the top.
  void Text(double line, const std::string& text);
  std::string Finish();

 private:
  double X(const Eigen::Vector2d& point) const;
  double Y(const Eigen::Vector2d& point) const;

  Eigen::Vector2d centre_;
  double radius_;
  double pixels_per_metre_;
  std::ostringstream svg_;
};

}  // namespace hairpin
