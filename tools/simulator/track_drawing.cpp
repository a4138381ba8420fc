#include "tools/simulator/track_drawing.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

#include "tools/simulator/track_geometry.hpp"

namespace hairpin {

namespace {

constexpr double kMargin = 6.0;            // m of meadow about the track
constexpr double kPicturePixels = 1200.0;  // the longer side
constexpr double kConeRadius = 0.38;  // m as drawn; a small cone is 0.11 m, which nobody would see
constexpr double kLargeConeRadius = 0.5;

/// A picture whose coordinates are the map's, y turned over.
class Picture {
 public:
  explicit Picture(const Track& track) {
    for (const auto* cones : {&track.left, &track.right, &track.others}) {
      for (const TrackCone& cone : *cones) Include(cone.position);
    }
    for (const Eigen::Vector2d& thing : track.clutter) Include(thing);
    Include(track.start.position());
    low_.array() -= kMargin;
    high_.array() += kMargin;
    out_ << std::fixed << std::setprecision(2);
  }

  void Polygons(const std::vector<Polyline>& rings, const std::string& style) {
    out_ << "<path d=\"";
    for (const Polyline& ring : rings) {
      for (size_t i = 0; i < ring.size(); ++i) {
        out_ << (i == 0 ? "M" : "L") << X(ring[i]) << ' ' << Y(ring[i]);
      }
      out_ << "Z";
    }
    out_ << "\" fill-rule=\"evenodd\" " << style << "/>\n";
  }
  void Line(const Polyline& line, bool closed, const std::string& style) {
    out_ << (closed ? "<polygon" : "<polyline") << " points=\"";
    for (const Eigen::Vector2d& point : line) out_ << X(point) << ',' << Y(point) << ' ';
    out_ << "\" fill=\"none\" " << style << "/>\n";
  }
  void Circle(const Eigen::Vector2d& centre, double radius, const std::string& style) {
    out_ << "<circle cx=\"" << X(centre) << "\" cy=\"" << Y(centre) << "\" r=\"" << radius << "\" "
         << style << "/>\n";
  }
  void Text(const Eigen::Vector2d& at, double size, const std::string& anchor,
            const std::string& text) {
    out_ << "<text x=\"" << X(at) << "\" y=\"" << Y(at) << "\" font-size=\"" << size
         << "\" text-anchor=\"" << anchor << "\" font-family=\"sans-serif\" fill=\"#333\">";
    for (const char c : text) {
      c == '<' ? out_ << "&lt;" : c == '&' ? out_ << "&amp;" : out_ << c;
    }
    out_ << "</text>\n";
  }

  /// One hundredth of the longer side: the unit of lettering.
  double percent() const { return (high_ - low_).maxCoeff() / 100.0; }
  const Eigen::Vector2d& low() const { return low_; }
  const Eigen::Vector2d& high() const { return high_; }

  std::string Finish() const {
    const double caption = 5.0 * percent();
    const Eigen::Vector2d size = high_ - low_ + Eigen::Vector2d(0.0, caption);
    const double scale = kPicturePixels / size.maxCoeff();
    std::ostringstream svg;
    svg << std::fixed << std::setprecision(2)
        << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << size.x() * scale
        << "\" height=\"" << size.y() * scale << "\" viewBox=\"0 " << -caption << ' ' << size.x()
        << ' ' << size.y() << "\">\n<rect x=\"0\" y=\"" << -caption
        << "\" width=\"100%\" height=\"100%\" fill=\"#f4f6f1\"/>\n"
        << out_.str() << "</svg>\n";
    return svg.str();
  }

 private:
  void Include(const Eigen::Vector2d& point) {
    low_ = low_.cwiseMin(point);
    high_ = high_.cwiseMax(point);
  }
  double X(const Eigen::Vector2d& point) const { return point.x() - low_.x(); }
  double Y(const Eigen::Vector2d& point) const { return high_.y() - point.y(); }

