#include "tools/simulator/track_ordering.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace hairpin {

namespace {

constexpr size_t kMaxStarts = 16;
constexpr int kMaxPasses = 50;
constexpr size_t kMaxMoved = 3;   // cones that Or-opt moves at once
constexpr double kNoGain = 1e-9;  // m, below rounding
using Tour = std::vector<size_t>;

class TourSearch {
 public:
  explicit TourSearch(const std::vector<Eigen::Vector2d>& points) : points_(points) {}

  Tour Best() const {
    Tour best;
    double least = std::numeric_limits<double>::infinity();
    const size_t starts = std::min(kMaxStarts, points_.size());
    for (size_t i = 0; i < starts; ++i) {
      Tour tour = Greedy(i * points_.size() / starts);
      for (int pass = 0; pass < kMaxPasses && (TwoOpt(tour) || OrOpt(tour)); ++pass) {
      }
      const double length = LengthOf(tour);
      if (length < least - kNoGain) {
        least = length;
        best = tour;
      }
    }
    return best;
  }

 private:
  double Distance(size_t a, size_t b) const { return (points_[a] - points_[b]).norm(); }

  double LengthOf(const Tour& tour) const {
    double length = 0.0;
    for (size_t i = 0; i < tour.size(); ++i)
      length += Distance(tour[i], tour[(i + 1) % tour.size()]);
    return length;
  }

  /// On to the nearest point not yet visited.
  Tour Greedy(size_t start) const {
    Tour left(points_.size());
    std::iota(left.begin(), left.end(), size_t{0});
    Tour tour;
    for (auto next = left.begin() + static_cast<std::ptrdiff_t>(start);;) {
      tour.push_back(*next);
      left.erase(next);
      if (left.empty()) return tour;
      next = std::min_element(left.begin(), left.end(), [&](size_t a, size_t b) {
        return Distance(tour.back(), a) < Distance(tour.back(), b);
      });
    }
  }

  /// Replaces two edges by two shorter ones, turning round what lies between. True if any was.
  bool TwoOpt(Tour& tour) const {
    bool improved = false;
    const size_t n = tour.size();
    for (size_t i = 0; i + 2 < n; ++i) {
      for (size_t j = i + 2; j < n; ++j) {
        const size_t after = tour[(j + 1) % n];
        const double gain = Distance(tour[i], tour[i + 1]) + Distance(tour[j], after) -
                            Distance(tour[i], tour[j]) - Distance(tour[i + 1], after);
        if (gain <= kNoGain) continue;
        std::reverse(tour.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                     tour.begin() + static_cast<std::ptrdiff_t>(j) + 1);
        improved = true;
      }
    }
    return improved;
  }

  /// Moves up to three neighbours to where they lengthen the tour less. True if any was.
  bool OrOpt(Tour& tour) const {
    const size_t n = tour.size();
    for (size_t count = 1; count <= std::min(kMaxMoved, n - 3); ++count) {
      for (size_t i = 0; i < n; ++i) {
        // With the moved ones first, the rest is an open line from tour[count] round to tour[n -
        // 1].
        std::rotate(tour.begin(), tour.begin() + 1, tour.end());
        const double saved = Distance(tour[n - 1], tour[0]) +
                             Distance(tour[count - 1], tour[count]) -
                             Distance(tour[n - 1], tour[count]);
        for (size_t j = count; j + 1 < n; ++j) {
          const double base = Distance(tour[j], tour[j + 1]);
          const double forward =
              Distance(tour[j], tour[0]) + Distance(tour[count - 1], tour[j + 1]);
          const double backward =
              Distance(tour[j], tour[count - 1]) + Distance(tour[0], tour[j + 1]);
          if (saved - (std::min(forward, backward) - base) <= kNoGain) continue;
          const auto begin = tour.begin();
          const auto moved = static_cast<std::ptrdiff_t>(count);
          if (backward < forward) std::reverse(begin, begin + moved);
          std::rotate(begin, begin + moved, begin + static_cast<std::ptrdiff_t>(j) + 1);
          return true;
        }
      }
    }
    return false;
  }

  const std::vector<Eigen::Vector2d>& points_;
};

}  // namespace

std::vector<size_t> OrderAlongClosedCurve(const std::vector<Eigen::Vector2d>& points) {
  constexpr size_t kFewestWithAChoice = 4;
  Tour tour(points.size());
  std::iota(tour.begin(), tour.end(), size_t{0});
  if (points.size() < kFewestWithAChoice) return tour;
  tour = TourSearch(points).Best();
  std::rotate(tour.begin(), std::find(tour.begin(), tour.end(), size_t{0}), tour.end());
  return tour;
}

}  // namespace hairpin
