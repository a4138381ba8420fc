#include "tools/evaluation/slam_dataset.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "tools/evaluation/recording_error.hpp"

namespace hairpin {
namespace {

constexpr double kNominalRange = 10.0;  // m, at which x, y noise is bearing and range noise

class Parser {
 public:
  Parser(std::string file, NoiseReading reading) : file_(std::move(file)), reading_(reading) {
    dataset_.steps.emplace_back();
  }

  void Take(const std::string& line) {
    ++line_;
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "ODOMETRY") {
      TakeOdometry(words);
    } else if (kind == "LANDMARK") {
      TakeSighting(words);
    } else if (!kind.empty()) {
      Refuse("neither ODOMETRY nor LANDMARK");
    }
  }

  SlamDataset Finish() {
    dataset_.num_landmarks = landmarks_.size();
    return std::move(dataset_);
  }

 private:
  [[noreturn]] void Refuse(const std::string& reason) const {
    throw RecordingError(file_ + ":" + std::to_string(line_) + ": " + reason);
  }

  double Number(std::istream& words) const {
    double number = 0.0;
    if (!(words >> number)) Refuse("a number is missing");
    return number;
  }

  template <int size>
  Eigen::Matrix<double, size, size> CovarianceFrom(std::istream& words) const {
    Eigen::Matrix<double, size, size> noise;
    for (int row = 0; row < size; ++row) {
      for (int column = row; column < size; ++column)
        noise(row, column) = noise(column, row) = Number(words);
    }
    if (Eigen::LLT<Eigen::Matrix<double, size, size>>(noise).info() != Eigen::Success)
      Refuse("its noise is not positive definite");
    if (reading_ == NoiseReading::kInformation) noise = noise.inverse().eval();
    return noise;
  }

  Eigen::Vector2d PolarSigmaFrom(const Eigen::Matrix2d& at_10m) const {
    if (std::abs(at_10m(0, 0) - at_10m(1, 1)) > 1e-4 || at_10m(0, 1) != 0.0)
      Refuse("noise of bearing and range must be v 0 v");
    return {std::sqrt(at_10m(0, 0) / kNominalRange), std::sqrt(at_10m(0, 0))};
  }

  void TakeOdometry(std::istream& words) {
    int from = 0;
    int to = 0;
    if (!(words >> from >> to)) Refuse("two ids are missing");
    if (newest_ >= 0 && from != newest_) Refuse("odometry does not go on from the newest pose");
    newest_ = to;
    SlamDataset::Step step;
    const double x = Number(words);
    const double y = Number(words);
    step.odometry.T_from_to = {x, y, Number(words)};
    step.odometry.sqrt_information = SqrtInformation(CovarianceFrom<3>(words));
    dataset_.steps.push_back(step);
  }

  void TakeSighting(std::istream& words) {
    int pose = 0;
    int id = 0;
    if (!(words >> pose >> id)) Refuse("two ids are missing");
    if (pose != newest_) Refuse("a landmark is not seen from the newest pose");
    SlamDataset::Sighting sighting{
        landmarks_.try_emplace(id, landmarks_.size()).first->second, {}, {}};
    const double x = Number(words);
    sighting.measurement.position = {x, Number(words)};
    Eigen::Matrix2d covariance = CovarianceFrom<2>(words);
    if (reading_ == NoiseReading::kBearingRange) {
      const Eigen::Vector2d& seen = sighting.measurement.position;
      sighting.polar_sigma = PolarSigmaFrom(covariance);
      const double across = sighting.polar_sigma->x() * seen.norm();
      const double along = sighting.polar_sigma->y();
      covariance = RotateCovariance(Eigen::Vector2d(along * along, across * across).asDiagonal(),
                                    std::atan2(seen.y(), seen.x()));
    }
    sighting.measurement.sqrt_information = SqrtInformation(covariance);
    dataset_.steps.back().sightings.push_back(sighting);
  }

  std::string file_;
  NoiseReading reading_;
  int line_ = 0;
  int newest_ = -1;
  std::map<int, size_t> landmarks_;  // by id
  SlamDataset dataset_;
};

}  // namespace

SlamDataset LoadSlamDataset(const std::string& file, NoiseReading reading) {
  std::ifstream stream(file);
  if (!stream) throw RecordingError(file + ": cannot be read");
  Parser parser(file, reading);
  for (std::string line; std::getline(stream, line);) parser.Take(line);
  return parser.Finish();
}

}  // namespace hairpin
