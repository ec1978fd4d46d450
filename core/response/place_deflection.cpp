#include "core/response/place_deflection.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/response/composed_signals.hpp"

namespace pleuel {

namespace {

int index_of(const BodyModel& body, const std::string& place) {
  const std::vector<std::string>& names = body.places.names;
  return static_cast<int>(std::ranges::find(names, place) - names.begin());
}

/// s of the foot of P on the line, and its derivatives by the design.
class ShareOfChord {
 public:
  ShareOfChord(const BodyModel& body, const std::string& place,
               const std::array<std::string, 2>& ends)
      : body_(body),
        p_(index_of(body, place)),
        a_(index_of(body, ends[0])),
        b_(index_of(body, ends[1])) {}

  double value() const {
    const Eigen::Vector3d along = chord(body_.places);
    return offset(body_.places).dot(along) / along.squaredNorm();
  }

  /// s = p·c/c²: s' = (p'·c + p·c' − 2 s c·c')/c²
  Eigen::VectorXd derivatives(int variables) const {
    const Eigen::Vector3d along = chord(body_.places), from = offset(body_.places);
    const double share = value();
    Eigen::VectorXd slopes = Eigen::VectorXd::Zero(variables);
    for (const auto& [variable, change] : body_.places_x) {
      const Eigen::Vector3d along_x = chord(change);
      slopes(variable) = (offset(change).dot(along) + (from - 2.0 * share * along).dot(along_x)) /
                         along.squaredNorm();
    }
    return slopes;
  }

 private:
  Eigen::Vector3d chord(const BodyPlaces& places) const {
    return places.positions.col(b_) - places.positions.col(a_);
  }
  Eigen::Vector3d offset(const BodyPlaces& places) const {
    return places.positions.col(p_) - places.positions.col(a_);
  }

  const BodyModel& body_;
  int p_, a_, b_;
};

}  // namespace

NamedPoint named_point(const BodyModel& body, const std::string& place) {
  return {point_of(body, index_of(body, place)), fmt::format("at \"{}\"", place)};
}

std::unique_ptr<Signal> make_place_deflection(const BodyModel& body, const std::string& place,
                                              const std::array<std::string, 2>& ends, int variables,
                                              int direction) {
  const ShareOfChord share(body, place, ends);
  const double s = share.value();
  const Eigen::VectorXd slopes = share.derivatives(variables);
  const auto deflection = [&](const std::string& name) {
    return make_deflection_signal(body, named_point(body, name), direction);
  };
  const auto scaled = [&](const std::string& name, DesignFactor factor) {
    return std::make_unique<ScaledSignal>(deflection(name), std::vector{std::move(factor)});
  };
  std::vector<SignalSum::Part> parts;
  parts.push_back({1.0, deflection(place)});
  parts.push_back({-1.0, scaled(ends[0], {1.0 - s, -slopes})});
  parts.push_back({-1.0, scaled(ends[1], {s, slopes})});
  return std::make_unique<SignalSum>(std::move(parts));
}

}  // namespace pleuel
