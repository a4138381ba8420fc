#pragma once

#include <vector>

#include "daemons/lidar_cone_detector/ground_plane.hpp"
#include "daemons/lidar_cone_detector/polar_grid.hpp"

namespace hairpin {

struct GroundLineParams {
  double max_slope = 0.0;         // against the plane
  double slope_sigma = 0.0;       // how steep ground usually is against the plane
  double height_sigma = 0.0;      // of a cell's lowest point about its line [m]
  double tolerance = 0.0;         // a point this close to a line goes on with it [m]
  double max_start_height = 0.0;  // of the first point of a sector above or below the plane [m]
  int min_points = 0;             // that a line which departs from the last one must have
};

/// The ground's height above the plane in every sector, as lines over range fitted piece by piece
/// outward [Himmelsbach 2010]. A line goes on as long as the next lowest point lies close to it; a
/// new one needs several points in a row, so that neither a lone cone nor a reflection from below
/// the ground bends it. Where a sector has no ground, its neighbours tell.
class GroundLines {
 public:
  GroundLines(const GroundLineParams& params, const PolarGrid& grid);
  void Fit(const PolarGrid& grid, const GroundPlane& plane);
  /// Height above the plane [m] at the middle of a sector, at the inner edge of a bin. `bin` goes
  /// to bins() inclusive.
  float at(int sector, int bin) const {
    return table_[static_cast<size_t>(sector) * static_cast<size_t>(bins_ + 1) +
                  static_cast<size_t>(bin)];
  }
  const float* row(int sector) const {
    return table_.data() + static_cast<size_t>(sector) * static_cast<size_t>(bins_ + 1);
  }

 private:
  struct Sample {
    float range;
    float height;
  };
  /// Regression of height on range, pulled to slope zero by what ground usually is.
  struct Line {
    double n = 0.0, r = 0.0, h = 0.0, rr = 0.0, rh = 0.0;
    float first_range = 0.0f, last_range = 0.0f;
    float slope = 0.0f, offset = 0.0f;
    float At(float range) const { return offset + slope * range; }
  };

  void Add(Line& line, const Sample& sample) const;
  bool Extends(const Line& line, const Sample& sample) const;
  /// Lines of one sector, from the car outward.
  void FitSector(const PolarGrid& grid, const GroundPlane& plane, int sector);
  void TryPending();
  void WriteRow(int sector);
  void FillEmptySectors();

  GroundLineParams params_;
  int sectors_;
  int bins_;
  float bin_length_;
  std::vector<float> table_;
  std::vector<uint8_t> known_;   // sectors with a line of their own
  std::vector<Line> lines_;      // of the sector in work
  std::vector<Sample> pending_;  // that do not fit the last line
};

}  // namespace hairpin
