#pragma once

#include <string>
#include <vector>

#include "tools/simulator/track.hpp"
#include "tools/surveying/survey.hpp"

namespace hairpin {

/// The track that the points mark, in local ENU about the first of them: each side in driving order
/// from the start on, in whatever order it was walked. Needs one start and one point ahead of it;
/// the last ones count. Throws TrackError where the points make no drivable track.
Track TrackOf(const std::vector<SurveyedPoint>& points, const std::string& name);

}  // namespace hairpin
