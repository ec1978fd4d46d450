#include "core/response/recovered_signal.hpp"

#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "core/response/body_state.hpp"

namespace pleuel {

namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// The axial forces N = κ ½ q_fᵀ Ĝ q_f of the members of geometric stiffening.
class StretchingForces {
 public:
  /// @param members  may be null: then there are none to ask for
  explicit StretchingForces(std::shared_ptr<const StretchedMembers> members)
      : members_(std::move(members)) {
    if (!members_) return;
    for (const StretchedElement& member : members_->values) {
      if (member.elongation.size() <= moved_.size()) continue;
      moved_.resize(member.elongation.size());
      bent_.resize(member.elongation.size());
    }
  }

  double force(int member, const BodyState& state) {
    const StretchedElement& element = member_of(members_->values, member);
    return 0.5 * element.axial_stiffness * square(element, state);
  }

  void add_gradient(int member, double slope, const BodyState& state, BodyGradient& writer) {
    const StretchedElement& element = member_of(members_->values, member);
    const double value = square(element, state);
    const auto moved = moved_.head(element.elongation.size());
    for (Eigen::Index i = 0; i < moved.size(); ++i) {
      writer.add_coordinate(slope * element.axial_stiffness * bent_(i), element.displacements[i]);
    }
    for (const auto& [variable, all] : members_->derivatives) {
      const StretchedElement& change = member_of(all, member);
      writer.add_design(
          variable, 0.5 * slope *
                        (change.axial_stiffness * value +
                         element.axial_stiffness * moved.dot(change.slopes.lazyProduct(moved))));
    }
  }

 private:
  static const StretchedElement& member_of(const std::vector<StretchedElement>& members,
                                           int member) {
    return members[member];
  }
  /// q_fᵀ Ĝ q_f; leaves q_f of the member and Ĝ q_f.
  double square(const StretchedElement& element, const BodyState& state) {
    const auto q = state.q();
    auto moved = moved_.head(element.elongation.size());
    auto bent = bent_.head(element.elongation.size());
    for (Eigen::Index i = 0; i < moved.size(); ++i) {
      moved(i) = q(element.displacements[i]);
    }
    bent = element.slopes.lazyProduct(moved);
    return moved.dot(bent);
  }

  std::shared_ptr<const StretchedMembers> members_;
  VectorXd moved_, bent_;  ///< scratch, as long as the largest member
};

/// Rows of displacements only, three a place.
SparseMatrix displacement_rows(const BodyPlaces& places) {
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index row = 0; row < places.shape.rows(); ++row) {
    if (row % 6 >= 3) continue;
    for (SparseMatrix::InnerIterator entry(places.shape, row); entry; ++entry) {
      entries.emplace_back(row / 6 * 3 + row % 6, entry.col(), entry.value());
    }
  }
  SparseMatrix rows(3 * places.size(), places.shape.cols());
  rows.setFromTriplets(entries.begin(), entries.end());
  return rows;
}

class RecoveredSignal final : public Signal {
 public:
  RecoveredSignal(const BodyModel& body, const Vector3d& gravity,
                  std::unique_ptr<Stations> stations)
      : body_(body),
        gravity_(gravity),
        stations_(std::move(stations)),
        recovery_(stations_->recovery()),
        displacement_(displacement_rows(body.places)),
        forces_(body.stretched),
        seen_(columns_of(recovery_)) {
    seen_displacement_ = rows_of(displacement_, seen_.places);
  }

  int channels() const override { return stations_->channels(); }
  std::string describe(int channel) const override { return stations_->describe(channel); }

  void observe(const State& state, Eigen::Ref<VectorXd> values) override {
    const BodyState of_body(body_, state);
    numbers_.noalias() = recovery_.of_coordinates * of_body.q();
    if (recovery_.of_accelerations.nonZeros() > 0) {
      set_accelerations(of_body);
      numbers_.noalias() += recovery_.of_accelerations * accelerations_;
    }
    if (body_.has_stiffening && recovery_.of_stretching.nonZeros() > 0) {
      stretching_.resize(recovery_.of_stretching.cols());
      for (int member : seen_.members) stretching_(member) = forces_.force(member, of_body);
      numbers_.noalias() += recovery_.of_stretching * stretching_;
    }
    for (int channel = 0; channel < channels(); ++channel) {
      values(channel) = stations_->value(
          channel, numbers_.data() + stations_->numbers() * stations_->station(channel));
    }
  }

