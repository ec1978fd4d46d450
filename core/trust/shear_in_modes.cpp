#include "core/trust/shear_in_modes.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/response/body_frequency.hpp"
#include "core/trust/beam_bending.hpp"

namespace pleuel {

namespace {

/// Modes of up to twice the frequency of one may pass it: shear takes less than half of them.
constexpr double highest_passing = 2.0;

/// Half of the share of shear in the energy of a mode: ω² is stiffness.
double share_of_mode(double shear, double energy_of_mode) {
  return energy_of_mode > 0.0 ? 0.5 * shear / (energy_of_mode + shear) : 0.0;
}

}  // namespace

/// @param modes  ascending, so many that none that is left out can pass
double ShearInModes::change_of_number(const std::vector<LoweredMode>& modes, int number) {
  std::vector<double> with_shear;
  for (const LoweredMode& mode : modes) with_shear.push_back(mode.frequency * (1.0 - mode.share));
  std::sort(with_shear.begin(), with_shear.end());
  const double shown = modes[number].frequency;
  return shown > 0.0 ? std::max(0.0, 1.0 - with_shear[number] / shown) : 0.0;
}

double ShearInModes::of_body(const std::string& beam, const ModeChoice& choice) const {
  const BodyModel& body = model_of_modes(run_.analysis).body(beam);
  const BendingReader reader(run_.problem, run_.x, beam);
  const auto lowered = [&](const BodyMode& mode) {
    State state(body.elastic_offset() + body.elastic_size(), 0);
    state.q.tail(body.elastic_size()) = mode.shapes.col(0).real();
    const double of_mode = 0.5 * mode.square;  // all energy of a mode with unit mass
    return LoweredMode{std::sqrt(mode.square),
                       share_of_mode(reader.shear_energy(body, state), of_mode)};
  };
  const LoweredMode shown = lowered(body_mode(body, choice));
  if (choice.axis) return shown.share;
  std::vector<LoweredMode> modes;
  for (int i = 0; i < body.elastic_size(); ++i) {
    modes.push_back(lowered(body_mode(body, {i})));
    if (modes.back().frequency > highest_passing * shown.frequency) break;
  }
  return change_of_number(modes, choice.number);
}

double ShearInModes::of_mechanism(const std::string& beam, std::size_t response) {
  const int number = run_.analysis.mechanism_modes[response];
  if (run_.problem.responses[response].mode.axis) return lowered_mode(beam, number).share;
  const Eigen::VectorXd& frequencies = run_.analysis.mechanism_frequencies;
  std::vector<LoweredMode> modes;
  for (int i = 0; i < frequencies.size(); ++i) {
    if (frequencies(i) > highest_passing * std::abs(frequencies(number))) break;
    modes.push_back(lowered_mode(beam, i));
  }
  return change_of_number(modes, number);
}

ShearInModes::LoweredMode ShearInModes::lowered_mode(const std::string& beam, int number) {
  const Model& model = model_of_modes(run_.analysis);
  const BendingReader reader(run_.problem, run_.x, beam);
  const Vibration& mode = vibration(number);
  State state(model.mechanism.system->coordinates(), model.mechanism.system->multipliers());
  state.q = mode.shape;
  double shear = 0.0;
  for (const BodyModel* part : model.parts(beam)) shear += reader.shear_energy(*part, state);
  return {run_.analysis.mechanism_frequencies(number), share_of_mode(shear, mode.energy)};
}

const ShearInModes::Vibration& ShearInModes::vibration(int number) {
  const auto known = vibrations_.find(number);
  if (known != vibrations_.end()) return known->second;
  if (!frozen_) {
    frozen_.emplace(model_of_modes(run_.analysis), run_.analysis.vibrating->initial.state);
  }
  const ModalVectors vectors = modal_vectors(frozen_->frozen, frozen_->modes, number);
  const Eigen::VectorXcd first = vectors.right.col(0);
  Eigen::Index largest = 0;
  first.cwiseAbs().maxCoeff(&largest);
  const Eigen::VectorXd shape = (first / first(largest)).real();
  const double frequency = std::max(frequency_of(vectors.s), 0.0);
  const double energy = 0.5 * frequency * frequency * shape.dot(frozen_->frozen.M * shape);
  return vibrations_[number] = {shape, energy};
}

}  // namespace pleuel
