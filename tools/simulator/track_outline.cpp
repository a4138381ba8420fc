#include "tools/simulator/track_outline.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

namespace hairpin {

namespace {

using Cell = std::pair<int, int>;

/// The eight cells about one, in a ring; the even ones share an edge with it.
constexpr std::array<Cell, 8> kRing{
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

/// Edges that `cell` would share with `cells`, or 0 where adding it would close a hole or touch at
/// a corner only: that is, where its neighbours in the ring are not one run.
int SharedEdges(const std::set<Cell>& cells, const Cell& cell) {
  int shared = 0;
  int runs = 0;
  const auto taken = [&](size_t i) {
    const Cell& step = kRing[i % kRing.size()];
    return cells.contains({cell.first + step.first, cell.second + step.second});
  };
  for (size_t i = 0; i < kRing.size(); ++i) {
    if (taken(i) && i % 2 == 0) ++shared;
    if (!taken(i) && taken(i + 1)) ++runs;
  }
  return runs == 1 ? shared : 0;
}

/// Grows from one cell until the boundary has the edges wanted. Cells that share one edge lengthen
/// it by two.
std::set<Cell> GrowCells(size_t edges, RandomStream& random) {
  constexpr size_t kFirst = 4;
  std::set<Cell> cells{{0, 0}};
  for (size_t boundary = kFirst; boundary < edges; boundary += 2) {
    std::set<Cell> candidates;
    for (const Cell& cell : cells) {
      for (size_t i = 0; i < kRing.size(); i += 2) {
        const Cell next{cell.first + kRing[i].first, cell.second + kRing[i].second};
        if (!cells.contains(next) && SharedEdges(cells, next) == 1) candidates.insert(next);
      }
    }
    // Never empty: to the right of the rightmost column's topmost cell there is always room.
    cells.insert(*std::next(candidates.begin(),
                            static_cast<std::ptrdiff_t>(random.Index(candidates.size()))));
  }
  return cells;
}

/// Grid corners of the boundary, counter-clockwise, one per edge.
std::vector<Cell> Boundary(const std::set<Cell>& cells) {
  std::map<Cell, Cell> next;
  for (const auto& [x, y] : cells) {
    if (!cells.contains({x, y - 1})) next[{x, y}] = {x + 1, y};
    if (!cells.contains({x + 1, y})) next[{x + 1, y}] = {x + 1, y + 1};
    if (!cells.contains({x, y + 1})) next[{x + 1, y + 1}] = {x, y + 1};
    if (!cells.contains({x - 1, y})) next[{x, y + 1}] = {x, y};
  }
  std::vector<Cell> corners{next.begin()->first};
  for (Cell at = next.begin()->second; at != corners.front(); at = next.at(at))
    corners.push_back(at);
  return corners;
}

/// The boundary from a bend on, so that straights are not cut by the list's end, as its runs of
/// straight edges.
std::vector<std::vector<Cell>> Straights(std::vector<Cell> corners) {
  const auto bends = [&corners](size_t i) {
    const Cell& before = corners[(i + corners.size() - 1) % corners.size()];
    const Cell& after = corners[(i + 1) % corners.size()];
    return before.first != after.first && before.second != after.second;
  };
  size_t first = 0;
  while (!bends(first)) ++first;
  std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(first), corners.end());
  std::vector<std::vector<Cell>> straights;
  for (size_t i = 0; i < corners.size(); ++i) {
    if (bends(i)) straights.emplace_back();
    straights.back().push_back(corners[i]);
  }
  return straights;
}

/// Bend at the beginning of a straight: 1 to the left, -1 to the right.
int BendBefore(const std::vector<std::vector<Cell>>& straights, size_t i) {
  const Cell& before = straights[(i + straights.size() - 1) % straights.size()].back();
  const Cell& at = straights[i].front();
  const Cell& after =
      straights[i].size() > 1 ? straights[i][1] : straights[(i + 1) % straights.size()].front();
  const int cross = (at.first - before.first) * (after.second - at.second) -
                    (at.second - before.second) * (after.first - at.first);
  return cross > 0 ? 1 : -1;
}

/// Positions of the grid's lines `from` to `to`, with random distances between.
std::map<int, double> GridLines(int from, int to, const OutlineParams& params,
                                RandomStream& random) {
  std::map<int, double> lines;
  double at = 0.0;
  for (int i = from; i <= to; ++i) {
    lines[i] = at;
    at += random.Uniform(params.min_spacing, params.max_spacing);
  }
  return lines;
}

class OutlineBuilder {
 public:
  OutlineBuilder(const std::vector<Cell>& corners, const OutlineParams& params,
                 RandomStream& random)
      : params_(params), random_(random) {
    const auto [left, right] = std::minmax_element(corners.begin(), corners.end());
    const auto [low, high] =
        std::minmax_element(corners.begin(), corners.end(),
                            [](const Cell& a, const Cell& b) { return a.second < b.second; });
    columns_ = GridLines(left->first, right->first, params, random);
    rows_ = GridLines(low->second, high->second, params, random);
  }

  void Add(const Cell& corner) {
    const double dx = random_.Uniform(-params_.shift, params_.shift);
    const double dy = random_.Uniform(-params_.shift, params_.shift);
    outline_.corners.emplace_back(columns_.at(corner.first) + dx, rows_.at(corner.second) + dy);
  }
  void StartsHere() { outline_.start_edge = outline_.corners.size(); }
  TrackOutline Finish() { return std::move(outline_); }

 private:
  const OutlineParams& params_;
  RandomStream& random_;
  std::map<int, double> columns_;
  std::map<int, double> rows_;
  TrackOutline outline_;
};

}  // namespace

TrackOutline RandomOutline(const OutlineParams& params, RandomStream& random) {
  const std::vector<Cell> corners = Boundary(GrowCells(params.edges, random));
  const auto straights = Straights(corners);
  const auto longest =
      std::max_element(straights.begin(), straights.end(),
                       [](const auto& a, const auto& b) { return a.size() < b.size(); }) -
      straights.begin();
  OutlineBuilder builder(corners, params, random);
  bool kept = true;
  for (size_t i = 0; i < straights.size(); ++i) {
    const size_t before = (i + straights.size() - 1) % straights.size();
    const bool starts = i == static_cast<size_t>(longest);
    const bool opposite = BendBefore(straights, i) != BendBefore(straights, before);
    const bool of_start = starts || before == static_cast<size_t>(longest);  // both its ends stay
    kept = !kept || !opposite || of_start || !random.Chance(params.shortcut);
    if (starts) builder.StartsHere();
    if (kept) builder.Add(straights[i].front());
    for (size_t k = 1; k < straights[i].size(); ++k) {
      if (!starts && !random.Chance(params.merge)) builder.Add(straights[i][k]);
    }
  }
  return builder.Finish();
}

}  // namespace hairpin