  void add_gradient(const State& state, int channel, double weight,
                    SignalGradient& gradient) override {
    prepare_derivatives();
    const BodyState of_body(body_, state);
    BodyGradient writer(body_, of_body, gradient);
    const int station = stations_->station(channel);
    const Near& near = near_[station];
    set_near(near, of_body);
    const Eigen::Index first = stations_->numbers() * station;
    const Stations::Numbers numbers = recovered(recovery_, first, of_body);
    const Stations::Numbers slopes = weight * stations_->slopes(channel, numbers.data());
    for (Eigen::Index i = 0; i < slopes.size(); ++i) {
      writer.add_elastic(slopes(i), recovery_.of_coordinates, first + i);
    }
    add_accelerations(near, first, slopes, of_body, writer);
    for (int member : near.members) {
      const double slope = slope_of(recovery_.of_stretching, first, member, slopes);
      forces_.add_gradient(member, slope, of_body, writer);
    }
    for (const auto& [k, change] : changes_) {
      writer.add_design(body_.places_x[k].variable, slopes.dot(recovered(change, first, of_body)));
    }
    for (std::size_t k = 0; k < body_.places_x.size(); ++k) {
      writer.add_design(body_.places_x[k].variable,
                        weight * stations_->design_slope(channel, numbers.data(), k));
    }
  }

 private:
  /// Places and members that the numbers of a station, or of all, come from.
  struct Near {
    std::set<int> places, members;
  };

  Near columns_of(const Recovery& recovery) const {
    Near all;
    const auto note = [](const SparseMatrix& rows, Eigen::Index divisor, std::set<int>& columns) {
      for (Eigen::Index row = 0; row < rows.rows(); ++row) {
        for (SparseMatrix::InnerIterator entry(rows, row); entry; ++entry) {
          columns.insert(static_cast<int>(entry.col() / divisor));
        }
      }
    };
    note(recovery.of_accelerations, 3, all.places);
    if (body_.has_stiffening) note(recovery.of_stretching, 1, all.members);
    return all;
  }

  /// Three rows of each place.
  static SparseMatrix rows_of(const SparseMatrix& displacement, const std::set<int>& places) {
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::Index row = 0;
    for (const int place : places) {
      for (Eigen::Index k = 0; k < 3; ++k, ++row) {
        for (SparseMatrix::InnerIterator entry(displacement, 3 * place + k); entry; ++entry) {
          entries.emplace_back(row, entry.col(), entry.value());
        }
      }
    }
    SparseMatrix rows(row, displacement.cols());
    rows.setFromTriplets(entries.begin(), entries.end());
    return rows;
  }

  /// Of all places that are seen, against free fall, local axes; the others are left as they are.
  void set_accelerations(const BodyState& state) {
    const FrameMotion<double> frame = state.frame();
    displacements_.noalias() = seen_displacement_ * state.q();
    rates_.noalias() = seen_displacement_ * state.v();
    rates_of_rates_.noalias() = seen_displacement_ * state.a();
    accelerations_.resize(displacement_.rows());
    Eigen::Index i = 0;
    for (const int place : seen_.places) {
      accelerations_.segment<3>(3 * place) = local_acceleration<double>(
          frame, gravity_,
          {body_.places.positions.col(place) + displacements_.segment<3>(i), rates_.segment<3>(i),
           rates_of_rates_.segment<3>(i)});
      i += 3;
    }
  }

  /// Of those that one station needs; the others are left as they are.
  void set_near(const Near& near, const BodyState& state) {
    const FrameMotion<double> frame = state.frame();
    accelerations_.resize(displacement_.rows());
    stretching_.resize(recovery_.of_stretching.cols());
    for (int place : near.places) {
      accelerations_.segment<3>(3 * place) =
          local_acceleration<double>(frame, gravity_, motion(place, state));
    }
    for (int member : near.members) stretching_(member) = forces_.force(member, state);
  }

  PointMotion motion(int place, const BodyState& state) const {
    return state.motion(body_.places.positions.col(place), displacement_, 3 * place);
  }

