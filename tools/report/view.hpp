#pragma once

#include <Eigen/Core>
#include <vector>

namespace hairpin {

/// From map [m] to a picture of fixed width: turned so that it is wider than high, scaled to fit, y
/// downward, with room for a header and a footer.
class View {
 public:
  static constexpr double kWidth = 1040.0;
  static constexpr double kSide = 28.0;

  /// Shows all of `points`; something sensible where there are none.
  explicit View(const std::vector<Eigen::Vector2d>& points);

  Eigen::Vector2d operator()(const Eigen::Vector2d& map) const;
  std::vector<Eigen::Vector2d> operator()(const std::vector<Eigen::Vector2d>& map) const;

  double scale() const { return scale_; }  // picture units per metre
  double height() const { return height_; }

 private:
  bool upright_ = false;  // in map it is higher than wide
  Eigen::Vector2d middle_ = Eigen::Vector2d::Zero();
  double scale_ = 1.0;
  double height_ = 0.0;
};

}  // namespace hairpin
