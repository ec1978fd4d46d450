#include "core/scene/packed_problem.hpp"

#include "core/jobs/child_program.hpp"
#include "core/scene/body_source.hpp"
#include "core/scene/dimension.hpp"

/// What does not go member by member.
namespace pleuel {

// They have constructors.

template <class Archive>
void transfer(Archive& archive, Number& number) {
  auto& [constant, variable, factor, expression] = number;
  archive(constant, variable, factor, expression);
}

template <class Archive>
void transfer(Archive& archive, Drive& drive) {
  auto& [motion, coordinate] = drive;
  archive(motion, coordinate);
}

template <class Archive>
void transfer(Archive& archive, Quantity& quantity) {
  std::string name(quantity.name), unit(quantity.unit);
  archive(name, unit);
  if constexpr (Archive::is_filling) quantity = {kept_text(name), kept_text(unit)};
}

/// Texts of invariants read back exactly.
template <class Archive>
void transfer(Archive& archive, InvariantsFile& file) {
  std::string text;
  if constexpr (!Archive::is_filling) text = write_invariants(file);
  archive(text);
  if constexpr (Archive::is_filling) {
    file = read_invariants_text(text, "invariants of another process");
  }
}

/// A source goes as the program behind it: what that wrote is in its record.
template <class Archive>
void transfer(Archive& archive, std::shared_ptr<const BodySource>& source) {
  std::optional<BodyGenerator> generator;
  if (source) generator = program_behind(*source);
  archive(generator);
  if constexpr (Archive::is_filling) {
    const ProgramPermission permission;  // who sent it had it
    source = generator ? make_body_source(std::move(*generator)) : nullptr;
  }
}

/// Of a struct with a base there is no list of all members: what is not named here is seen here.
struct NamedSimulationSettings : TimeIntegration {
  bool quasi_static_start, moves_by_bending, checks_resolution;
};
static_assert(sizeof(NamedSimulationSettings) == sizeof(SimulationSettings));

template <class Archive>
void transfer(Archive& archive, SimulationSettings& settings) {
  archive(static_cast<TimeIntegration&>(settings), settings.quasi_static_start,
          settings.moves_by_bending, settings.checks_resolution);
}

/// It has no members.
template <class Archive>
void transfer(Archive&, EnergyBalanceResponse&) {}

// Declared elsewhere: the members are packed here alone.

void transfer(Packer& archive, ProblemFile& problem) {
  with_members(problem, archive);
}

void transfer(Unpacker& archive, ProblemFile& problem) {
  with_members(problem, archive);
}

}  // namespace pleuel
