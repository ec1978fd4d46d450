#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/response/composed_signals.hpp"

namespace pleuel::test::largest_signal_test {
namespace {

/// q₀, −q₀ and 2 q₁ − 1.
class ThreeLines final : public Signal {
 public:
  int channels() const override { return 3; }
  std::string describe(int channel) const override { return fmt::format("line {}", channel); }
  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    values << state.q(0), -state.q(0), 2.0 * state.q(1) - 1.0;
  }
  void add_gradient(const State&, int channel, double weight, SignalGradient& gradient) override {
    if (channel == 2) {
      gradient.q(1) += 2.0 * weight;
    } else {
      gradient.q(0) += channel == 0 ? weight : -weight;
    }
  }
};

/// max(|q₀|, 2 q₁ − 1) and its slope, one after the other of its three sides.
TEST(LargestSignal, IsTheLargestAtEachInstant) {
  LargestSignal signal(std::make_unique<ThreeLines>(), "largest");
  EXPECT_EQ(signal.channels(), 1);
  EXPECT_EQ(signal.describe(0), "largest");
  struct Case {
    Eigen::Vector2d q;
    double value;
    Eigen::Vector2d slope;
  };
  for (const Case& one : {Case{{0.5, 0.0}, 0.5, {1.0, 0.0}}, Case{{-0.7, 0.5}, 0.7, {-1.0, 0.0}},
                          Case{{-0.7, 1.5}, 2.0, {0.0, 2.0}}}) {
    State state;
    state.q = one.q;
    Eigen::VectorXd value(1);
    signal.observe(state, value);
    EXPECT_EQ(value(0), one.value);
    SignalGradient gradient(2, 0, 0);
    signal.add_gradient(state, 0, 3.0, gradient);
    EXPECT_EQ(Eigen::Vector2d(gradient.q), 3.0 * one.slope);
  }
}

}  // namespace
}  // namespace pleuel::test::largest_signal_test
