#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "daemons/global_mapper/pose_landmark_graph.hpp"
#include "tools/evaluation/slam_dataset.hpp"

namespace hairpin {

struct SlamReport {
  double final_cost = 0.0;  // half the sum of squared whitened residuals, no loss function
  int full_solves = 0;
  std::vector<double> step_ms;  // wall time of each pose's update
  double total_s = 0.0;
};

/// Feeds a dataset into a graph step by step. After each step the newest poses are solved;
/// everything is, when a known landmark is seen where it should not be (a loop closes), or after
/// `full_solve_steps`, and at the end.
SlamReport EvaluateSlam(const SlamDataset& dataset, const GraphParams& params,
                        int full_solve_steps);

nlohmann::json ToJson(const SlamReport& report);

}  // namespace hairpin
