#include "daemons/global_mapper/map_store.hpp"

#include <filesystem>
#include <utility>

#include "common/clock.hpp"
#include "common/require.hpp"
#include "daemons/global_mapper/map_file.hpp"

namespace hairpin {
namespace {

constexpr Require require("global_mapper");

int64_t TimeOf(const MapRecord& record) {
  return std::visit([](const auto& kind) { return kind.utime; }, record);
}

}  // namespace

MapStore::MapStore(const MapStoreParams& params) : params_(params) {
  require(params.resume_within > 0.0, "resume_within must be > 0");
  require(params.max_journal_bytes > 0, "max_journal_bytes must be > 0");
  if (params_.directory.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(params_.directory, error);
  if (error) problem_ = params_.directory + ": " + error.message();
}

size_t MapStore::Resume(int64_t utime, GlobalMapper& mapper) {
  if (params_.directory.empty()) return 0;
  const std::string file = params_.directory + (mapper.localising() ? "/place" : "/journal");
  journal_ = std::make_unique<Journal>(file, params_.max_journal_bytes);
  const JournalContents contents = ReadJournal(file);
  const int64_t ended = contents.records.empty() ? 0 : TimeOf(contents.records.back());
  const double ago = SecondsBetween(ended, utime);
  if (ago <= 0.0 || ago > params_.resume_within) {
    journal_->Start();
    return 0;
  }
  mapper.Replay(contents.records);
  journal_->Continue(contents.good_bytes);
  return contents.records.size();
}

void MapStore::Keep(const GlobalMapper::Outcome& outcome, int64_t session) {
  if (!journal_) return;
  if (!outcome.records.empty()) journal_->Append(outcome.records, TimeOf(outcome.records.back()));
  if (!journal_failed_ && !journal_->problem().empty()) {
    journal_failed_ = true;
    problem_ = journal_->problem();
  }
  if (outcome.estimate && !outcome.driven.empty()) Save(outcome, session);
}

void MapStore::Save(const GlobalMapper::Outcome& outcome, int64_t session) {
  const GlobalMapEstimate& estimate = *outcome.estimate;
  MapFile map;
  map.session = session;
  map.utime = estimate.utime;
  map.laps = estimate.laps;
  map.gate = FindMapGate(estimate.cones);
  map.driven = outcome.driven;
  map.cones = estimate.cones;
  try {
    SaveMapFile(map, map_file());
  } catch (const std::runtime_error& error) {
    problem_ = error.what();
  }
}

std::string MapStore::TakeProblem() { return std::exchange(problem_, {}); }

}  // namespace hairpin
