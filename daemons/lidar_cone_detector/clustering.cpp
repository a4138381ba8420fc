#include "daemons/lidar_cone_detector/clustering.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace hairpin {
namespace {

struct Offset {
  int32_t column, row;
};

// Half of the 5 x 5 cells around one: the other half finds the pair from its own side. The four
// corners count too: they touch the tolerance exactly.
constexpr std::array<Offset, 12> kNeighbours{{{1, 0},
                                              {2, 0},
                                              {-2, 1},
                                              {-1, 1},
                                              {0, 1},
                                              {1, 1},
                                              {2, 1},
                                              {-2, 2},
                                              {-1, 2},
                                              {0, 2},
                                              {1, 2},
                                              {2, 2}}};
constexpr int32_t kBorder = 2;  // cells without points, so that neighbours need no bounds

constexpr int64_t kMaxCells = 16'000'000;

}  // namespace

Clustering::Clustering(double tolerance, double half_extent)
    : tolerance_squared_(static_cast<float>(tolerance * tolerance)),
      half_extent_(static_cast<float>(half_extent)) {
  if (!(tolerance > 0.0)) throw std::invalid_argument("Clustering: tolerance must be > 0");
  if (!(half_extent > 0.0)) throw std::invalid_argument("Clustering: half_extent must be > 0");
  // A little less than the diagonal, so that rounding cannot make two points of a cell too far.
  const double side = 0.9999 * tolerance / std::sqrt(2.0);
  const double width = std::ceil(2.0 * half_extent / side) + 1.0 + 2.0 * kBorder;
  if (width * width > static_cast<double>(kMaxCells))
    throw std::invalid_argument("Clustering: half_extent over tolerance must be < 1400");
  per_metre_ = static_cast<float>(1.0 / side);
  width_ = static_cast<int32_t>(width);
  cell_at_.resize(static_cast<size_t>(width_) * static_cast<size_t>(width_));
}

void Clustering::SortIntoCells(const std::vector<float>& x, const std::vector<float>& y,
                               std::span<const uint32_t> selected) {
  cells_.clear();
  cell_of_.clear();
  members_.clear();
  for (const uint32_t i : selected) {
    if (!(std::abs(x[i]) <= half_extent_ && std::abs(y[i]) <= half_extent_)) continue;
    const auto column = static_cast<int32_t>((x[i] + half_extent_) * per_metre_) + kBorder;
    const auto row = static_cast<int32_t>((y[i] + half_extent_) * per_metre_) + kBorder;
    uint32_t& slot = cell_at_[static_cast<size_t>(row) * static_cast<size_t>(width_) +
                              static_cast<size_t>(column)];
    if (slot == 0) {
      const auto number = static_cast<uint32_t>(cells_.size());
      cells_.push_back({column, row, 0, 0, number, x[i], x[i], y[i], y[i]});
      slot = number + 1;
    }
    Cell& cell = cells_[slot - 1];
    ++cell.count;
    cell.min_x = std::min(cell.min_x, x[i]);
    cell.max_x = std::max(cell.max_x, x[i]);
    cell.min_y = std::min(cell.min_y, y[i]);
    cell.max_y = std::max(cell.max_y, y[i]);
    cell_of_.push_back(slot - 1);
    members_.push_back(i);
  }
  uint32_t first = 0;
  for (Cell& cell : cells_) {
    cell.first = first;
    first += cell.count;
    cell.count = 0;
  }
  sorted_.resize(members_.size());
  for (size_t k = 0; k < members_.size(); ++k) {
    Cell& cell = cells_[cell_of_[k]];
    sorted_[cell.first + cell.count++] = {x[members_[k]], y[members_[k]]};
  }
}

uint32_t Clustering::Root(uint32_t cell) {
  while (cells_[cell].parent != cell) {
    cells_[cell].parent = cells_[cells_[cell].parent].parent;
    cell = cells_[cell].parent;
  }
  return cell;
}

bool Clustering::AreNear(const Cell& a, const Cell& b) const {
  const float gap_x = std::max({0.0f, a.min_x - b.max_x, b.min_x - a.max_x});
  const float gap_y = std::max({0.0f, a.min_y - b.max_y, b.min_y - a.max_y});
  if (gap_x * gap_x + gap_y * gap_y > tolerance_squared_) return false;
  for (uint32_t i = a.first; i < a.first + a.count; ++i) {
    for (uint32_t j = b.first; j < b.first + b.count; ++j) {
      const float dx = sorted_[i].x - sorted_[j].x;
      const float dy = sorted_[i].y - sorted_[j].y;
      if (dx * dx + dy * dy <= tolerance_squared_) return true;
    }
  }
  return false;
}

void Clustering::ConnectNeighbours() {
  for (uint32_t a = 0; a < cells_.size(); ++a) {
    for (const Offset& offset : kNeighbours) {
      const auto column = static_cast<size_t>(cells_[a].column + offset.column);
      const auto row = static_cast<size_t>(cells_[a].row + offset.row);
      const uint32_t slot = cell_at_[row * static_cast<size_t>(width_) + column];
      if (slot == 0) continue;
      const uint32_t root_a = Root(a);
      const uint32_t root_b = Root(slot - 1);
      if (root_a == root_b || !AreNear(cells_[a], cells_[slot - 1])) continue;
      cells_[std::max(root_a, root_b)].parent = std::min(root_a, root_b);
    }
  }
}

void Clustering::Collect() {
  // Cells are in the order of their first point, and a root is the first cell of its component.
  clusters_.begin.clear();
  label_.assign(cells_.size(), 0);
  uint32_t count = 0;
  for (uint32_t cell = 0; cell < cells_.size(); ++cell) {
    const uint32_t root = Root(cell);
    if (root == cell) {
      label_[cell] = count++;
      clusters_.begin.push_back(0);
    } else {
      label_[cell] = label_[root];
    }
    clusters_.begin[label_[cell]] += cells_[cell].count;
  }
  uint32_t first = 0;
  for (uint32_t& begin : clusters_.begin) {
    const uint32_t size = begin;
    begin = first;
    first += size;
  }
  clusters_.begin.push_back(first);
  clusters_.points.resize(members_.size());
  cursor_.assign(clusters_.begin.begin(), clusters_.begin.end());
  for (size_t k = 0; k < members_.size(); ++k)
    clusters_.points[cursor_[label_[cell_of_[k]]]++] = members_[k];
}

const Clusters& Clustering::Run(const std::vector<float>& x, const std::vector<float>& y,
                                std::span<const uint32_t> selected) {
  SortIntoCells(x, y, selected);
  ConnectNeighbours();
  Collect();
  for (const Cell& cell : cells_) {
    cell_at_[static_cast<size_t>(cell.row) * static_cast<size_t>(width_) +
             static_cast<size_t>(cell.column)] = 0;
  }
  return clusters_;
}

}  // namespace hairpin
