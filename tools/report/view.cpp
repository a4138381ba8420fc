#include "tools/report/view.hpp"

#include <algorithm>

namespace hairpin {
namespace {

constexpr double kMaxTrackHeight = 640.0;
constexpr double kHeader = 64.0;
constexpr double kFooter = 44.0;

}  // namespace

View::View(const std::vector<Eigen::Vector2d>& points) {
  constexpr double kLeastSize = 10.0;  // m
  Eigen::Vector2d low = Eigen::Vector2d::Zero();
  Eigen::Vector2d high = Eigen::Vector2d::Zero();
  if (!points.empty()) low = high = points.front();
  for (const Eigen::Vector2d& point : points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const Eigen::Vector2d size = (high - low).cwiseMax(kLeastSize);
  upright_ = size.y() > size.x();
  middle_ = (low + high) / 2.0;
  scale_ = std::min((kWidth - 2.0 * kSide) / size.maxCoeff(), kMaxTrackHeight / size.minCoeff());
  height_ = kHeader + scale_ * size.minCoeff() + 2.0 * kSide + kFooter;
}

Eigen::Vector2d View::operator()(const Eigen::Vector2d& map) const {
  const Eigen::Vector2d offset = scale_ * (map - middle_);
  const Eigen::Vector2d centre(kWidth / 2.0, kHeader + (height_ - kHeader - kFooter) / 2.0);
  // A quarter turn to the right, or none; both with y downward.
  const double right = upright_ ? offset.y() : offset.x();
  const double down = upright_ ? offset.x() : -offset.y();
  return centre + Eigen::Vector2d(right, down);
}

std::vector<Eigen::Vector2d> View::operator()(const std::vector<Eigen::Vector2d>& map) const {
  std::vector<Eigen::Vector2d> picture;
  picture.reserve(map.size());
  for (const Eigen::Vector2d& point : map) picture.push_back((*this)(point));
  return picture;
}

}  // namespace hairpin