  Eigen::Vector2d low_ = Eigen::Vector2d::Constant(std::numeric_limits<double>::max());
  Eigen::Vector2d high_ = Eigen::Vector2d::Constant(std::numeric_limits<double>::lowest());
  std::ostringstream out_;
};

const char* FillOf(ConeColour colour) {
  switch (colour) {
    case ConeColour::kBlue:
      return "#1f5fd0";
    case ConeColour::kYellow:
      return "#f7c600";
    case ConeColour::kOrange:
    case ConeColour::kOrangeLarge:
      return "#f4701b";
    case ConeColour::kUnknown:
      break;
  }
  return "#9aa0a6";
}

void DrawSurface(Picture& picture, const Track& track) {
  const std::string asphalt = "fill=\"#d5d8dc\"";
  Polyline left = PositionsOf(track.left);
  const Polyline right = PositionsOf(track.right);
  if (track.closed) {
    picture.Polygons({left, right}, asphalt);
  } else {
    Polyline outline = left;
    outline.insert(outline.end(), right.rbegin(), right.rend());
    picture.Polygons({outline}, asphalt);
  }
  picture.Line(CentreLine(track), false,
               "stroke=\"#fff\" stroke-width=\"0.2\" stroke-dasharray=\"1 1\"");
  picture.Line(left, track.closed,
               "stroke=\"#1f5fd0\" stroke-opacity=\"0.45\" stroke-width=\"0.15\"");
  picture.Line(right, track.closed,
               "stroke=\"#c79f00\" stroke-opacity=\"0.6\" stroke-width=\"0.15\"");
}

void DrawCones(Picture& picture, const Track& track) {
  for (const auto* cones : {&track.left, &track.right, &track.others}) {
    for (const TrackCone& cone : *cones) {
      const bool large = cone.colour == ConeColour::kOrangeLarge;
      picture.Circle(
          cone.position, large ? kLargeConeRadius : kConeRadius,
          std::string("fill=\"") + FillOf(cone.colour) + "\" stroke=\"#333\" stroke-width=\"0.1\"");
    }
  }
  constexpr double kArm = 0.35;
  for (const Eigen::Vector2d& thing : track.clutter) {
    for (const double slope : {-1.0, 1.0}) {
      const Eigen::Vector2d arm(kArm, slope * kArm);
      picture.Line({thing - arm, thing + arm}, false, "stroke=\"#8a8f94\" stroke-width=\"0.2\"");
    }
  }
}

void DrawGate(Picture& picture, const GateLine& gate) {
  picture.Line({gate.left, gate.right}, false, "stroke=\"#fff\" stroke-width=\"0.6\"");
  picture.Line({gate.left, gate.right}, false,
               "stroke=\"#111\" stroke-width=\"0.6\" stroke-dasharray=\"0.4 0.4\"");
}

void DrawCar(Picture& picture, const Track& track) {
  const Polyline arrow{
      track.start * Eigen::Vector2d(1.4, 0.0), track.start * Eigen::Vector2d(-1.2, 0.8),
      track.start * Eigen::Vector2d(-0.6, 0.0), track.start * Eigen::Vector2d(-1.2, -0.8)};
  picture.Polygons({arrow}, "fill=\"#c0392b\" stroke=\"#333\" stroke-width=\"0.08\"");
}

void DrawCaption(Picture& picture, const Track& track) {
  constexpr double kBar = 10.0;  // m
  const double unit = picture.percent();
  std::ostringstream text;
  text << track.name << (track.closed ? ": lap of " : ": ")
       << std::lround(Length(CentreLine(track), false)) << " m, " << track.left.size() << " + "
       << track.right.size() << " cones";
  const double top = picture.high().y() + 1.5 * unit;
  picture.Text({picture.low().x() + 2.0 * unit, top}, 2.2 * unit, "start", text.str());
  const Eigen::Vector2d bar(picture.high().x() - 2.0 * unit - kBar, top);
  const Eigen::Vector2d along(kBar, 0.0);
  const Eigen::Vector2d tick(0.0, 0.5 * unit);
  picture.Line({bar + tick, bar - tick, bar, bar + along, bar + along - tick, bar + along + tick},
               false, "stroke=\"#333\" stroke-width=\"" + std::to_string(0.2 * unit) + "\"");
  picture.Text(bar + 0.5 * along + 2.0 * tick, 1.8 * unit, "middle", "10 m");
}

}  // namespace

std::string DrawTrack(const Track& track) {
  Picture picture(track);
  DrawSurface(picture, track);
  DrawGate(picture, track.start_line);
  if (!track.closed) DrawGate(picture, track.finish_line);
  DrawCones(picture, track);
  DrawCar(picture, track);
  DrawCaption(picture, track);
  return picture.Finish();
}

}  // namespace hairpin