  /// The numbers of a station, from accelerations and stretching that are set.
  Stations::Numbers recovered(const Recovery& recovery, Eigen::Index first,
                              const BodyState& state) const {
    Stations::Numbers numbers(stations_->numbers());
    for (Eigen::Index i = 0; i < numbers.size(); ++i) {
      numbers(i) = product(recovery.of_coordinates, first + i, state.q()) +
                   product(recovery.of_accelerations, first + i, accelerations_);
      if (!body_.has_stiffening) continue;
      numbers(i) += product(recovery.of_stretching, first + i, stretching_);
    }
    return numbers;
  }

  /// Σ slopes · column
  static double slope_of(const SparseMatrix& rows, Eigen::Index first, Eigen::Index column,
                         const Stations::Numbers& slopes) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < slopes.size(); ++i) {
      sum += slopes(i) * rows.coeff(first + i, column);
    }
    return sum;
  }

  void add_accelerations(const Near& near, Eigen::Index first, const Stations::Numbers& slopes,
                         const BodyState& state, BodyGradient& writer) const {
    if (near.places.empty()) return;
    const FrameMotion<double> frame = state.frame();
    for (int place : near.places) {
      Vector3d slope;
      for (Eigen::Index k = 0; k < 3; ++k) {
        slope(k) = slope_of(recovery_.of_accelerations, first, 3 * place + k, slopes);
      }
      if (slope.isZero(0.0)) continue;
      std::array<Vector3<WideDual>, 3> fixed;
      const PointMotion moved = motion(place, state);
      for (std::size_t k = 0; k < 3; ++k) fixed[k] = moved[k].cast<WideDual>();
      const auto slopes_of_frame =
          derivatives_of<frame_directions>([&](const SeedGroup& seed) -> WideDual {
            const auto acceleration =
                local_acceleration<WideDual>(state.seeded_frame(seed), gravity_, fixed);
            return acceleration(0) * slope(0) + acceleration(1) * slope(1) +
                   acceleration(2) * slope(2);
          });
      writer.add_frame(1.0, slopes_of_frame);
      writer.add_place(place,
                       {frame.omega.cross(frame.omega.cross(slope)) - frame.alpha.cross(slope),
                        2.0 * slope.cross(frame.omega), slope});
    }
  }

  void prepare_derivatives() {
    if (!near_.empty()) return;
    near_.resize(recovery_.of_coordinates.rows() / stations_->numbers());
    record_near(recovery_);
    for (std::size_t k = 0; k < body_.places_x.size(); ++k) {
      Recovery change = stations_->recovery_derivative(k);
      if (is_zero(change)) continue;
      record_near(change);
      changes_.emplace_back(k, std::move(change));
    }
  }

  static bool is_zero(const Recovery& recovery) {
    const auto has_none = [](const SparseMatrix& rows) {
      return rows.coeffs().size() == 0 || rows.coeffs().isZero(0.0);
    };
    return has_none(recovery.of_coordinates) && has_none(recovery.of_accelerations) &&
           has_none(recovery.of_stretching);
  }

  void record_near(const Recovery& recovery) {
    const auto note = [&](const SparseMatrix& rows, Eigen::Index divisor, auto part) {
      for (Eigen::Index row = 0; row < rows.rows(); ++row) {
        Near& near = near_[row / stations_->numbers()];
        for (SparseMatrix::InnerIterator entry(rows, row); entry; ++entry) {
          (near.*part).insert(static_cast<int>(entry.col() / divisor));
        }
      }
    };
    note(recovery.of_accelerations, 3, &Near::places);
    if (body_.has_stiffening) note(recovery.of_stretching, 1, &Near::members);
  }

  const BodyModel& body_;
  Vector3d gravity_;
  std::unique_ptr<Stations> stations_;
  Recovery recovery_;
  SparseMatrix displacement_;  ///< of all places, 3 places × n
  StretchingForces forces_;
  /// Derivatives of the recovery, once they are needed: those that are not zero, by their index.
  std::vector<std::pair<std::size_t, Recovery>> changes_;
  std::vector<Near> near_;  ///< of each station
  Near seen_;               ///< of all stations
  SparseMatrix seen_displacement_;
  VectorXd numbers_, accelerations_, stretching_;    ///< scratch
  VectorXd displacements_, rates_, rates_of_rates_;  ///< scratch, of the places seen
};

}  // namespace

std::unique_ptr<Signal> make_recovered_signal(const BodyModel& body, const Vector3d& gravity,
                                              std::unique_ptr<Stations> stations) {
  return std::make_unique<RecoveredSignal>(body, gravity, std::move(stations));
}

}  // namespace pleuel
