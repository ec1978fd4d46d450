#include "core/response/divided_deflection.hpp"

#include <array>
#include <utility>

#include "core/base/dual.hpp"
#include "core/frame/body_frame.hpp"

namespace pleuel {

namespace {

class DividedDeflection final : public Signal {
 public:
  DividedDeflection(DeflectionVectors vectors, DividedReference reference, int direction)
      : signals_{std::move(vectors.place), std::move(vectors.origin), std::move(vectors.end),
                 std::move(vectors.axis)},
        reference_(reference),
        direction_(direction) {}

  int channels() const override { return 1; }
  std::string describe(int) const override {
    const std::string place = signals_[0]->describe(0);
    return place.substr(0, place.find(','));
  }

  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    values(0) = evaluate<double>(numbers<double>(state));
  }

  void add_gradient(const State& state, int, double weight, SignalGradient& gradient) override {
    Numbers<Wide> seeded = numbers<Wide>(state);
    for (int i = 0; i < size; ++i) seeded[i].derivatives()[i] = 1.0;
    const Wide deflection = evaluate<Wide>(seeded);
    for (int i = 0; i < size; ++i) {
      const double slope = deflection.derivatives()[i];
      if (slope == 0.0) continue;
      signals_[i / 3]->add_gradient(state, i % 3, weight * slope, gradient);
    }
  }

 private:
  static constexpr int size = 12;
  using Wide = DualOf<size>;
  template <class Scalar>
  using Numbers = std::array<Scalar, size>;

  template <class Scalar>
  Numbers<Scalar> numbers(const State& state) {
    Numbers<Scalar> all;
    Eigen::VectorXd vector(3);
    for (std::size_t k = 0; k < signals_.size(); ++k) {
      signals_[k]->observe(state, vector);
      for (std::size_t i = 0; i < 3; ++i) {
        all[3 * k + i] = Scalar(vector(i));
      }
    }
    return all;
  }

  template <class Scalar>
  Scalar evaluate(const Numbers<Scalar>& all) const {
    using std::sqrt;
    const auto vector = [&](std::size_t k) {
      return Vector3<Scalar>(all[3 * k], all[3 * k + 1], all[3 * k + 2]);
    };
    const Vector3<Scalar> origin = vector(1), axis = vector(3);
    const Vector3<Scalar> distance = vector(0) - origin;
    if (reference_ == DividedReference::tangent) return axis.dot(distance);
    const Vector3<Scalar> chord = vector(2) - origin;
    const Vector3<Scalar> normal = direction_ == 1 ? axis.cross(chord) : chord.cross(axis);
    return normal.dot(distance) / sqrt(normal.dot(normal));
  }

  std::array<std::unique_ptr<Signal>, 4> signals_;
  DividedReference reference_;
  int direction_;
};

}  // namespace

std::unique_ptr<Signal> make_divided_deflection(DeflectionVectors vectors,
                                                DividedReference reference, int direction) {
  return std::make_unique<DividedDeflection>(std::move(vectors), reference, direction);
}

}  // namespace pleuel
