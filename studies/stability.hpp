#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace pleuel {

/// How one file ran with one formulation of the constrained equations of motion.
struct StabilityRun {
  std::filesystem::path file;
  std::string problem;  ///< its name
  std::string formulation;
  std::string failure;  ///< empty: it succeeded; else nothing below is known
  int steps = 0, newton_iterations = 0, factorizations = 0;
  double position_drift = 0.0, velocity_drift = 0.0;  ///< largest |Φ| and |dΦ/dt|: see Monitors
  double energy_error = 0.0;                          ///< relative
  double condition = 0.0;             ///< largest of a step matrix, scaled: see LinearSolver
  std::vector<std::string> warnings;  ///< what speaks against the numbers of its responses
  double seconds = 0.0;               ///< wall time of the simulation, one thread

  bool is_ok() const { return failure.empty(); }
};

/// A formulation by what it changes in a file.
struct ComparedFormulation {
  std::string name;
  std::vector<std::string> overrides;  ///< as in read_problem()
};

/// The formulations that are compared: all that /simulation/formulation of a file may name, index 1
/// as it is, with Baumgarte's terms (100 1/s) and with projection. Then index 3 with other schemes
/// than that of the file: Newmark's with its spectral radius, and implicit Euler.
const std::vector<ComparedFormulation>& compared_formulations();

/// Sees each run as it is done.
using StabilityObserver = std::function<void(const StabilityRun&)>;

/// Simulates the start design of each file with each of them; everything else is as
/// the file says.
/// @param overrides  of all files, as in read_problem()
/// @param load_case  the only one of each file that is meant; none: files have no load cases
/// @throws InputError for a file that cannot be read, before any is simulated; a failing simulation
///         is only marked
/// @throws Stopped if a stop was asked for before the first run was done; later, the runs that were
///         done are returned
std::vector<StabilityRun> stability_study(const std::vector<std::filesystem::path>& files,
                                          const std::vector<std::string>& overrides,
                                          const StabilityObserver& observer = {},
                                          const std::optional<std::string>& load_case = {});

}  // namespace pleuel
