#include "daemons/gnss_driver/gnss_driver.hpp"

#include <utility>

namespace hairpin {
namespace {

constexpr int64_t kDay = 86'400'000'000;  // us

}  // namespace

GnssDecoder::GnssDecoder(const GnssErrorModel& errors)
    : errors_(errors),
      splitter_({[this](std::string_view text) { OnNmea(text); },
                 [this](uint16_t class_and_id, Bytes payload) { OnUbx(class_and_id, payload); },
                 [this](std::string_view why) { CountBad(why); }}) {}

std::vector<GnssFix> GnssDecoder::Add(Bytes bytes) {
  splitter_.Add(bytes);
  return std::exchange(fixes_, {});
}

std::optional<GnssFix> GnssDecoder::Flush() {
  if (epoch_ && !epoch_->is_out) Emit();
  const std::vector<GnssFix> fixes = std::exchange(fixes_, {});
  return fixes.empty() ? std::nullopt : std::optional(fixes.back());
}

void GnssDecoder::OnNmea(std::string_view text) {
  if (is_ubx_) return;
  try {
    const std::optional<NmeaMessage> message = ParseNmea(text);
    if (message) std::visit([this](const auto& sentence) { Take(sentence); }, *message);
  } catch (const GnssFormatError& error) {
    CountBad(error.what());
  }
}

void GnssDecoder::OnUbx(uint16_t class_and_id, Bytes payload) {
  try {
    if (class_and_id == kUbxNavPvt) {
      const std::optional<UbxNavPvt> pvt = ParseNavPvt(payload);
      if (!pvt) return;
      if (!std::exchange(is_ubx_, true)) epoch_.reset();
      Epoch& epoch = At(pvt->time_of_week_ms);
      const std::optional<double> heading = epoch.fix.heading;
      const double heading_sigma = epoch.fix.heading_sigma;
      epoch.fix = pvt->fix;
      epoch.fix.heading = heading;
      epoch.fix.heading_sigma = heading_sigma;
      epoch.has_position = true;
      Heard(kPvt);
    } else if (class_and_id == kUbxNavRelPosNed && is_ubx_) {
      const UbxNavRelPosNed relative = ParseNavRelPosNed(payload);
      Epoch& epoch = At(relative.time_of_week_ms);
      epoch.fix.heading = relative.heading;
      epoch.fix.heading_sigma = relative.heading_sigma;
      Heard(kRel);
    }
  } catch (const GnssFormatError& error) {
    CountBad(error.what());
  }
}

void GnssDecoder::Take(const NmeaGga& gga) {
  Epoch& epoch = At(gga.time);
  epoch.fix.type = gga.type;
  epoch.dilution = gga.dilution;
  epoch.has_position = true;
  if (gga.position) epoch.fix.position = *gga.position;
  Heard(kGga);
}

void GnssDecoder::Take(const NmeaRmc& rmc) {
  date_ = Date{rmc.day_utime, rmc.time};
  At(rmc.time);
  if (rmc.velocity) TakeVelocity(*rmc.velocity);
  Heard(kRmc);
}

// VTG and HDT carry no time: they belong to the epoch that has begun.
void GnssDecoder::Take(const NmeaVtg& vtg) {
  if (!epoch_) return;
  if (vtg.velocity) TakeVelocity(*vtg.velocity);
  Heard(kVtg);
}

void GnssDecoder::Take(const NmeaHdt& hdt) {
  if (!epoch_) return;
  epoch_->fix.heading = hdt.heading;
  epoch_->fix.heading_sigma = errors_.heading_rad;
  Heard(kHdt);
}

void GnssDecoder::Take(const NmeaGst& gst) {
  At(gst.time).sigma = gst.sigma;
  Heard(kGst);
}

void GnssDecoder::TakeVelocity(const Eigen::Vector2d& velocity) {
  epoch_->fix.velocity = {velocity.x(), velocity.y(), 0.0};
  epoch_->fix.velocity_sigma.setConstant(errors_.velocity_mps);
  epoch_->fix.has_velocity = true;
}

GnssDecoder::Epoch& GnssDecoder::At(int64_t key) {
  if (epoch_ && epoch_->key == key) return *epoch_;
  if (epoch_) {
    if (!epoch_->is_out) Emit();
    expected_ = epoch_->heard;
  }
  epoch_ = Epoch{};
  epoch_->key = key;
  return *epoch_;
}

void GnssDecoder::Heard(Kind kind) {
  epoch_->heard |= kind;
  const bool is_complete = expected_ != 0 && (epoch_->heard & expected_) == expected_;
  if (is_complete && !epoch_->is_out) Emit();
}

void GnssDecoder::Emit() {
  epoch_->is_out = true;
  const std::optional<int64_t> utime = UtimeOf(*epoch_);
  if (!epoch_->has_position || !utime) return;
  if (last_utime_ && *utime <= *last_utime_) {
    CountBad(kTimeDoesNotIncrease);
    return;
  }
  last_utime_ = utime;
  GnssFix fix = epoch_->fix;
  fix.utime = *utime;
  if (!is_ubx_) fix.position_sigma = PositionSigma(*epoch_);
  fixes_.push_back(fix);
}

std::optional<int64_t> GnssDecoder::UtimeOf(const Epoch& epoch) const {
  if (is_ubx_) return epoch.fix.utime;
  if (!date_) return std::nullopt;
  // The first messages of a day may come before the date has changed.
  const bool is_next_day = epoch.key < date_->time - kDay / 2;
  return date_->day_utime + epoch.key + (is_next_day ? kDay : 0);
}

Eigen::Vector3d GnssDecoder::PositionSigma(const Epoch& epoch) const {
  if (epoch.sigma) return *epoch.sigma;
  double sigma = errors_.single_m;
  if (epoch.fix.type == FixType::kDifferential) sigma = errors_.differential_m;
  if (epoch.fix.type == FixType::kFloat) sigma = errors_.float_m;
  if (epoch.fix.type == FixType::kRtk) sigma = errors_.rtk_m;
  sigma *= epoch.dilution;
  return {sigma, sigma, sigma * errors_.vertical_factor};
}

}  // namespace hairpin
