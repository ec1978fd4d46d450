#pragma once

#include <random>

namespace pleuel {

/// Numbers of generic size, the same in every run. The engine's raw numbers are prescribed by the
/// standard, unlike those of its distributions.
class GenericNumbers {
 public:
  /// In [0, 1].
  double part() { return static_cast<double>(engine_()) / std::mt19937::max(); }
  /// In [1/2, 1].
  double size() { return 0.5 + 0.5 * part(); }
  /// In [1/2, 1] or [−1, −1/2].
  double signed_size() {
    const double magnitude = size();
    return engine_() % 2 == 0 ? magnitude : -magnitude;
  }

 private:
  std::mt19937 engine_;
};

}  // namespace pleuel
