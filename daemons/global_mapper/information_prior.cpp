#include "daemons/global_mapper/information_prior.hpp"

#include <algorithm>
#include <iterator>

namespace hairpin {
namespace {

using RowMajor33 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using RowMajor23 = Eigen::Matrix<double, 2, 3, Eigen::RowMajor>;
using RowMajor22 = Eigen::Matrix<double, 2, 2, Eigen::RowMajor>;

}  // namespace

InformationPrior::InformationPrior(const Eigen::Vector3d& pose, double variance)
    : H_(Eigen::MatrixXd::Identity(3, 3) / variance),
      b_(Eigen::VectorXd::Zero(3)),
      reference_(pose) {}

std::optional<Eigen::Index> InformationPrior::SlotOf(size_t landmark) const {
  if (landmark >= first_of_.size() || first_of_[landmark] < 0) return std::nullopt;
  return first_of_[landmark];
}

Eigen::Index InformationPrior::AddSlot(size_t landmark, const double* position) {
  if (const auto slot = SlotOf(landmark)) return *slot;
  const Eigen::Index first = size();
  if (first + 2 > H_.rows()) {
    const Eigen::Index room = 2 * H_.rows() + 64;  // copied seldom, so that no pose pays for it
    H_.conservativeResizeLike(Eigen::MatrixXd::Zero(room, room));
  }
  b_.conservativeResizeLike(Eigen::VectorXd::Zero(first + 2));
  reference_.conservativeResize(first + 2);
  reference_.tail<2>() = Eigen::Vector2d(position[0], position[1]);
  if (first_of_.size() <= landmark) first_of_.resize(landmark + 1, -1);
  first_of_[landmark] = first;
  landmarks_.push_back(landmark);
  return first;
}

void InformationPrior::Marginalise(const double* oldest, const double* next,
                                   const OdometryMeasurement& odometry,
                                   const std::vector<Sighting>& sightings) {
  for (const Sighting& sighting : sightings) AddSlot(sighting.landmark, sighting.position);
  const Eigen::Index n = size();
  auto H = H_.topLeftCorner(n, n);
  // Everything that touches the oldest pose: its own block, its row to the rest, its vector.
  // Linear factors are r = r0 + J (x - x0), with d = x - reference: r = (r0 + J (reference - x0)) +
  // J d.
  Eigen::Matrix3d H00 = H.topLeftCorner<3, 3>();
  Eigen::Vector3d b0 = b_.head<3>();
  Eigen::MatrixXd row = H.topRows(3);
  row.leftCols<3>().setZero();  // becomes the next pose's
  H.topRows(3).setZero();
  H.leftCols(3).setZero();
  b_.head<3>().setZero();
  const Eigen::Vector3d shift = reference_.head<3>() - Eigen::Map<const Eigen::Vector3d>(oldest);

  for (const Sighting& sighting : sightings) {
    Eigen::Vector2d r;
    RowMajor23 Jp;
    RowMajor22 Jl;
    LandmarkResidual(*sighting.measurement, oldest, sighting.position, r.data(), Jp.data(),
                     Jl.data());
    const Eigen::Index l = *SlotOf(sighting.landmark);
    r += Jp * shift;
    r += Jl * (reference_.segment<2>(l) - Eigen::Map<const Eigen::Vector2d>(sighting.position));
    const double w = sighting.weight;
    H00 += w * Jp.transpose() * Jp;
    b0 -= w * Jp.transpose() * r;
    row.middleCols<2>(l) += w * Jp.transpose() * Jl;
    H.block<2, 2>(l, l) += w * Jl.transpose() * Jl;
    b_.segment<2>(l) -= w * Jl.transpose() * r;
  }
  Eigen::Vector3d r;
  RowMajor33 J0;
  RowMajor33 J1;
  OdometryResidual(odometry, oldest, next, r.data(), J0.data(), J1.data());
  reference_.head<3>() = Eigen::Map<const Eigen::Vector3d>(next);
  r += J0 * shift;
  H00 += J0.transpose() * J0;
  b0 -= J0.transpose() * r;
  row.leftCols<3>() += J0.transpose() * J1;
  H.topLeftCorner<3, 3>() += J1.transpose() * J1;
  b_.head<3>() -= J1.transpose() * r;

  const Eigen::LLT<Eigen::Matrix3d> factor(H00);
  const Eigen::MatrixXd gain = factor.solve(row);  // 3 x size
  H.triangularView<Eigen::Lower>() -= row.transpose() * gain;
  H.triangularView<Eigen::StrictlyUpper>() = H.transpose();
  b_.noalias() -= gain.transpose() * b0;
}

void InformationPrior::Merge(size_t landmark, size_t into) {
  const auto from = SlotOf(landmark);
  if (!from) return;
  const auto to = SlotOf(into);
  if (!to) {
    // Only renamed; its reference stays what it was.
    if (first_of_.size() <= into) first_of_.resize(into + 1, -1);
    first_of_[into] = *from;
    first_of_[landmark] = -1;
    *std::find(landmarks_.begin(), landmarks_.end(), landmark) = into;
    return;
  }
  // Of x = reference_to + d_to follows d_from = d_to + (reference_to - reference_from).
  const Eigen::Vector2d offset = reference_.segment<2>(*to) - reference_.segment<2>(*from);
  const Eigen::Index n = size();
  b_ -= H_.middleCols<2>(*from).topRows(n) * offset;
  H_.middleRows<2>(*to) += H_.middleRows<2>(*from).eval();
  H_.middleCols<2>(*to) += H_.middleCols<2>(*from).eval();
  b_.segment<2>(*to) += b_.segment<2>(*from).eval();
  const Eigen::Index behind = n - *from - 2;
  const auto shrink = [&](auto& vector) {
    vector.segment(*from, behind) = vector.tail(behind).eval();
    vector.conservativeResize(vector.size() - 2);
  };
  H_.middleRows(*from, behind) = H_.middleRows(*from + 2, behind).eval();
  H_.middleCols(*from, behind) = H_.middleCols(*from + 2, behind).eval();
  H_.middleRows(n - 2, 2).setZero();
  H_.middleCols(n - 2, 2).setZero();
  shrink(b_);
  shrink(reference_);
  std::erase(landmarks_, landmark);
  for (Eigen::Index& first : first_of_) first -= first > *from ? 2 : 0;
  first_of_[landmark] = -1;
}

std::vector<size_t> InformationPrior::KnownAmong(const std::vector<size_t>& landmarks) const {
  std::vector<size_t> known;
  std::copy_if(landmarks.begin(), landmarks.end(), std::back_inserter(known),
               [this](size_t landmark) { return Knows(landmark); });
  return known;
}

std::vector<Eigen::Index> InformationPrior::RowsOf(const std::vector<size_t>& landmarks) const {
  std::vector<Eigen::Index> rows;
  for (const size_t landmark : landmarks) {
    const Eigen::Index first = *SlotOf(landmark);
    rows.push_back(first);
    rows.push_back(first + 1);
  }
  return rows;
}

std::optional<InformationPrior::Quadratic> InformationPrior::Condition(
    const std::vector<size_t>& landmarks, const double* pose, const Values& values) const {
  Eigen::VectorXd difference = -reference_;
  difference.head<3>() += Eigen::Map<const Eigen::Vector3d>(pose);
  for (const size_t landmark : landmarks_)
    difference.segment<2>(*SlotOf(landmark)) += Eigen::Map<const Eigen::Vector2d>(values(landmark));
  // The gradient at the present difference, of which the kept variables' own share is left to
  // solve.
  const std::vector<Eigen::Index> kept = RowsOf(landmarks);
  Quadratic cost{H_(kept, kept), {}};
  const Eigen::LLT<Eigen::MatrixXd> factor(cost.information);
  if (factor.info() != Eigen::Success) return std::nullopt;
  const Eigen::VectorXd gradient =
      H_(Eigen::seqN(0, size()), kept).transpose() * difference - b_(kept);
  cost.mean = reference_(kept) + difference(kept) - factor.solve(gradient);
  return cost;
}

std::optional<InformationPrior::Marginal> InformationPrior::Marginalised(
    const std::vector<size_t>& landmarks) const {
  Marginal marginal;
  std::vector<bool> is_kept(first_of_.size(), false);
  for (const size_t landmark : landmarks) is_kept[landmark] = true;
  std::copy_if(landmarks_.begin(), landmarks_.end(), std::back_inserter(marginal.others),
               [&](size_t landmark) { return !is_kept[landmark]; });
  std::vector<Eigen::Index> kept = RowsOf(landmarks);
  kept.insert(kept.begin(), {0, 1, 2});
  const std::vector<Eigen::Index> others = RowsOf(marginal.others);
  marginal.information.compute(H_(others, others));
  const auto& of_others = marginal.information;
  if (of_others.info() != Eigen::Success) return std::nullopt;
  const Eigen::MatrixXd cross = H_(others, kept);
  marginal.gain = of_others.solve(cross);
  marginal.cost.information = H_(kept, kept);
  marginal.cost.information.noalias() -= cross.transpose() * marginal.gain;
  const Eigen::VectorXd alone = of_others.solve(b_(others));
  const Eigen::LLT<Eigen::MatrixXd> of_kept(marginal.cost.information);
  if (of_kept.info() != Eigen::Success) return std::nullopt;
  const Eigen::VectorXd difference = of_kept.solve(b_(kept) - cross.transpose() * alone);
  marginal.cost.mean = reference_(kept) + difference;
  marginal.mean = reference_(others) + alone - marginal.gain * difference;
  return marginal;
}

}  // namespace hairpin
