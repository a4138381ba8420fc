#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

namespace hairpin {

/// The text with the characters escaped that mean something in HTML and SVG.
std::string Escaped(std::string_view text);

/// A number with a fixed count of digits behind the point, the same on every machine.
std::string Fixed(double value, int digits);

/// About how wide the text stands in a legend, in picture units.
double LegendTextWidth(std::string_view text);

/// The style sheet of all pictures, for light and dark screens and for paper.
extern const char* const kPictureStyle;

/// A picture under construction. Positions in picture units, x right, y down. `look` names classes
/// of kPictureStyle.
class Svg {
 public:
  Svg(double width, double height, std::string_view title);

  void Line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, std::string_view look);
  void Polyline(const std::vector<Eigen::Vector2d>& points, std::string_view look,
                std::string_view colour = "");
  /// Closed rings, filled by the winding rule.
  void Area(const std::vector<std::vector<Eigen::Vector2d>>& rings, std::string_view look);
  void Circle(const Eigen::Vector2d& centre, double radius, std::string_view look);
  void Rectangle(const Eigen::Vector2d& corner, double width, double height, std::string_view look,
                 std::string_view tooltip = "", std::string_view colour = "");
  /// `look` may hold "start", "middle" or "end" for what lies at the position; turned by `turn_deg`
  /// clockwise.
  void Text(const Eigen::Vector2d& position, std::string_view text, std::string_view look,
            double turn_deg = 0.0);

  /// For use inside a page that holds kPictureStyle.
  std::string Inline() const;
  /// A file of its own.
  std::string Standalone() const;

  double width() const { return width_; }
  double height() const { return height_; }

 private:
  std::string Head(bool standalone) const;

  double width_;
  double height_;
  std::string title_;
  std::string body_;
};

}  // namespace hairpin
