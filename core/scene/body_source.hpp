#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/scene/body_constants.hpp"

namespace pleuel {

/// Makes an elastic body for a design, with derivatives. What it makes for two designs has the same
/// coordinates, places, points and elements.
class BodySource {
 public:
  virtual ~BodySource() = default;

  /// @param values  of the variables [SI], in their order
  /// @returns       InvariantsFile::design has these variables in this order
  /// @throws SimulationError if no body can be made for this design
  virtual std::shared_ptr<const InvariantsFile> at(const Eigen::VectorXd& values) const = 0;

  /// What at() follows from besides the design: two sources with the same text make the same bodies.
  virtual std::string identity() const = 0;

  /// How far a design is from the nearest one that a body was made for, relative, if what at()
  /// returns in between is continued; 0: every body is made for its design.
  virtual double distance(const Eigen::VectorXd& /*values*/) const { return 0.0; }
};

// How a problem file says that bodies are made, and what makes them.

/// A design variable that the making of a body depends on.
struct MadeVariable {
  std::string name;
  std::string unit;  ///< SI
};

struct BodyGenerator {
  std::string body;
  std::vector<std::string> command;  ///< a program with its arguments; empty: a function
  std::string folder;                ///< that it runs in: that of the problem file
  std::vector<std::string> files;    ///< that it reads, besides those that the command names
  std::vector<MadeVariable> variables;
  bool gives_derivatives = false;  ///< else they are forward differences of calls
  double step = 1e-4;              ///< of these, relative
  double time_limit = 3600.0;      ///< of a call [s]
  std::string record;              ///< folder that keeps what programs wrote; empty: none
};

/// A function of the process that uses Pleuel as a library, in place of a program.
/// @param values  of the variables of the generator [SI], in their order
/// @returns       a file of invariants
/// @throws SimulationError if there is no body for this design
using BodyFunction = std::function<std::string(const Eigen::VectorXd& values)>;

/// From now on, problems that are read in this process have bodies of this name with a generator made
/// by the function; an empty one takes it back. Any thread may call it.
void register_body(const std::string& body, BodyFunction function);

/// Calls the registered function, or else the program, once for each design, and once more for each
/// variable where it gives no derivatives; programs beside each other. What was made is kept, in
/// memory and, of programs, in the folder of the record.
/// @throws InputError if there is no function, and no program that is allowed
///         (core/jobs/child_program.hpp); from at(), SimulationError
std::shared_ptr<const BodySource> make_body_source(BodyGenerator generator);

/// The generator behind a source, to send it to another process.
/// @throws InputError if it is another kind of source, or a function
const BodyGenerator& program_behind(const BodySource& source);

}  // namespace pleuel
