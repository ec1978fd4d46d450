#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/response/modal_vectors.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// What shear, which a beam leaves out, would change of natural frequencies, as a share of them. It
/// lowers ω² by its share in the energy of the mode, estimated with the shape that the mode has
/// without it; modes that it lowers more may pass others, and the number of a frequency counts them
/// as they stand then. Of a mode along an axis it is that of this mode.
class ShearInModes {
 public:
  /// @param run  must outlive this
  explicit ShearInModes(const TrustedRun& run) : run_(run) {}

  /// Of a frequency of a beam in its frame.
  /// @throws InputError if the beam has no such mode
  double of_body(const std::string& beam, const ModeChoice& choice) const;

  /// Of a frequency of the whole mechanism, by shear in one beam.
  /// @param response  index of the frequency
  double of_mechanism(const std::string& beam, std::size_t response);

 private:
  /// A natural mode, and by how much of it shear would lower its frequency.
  struct LoweredMode {
    double frequency = 0.0, share = 0.0;
  };
  /// A mode of the mechanism, with its energy.
  struct Vibration {
    Eigen::VectorXd shape;
    double energy = 0.0;  ///< ½ ω² φᵀ M φ; 0 of what does not vibrate
  };

  static double change_of_number(const std::vector<LoweredMode>& modes, int number);
  LoweredMode lowered_mode(const std::string& beam, int number);
  const Vibration& vibration(int number);

  const TrustedRun& run_;
  // Of the mechanism, as they are asked for.
  std::optional<FrozenModes> frozen_;
  std::map<int, Vibration> vibrations_;
};

}  // namespace pleuel
